#pragma once

#include "model.hpp"

namespace knead {

/// What holds the selected shapes and keeps them together, whatever their material is.
template <int D>
struct JoinedShapes {
  std::vector<int> rows;             ///< first control point of every shape, and the end
  ActiveSettings<D> settings;        ///< held, constraints and visible; the rest is as it comes
  std::vector<std::string> held_by;  ///< for each control point that is held, by what
  std::vector<SeamReport> seams;     ///< of surfaces
  std::vector<std::string> notes;
  bool entwined = false;  ///< conditions along edges or seams depend on all that come before them
};

/// Errors: surfaces of different rest modes, constraints that contradict each other (input); those
/// of the coupling.
template <int D>
[[nodiscard]] Expected<JoinedShapes<D>> join_shapes(const ModelInputOf<D>& input);
template <>
[[nodiscard]] Expected<JoinedShapes<2>> join_shapes(const ModelInput& input);

/// All that holds shapes, as conditions on displacements from rest: control points that do not move
/// before the others.
template <int D>
[[nodiscard]] std::vector<LinearConstraint> conditions_of(const JoinedShapes<D>& joined,
                                                          const Points& displacement) {
  std::vector<LinearConstraint> to;
  for (std::size_t k = 0; k < joined.settings.held.size(); ++k) {
    if (!joined.settings.held[k]) continue;
    const int row = static_cast<int>(k);
    to.push_back({joined.held_by[k], {{row, 1.0}}, displacement.row(row).transpose()});
  }
  to.insert(to.end(), joined.settings.constraints.begin(), joined.settings.constraints.end());
  return to;
}

}  // namespace knead
