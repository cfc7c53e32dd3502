#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead::oracle {

/// Shapes whose parts Open CASCADE puts elsewhere by locations: products, powers, inverse powers,
/// nested, and on every kind of part (shells, faces, their surfaces, wires, edges and vertices).
[[nodiscard]] std::vector<std::string> occt_placed_names();

/// Writes one of them as a .brep file.
[[nodiscard]] bool occt_write_placed(const std::string& name, const std::filesystem::path& path);

/// Where the parts of a .brep file are.
struct OcctPlaces {
  std::vector<Point> centres;   ///< of gravity of its faces, in order
  std::vector<double> areas;    ///< of its faces
  std::vector<Point> vertices;  ///< in order of exploration, as often as they are used
};
[[nodiscard]] std::optional<OcctPlaces> occt_places(const std::filesystem::path& path);

}  // namespace knead::oracle
