#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead {

/// Numbers at the points of a grid.
struct GridField {
  std::string name;
  int components = 1;
  std::vector<double> values;  ///< point after point
};

/// A surface as a grid of points with fields, (i, j) at row i counts[1] + j.
struct FieldGrid {
  std::string name;
  std::array<int, 2> counts = {0, 0};
  Points points;
  std::vector<GridField> fields;
};

/// The grids as an unstructured grid of quadrilaterals in the XML format of VTK (.vtu, ASCII,
/// version 0.1), which ParaView opens. A field that some grids lack is 0 there, and what is not
/// finite is written as 0: the format has no word for it. Numbers have 9 significant digits.
[[nodiscard]] std::string vtu_text(std::span<const FieldGrid> grids);

}  // namespace knead
