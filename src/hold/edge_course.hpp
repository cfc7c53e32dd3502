#pragma once

#include <functional>
#include <numbers>
#include <span>
#include <vector>

#include "brep/shared_edge.hpp"

namespace knead {

/// The angle in radians up to which an edge counts as smooth, and the tangent planes along it are
/// kept common.
inline constexpr double smooth_angle = 0.5 * std::numbers::pi / 180;

/// Whether the surfaces at an edge have the same tangent planes all along it, as the file was
/// opened.
[[nodiscard]] bool is_smooth(const SharedEdge& edge);

/// How samples of a course are made finer.
struct CourseSampling {
  /// How many parts a span of these knots asks for; at least 1.
  std::function<int(const KnotVector&)> per_span;
  /// The sample between two of those given, at this share of the way.
  std::function<SharedEdge::Sample(const SharedEdge::Sample&, const SharedEdge::Sample&, double)>
      between;
};

/// The samples of a course, with more between them wherever spans of its surfaces are short.
///
/// The phase of a sample on a knot vector is the number of its span plus how far it is into it.
/// Those of two samples differ by the number of spans between them, knots of any spacing included;
/// an interval is divided into as many parts as the surface asks for that changes most, 256 at
/// most. Samples given are kept, so that the result is never coarser than they are.
/// \param given at least one, with a foot on each of the surfaces
[[nodiscard]] std::vector<SharedEdge::Sample> finer_samples(
    std::span<const SharedEdge::Sample> given, std::span<const Surface* const> surfaces,
    const CourseSampling& sampling);

}  // namespace knead
