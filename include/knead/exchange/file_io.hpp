#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "knead/base/error.hpp"

namespace knead {

/// Bytes of the largest file that is read: a model takes several times as much memory as its file.
inline constexpr std::size_t max_file_size = std::size_t{1} << 30;

/// The whole file, or what comes through a pipe, as bytes. Errors (input), where `file` names it:
/// it does not exist, is a directory, cannot be read, is larger than `most` bytes, or is a named
/// pipe into which nothing writes for three seconds.
[[nodiscard]] Expected<std::string> read_file(const std::filesystem::path& path,
                                              std::size_t most = max_file_size);

/// Whether `write_file_atomically` may put a file there, as far as that can be told without
/// writing. Errors (input): it is a directory, or a file that nobody may write to; its directory
/// does not exist or may not be written to; links lead in a circle.
[[nodiscard]] Expected<void> check_writable(const std::filesystem::path& path);

/// Puts `bytes` at `path` entirely or not at all: written to a temporary file in the same
/// directory, given the permissions of the file it replaces, flushed to the disk, renamed, and the
/// directory flushed. Symbolic links are followed, also to a file that does not exist yet. On
/// failure nothing is left behind and `path` is unchanged. A process that is killed leaves its
/// temporary file (.knead-XXXXXX), which the next call in that directory removes: the lock on it
/// tells that nobody writes it any more.
///
/// Errors (input): those of `check_writable`, and what the system says while it writes.
[[nodiscard]] Expected<void> write_file_atomically(const std::filesystem::path& path,
                                                   std::string_view bytes);

/// How a whole file is compressed: by gzip (RFC 1952, one member), or as the only entry of a ZIP
/// archive, stored or deflated, as the CAx-IF recommends for STEP (".stpZ"). The data of both are
/// DEFLATE (RFC 1951).
enum class Compression { none, gzip, zip };

/// "gzip", "ZIP", or nothing.
[[nodiscard]] std::string_view name_of(Compression kind);

/// By the first bytes.
[[nodiscard]] Compression compression_of(std::string_view bytes);

/// By the ending of a file name, in any case: ".gz" and ".stpz".
[[nodiscard]] Compression compression_of_name(std::string_view file_name);

/// The name without that ending: "a.step" of "a.step.gz", "a.stp" of "a.stpZ"; others stay.
[[nodiscard]] std::string uncompressed_name(std::string_view file_name);

/// What is compressed. The size is taken from the file, and refused before anything is unpacked if
/// it is above `most` or above what DEFLATE can make of the bytes there are (1032 for one); data
/// that go on beyond it are left at once. So the cost is linear in the size that is allowed,
/// whatever the file says, and memory is that of the result.
///
/// Errors (input): it is too large, damaged (its checksum differs), ends too early, has several
/// members or entries, is encrypted, or is a ZIP archive of another method or of more than 4 GiB;
/// bytes that are not compressed.
[[nodiscard]] Expected<std::string> uncompress(std::string_view bytes,
                                               std::size_t most = max_file_size);

/// The bytes compressed, always alike: without a date (1980-01-01 in ZIP), at zlib's default level.
/// `entry` is the name of the entry of a ZIP archive. `none`: the bytes. Error (input): more than 4
/// GiB - 1.
[[nodiscard]] Expected<std::string> compress(std::string_view bytes, Compression kind,
                                             std::string_view entry);

/// The bytes compressed as the ending of the name asks, from whatever they are: as they are where
/// that is so already. Errors: those of `uncompress`, without a limit, and `compress`.
[[nodiscard]] Expected<std::string> compress_by_name(std::string bytes, std::string_view file_name);

/// The bytes compressed as the file `like` is: under the header of its gzip, or in an archive whose
/// entry has the same name, date and attributes; stored if that is. If they are what `like` holds,
/// `like` itself. Errors: those of `uncompress`.
[[nodiscard]] Expected<std::string> compress_like(std::string_view bytes, std::string_view like);

/// One clause about a compressed file, for who asks what it is: "compressed as ZIP: entry
/// \"a.stp\", 812 of 4096 bytes". Errors: those of its frame.
[[nodiscard]] Expected<std::string> describe_compression(std::string_view bytes);

}  // namespace knead
