#pragma once

#include <string>
#include <vector>

#include "knead/base/error.hpp"

namespace knead::cli {

/// A file named on the command line: the option, and the path as given (empty: not given).
struct NamedFile {
  std::string option, path;
};

/// Checks before the work begins whether the results can be written. Errors: an output that is the same
/// file as another output or as one of `inputs` (usage); a directory that is missing or not writable (input). Devices
/// and pipes are always assumed writable, and different from one another.
[[nodiscard]] Expected<void> check_outputs(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs);

}  // namespace knead::cli
