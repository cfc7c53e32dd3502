#pragma once

#include <string>

#include "knead/exchange/file_info.hpp"

namespace knead::cli {

/// What is in a file, for people: lines, each with its end.
[[nodiscard]] std::string info_text(const FileInfo& info);

}  // namespace knead::cli
