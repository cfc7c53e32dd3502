#pragma once

#include <filesystem>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead::oracle {

/// What Open CASCADE reads of a STEP file with curves and surfaces that belong to no solid.
struct OcctCurves {
  std::vector<Curve> curves;  ///< of its edges outside of faces, in mm
  int faces = 0;
  int warnings = 0;  ///< and fails, of reading and transferring
};
[[nodiscard]] OcctCurves occt_curves(const std::filesystem::path& path);

}  // namespace knead::oracle
