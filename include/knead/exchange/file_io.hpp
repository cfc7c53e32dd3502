#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "knead/base/error.hpp"

namespace knead {

/// Bytes of the largest file that is read: a model takes several times as much memory as its file.
inline constexpr std::size_t max_file_size = std::size_t{1} << 30;

/// The whole file, or what comes through a pipe, as bytes. Errors (input), where `file` names it: it does not exist, is
/// a directory, cannot be read, is larger than `most` bytes, or is a named pipe into which nothing writes for three
/// seconds.
[[nodiscard]] Expected<std::string> read_file(const std::filesystem::path& path, std::size_t most = max_file_size);

/// Whether `write_file_atomically` may put a file there, as far as that can be told without writing. Errors (input): it
/// is a directory, or a file that nobody may write to; its directory does not exist or may not be written to; links
/// lead in a circle.
[[nodiscard]] Expected<void> check_writable(const std::filesystem::path& path);

/// Puts `bytes` at `path` entirely or not at all: written to a temporary file in the same directory, given the
/// permissions of the file it replaces, flushed to the disk, renamed, and the directory flushed. Symbolic links are
/// followed, also to a file that does not exist yet. On failure nothing is left behind and `path` is unchanged. A
/// process that is killed leaves its temporary file (.knead-XXXXXX), which the next call in that directory removes: the
/// lock on it tells that nobody writes it any more.
///
/// Errors (input): those of `check_writable`, and what the system says while it writes.
[[nodiscard]] Expected<void> write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace knead
