#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "knead/exchange/file_io.hpp"

namespace knead::detail {

/// The frame of a compressed file, with the data in it as they are. Views are of the file's bytes.
struct Archive {
  Compression kind = Compression::none;
  std::string_view packed;
  bool deflated = true;        ///< else stored
  std::size_t size = 0;        ///< of what is packed; of gzip modulo 2^32
  std::uint32_t crc = 0;       ///< of what is packed
  std::string_view header;     ///< gzip: all of it
  std::string_view entry;      ///< ZIP: the name of the entry
  std::uint16_t made_by = 20;  ///< ZIP: version and system
  std::uint16_t flags = 0;     ///< ZIP: of those, that the name is UTF-8 (bit 11)
  std::uint16_t time = 0;
  std::uint16_t date = 0x21;  ///< 1980-01-01
  std::uint16_t internal = 0;
  std::uint32_t attributes = 0;
};

/// Reads the frame of a gzip member (RFC 1952) or of a ZIP archive with one entry (APPNOTE 6.3),
/// whose sizes are those of its central directory. Errors (input): `uncompress` lists them.
[[nodiscard]] Expected<Archive> read_archive(std::string_view bytes);

/// The file with other data in that frame. Extra fields and comments of ZIP are left out.
[[nodiscard]] std::string write_archive(const Archive& archive);

}  // namespace knead::detail
