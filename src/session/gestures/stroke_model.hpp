#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scene/model/model.hpp"
#include "sculpt/travelled.hpp"
#include "spline/interpolation/site_values.hpp"

namespace knead {

/// A model that strokes press, and the abscissae at which they are remembered.
struct StrokeModel {
  SceneModel scene;
  std::vector<SiteValues<2>> values;  // per selected surface
  Points places;  // at the abscissae of all of them, of the shapes from before the stroke

  /// Values at the abscissae of stacked control points, and back.
  [[nodiscard]] Points at_abscissae(const Points& x) const;
  [[nodiscard]] Points control_points(const Points& values) const;
  /// A displacement of control points that the model's constraints allow, for one that they may
  /// not.
  [[nodiscard]] Points allowed(const Points& x) const;
  /// How deep these tools stand in the shapes from before the stroke, at the abscissae, file units.
  [[nodiscard]] double depth_of(std::span<const Tool> tools) const;
  /// Where a displacement of control points from the shapes before is expected after these travels
  /// of tools.
  [[nodiscard]] Points after_travels(std::span<const OpenStroke::Before> before, const Points& last,
                                     std::span<const Travel> travels) const;
};

/// Makes the model of this input, with the abscissae of the shapes from before the stroke, unless
/// it is there.
[[nodiscard]] Expected<void> keep_stroke_model(std::optional<StrokeModel>& kept, ModelInput input,
                                               std::span<const OpenStroke::Before> before);

/// The displacement of control points as the masks of the selected surfaces lessen it.
[[nodiscard]] Points unmasked(const Scene& scene, Points displacement);

}  // namespace knead
