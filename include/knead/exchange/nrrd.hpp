#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "knead/image/volume.hpp"

namespace knead {

/// The header of an NRRD file (teem.sourceforge.net/nrrd/format.html), versions NRRD0001 to NRRD0005, of numbers in
/// three dimensions without compression.
struct NrrdHeader {
  enum class Type { int8, uint8, int16, uint16, int32, uint32, int64, uint64, single, real };
  Type type = Type::uint8;
  std::array<int, 3> size = {0, 0, 0};
  bool big_endian = false;
  VolumeFrame frame = {};
  std::string space = {};      ///< of the axes of space, as in "left-posterior-superior"; empty if it has none
  std::string data_file = {};  ///< of a detached header; empty if the data follow
  std::size_t data_at = 0;     ///< where the data begin in the header's own file
  long skipped_lines = 0;      ///< of the data, then
  long skipped_bytes = 0;      ///< of the data; −1: all but the last ones that are needed

  /// Of all voxels.
  [[nodiscard]] std::size_t data_bytes() const;
};

/// Whether bytes begin as an NRRD file does.
[[nodiscard]] bool is_nrrd(std::string_view bytes);

/// Reads a header. Places of voxels: `space directions` with `space origin`; or `spacings`, with `axis mins` where
/// `centers` says what they are of; or steps of 1. Values are taken as they are: `old min` and the like are ignored, as
/// are comments, keys and units. `name` stands for the file in errors.
/// Errors (input), with the line: no NRRD file; a dimension other than 3, sizes that are not positive or of more than
/// 2^27 voxels together, a type that is no number; data that are compressed, as text, or in several files; fields that
/// cannot be read, are missing or come twice; directions that are none.
[[nodiscard]] Expected<NrrdHeader> parse_nrrd_header(std::string_view bytes, std::string name = {});

/// The voxels from the data, which for an attached header are the bytes after it. Errors (input): more or fewer data
/// than the sizes ask for; values that are not finite; 64-bit integers that a double cannot hold.
[[nodiscard]] Expected<VolumeImage> nrrd_volume(const NrrdHeader& header, std::string_view data);

/// A volume file, with its data from the file that a detached header names. That must be a regular file in the folder
/// of `path` or below: a header from elsewhere cannot have other files read. Errors (input): those above and of
/// `read_file`; a data file with an absolute path or "..", or with links that lead out of the folder.
struct NrrdFile {
  NrrdHeader header;
  VolumeImage volume;
};
[[nodiscard]] Expected<NrrdFile> read_nrrd(const std::filesystem::path& path);
/// The same from the bytes that were read from `path`, which is not read again.
[[nodiscard]] Expected<NrrdFile> nrrd_file(std::string bytes, const std::filesystem::path& path);

/// The bytes of an attached NRRD file of 8-bit numbers, values rounded and clamped to 0 to 255, in the same space.
[[nodiscard]] std::string nrrd_bytes(const VolumeImage& volume, std::string_view space = {});

}  // namespace knead
