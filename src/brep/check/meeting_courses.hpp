#pragma once

#include <array>
#include <string>
#include <vector>

#include "brep/shared_edge.hpp"

namespace knead::brep {

/// Where two edges of one face each run beside each other, or sides of surfaces without faces, as
/// `measure_edges` finds and calls it.
struct MeetingCourse {
  std::string id;  ///< "#12+#15", "#55.u0+#70.v1"
  /// The B-spline surfaces of the model under both faces; none: another surface, which has no feet.
  std::array<Index, 2> surfaces = {none, none};
  /// By ascending parameter of the first edge's curve, ends included, with a foot on each of the
  /// surfaces that are not none. Feet of a side are on it.
  std::vector<SharedEdge::Sample> samples = {};
};

/// The meetings of a model, in the order of `measure_edges`. Left out are those that cannot be
/// followed on either surface, and those of one surface with itself where it is not closed. Cost: a
/// few hundred searches for the nearest point for each, shared among threads.
[[nodiscard]] std::vector<MeetingCourse> meeting_courses(const Model& model);

}  // namespace knead::brep
