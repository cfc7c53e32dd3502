#pragma once

#include <string>
#include <vector>

#include "knead/base/error.hpp"

namespace knead::cli {

/// A file named on the command line: the option, and the path as given (empty: not given).
struct NamedFile {
  std::string option, path;
};

/// Finds out before the work begins what would keep the results from being written. Errors: an output that is the same
/// file as another output or as one of `inputs` (usage); a directory that is missing or may not be written to (input).
/// Devices and pipes are always taken to be writable, and different from one another.
[[nodiscard]] Expected<void> check_outputs(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs);

}  // namespace knead::cli
