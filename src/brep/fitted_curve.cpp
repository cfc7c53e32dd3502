#include "fitted_curve.hpp"

#include <algorithm>
#include <cmath>

#include "knead/spline/evaluate.hpp"
#include "spline/greville_interpolation.hpp"

namespace knead::brep {
namespace {

using PathPoint = std::function<Expected<Point>(double)>;

constexpr std::size_t most_spans = 4096;
constexpr int per_span = 5;

Expected<Curve> interpolated(const PathPoint& path, const std::vector<double>& breaks,
                             const std::vector<double>& corners) {
  std::vector<double> knots;
  for (std::size_t k = 0; k < breaks.size(); ++k) {
    const bool end = k == 0 || k + 1 == breaks.size();
    knots.insert(knots.end(), end ? 4 : std::ranges::binary_search(corners, breaks[k]) ? 3 : 1, breaks[k]);
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

/// The breaks, with those spans halved in which the curve is off the path. Errors: spans that cannot be halved further.
Expected<std::vector<double>> halved(const PathPoint& path, const Curve& curve, const std::vector<double>& breaks,
                                     double tolerance) {
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
    if (off && breaks[k] - breaks[k - 1] < 2 * least_fitted_span * (breaks.back() - breaks.front()))
      return numerical_error(not_fitted);
    if (off) result.push_back(0.5 * (breaks[k - 1] + breaks[k]));
    result.push_back(breaks[k]);
  }
  return result;
}

}  // namespace

Expected<Curve> fitted_curve(const PathPoint& path, std::vector<double> breaks, const std::vector<double>& corners,
                             double tolerance) {
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

}  // namespace knead::brep
