#include "fitted_curve.hpp"

#include <algorithm>
#include <cmath>

#include "boundary_curve.hpp"
#include "knead/spline/evaluate.hpp"
#include "spline/interpolation/greville_interpolation.hpp"

namespace knead::brep {
namespace {

// A cubic spline through a path that can be evaluated at any parameter, to a tolerance, in the
// path's own parameter (pairs of curves and surfaces of a file stay matched). Interpolation at the
// Greville abscissae is a banded system that is never singular (Schoenberg and Whitney: every
// abscissa lies inside its function's support) and stable for cubics; spans are halved until four
// points in each are within the tolerance. The error falls by 16 with each halving where the path
// has four derivatives. At corners of the path triple knots let the curve turn. Errors are measured
// between the abscissae, not at them.
constexpr std::size_t most_spans = 4096;
constexpr int per_span = 5;
constexpr int first_spans = 8;
constexpr double beside_corner =
    0.25;                             // of a first span: divisions nearer to a corner are left out
constexpr double least_span = 1e-10;  // of all parameters
constexpr double lift_tolerance = 1e-8;  // of a path's size

std::vector<double> first_breaks(const Interval& range, const std::vector<double>& all_corners) {
  const double from = range.lower, to = range.upper;
  const double least = least_span * (to - from), span = (to - from) / first_spans;
  std::vector<double> breaks = {from};
  for (const double corner : all_corners) {
    if (corner - breaks.back() > least && to - corner > least) breaks.push_back(corner);
  }
  const std::vector<double> corners(breaks.begin() + 1, breaks.end());
  for (int k = 1; k < first_spans; ++k) {
    const double t = std::lerp(from, to, static_cast<double>(k) / first_spans);
    // A division right beside a corner would make the abscissae of two functions nearly equal, and
    // the system nearly singular.
    const auto beside = [&](double corner) { return std::abs(corner - t) < beside_corner * span; };
    if (std::ranges::none_of(corners, beside)) breaks.push_back(t);
  }
  breaks.push_back(to);
  std::ranges::sort(breaks);
  return breaks;
}

Expected<Curve> interpolated(const PathPoint& path, const std::vector<double>& breaks,
                             const std::vector<double>& corners) {
  std::vector<double> knots;
  for (std::size_t k = 0; k < breaks.size(); ++k) {
    const bool end = k == 0 || k + 1 == breaks.size();
    knots.insert(knots.end(),
                 end                                              ? 4
                 : std::ranges::binary_search(corners, breaks[k]) ? 3
                                                                  : 1,
                 breaks[k]);
  }
  auto vector = KnotVector::create(3, std::move(knots));
  if (!vector) return std::unexpected(vector.error());
  const auto interpolation = GrevilleInterpolation::create(*vector);
  if (!interpolation) return std::unexpected(interpolation.error());
  Points points(interpolation->size(), 3);
  for (int k = 0; k < interpolation->size(); ++k) {
    const auto p = path(interpolation->abscissae()[static_cast<std::size_t>(k)]);
    if (!p) return std::unexpected(p.error());
    points.row(k) = p->transpose();
  }
  interpolation->solve(points.data(), 1, 3);
  return Curve::create({*std::move(vector)}, std::move(points));
}

/// The breaks, with those spans halved in which the curve is off the path. Errors: spans that
/// cannot be halved further.
Expected<std::vector<double>> halved(const PathPoint& path, const Curve& curve,
                                     const std::vector<double>& breaks, double tolerance) {
  std::vector<double> result = {breaks.front()};
  for (std::size_t k = 1; k < breaks.size(); ++k) {
    bool off = false;
    for (int j = 1; j < per_span && !off; ++j) {
      const double t = std::lerp(breaks[k - 1], breaks[k], static_cast<double>(j) / per_span);
      const auto wanted = path(t);
      if (!wanted) return std::unexpected(wanted.error());
      const auto is = evaluate_point<1>(curve, {t});
      if (!is) return std::unexpected(is.error());
      off = (*is - *wanted).norm() > tolerance;
    }
    if (off && breaks[k] - breaks[k - 1] < 2 * least_span * (breaks.back() - breaks.front()))
      return numerical_error(not_fitted);
    if (off) result.push_back(0.5 * (breaks[k - 1] + breaks[k]));
    result.push_back(breaks[k]);
  }
  return result;
}

}  // namespace

Expected<Curve> fitted_curve(const PathPoint& path, const Interval& range,
                             const std::vector<double>& corners, double tolerance) {
  std::vector<double> breaks = first_breaks(range, corners);
  while (true) {
    auto curve = interpolated(path, breaks, corners);
    if (!curve) return curve;
    auto finer = halved(path, *curve, breaks, tolerance);
    if (!finer) return std::unexpected(finer.error());
    if (finer->size() == breaks.size()) return curve;
    if (finer->size() > most_spans) return numerical_error(not_fitted);
    breaks = *std::move(finer);
  }
}

Expected<std::optional<Curve>> lifted_curve(const PathPoint& path, std::vector<double> corners) {
  std::ranges::sort(corners);
  Points sample(first_spans + 1, 3);
  for (int k = 0; k <= first_spans; ++k) {
    const auto p = path(static_cast<double>(k) / first_spans);
    if (!p) return std::unexpected(p.error());
    sample.row(k) = p->transpose();
  }
  const double size = net_diagonal(sample);
  if (!(size > 0)) return std::nullopt;
  auto curve = fitted_curve(path, {0, 1}, corners, lift_tolerance * size);
  if (!curve) return std::unexpected(std::move(curve.error()));
  return *std::move(curve);
}

}  // namespace knead::brep
