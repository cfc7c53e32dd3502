#pragma once

#include "knead/exchange/file_info.hpp"

namespace knead::cli {

/// The parts of an assembly and where they stand; nothing for a file whose coordinates are the
/// model's.
void print_parts(const FileInfo& info);

}  // namespace knead::cli
