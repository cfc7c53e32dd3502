#pragma once

#include "knead/scene/model.hpp"

namespace knead {

/// What holds the selected surfaces and keeps them together, whatever their material is.
struct JoinedSurfaces {
  std::vector<int> rows;             ///< first control point of every surface, and the end
  ActiveSettings<2> settings;        ///< held, constraints and visible; the rest is as it comes
  std::vector<std::string> held_by;  ///< for each control point that is held, by what
  std::vector<SeamReport> seams;
  std::vector<std::string> notes;
  bool entwined = false;  ///< conditions along edges or seams depend on all that come before them
};

/// Errors: surfaces of different rest modes, constraints that contradict each other (input); those of the coupling.
[[nodiscard]] Expected<JoinedSurfaces> join_surfaces(const ModelInput& input);

}  // namespace knead
