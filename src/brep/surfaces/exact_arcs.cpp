#include "exact_arcs.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace knead::brep {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;
// Of angles, and of a radius: what is nearer to the axis is on it.
constexpr double on_axis = 1e-12;

// Of pieces of at most a quarter turn all weights cos(δ/2) are at least √½, and control points stay
// near the curve. The tolerance keeps a quarter that rounding made longer from becoming two pieces.
int quarter_turns(double angle) {
  return std::max(1, static_cast<int>(std::ceil(angle / (full_turn / 4) - on_axis)));
}

/// The end of part k.
double part_end(const Interval& range, int pieces, int k) {
  return k == pieces ? range.upper : range.lower + range.length() * k / pieces;
}

// Degree 2 and double knots: Bézier pieces that join. Since they are equally long their derivatives
// agree there as well.
Expected<KnotVector> double_knots(const Interval& range, int pieces) {
  std::vector<double> knots(3, range.lower);
  for (int k = 1; k < pieces; ++k) knots.insert(knots.end(), 2, part_end(range, pieces, k));
  knots.insert(knots.end(), 3, range.upper);
  return KnotVector::create(2, std::move(knots));
}

}  // namespace

bool whole_turn(double angle) { return angle >= full_turn * (1 - on_axis); }

Expected<Curve> conic_spline(const Interval& range, int pieces, bool closed,
                             const std::function<Point(double)>& at,
                             const std::function<ConicCorner(double, double)>& corner) {
  auto knots = double_knots(range, pieces);
  if (!knots) return std::unexpected(knots.error());
  Points points(2 * pieces + 1, 3);
  std::vector<double> weights(static_cast<std::size_t>(2 * pieces + 1), 1);
  for (int k = 0; k <= pieces; ++k) {
    const double t = part_end(range, pieces, k);
    points.row(2 * k) = at(t).transpose();
    if (k == pieces) break;
    const ConicCorner c = corner(t, part_end(range, pieces, k + 1));
    points.row(2 * k + 1) = c.place.transpose();
    weights[static_cast<std::size_t>(2 * k + 1)] = c.weight;
  }
  if (closed) points.row(2 * pieces) = points.row(0);
  if (std::ranges::all_of(weights, [](double w) { return w == 1; })) weights.clear();
  return Curve::create({*std::move(knots)}, std::move(points), std::move(weights));
}

Expected<Curve> ellipse_spline(const Point& centre, const Point& a, const Point& b,
                               const Interval& range) {
  return conic_spline(
      range, quarter_turns(range.length()), whole_turn(range.length()),
      [&](double t) -> Point { return centre + std::cos(t) * a + std::sin(t) * b; },
      [&](double from, double to) {
        const double middle = (from + to) / 2, weight = std::cos((to - from) / 2);
        return ConicCorner{centre + (std::cos(middle) * a + std::sin(middle) * b) / weight, weight};
      });
}

Expected<Surface> swept_about(const Curve& profile, const Point& origin, const Point& axis,
                              const Interval& angles) {
  const int pieces = quarter_turns(angles.length());
  auto round = double_knots(angles, pieces);
  if (!round) return std::unexpected(round.error());
  const bool closed = whole_turn(angles.length());
  const int n = profile.size();
  Points points(static_cast<Eigen::Index>(2 * pieces + 1) * n, 3);
  std::vector<double> weights;
  const double size =
      (profile.control_points().rowwise() - origin.transpose()).rowwise().norm().maxCoeff();
  for (int i = 0; i <= 2 * pieces; ++i) {
    const double from = part_end(angles, pieces, i / 2), to = part_end(angles, pieces, (i + 1) / 2);
    // Even i are ends of pieces (`from` is `to`, weight 1), odd i corners at their middles, farther
    // from the axis by 1/cos(δ/2).
    const double angle = closed && i == 2 * pieces ? angles.lower : (from + to) / 2;
    const double weight = std::cos((to - from) / 2);
    for (int j = 0; j < n; ++j) {
      const Point d = profile.control_points().row(j).transpose() - origin;
      Point across = d - d.dot(axis) * axis;
      if (across.norm() <= on_axis * size) across.setZero();
      const Point turned =
          (std::cos(angle) * across + std::sin(angle) * axis.cross(across)) / weight;
      points.row(static_cast<Eigen::Index>(i) * n + j) =
          (origin + d.dot(axis) * axis + turned).transpose();
      weights.push_back(weight *
                        (profile.rational() ? profile.weights()[static_cast<std::size_t>(j)] : 1));
    }
  }
  return Surface::create({*std::move(round), profile.knots(0)}, std::move(points),
                         std::move(weights));
}

Expected<Surface> swept_along(const Curve& profile, const Point& direction, const Interval& along) {
  auto line = KnotVector::create(1, {along.lower, along.lower, along.upper, along.upper});
  if (!line) return std::unexpected(line.error());
  Points points(2 * static_cast<Eigen::Index>(profile.size()), 3);
  std::vector<double> weights;
  for (int i = 0; i < profile.size(); ++i) {
    const Point p = profile.control_points().row(i).transpose();
    points.row(2 * i) = (p + along.lower * direction).transpose();
    points.row(2 * i + 1) = (p + along.upper * direction).transpose();
    if (profile.rational())
      weights.insert(weights.end(), 2, profile.weights()[static_cast<std::size_t>(i)]);
  }
  return Surface::create({profile.knots(0), *std::move(line)}, std::move(points),
                         std::move(weights));
}

}  // namespace knead::brep
