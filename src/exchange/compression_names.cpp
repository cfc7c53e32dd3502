// What names and first bytes tell of compression; the rest needs zlib.
#include "knead/exchange/file_io.hpp"

namespace knead {
namespace {

bool ends_with(std::string_view name, std::string_view ending) {
  if (name.size() <= ending.size()) return false;
  name.remove_prefix(name.size() - ending.size());
  for (std::size_t k = 0; k < ending.size(); ++k) {
    const char c = name[k];
    if (('A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) != ending[k]) return false;
  }
  return true;
}

}  // namespace

std::string_view name_of(Compression kind) {
  return kind == Compression::gzip ? "gzip" : kind == Compression::zip ? "ZIP" : "";
}

Compression compression_of(std::string_view bytes) {
  if (bytes.starts_with("\x1F\x8B")) return Compression::gzip;
  return bytes.starts_with("PK\x03\x04") ? Compression::zip : Compression::none;
}

Compression compression_of_name(std::string_view file_name) {
  if (ends_with(file_name, ".gz")) return Compression::gzip;
  return ends_with(file_name, ".stpz") ? Compression::zip : Compression::none;
}

std::string uncompressed_name(std::string_view file_name) {
  const Compression kind = compression_of_name(file_name);
  const std::size_t cut = kind == Compression::gzip ? 3 : kind == Compression::zip ? 1 : 0;
  return std::string(file_name.substr(0, file_name.size() - cut));
}

}  // namespace knead
