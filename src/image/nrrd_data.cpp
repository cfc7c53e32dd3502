#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <system_error>

#include "knead/base/printable.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/image/volume.hpp"

namespace knead {
namespace {

using NrrdType = NrrdHeader::Type;

std::size_t bytes_per_value(NrrdType type) {
  switch (type) {
    case NrrdType::int8:
    case NrrdType::uint8:
      return 1;
    case NrrdType::int16:
    case NrrdType::uint16:
      return 2;
    case NrrdType::int32:
    case NrrdType::uint32:
    case NrrdType::single:
      return 4;
    default:
      return 8;
  }
}

// Copied byte by byte, as data begin anywhere in a file and not on the boundary of a number.
template <class T>
void read_values(std::string_view data, bool swapped, std::vector<double>& values) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, data.data() + k * sizeof(T), sizeof(T));
    if (swapped) std::ranges::reverse(bytes);
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    values[k] = static_cast<double>(value);
  }
}

void read_values(const NrrdHeader& header, std::string_view data, std::vector<double>& values) {
  const bool swapped = header.big_endian != (std::endian::native == std::endian::big);
  switch (header.type) {
    case NrrdType::int8:
      return read_values<std::int8_t>(data, swapped, values);
    case NrrdType::uint8:
      return read_values<std::uint8_t>(data, swapped, values);
    case NrrdType::int16:
      return read_values<std::int16_t>(data, swapped, values);
    case NrrdType::uint16:
      return read_values<std::uint16_t>(data, swapped, values);
    case NrrdType::int32:
      return read_values<std::int32_t>(data, swapped, values);
    case NrrdType::uint32:
      return read_values<std::uint32_t>(data, swapped, values);
    case NrrdType::int64:
      return read_values<std::int64_t>(data, swapped, values);
    case NrrdType::uint64:
      return read_values<std::uint64_t>(data, swapped, values);
    case NrrdType::single:
      return read_values<float>(data, swapped, values);
    case NrrdType::real:
      return read_values<double>(data, swapped, values);
  }
}

/// The file that a detached header names. Links are followed here, so that what is read later is
/// what was judged.
Expected<std::filesystem::path> data_file_of(const NrrdHeader& header,
                                             const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  const auto refused = [&](std::string what) {
    return std::unexpected(
        Error{ErrorKind::input, fmt::format("\"{}\" {}", printable(header.data_file), what),
              "data file", "put the data into the folder of the header", path.string(), 0});
  };
  const fs::path name = header.data_file;
  if (name.is_absolute() || std::find(name.begin(), name.end(), fs::path("..")) != name.end()) {
    return refused("may lie outside of the folder of the header");
  }
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
#ifdef __wasi__  // without links
  return folder / name;
#else
  std::error_code failed;
  const fs::path inside = fs::canonical(folder, failed);
  const fs::path file = failed ? fs::path() : fs::canonical(folder / name, failed);
  if (failed) return folder / name;  // reading says why it cannot be found
  if (std::mismatch(inside.begin(), inside.end(), file.begin(), file.end()).first != inside.end())
    return refused("leads out of the folder of the header");
  if (!fs::is_regular_file(file, failed)) return refused("is no regular file");
  return file;
#endif
}

std::string vector_text(const Eigen::Vector3d& v) {
  return fmt::format("({:.17g},{:.17g},{:.17g})", v[0], v[1], v[2]);
}

}  // namespace

std::size_t NrrdHeader::data_bytes() const {
  std::size_t all = bytes_per_value(type);
  for (const int n : size) all *= static_cast<std::size_t>(n);
  return all;
}

// Lines are skipped before bytes, as the format says. −1 bytes means that the data are the last
// ones of the file, whatever precedes them.
Expected<VolumeImage> nrrd_volume(const NrrdHeader& header, std::string_view data) {
  for (long line = 0; line < header.skipped_lines; ++line) {
    const auto end = data.find('\n');
    if (end == std::string_view::npos)
      return input_error("the data end within the skipped lines", "line skip");
    data.remove_prefix(end + 1);
  }
  const std::size_t needed = header.data_bytes();
  if (header.skipped_bytes > 0) {
    data.remove_prefix(std::min(data.size(), static_cast<std::size_t>(header.skipped_bytes)));
  } else if (header.skipped_bytes < 0 && data.size() > needed) {
    data.remove_prefix(data.size() - needed);
  }
  if (data.size() != needed) {
    const auto [nx, ny, nz] = header.size;
    return input_error(fmt::format("{} x {} x {} voxels need {} bytes of data, not {}", nx, ny, nz,
                                   needed, data.size()),
                       "data", "check sizes, type and byte skip");
  }
  VolumeImage volume{header.size, {}, header.frame};
  volume.values.resize(needed / bytes_per_value(header.type));
  read_values(header, data, volume.values);
  if (header.type == NrrdType::int64 || header.type == NrrdType::uint64) {
    constexpr double largest = 9007199254740992.0;  // 2^53: beyond, not every integer is a double
    const auto lost =
        std::ranges::find_if(volume.values, [](double x) { return std::abs(x) > largest; });
    if (lost != volume.values.end()) {
      return input_error("the value is larger than 2^53",
                         fmt::format("voxel {}", lost - volume.values.begin()),
                         "save the volume as float or double");
    }
  }
  if (auto checked = check_volume(volume); !checked) return std::unexpected(checked.error());
  return volume;
}

Expected<NrrdFile> nrrd_file(std::string bytes, const std::filesystem::path& path) {
  auto header = parse_nrrd_header(bytes, path.string());
  if (!header) return std::unexpected(header.error());
  std::string_view data = std::string_view(bytes).substr(header->data_at);
  std::filesystem::path from = path;
  if (!header->data_file.empty()) {
    auto found = data_file_of(*header, path);
    if (!found) return std::unexpected(found.error());
    from = *std::move(found);
    auto read = read_file(from);
    if (!read) return std::unexpected(read.error());
    bytes = *std::move(read);
    data = bytes;
  }
  auto volume = nrrd_volume(*header, data);
  if (!volume) {
    Error error = volume.error();
    error.file = from.string();
    return std::unexpected(std::move(error));
  }
  return NrrdFile{std::move(*header), std::move(*volume)};
}

Expected<NrrdFile> read_nrrd(const std::filesystem::path& path) {
  auto bytes = read_file(path);
  if (!bytes) return std::unexpected(bytes.error());
  return nrrd_file(*std::move(bytes), path);
}

// 17 digits give the same doubles back: the mask lies exactly where the volume does.
std::string nrrd_bytes(const VolumeImage& volume, std::string_view space) {
  const auto [nx, ny, nz] = volume.size;
  const Eigen::Matrix3d& d = volume.frame.directions;
  std::string bytes = fmt::format(
      "NRRD0004\ntype: uint8\ndimension: 3\n{}\nsizes: {} {} {}\nspace directions: {} {} {}\n"
      "space origin: {}\nencoding: raw\n\n",
      space.empty() ? "space dimension: 3" : fmt::format("space: {}", space), nx, ny, nz,
      vector_text(d.col(0)), vector_text(d.col(1)), vector_text(d.col(2)),
      vector_text(volume.frame.origin));
  bytes.reserve(bytes.size() + volume.values.size());
  for (const double x : volume.values) {
    bytes.push_back(
        static_cast<char>(static_cast<unsigned char>(std::lround(std::clamp(x, 0.0, 255.0)))));
  }
  return bytes;
}

}  // namespace knead
