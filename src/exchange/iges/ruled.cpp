#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "brep/boundary_curve.hpp"
#include "geometry.hpp"
#include "knead/spline/spline_refinement.hpp"

namespace knead::iges {
namespace {

// Of knots moved to 0 … 1, and of weights.
constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
// Entity 118: S(u, v) = (1 − v) C_1(u) + v C_2(u), both curves over 0 … 1. On a common basis that
// is a B-spline surface of degree p × 1 with their control points: degrees are elevated, knots
// united, and weights compared, since curves with different weights have a ruled surface of higher
// degree.
constexpr const char* remedy =
    "convert it to a B-spline surface in the program that wrote the file";

/// The part of a curve over `range`, clamped, on the parameters 0 … 1.
Expected<Curve> over_unit(const Curve& whole, const Interval& range) {
  const int p = whole.knots(0).degree();
  std::vector<double> missing;
  for (const double end : {range.lower, range.upper}) {
    for (int k = whole.knots(0).multiplicity(end); k < p; ++k) missing.push_back(end);
  }
  const auto fine = insert_knots<1>(whole, {missing});
  if (!fine) return fine;
  const auto all = fine->knots(0).knots();
  // From the last p of the knots at the lower end to the first p of those at the upper one.
  const auto first = std::ranges::upper_bound(all, range.lower) - all.begin() - p;
  const auto last = std::ranges::lower_bound(all, range.upper) - all.begin();
  std::vector<double> knots = {0};
  for (auto k = first; k < last + p; ++k) {
    const double t = all[static_cast<std::size_t>(k)];
    knots.push_back(t >= range.upper   ? 1
                    : t <= range.lower ? 0
                                       : (t - range.lower) / range.length());
  }
  knots.push_back(1);
  auto vector = KnotVector::create(p, std::move(knots));
  if (!vector) return std::unexpected(vector.error());
  const auto count = last - first + 1;
  std::vector<double> weights;
  if (fine->rational()) {
    const auto its_weights = fine->weights();
    weights.assign(its_weights.begin() + first - 1, its_weights.begin() + first - 1 + count);
  }
  return Curve::create({*std::move(vector)}, fine->control_points().middleRows(first - 1, count),
                       std::move(weights));
}

/// A line (110) or a B-spline curve (126) over 0 … 1.
Expected<Curve> side(const File& file, int ruled, int number, const Eigen::Affine3d& outer) {
  const Entity* entity = file.find(number);
  if (entity == nullptr)
    return file.error(ruled, "it has no second or no first curve", "get the whole file");
  const auto parameters = file.parameters(number);
  if (!parameters) return std::unexpected(parameters.error());
  if (entity->type == 110) {
    const auto transform = transform_of(file, number);
    const auto v = numbers(file, number, *parameters, 1, 6);
    if (!transform || !v) return std::unexpected(!transform ? transform.error() : v.error());
    const Eigen::Affine3d move = outer * *transform;
    Points points(2, 3);
    for (Eigen::Index k = 0; k < 2; ++k) {
      const double* p = &(*v)[static_cast<std::size_t>(3 * k)];
      points.row(k) = (move * Point(p[0], p[1], p[2])).transpose();
    }
    return Curve::create({*KnotVector::create(1, {0, 0, 1, 1})}, std::move(points));
  }
  if (entity->type != 126) {
    return file.error(ruled,
                      fmt::format("a ruled surface at {}, which is no line or B-spline curve",
                                  file.label(number)),
                      remedy);
  }
  const auto curve = read_curve(file, number, outer);
  if (!curve) return curve;
  Interval range = curve->knots(0).domain();
  const auto layout = curve_layout(file, number, *parameters);
  if (const auto ends = numbers(file, number, *parameters, layout->domain, 2)) {
    const Interval span{std::max((*ends)[0], range.lower), std::min((*ends)[1], range.upper)};
    if (span.length() > 0) range = span;
  }
  return over_unit(*curve, range);
}

/// The knots of `to` that `from` lacks. Those that differ by the rounding of 0 … 1 are one.
std::vector<double> lacking(const Curve& from, const Curve& to) {
  std::vector<double> result;
  const auto knots = from.knots(0).knots(), other = to.knots(0).knots();
  std::size_t k = 0;
  for (const double t : other) {
    while (k < knots.size() && knots[k] < t - rounding) ++k;
    if (k < knots.size() && knots[k] <= t + rounding) {
      ++k;
    } else {
      result.push_back(t);
    }
  }
  return result;
}

/// Whether two rows of weights are multiples of each other.
bool same_weights(const Curve& a, const Curve& b) {
  if (!a.rational() && !b.rational()) return true;
  if (!a.rational() || !b.rational()) return false;
  const auto v = a.weights(), w = b.weights();
  for (std::size_t k = 0; k < v.size(); ++k) {
    const double left = v[k] * w[0], right = w[k] * v[0];
    if (std::abs(left - right) > 4 * rounding * std::abs(left)) return false;
  }
  return true;
}

}  // namespace

Expected<Surface> read_ruled_surface(const File& file, int number, const Eigen::Affine3d& move) {
  const auto parameters = file.parameters(number);
  if (!parameters) return std::unexpected(parameters.error());
  // Curves, and whether the second one is turned.
  const auto head = numbers(file, number, *parameters, 1, 3);
  if (!head) return std::unexpected(head.error());
  std::array<Curve, 2> sides = {
      *Curve::create({*KnotVector::create(1, {0, 0, 1, 1})}, Points::Zero(2, 3)),
      *Curve::create({*KnotVector::create(1, {0, 0, 1, 1})}, Points::Zero(2, 3))};
  for (std::size_t k = 0; k < 2; ++k) {
    auto rail = side(file, number, static_cast<int>((*head)[k]), move);
    if (!rail) return std::unexpected(rail.error());
    sides[k] = *std::move(rail);
  }
  if ((*head)[2] != 0) sides[1] = brep::turned(sides[1]);
  const bool lines = sides[0].size() == 2 && sides[1].size() == 2;
  if (file.find(number)->form != 1 && !lines) {
    return file.error(
        number,
        "a ruled surface by equal lengths along its curves (form 0), which is no B-spline surface",
        remedy);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const int times = sides[1 - k].knots(0).degree() - sides[k].knots(0).degree();
    if (times <= 0) continue;
    auto raised = elevate_degree<1>(sides[k], 0, times);
    if (!raised) return std::unexpected(raised.error());
    sides[k] = *std::move(raised);
  }
  const auto first = insert_knots<1>(sides[0], {lacking(sides[0], sides[1])});
  if (!first) return std::unexpected(first.error());
  const auto second = insert_knots<1>(sides[1], {lacking(sides[1], *first)});
  if (!second) return std::unexpected(second.error());
  if (first->size() != second->size() || !same_weights(*first, *second)) {
    return file.error(number,
                      "a ruled surface at curves with different weights, which is read no further",
                      remedy);
  }
  const Eigen::Index n = first->size();
  Points points(2 * n, 3);  // u along the curves is slow
  std::vector<double> weights;
  for (Eigen::Index k = 0; k < n; ++k) {
    points.row(2 * k) = first->control_points().row(k);
    points.row(2 * k + 1) = second->control_points().row(k);
    if (first->rational())
      weights.insert(weights.end(), 2, first->weights()[static_cast<std::size_t>(k)]);
  }
  auto surface = Surface::create({first->knots(0), *KnotVector::create(1, {0, 0, 1, 1})},
                                 std::move(points), std::move(weights));
  if (!surface) return file.error(number, surface.error().message());
  return surface;
}

}  // namespace knead::iges
