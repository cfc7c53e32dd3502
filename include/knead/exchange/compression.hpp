#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "knead/base/error.hpp"
#include "knead/exchange/file_io.hpp"

namespace knead {

/// How a whole file is compressed: by gzip (RFC 1952, one member), or as the only entry of a ZIP archive, stored or
/// deflated, as the CAx-IF recommends for STEP (".stpZ"). The data of both are DEFLATE (RFC 1951).
enum class Compression { none, gzip, zip };

/// "gzip", "ZIP", or nothing.
[[nodiscard]] std::string_view name_of(Compression kind);

/// By the first bytes.
[[nodiscard]] Compression compression_of(std::string_view bytes);

/// By the ending of a file name, in any case: ".gz" and ".stpz".
[[nodiscard]] Compression compression_of_name(std::string_view file_name);

/// The name without that ending: "a.step" of "a.step.gz", "a.stp" of "a.stpZ"; others stay.
[[nodiscard]] std::string uncompressed_name(std::string_view file_name);

/// What is compressed. The size is taken from the file, and refused before anything is unpacked if it is above `most`
/// or above what DEFLATE can make of the bytes there are (1032 for one); data that go on beyond it are left at once. So
/// the cost is linear in the size that is allowed, whatever the file says, and memory is that of the result.
///
/// Errors (input): it is too large, damaged (its checksum differs), ends too early, has several members or entries, is
/// encrypted, or is a ZIP archive of another method or of more than 4 GiB; bytes that are not compressed.
[[nodiscard]] Expected<std::string> uncompress(std::string_view bytes, std::size_t most = max_file_size);

/// The bytes compressed, always alike: without a date (1980-01-01 in ZIP), at zlib's default level. `entry` is the name
/// of the entry of a ZIP archive. `none`: the bytes. Error (input): more than 4 GiB - 1.
[[nodiscard]] Expected<std::string> compress(std::string_view bytes, Compression kind, std::string_view entry);

/// The bytes compressed as the file `like` is: under the header of its gzip, or in an archive whose entry has the same
/// name, date and attributes; stored if that is. If they are what `like` holds, `like` itself. Errors: those of
/// `uncompress`.
[[nodiscard]] Expected<std::string> compress_like(std::string_view bytes, std::string_view like);

/// One clause about a compressed file, for who asks what it is: "compressed as ZIP: entry \"a.stp\", 812 of 4096
/// bytes". Errors: those of its frame.
[[nodiscard]] Expected<std::string> describe_compression(std::string_view bytes);

}  // namespace knead
