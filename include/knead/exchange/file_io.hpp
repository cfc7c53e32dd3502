#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "knead/base/error.hpp"

namespace knead {

/// The whole file as bytes. Errors (input): it does not exist, is not a regular file, or cannot be read; `file` names
/// it.
[[nodiscard]] Expected<std::string> read_file(const std::filesystem::path& path);

/// Puts `bytes` at `path` entirely or not at all: written to a temporary file in the same directory, flushed to the
/// disk, given the permissions of the file it replaces, and renamed. A symbolic link is followed. On failure nothing is
/// left behind and `path` is unchanged. Errors (input): the directory or the file cannot be written.
[[nodiscard]] Expected<void> write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace knead
