#include "brush_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "knead/spline/closest_point.hpp"
#include "knead/spline/evaluate.hpp"
#include "scene/places.hpp"

namespace knead {
namespace {

constexpr int most_places = 20000;    // of one piece of a path
constexpr int length_pieces = 8;      // by which a piece is measured
constexpr double closing_gap = 1e-6;  // of the size: edges nearer than this are one
constexpr double samples_along[] = {0, 0.3, 0.7, 1};

Expected<Point> point_at(const Surface& surface, const Fractions& at) {
  const auto u = parameters_at(surface, at, "path");
  if (!u) return std::unexpected(u.error());
  return evaluate_point<2>(surface, *u);
}

std::array<bool, 2> closed_directions(const Surface& surface, double size) {
  std::array<bool, 2> closed = {};
  for (std::size_t d = 0; d < 2; ++d) {
    closed[d] = std::ranges::all_of(samples_along, [&](double t) {
      const auto begin = point_at(surface, d == 0 ? Fractions{0, t} : Fractions{t, 0});
      const auto end = point_at(surface, d == 0 ? Fractions{1, t} : Fractions{t, 1});
      return begin && end && (*begin - *end).norm() <= closing_gap * size;
    });
  }
  return closed;
}

/// The fractions of the point of a surface near x.
struct Foot {
  Fractions at = {};
  double distance = 0;
};
// A local search from the Greville abscissae of the nearest control point. A brush asks for
// thousands of feet near the surface, where that finds the nearest one; a global search for each
// would take longer than the brush.
Foot foot_on(const Surface& shape, const std::array<bool, 2>& closed, const Point& x) {
  Eigen::Index nearest = 0;
  (shape.control_points().rowwise() - x.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
  const int n = shape.net()[1], row = static_cast<int>(nearest);
  const ClosestPoint<2> found = closest_point_from<2>(
      shape, x, {shape.knots(0).greville(row / n), shape.knots(1).greville(row % n)}, closed);
  Foot foot{{}, found.distance};
  for (std::size_t d = 0; d < 2; ++d) {
    const Interval domain = shape.knots()[d].domain();
    foot.at[d] = std::clamp((found.parameters[d] - domain.lower) / domain.length(), 0., 1.);
  }
  return foot;
}

double distance_from_box(const Point& x, const Point& lower, const Point& upper) {
  return (lower - x).cwiseMax(x - upper).cwiseMax(0).norm();
}

}  // namespace

BrushPath::BrushPath(std::span<const int> selection, std::span<const OpenStroke::Before> shapes,
                     double spacing, double rope)
    : spacing_(spacing), rope_(rope) {
  assert(selection.size() == shapes.size());
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const Points& net = shapes[k].current->control_points();
    const Point lower = net.colwise().minCoeff(), upper = net.colwise().maxCoeff();
    sheets_.push_back({selection[k], shapes[k].current,
                       closed_directions(*shapes[k].current, (upper - lower).norm()), lower,
                       upper});
  }
}

const BrushPath::Sheet& BrushPath::sheet(int surface) const {
  const auto found = std::ranges::find(sheets_, surface, &Sheet::surface);
  assert(found != sheets_.end());
  return *found;
}

Expected<Point> BrushPath::point(const BrushPoint& at) const {
  return point_at(*sheet(at.surface).shape, at.at);
}

BrushPoint BrushPath::nearest(int surface, const Point& x) const {
  const Sheet& on = sheet(surface);
  return {surface, foot_on(*on.shape, on.closed, x).at, {}};
}

Expected<BrushPoint> BrushPath::towards(const BrushPoint& from, const BrushPoint& to,
                                        double share) const {
  if (share == 1) return to;
  if (from.surface == to.surface) {
    BrushPoint result{from.surface, from.at, from.pen.towards(to.pen, share)};
    const std::array<bool, 2>& closed = sheet(from.surface).closed;
    for (std::size_t d = 0; d < 2; ++d) {
      double way = to.at[d] - from.at[d];
      if (closed[d] && std::abs(way) > 0.5) way -= std::copysign(1, way);
      result.at[d] = from.at[d] + share * way;
      if (closed[d]) result.at[d] -= result.at[d] < 0 ? -1 : result.at[d] > 1 ? 1 : 0;
      result.at[d] = std::clamp(result.at[d], 0., 1.);
    }
    return result;
  }
  const auto p = point(from), q = point(to);
  if (!p) return std::unexpected(p.error());
  if (!q) return std::unexpected(q.error());
  const Point x = *p + share * (*q - *p);
  BrushPoint best;
  double least = std::numeric_limits<double>::infinity();
  for (const Sheet& on : sheets_) {
    // The box of the net contains the surface: no foot on it is nearer than the box.
    if (distance_from_box(x, on.lower, on.upper) >= least) continue;
    const Foot foot = foot_on(*on.shape, on.closed, x);
    if (foot.distance >= least) continue;
    least = foot.distance;
    best = {on.surface, foot.at, from.pen.towards(to.pen, share)};
  }
  return best;
}

Expected<double> BrushPath::length(const BrushPoint& from, const BrushPoint& to) const {
  double sum = 0;
  auto before = point(from);
  for (int k = 1; k <= length_pieces && before; ++k) {
    const auto next = towards(from, to, static_cast<double>(k) / length_pieces);
    auto here = next ? point(*next) : std::unexpected(next.error());
    if (here) sum += (*here - *before).norm();
    before = std::move(here);
  }
  if (!before) return std::unexpected(before.error());
  return sum;
}

Expected<std::vector<BrushPoint>> BrushPath::places(const BrushPoint& from, const BrushPoint& to,
                                                    const BrushPoint& at) const {
  const auto way = length(from, to);
  if (!way) return std::unexpected(way.error());
  if (*way > most_places * spacing_) {
    return input_error(
        fmt::format(
            "a piece of the path of {:.3g} is too long for a brush of this radius, which has a "
            "place every {:.3g}",
            *way, spacing_),
        "path", "give more points, or use a larger radius");
  }
  const int count = std::max(1, static_cast<int>(std::ceil(*way / spacing_)));
  std::vector<BrushPoint> result;
  BrushPoint here = at;
  for (int k = 1; k <= count; ++k) {
    const auto pointer = towards(from, to, static_cast<double>(k) / count);
    if (!pointer) return std::unexpected(pointer.error());
    if (rope_ > 0) {
      const auto p = point(*pointer), q = point(here);
      if (!p) return std::unexpected(p.error());
      if (!q) return std::unexpected(q.error());
      const double distance = (*p - *q).norm();
      if (distance <= rope_) continue;
      // A brush on a rope moves straight towards the pointer until they are a rope's length apart:
      // a tractrix, which smooths the path of the hand.
      const auto drawn = towards(here, *pointer, 1 - rope_ / distance);
      if (!drawn) return std::unexpected(drawn.error());
      here = *drawn;
    } else {
      here = *pointer;
    }
    result.push_back(here);
  }
  return result;
}

Expected<BrushPlace> BrushPath::place(const BrushPoint& at) const {
  const Surface& surface = *sheet(at.surface).shape;
  const auto u = parameters_at(surface, at.at, "path");
  if (!u) return std::unexpected(u.error());
  Parameters<2> here(1, 2);
  here << (*u)[0], (*u)[1];
  const auto jet = evaluate<2>(surface, here, 1);
  if (!jet) return std::unexpected(jet.error());
  const Point su = jet->at({1, 0}).row(0), sv = jet->at({0, 1}).row(0);
  const Point normal = su.cross(sv).stableNormalized();
  return BrushPlace{jet->points().row(0).transpose(), normal, su.stableNormalized(),
                    normal.cross(su).stableNormalized(), at.pen};
}

}  // namespace knead
