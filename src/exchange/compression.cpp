#include "knead/exchange/file_io.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <limits>

#include "archive.hpp"
#include "deflate.hpp"
#include "knead/base/printable.hpp"

namespace knead {
namespace {

/// A DEFLATE symbol of two bits stands for at most 258 bytes.
constexpr std::size_t largest_ratio = 1032;

Expected<std::string> unpack(const detail::Archive& archive, std::size_t most) {
  if (archive.size > most) {
    return input_error(
        fmt::format("unpacked the file has {:.1f} MiB, more than the {:.4g} that are allowed",
                    static_cast<double>(archive.size) / (1 << 20),
                    static_cast<double>(most) / (1 << 20)),
        {}, "allow more (--max-unpacked) if it comes from somebody you trust");
  }
  if (archive.deflated && archive.size / largest_ratio > archive.packed.size()) {
    return input_error("the compressed file states a size that its data cannot have", {},
                       "have it written or sent again");
  }
  auto bytes = archive.deflated ? detail::inflate(archive.packed, archive.size)
                                : std::string(archive.packed);
  if (!bytes) {
    if (bytes.error().remedy.empty())
      bytes.error().remedy = "have it written or sent again, or unpack it";
    return bytes;
  }
  if (detail::crc_32(*bytes) != archive.crc) {
    return input_error("the compressed file is damaged: its checksum differs", {},
                       "have it written or sent again");
  }
  return bytes;
}

Expected<std::string> pack(std::string_view bytes, detail::Archive archive) {
  std::string packed;
  if (archive.deflated) {
    auto made = detail::deflate(bytes);
    if (!made) return made;
    packed = *std::move(made);
  }
  archive.packed = archive.deflated ? packed : bytes;
  archive.size = bytes.size();
  archive.crc = detail::crc_32(bytes);
  return detail::write_archive(archive);
}

}  // namespace

Expected<std::string> uncompress(std::string_view bytes, std::size_t most) {
  const auto archive = detail::read_archive(bytes);
  if (!archive) return std::unexpected(archive.error());
  return unpack(*archive, most);
}

Expected<std::string> compress(std::string_view bytes, Compression kind, std::string_view entry) {
  if (kind == Compression::none) return std::string(bytes);
  detail::Archive archive;
  archive.kind = kind;
  archive.entry = entry;
  constexpr std::uint16_t utf8 = 1U << 11;
  archive.flags = utf8;
  return pack(bytes, archive);
}

Expected<std::string> compress_by_name(std::string bytes, std::string_view file_name) {
  const Compression wanted = compression_of_name(file_name), present = compression_of(bytes);
  if (wanted == present) return bytes;
  if (present != Compression::none) {
    auto plain = uncompress(bytes, std::numeric_limits<std::size_t>::max());
    if (!plain) return plain;
    bytes = *std::move(plain);
  }
  return compress(bytes, wanted,
                  std::filesystem::path(uncompressed_name(file_name)).filename().string());
}

Expected<std::string> compress_like(std::string_view bytes, std::string_view like) {
  const auto archive = detail::read_archive(like);
  if (!archive) return std::unexpected(archive.error());
  if (archive->size == bytes.size() && archive->crc == detail::crc_32(bytes)) {
    const auto held = unpack(*archive, archive->size);
    if (!held) return held;
    if (*held == bytes) return std::string(like);
  }
  return pack(bytes, *archive);
}

Expected<std::string> describe_compression(std::string_view bytes) {
  const auto archive = detail::read_archive(bytes);
  if (!archive) return std::unexpected(archive.error());
  const std::string entry = archive->kind == Compression::zip
                                ? fmt::format("entry \"{}\", ", printable(archive->entry))
                                : std::string();
  return fmt::format("compressed as {}: {}{} of {} bytes", name_of(archive->kind), entry,
                     bytes.size(), archive->size);
}

}  // namespace knead
