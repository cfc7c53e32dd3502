#include "gaps.hpp"

#include <algorithm>
#include <cmath>

#include "knead/spline/evaluate.hpp"

namespace knead::occt {
namespace {

constexpr int intervals = 200;
constexpr double rounding_share = 1e-13;  // of the largest coordinate

template <int D>
Point inside(const Spline<D>& spline, std::array<double, D> at) {
  for (std::size_t d = 0; d < D; ++d) {
    const auto domain = spline.knots(static_cast<int>(d)).domain();
    at[d] = std::clamp(at[d], domain.lower, domain.upper);  // beyond by rounding
  }
  return *evaluate_point<D>(spline, at);
}

}  // namespace

// Types 1 to 5 are a line, circle, ellipse, parabola and hyperbola, 6 and 7 splines, 8 a trimmed
// curve, which has the parameters of its basis, 9 an offset. A parabola is x = t² / (4 f), y = t
// with focal length f.
std::optional<Point> point_of(const BrepCurve& curve, int dimension, double t) {
  if (curve.type == 8) return point_of(*curve.basis, dimension, t);
  if (curve.type > 5)
    return curve.spline ? std::optional(inside<1>(*curve.spline, {t})) : std::nullopt;
  const auto& v = curve.numbers;
  // Origin, in space the axis, x and y: of a line only the direction.
  const auto at = [&](std::size_t k) {
    const std::size_t n = static_cast<std::size_t>(dimension) * k;
    return Point(v[n], v[n + 1], dimension == 3 ? v[n + 2] : 0);
  };
  if (curve.type == 1) return at(0) + t * at(1);
  const std::size_t x = dimension == 3 ? 2 : 1,
                    sizes = static_cast<std::size_t>(dimension) * (x + 2);
  const double a = v[sizes];
  switch (curve.type) {
    case 2:
      return at(0) + a * (std::cos(t) * at(x) + std::sin(t) * at(x + 1));
    case 3:
      return at(0) + a * std::cos(t) * at(x) + v[sizes + 1] * std::sin(t) * at(x + 1);
    case 4:
      return at(0) + t * t / (4 * a) * at(x) + t * at(x + 1);
    default:
      return at(0) + a * std::cosh(t) * at(x) + v[sizes + 1] * std::sinh(t) * at(x + 1);
  }
}

const Surface* GapMeter::surface(int index) {
  auto& stored = surfaces_[static_cast<std::size_t>(index) - 1];
  if (!stored) {
    stored.emplace();
    const auto& listed = file_.surfaces[static_cast<std::size_t>(index) - 1].spline;
    if (listed && *listed) {
      if (auto made = detail::surface_of(**listed)) *stored = *std::move(made);
    }
  }
  return *stored ? &**stored : nullptr;
}

// An edge with "same parameter" has one parameter for its curve in space and its curves on
// surfaces: points at equal shares of both ranges must coincide. The largest distance found at
// samples is the tolerance that Open CASCADE asks of the edge. No closest points are sought: a
// curve that runs along the other at another speed counts as apart, as it does there.
std::optional<EdgeGap> GapMeter::gap(const BrepShape& edge) {
  if (!edge.same_parameter || edge.geometry == 0) return std::nullopt;
  EdgeGap result;
  for (const Use& use : edge.uses) {
    if (file_.shapes[use.shape].kind == Shape::vertex) result.at_vertex.push_back(0);
  }
  if (result.at_vertex.size() != edge.uses.size()) return std::nullopt;
  const auto end = [&](bool last, const Point& p) {
    for (std::size_t k = 0; k < edge.uses.size(); ++k) {
      if (edge.uses[k].orientation != (last ? '-' : '+')) continue;
      const Point vertex = edge.uses[k].place * file_.shapes[edge.uses[k].shape].point;
      result.at_vertex[k] = std::max(result.at_vertex[k], (p - vertex).norm());
    }
  };
  const BrepCurve& curve = file_.curves[static_cast<std::size_t>(edge.geometry) - 1];
  for (int k = 0; k <= intervals; ++k) {
    const double share = static_cast<double>(k) / intervals;
    const auto point = point_of(curve, 3, std::lerp(edge.range[0], edge.range[1], share));
    if (!point) return std::nullopt;
    const Point p = edge.place * *point;
    result.rounding = std::max(result.rounding, rounding_share * p.cwiseAbs().maxCoeff());
    const bool last = k == intervals, ends = k == 0 || last;
    if (ends) end(last, p);
    for (const BrepFlatCurve& flat : edge.flat) {
      const Surface* on = flat.surface == 0 ? nullptr : surface(flat.surface);
      if (on == nullptr) return std::nullopt;
      for (const int index : {flat.curve, flat.other}) {
        if (index == 0) continue;
        const BrepCurve& course = file_.flat_curves[static_cast<std::size_t>(index) - 1];
        const auto at = point_of(course, 2, std::lerp(flat.range[0], flat.range[1], share));
        if (!at) return std::nullopt;
        const Point q = flat.place * inside<2>(*on, {at->x(), at->y()});
        result.along = std::max(result.along, (q - p).norm());
        if (ends) end(last, q);
      }
    }
  }
  return result;
}

}  // namespace knead::occt
