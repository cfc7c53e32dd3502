#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead::oracle {

/// A B-spline surface as Open CASCADE holds it after translation.
struct OcctSurface {
  std::array<int, 2> degree = {};
  std::array<int, 2> net = {};
  std::array<bool, 2> periodic = {};
  std::array<std::vector<double>, 2> knots;  ///< with their multiplicities
  std::vector<double> weights;
  Points poles;  ///< u slow, v fast
};

/// What Open CASCADE makes of one B-spline surface entity of a file.
struct OcctResult {
  std::vector<OcctSurface>
      surfaces;  ///< one per face on it (or one for itself where it stands without face)
  /// Area of each face over the area of the whole surface it lies on, where that has one.
  std::vector<double> area_ratios;
};

/// What Open CASCADE makes of a file.
struct OcctModel {
  std::map<std::string, int> entities;  ///< number of entities by type
  std::map<std::string, int> topology;  ///< number of solids, shells, faces, edges, … by name
  std::vector<std::string> faces;       ///< kind of surface of each face, in order of exploration
  std::map<std::string, OcctResult> results;  ///< by name of the surface entity, "#123"
};

/// Reads and translates a file with the length unit set to `unit` ("mm", "inch", …); none if it
/// cannot.
[[nodiscard]] std::optional<OcctModel> occt_read(const std::filesystem::path& path,
                                                 const std::string& unit);

}  // namespace knead::oracle
