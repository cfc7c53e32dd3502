#pragma once

#include <string>

#include "knead/base/error.hpp"

namespace knead::cli {

/// The files of `knead snake`.
struct SnakeArguments {
  std::string image, script, output, mask;
};

/// An error of what a script asks for, which names it; without a script it is about the image.
[[nodiscard]] Error of_script(Error error, const SnakeArguments& options);

/// Files that a script names are beside it.
[[nodiscard]] std::string beside(const std::string& script, const std::string& file);

/// `knead snake` in a volume, whose bytes (NRRD) were read from `options.image`.
[[nodiscard]] Expected<void> run_volume_snake(const SnakeArguments& options, std::string bytes);

}  // namespace knead::cli
