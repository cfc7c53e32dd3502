#include "archive.hpp"

#include <fmt/format.h>

namespace knead::detail {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t gzip_head = 10, gzip_tail = 8;
constexpr std::size_t local_head = 30, central_head = 46, end_record = 22;
constexpr std::string_view central_mark = "PK\x01\x02", end_mark = "PK\x05\x06",
                           local_mark = "PK\x03\x04";

std::uint32_t number(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t k = count; k-- > 0;)
    value = value << 8U | static_cast<unsigned char>(bytes[at + k]);
  return value;
}
std::uint16_t number16(std::string_view bytes, std::size_t at) {
  return static_cast<std::uint16_t>(number(bytes, at, 2));
}
std::uint32_t number32(std::string_view bytes, std::size_t at) { return number(bytes, at, 4); }

void append(std::string& text, std::size_t value, int count) {
  for (int k = 0; k < count; ++k, value >>= 8U) text += static_cast<char>(value & 0xFFU);
}

std::unexpected<Error> damaged(std::string what) {
  return input_error(std::move(what), {}, "have it written or sent again");
}
std::unexpected<Error> other_kind(std::string what) {
  return input_error(std::move(what), {}, "unpack it, and open the CAD file in it");
}
std::unexpected<Error> too_short(Compression kind) {
  return damaged(fmt::format("the file is {}, and ends too early", name_of(kind)));
}

Expected<Archive> read_gzip(std::string_view bytes) {
  enum Flag : unsigned { header_crc = 2, extra = 4, name = 8, comment = 16, reserved = 0xE0 };
  if (bytes.size() < gzip_head + gzip_tail) return too_short(Compression::gzip);
  const auto flags = static_cast<unsigned char>(bytes[3]);
  if (bytes[2] != 8 || (flags & reserved) != 0)
    return other_kind("the file is gzip of a kind that is not known");
  std::size_t at = gzip_head;
  if ((flags & extra) != 0) at += 2 + std::size_t{number16(bytes, at)};
  for (const Flag text : {name, comment}) {
    if ((flags & text) == 0) continue;
    const auto end = bytes.find('\0', at);
    at = end == bytes.npos ? bytes.size() : end + 1;
  }
  if ((flags & header_crc) != 0) at += 2;
  if (at + gzip_tail > bytes.size()) return too_short(Compression::gzip);
  Archive archive;
  archive.kind = Compression::gzip;
  archive.header = bytes.substr(0, at);
  archive.packed = bytes.substr(at, bytes.size() - gzip_tail - at);
  archive.crc = number32(bytes, bytes.size() - 8);
  archive.size = number32(bytes, bytes.size() - 4);
  return archive;
}

/// Where the record that ends a ZIP archive begins: with its comment it reaches to the end of the
/// file.
std::size_t end_of_directory(std::string_view bytes) {
  constexpr std::size_t longest_comment = 0xFFFF;
  if (bytes.size() < end_record) return bytes.npos;
  const std::size_t last = bytes.size() - end_record;
  const std::size_t first = last > longest_comment ? last - longest_comment : 0;
  for (std::size_t at = last + 1; at-- > first;) {
    if (bytes.substr(at, 4) == end_mark &&
        at + end_record + number16(bytes, at + 20) == bytes.size())
      return at;
  }
  return bytes.npos;
}

/// The head of the one entry in the central directory, whole.
Expected<std::string_view> central_entry(std::string_view bytes) {
  const std::size_t end = end_of_directory(bytes);
  if (end == bytes.npos) return too_short(Compression::zip);
  const std::size_t count = number16(bytes, end + 10), size = number32(bytes, end + 12),
                    begin = number32(bytes, end + 16);
  if (count == 0xFFFF || size == 0xFFFFFFFF || begin == 0xFFFFFFFF)
    return other_kind("the archive is a ZIP64");
  if (number32(bytes, end + 4) != 0 || number16(bytes, end + 8) != count) {
    return other_kind("the ZIP archive is one part of several");
  }
  if (count != 1) {
    return other_kind(count == 0 ? "the ZIP archive is empty"
                                 : fmt::format("the ZIP archive holds {} files", count));
  }
  if (begin + size > end || size < central_head || bytes.substr(begin, 4) != central_mark) {
    return damaged("the directory of the ZIP archive is damaged");
  }
  return bytes.substr(begin, size);
}

Expected<Archive> read_zip(std::string_view bytes) {
  const auto entry = central_entry(bytes);
  if (!entry) return std::unexpected(entry.error());
  const std::string_view head = *entry;
  const std::size_t name = number16(head, 28), packed = number32(head, 20),
                    begin = number32(head, 42);
  const std::uint16_t flags = number16(head, 8), method = number16(head, 10);
  Archive archive;
  archive.size = number32(head, 24);
  if (packed == 0xFFFFFFFF || archive.size == 0xFFFFFFFF || begin == 0xFFFFFFFF) {
    return other_kind("the archive is a ZIP64");
  }
  constexpr unsigned encrypted = 1, strongly = 1U << 6, masked = 1U << 13, utf8 = 1U << 11;
  if ((flags & (encrypted | strongly | masked)) != 0)
    return other_kind("the ZIP archive is encrypted");
  if (method != 0 && method != 8)
    return other_kind(fmt::format("the ZIP archive uses the method {}", method));
  const auto wrong = [] { return damaged("the entry of the ZIP archive is damaged"); };
  // Nothing may overlap: the local head, its name and extra field, the data, and the directory in
  // this order.
  const auto directory = static_cast<std::size_t>(head.data() - bytes.data());
  if (central_head + name > head.size() || begin + local_head > directory) return wrong();
  if (bytes.substr(begin, 4) != local_mark || number16(bytes, begin + 8) != method) return wrong();
  const std::size_t data =
      begin + local_head + number16(bytes, begin + 26) + number16(bytes, begin + 28);
  if (data + packed > directory || (method == 0 && packed != archive.size)) return wrong();
  archive.kind = Compression::zip;
  archive.packed = bytes.substr(data, packed);
  archive.deflated = method == 8;
  archive.crc = number32(head, 16);
  archive.entry = head.substr(central_head, name);
  archive.made_by = number16(head, 4);
  archive.flags = flags & utf8;
  archive.time = number16(head, 12);
  archive.date = number16(head, 14);
  archive.internal = number16(head, 36);
  archive.attributes = number32(head, 38);
  return archive;
}

/// What the local head and that of the directory have in common, from the version that is needed
/// on.
std::string common_head(const Archive& archive) {
  constexpr std::size_t needed = 20;  // version 2.0, the first with DEFLATE
  std::string text;
  append(text, needed, 2);
  append(text, archive.flags, 2);
  append(text, archive.deflated ? 8 : 0, 2);
  append(text, archive.time, 2);
  append(text, archive.date, 2);
  append(text, archive.crc, 4);
  append(text, archive.packed.size(), 4);
  append(text, archive.size, 4);
  append(text, archive.entry.size(), 2);
  append(text, 0, 2);  // no extra field
  return text;
}

std::string write_zip(const Archive& archive) {
  std::string text;
  text.reserve(archive.packed.size() + 2 * archive.entry.size() + local_head + central_head +
               end_record);
  const std::string common = common_head(archive);
  text.append(local_mark).append(common).append(archive.entry).append(archive.packed);
  const std::size_t directory = text.size();
  text += central_mark;
  append(text, archive.made_by, 2);
  text += common;
  append(text, 0, 4);  // no comment, the first disk
  append(text, archive.internal, 2);
  append(text, archive.attributes, 4);
  append(text, 0, 4);  // the local head begins the file
  text += archive.entry;
  const std::size_t size = text.size() - directory;
  text += end_mark;
  append(text, 0, 4);
  append(text, 1, 2);
  append(text, 1, 2);
  append(text, size, 4);
  append(text, directory, 4);
  append(text, 0, 2);
  return text;
}

}  // namespace

Expected<Archive> read_archive(std::string_view bytes) {
  switch (compression_of(bytes)) {
    case Compression::gzip:
      return read_gzip(bytes);
    case Compression::zip:
      return read_zip(bytes);
    case Compression::none:
      break;
  }
  return input_error("the file is not compressed");
}

std::string write_archive(const Archive& archive) {
  if (archive.kind == Compression::zip) return write_zip(archive);
  // Deflated, without flags and a date, from an unknown system.
  std::string text(archive.header.empty() ? "\x1F\x8B\x08\0\0\0\0\0\0\xFF"sv : archive.header);
  text += archive.packed;
  append(text, archive.crc, 4);
  append(text, archive.size, 4);
  return text;
}

}  // namespace knead::detail
