#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace knead::oracle {

/// What Open CASCADE makes of a STEP or IGES file or one of its own; lengths in mm.
struct OcctFile {
  std::map<std::string, int> topology;  ///< numbers of faces, edges, … by name
  int bad_faces = 0;                    ///< that BRepCheck finds fault with
  double area = 0, volume = 0;          ///< of its faces, of its solids
  /// Of each edge of each face, in order: how far its curve in space is from the face, at 41 points
  /// of its own curve in parameters, or the tolerance of the edge, if that is larger.
  std::vector<double> gaps;
};

/// None if it cannot be read.
[[nodiscard]] std::optional<OcctFile> occt_read_file(const std::filesystem::path& path);

/// Of each edge of each face of a file, in order: its largest distance from the nearest other face,
/// mm.
[[nodiscard]] std::vector<double> occt_partings(const std::filesystem::path& path);

}  // namespace knead::oracle
