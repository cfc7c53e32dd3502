#pragma once

#include <string>
#include <vector>

#include "scene/model/model.hpp"

namespace knead {

/// What an open brush has asked for so far: it follows from the scene.
struct BrushRun {
  ModelInput input;    ///< for which it was made
  OpenBrush open;      ///< the path is as far as it was led
  BrushPoint at = {};  ///< where the brush is, which may trail behind the end of the path
  std::vector<double>
      sides;  ///< of the selected surfaces: `seam_sides` from the one where the path begins
  BrushSamples samples;
  Points fair;                          ///< displacement to the fair shape, at the samples
  std::vector<BrushHistory> histories;  ///< of the stroke and its images
  bool stuck = false;                   ///< all that it asks for is held
  std::string shape = {};  ///< of which the pattern of a stamp was made; empty: of none

  /// Whether any control point is within the radius of the path.
  [[nodiscard]] bool reaches() const;
};

}  // namespace knead
