#include "brush_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knead/scene/places.hpp"
#include "knead/spline/evaluate.hpp"

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

}  // namespace

BrushPath::BrushPath(const Surface& surface, double spacing, double rope)
    : surface_(surface), spacing_(spacing), rope_(rope) {
  const Points& net = surface.control_points();
  const double size = (net.colwise().maxCoeff() - net.colwise().minCoeff()).norm();
  for (std::size_t d = 0; d < 2; ++d) {
    closed_[d] = std::ranges::all_of(samples_along, [&](double t) {
      const auto begin = point_at(surface, d == 0 ? Fractions{0, t} : Fractions{t, 0});
      const auto end = point_at(surface, d == 0 ? Fractions{1, t} : Fractions{t, 1});
      return begin && end && (*begin - *end).norm() <= closing_gap * size;
    });
  }
}

Fractions BrushPath::towards(const Fractions& from, const Fractions& to, double share) const {
  Fractions result = {};
  for (std::size_t d = 0; d < 2; ++d) {
    double way = to[d] - from[d];
    if (closed_[d] && std::abs(way) > 0.5) way -= std::copysign(1, way);
    result[d] = share == 1 ? to[d] : from[d] + share * way;
    if (closed_[d]) result[d] -= result[d] < 0 ? -1 : result[d] > 1 ? 1 : 0;
    result[d] = std::clamp(result[d], 0., 1.);
  }
  return result;
}

Expected<double> BrushPath::length(const Fractions& from, const Fractions& to) const {
  double sum = 0;
  auto before = point_at(surface_, from);
  for (int k = 1; k <= length_pieces && before; ++k) {
    auto here = point_at(surface_, towards(from, to, static_cast<double>(k) / length_pieces));
    if (here) sum += (*here - *before).norm();
    before = std::move(here);
  }
  if (!before) return std::unexpected(before.error());
  return sum;
}

Expected<std::vector<Fractions>> BrushPath::places(const Fractions& from, const Fractions& to,
                                                   const Fractions& at) const {
  const auto way = length(from, to);
  if (!way) return std::unexpected(way.error());
  if (*way > most_places * spacing_) {
    return input_error(fmt::format("a piece of the path of {:.3g} is too long for a brush of this radius, which has a "
                                   "place every {:.3g}",
                                   *way, spacing_),
                       "path", "give more points, or use a larger radius");
  }
  const int count = std::max(1, static_cast<int>(std::ceil(*way / spacing_)));
  std::vector<Fractions> result;
  Fractions here = at;
  for (int k = 1; k <= count; ++k) {
    const Fractions pointer = towards(from, to, static_cast<double>(k) / count);
    if (rope_ > 0) {
      const auto p = point_at(surface_, pointer), q = point_at(surface_, here);
      if (!p) return std::unexpected(p.error());
      if (!q) return std::unexpected(q.error());
      const double distance = (*p - *q).norm();
      if (distance <= rope_) continue;
      here = towards(here, pointer, 1 - rope_ / distance);
    } else {
      here = pointer;
    }
    result.push_back(here);
  }
  return result;
}

Expected<BrushPlace> BrushPath::place(const Fractions& at) const {
  const auto u = parameters_at(surface_, at, "path");
  if (!u) return std::unexpected(u.error());
  Parameters<2> here(1, 2);
  here << (*u)[0], (*u)[1];
  const auto jet = evaluate<2>(surface_, here, 1);
  if (!jet) return std::unexpected(jet.error());
  const Point su = jet->at({1, 0}).row(0), sv = jet->at({0, 1}).row(0);
  return BrushPlace{jet->points().row(0).transpose(), su.cross(sv).stableNormalized()};
}

}  // namespace knead
