#pragma once

#include <Eigen/Geometry>

#include "hold/constraint_list_space.hpp"
#include "knead/hold/constraints.hpp"
#include "knead/spline/extremum.hpp"
#include "support/surfaces.hpp"

/// Displacements that a list of constraints allows, and what the tests ask of them.
namespace knead::testing {

inline double size_of(const Surface& s) {
  return (s.control_points().colwise().maxCoeff() - s.control_points().colwise().minCoeff()).norm();
}

inline ConstraintSpace space_of(const Surface& s, const ConstraintList& list) {
  auto made = constraint_space(list, Points::Zero(s.size(), 3), size_of(s));
  if (!made) ADD_FAILURE() << made.error().message();
  return made ? std::move(*made) : ConstraintSpace(s.size());
}

/// A random displacement of the space, its largest coordinate 1 or what the constraints ask for.
inline Points random_member(const Surface& s, const ConstraintList& list, unsigned seed) {
  const ConstraintSpace space = space_of(s, list);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  Eigen::MatrixXd y(space.free_count(), space.coupled() ? 1 : 3);
  for (Eigen::Index k = 0; k < y.size(); ++k) y.data()[k] = value(random);
  Points x = space.expand(y);
  if (x.size() > 0 && x.cwiseAbs().maxCoeff() > 0) x /= x.cwiseAbs().maxCoeff();
  return x + size_of(s) * space.feasible(Points::Zero(s.size(), 3));
}

/// The displacement field as a surface of its own: same knots and weights, displacements for
/// control points.
inline Surface field(const Surface& rest, const Points& displacement) {
  return *rest.with_control_points(displacement);
}

inline Surface moved(const Surface& rest, const Points& displacement) {
  return *rest.with_control_points(rest.control_points() + displacement);
}

/// `order`-th derivative in `direction` along the line u = c or v = c, at `samples` parameters.
inline Points on_line(const Surface& s, int direction, double c, int order, Side side,
                      int samples = 41) {
  Parameters<2> at(samples, 2);
  const Interval other = s.knots(1 - direction).domain();
  for (int k = 0; k < samples; ++k) {
    at(k, direction) = c;
    at(k, 1 - direction) = std::lerp(other.lower, other.upper, (k + 0.5) / samples);
  }
  const auto e = evaluate(s, at, order, side);
  if (!e) ADD_FAILURE() << e.error().message();
  return e->at(direction == 0 ? MultiIndex<2>{order, 0} : MultiIndex<2>{0, order});
}

/// Largest angle between the normals on both sides of a line, at samples that have normals.
inline double crease(const Surface& s, int direction, double c, int samples = 41) {
  Parameters<2> at(samples, 2);
  const Interval other = s.knots(1 - direction).domain();
  for (int k = 0; k < samples; ++k) {
    at(k, direction) = c;
    at(k, 1 - direction) = std::lerp(other.lower, other.upper, (k + 0.5) / samples);
  }
  const auto l = evaluate(s, at, 1, Side::left), r = evaluate(s, at, 1, Side::right);
  double angle = 0;
  for (int k = 0; k < samples; ++k) {
    const Point a = Point(l->at({1, 0}).row(k)).cross(Point(l->at({0, 1}).row(k))).normalized();
    const Point b = Point(r->at({1, 0}).row(k)).cross(Point(r->at({0, 1}).row(k))).normalized();
    angle = std::max(angle, std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  return angle;
}

/// Reliefs over all pairings of knot families with each other (every family occurs in u and in v),
/// with and without weights. Families with spans that differ by many decades are left out unless
/// `all`: derivatives there lose what spans differ by.
inline std::vector<std::pair<std::string, Surface>> reliefs(int p, int q, bool all,
                                                            double weight_spread) {
  std::vector<NamedKnots> u = knot_families(p), v = knot_families(q);
  if (!all) {
    std::erase_if(u, [](const NamedKnots& k) { return !k.ordinary(); });
    std::erase_if(v, [](const NamedKnots& k) { return !k.ordinary(); });
  }
  std::vector<std::pair<std::string, Surface>> result;
  for (std::size_t k = 0; k < std::max(u.size(), v.size()); ++k) {
    const NamedKnots &a = u[k % u.size()], &b = v[(5 * k + 3) % v.size()];
    const auto seed = static_cast<unsigned>(k);
    result.emplace_back(a.name + " x " + b.name, relief(a.knots, b.knots, seed));
    result.emplace_back(a.name + " x " + b.name + " rational",
                        relief(a.knots, b.knots, seed, 0.1, weight_spread));
  }
  return result;
}

}  // namespace knead::testing
