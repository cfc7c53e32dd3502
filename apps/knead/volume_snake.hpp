#pragma once

#include <string>

#include "knead/base/error.hpp"

namespace knead::cli {

/// The files of `knead snake`.
struct SnakeArguments {
  std::string image, script, output, mask;
};

/// Files that a script names are beside it.
[[nodiscard]] std::string beside(const std::string& script, const std::string& file);

/// Whether the file begins as a volume (NRRD) does.
[[nodiscard]] bool is_volume_file(const std::string& path);

/// `knead snake` in a volume.
[[nodiscard]] Expected<void> run_volume_snake(const SnakeArguments& options);

}  // namespace knead::cli
