#include "curves.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "instances.hpp"
#include "knead/spline/basis.hpp"
#include "knead/spline/evaluate.hpp"
#include "knots.hpp"

namespace knead::step {
namespace {

/// Leaves out functions with equal knots all along, [t_i, t_(i+p+1)), and their control points:
/// they are zero everywhere. Some writers repeat the first knot and control point of a trimmed
/// curve.
void leave_out_empty(std::size_t degree, std::vector<double>& knots, Points& points,
                     std::vector<double>& weights) {
  for (std::size_t i = 0; i + degree + 1 < knots.size();) {
    const auto rows = static_cast<std::size_t>(points.rows());
    if (knots[i] != knots[i + degree + 1] || rows <= degree + 1) {
      ++i;
      continue;
    }
    knots.erase(knots.begin() + static_cast<std::ptrdiff_t>(i));
    if (weights.size() == rows) weights.erase(weights.begin() + static_cast<std::ptrdiff_t>(i));
    const auto k = static_cast<Eigen::Index>(i), below = points.rows() - 1 - k;
    points.middleRows(k, below) = points.bottomRows(below).eval();
    points.conservativeResize(points.rows() - 1, Eigen::NoChange);
  }
}

}  // namespace

// B_SPLINE_CURVE(degree, control_points_list, curve_form, closed_curve, self_intersect), then
// B_SPLINE_CURVE_WITH_KNOTS(knot_multiplicities, knots, knot_spec); weights as of surfaces.
Expected<Curve> read_b_spline_curve(const Reader& reader, std::uint32_t instance) {
  constexpr std::size_t attributes_of_curve = 6;
  std::optional<ImpliedKnots> form;
  if (reader.is(instance, "BEZIER_CURVE")) form = ImpliedKnots::bezier;
  if (reader.is(instance, "QUASI_UNIFORM_CURVE")) form = ImpliedKnots::quasi_uniform;
  if (reader.is(instance, "UNIFORM_CURVE")) form = ImpliedKnots::uniform;
  const bool listed = reader.is(instance, "B_SPLINE_CURVE_WITH_KNOTS");
  if (!form && !listed) return reader.error(instance, "it is not a B-spline curve with knots");
  const auto attributes = reader.attributes(instance, "B_SPLINE_CURVE", 1, 2);
  const auto degree = attributes.empty() ? std::nullopt : reader.integer(attributes[0]);
  if (!degree || *degree < 1 || *degree > max_degree)
    return reader.error(instance, "its degree is not 1 to " + std::to_string(max_degree));
  const auto targets = reader.references(attributes[1]);
  Points points(static_cast<Eigen::Index>(targets.size()), 3);
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const auto point = reader.point(targets[k]);
    if (!point) return std::unexpected(point.error());
    points.row(static_cast<Eigen::Index>(k)) = point->transpose();
  }
  const int count = static_cast<int>(targets.size());
  const auto lists =
      reader.attributes(instance, "B_SPLINE_CURVE_WITH_KNOTS", attributes_of_curve, 2);
  if (listed && lists.empty()) return reader.error(instance, "it has no knots");
  std::vector<double> weights;
  if (reader.is(instance, "RATIONAL_B_SPLINE_CURVE")) {
    const auto rational =
        reader.attributes(instance, "RATIONAL_B_SPLINE_CURVE", attributes_of_curve, 1);
    if (rational.empty() || !reader.is_list(rational[0]))
      return reader.error(instance, "it has no weights");
    for (const auto k : reader.file().children(rational[0])) {
      weights.push_back(reader.real(k).value_or(std::numeric_limits<double>::quiet_NaN()));
    }
  }
  const auto listed_knots = [&]() -> Expected<KnotVector> {
    auto list = read_knot_list(reader, instance, *degree, count, lists[0], lists[1], "");
    if (!list) return std::unexpected(std::move(list.error()));
    leave_out_empty(static_cast<std::size_t>(*degree), *list, points, weights);
    return knots_of_list(reader, instance, *degree, *std::move(list), "");
  };
  auto knots = listed ? listed_knots() : implied_knots(*form, *degree, count);
  if (!knots) return std::unexpected(std::move(knots.error()));
  return Curve::create({*std::move(knots)}, std::move(points), std::move(weights));
}

}  // namespace knead::step
