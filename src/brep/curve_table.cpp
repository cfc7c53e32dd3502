#include "curve_table.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "knead/spline/basis.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::brep {

Expected<CurveTable> CurveTable::create(Curve curve) {
  CurveTable result(std::move(curve));
  const auto& knots = result.curve_.knots(0);
  const auto spans = knots.spans();
  const int per_span = std::max(knots.degree() + 1, spans.size() > 64 ? 4 : 8);
  for (const int s : spans) {
    for (int k = 0; k < per_span; ++k) {
      const double t = static_cast<double>(k) / per_span;
      result.parameters_.push_back(
          std::clamp((1 - t) * knots[s] + t * knots[s + 1], knots[s], knots[s + 1]));
    }
  }
  result.parameters_.push_back(knots.domain().upper);
  const Parameters<1> parameters = Eigen::Map<const Eigen::VectorXd>(
      result.parameters_.data(), static_cast<Eigen::Index>(result.parameters_.size()));
  auto evaluation = evaluate<1>(result.curve_, parameters);
  if (!evaluation) return std::unexpected(std::move(evaluation.error()));
  result.points_ = evaluation->points();
  result.lower_ = result.points_.colwise().minCoeff().transpose();
  result.upper_ = result.points_.colwise().maxCoeff().transpose();
  for (Eigen::Index k = 1; k < result.points_.rows(); ++k) {
    result.longest_chord_ =
        std::max(result.longest_chord_, (result.points_.row(k) - result.points_.row(k - 1)).norm());
  }
  return result;
}

/// The curve and its first two derivatives; none where a denominator is not positive. Nothing is
/// allocated: this is asked several times for every point of every edge of a file.
std::optional<std::array<Point, 3>> CurveTable::jet(double t) const {
  const KnotVector& knots = curve_.knots(0);
  const auto p = static_cast<std::size_t>(knots.degree());
  const int span = knots.find_span(t);
  std::array<double, 3 * (max_degree + 1)> basis;
  basis_derivatives(knots, span, t, 2, basis.data());
  const double* const points = curve_.control_points().data() + 3 * (span - knots.degree());
  std::array<Point, 3> result;
  std::array<double, 3> weight{};
  for (std::size_t d = 0; d < 3; ++d) {
    double sum[3] = {0, 0, 0};
    for (std::size_t r = 0; r <= p; ++r) {
      double n = basis[d * (p + 1) + r];
      if (curve_.rational()) n *= curve_.weights()[static_cast<std::size_t>(span) - p + r];
      weight[d] += n;
      for (std::size_t c = 0; c < 3; ++c) sum[c] += n * points[3 * r + c];
    }
    result[d] = Point(sum[0], sum[1], sum[2]);
  }
  if (!curve_.rational()) return result;
  if (!(weight[0] > 0)) return std::nullopt;
  result[0] /= weight[0];
  result[1] = (result[1] - weight[1] * result[0]) / weight[0];
  result[2] = (result[2] - 2 * weight[1] * result[1] - weight[2] * result[0]) / weight[0];
  return result;
}

/// By Newton's iteration from the k-th tabulated point, between its neighbours, if that improves
/// the foot.
void CurveTable::descend(const Point& point, Eigen::Index k, Foot& foot) const {
  const double lower = parameters_[static_cast<std::size_t>(std::max<Eigen::Index>(k - 1, 0))];
  const double upper =
      parameters_[static_cast<std::size_t>(std::min<Eigen::Index>(k + 1, points_.rows() - 1))];
  double t = parameters_[static_cast<std::size_t>(k)];
  for (int iteration = 0; iteration < 10; ++iteration) {
    const auto value = jet(t);
    if (!value) return;
    const auto& [place, first, second] = *value;
    const Point offset = place - point;
    if (offset.norm() < foot.distance) foot = {t, offset.norm()};
    // Newton on (S - P)·S' where the distance is convex, Gauss-Newton elsewhere.
    const double slope = first.squaredNorm();
    const double curvature = slope + offset.dot(second);
    const double divisor = curvature > 0 ? curvature : slope;
    if (!(divisor > 0)) return;
    const double next = std::clamp(t - offset.dot(first) / divisor, lower, upper);
    if (std::abs(next - t) <= 1e-9 * (upper - lower)) return;
    t = next;
  }
}

// Points at fixed parameters are searched first, then Newton's iteration runs from those that could
// hide a nearer foot: a curve between two neighbouring points is taken to stay within twice their
// chord of them. This is an estimate and no bound, as a search that certifies its result would cost
// far more for every point of every edge of a file. Beyond `limit` the distance to the box is
// enough.
CurveTable::Foot CurveTable::closest(const Point& point, double limit) const {
  const double outside = (lower_ - point).cwiseMax(point - upper_).cwiseMax(0).norm();
  // The box is that of the tabulated points, which the curve is taken to leave by no more than two
  // chords.
  if (outside - 2 * longest_chord_ > limit) return {parameters_.front(), outside};
  const Eigen::Index size = points_.rows();
  const auto squared = [&](Eigen::Index k) {
    const double* p = points_.data() + 3 * k;
    const double x = p[0] - point[0], y = p[1] - point[1], z = p[2] - point[2];
    return x * x + y * y + z * z;
  };
  double least = squared(0);
  Eigen::Index best = 0;
  for (Eigen::Index k = 1; k < size; ++k) {
    const double here = squared(k);
    if (here < least) std::tie(least, best) = std::pair(here, k);
  }
  Foot foot{parameters_[static_cast<std::size_t>(best)], std::sqrt(least)};
  // The foot may lie next to any tabulated local minimum whose chords allow a smaller distance.
  const double infinity = std::numeric_limits<double>::infinity();
  double before = infinity, here = squared(0);
  for (Eigen::Index k = 0; k < size; ++k) {
    const double after = k + 1 < size ? squared(k + 1) : infinity;
    if (before >= here && after >= here) {
      const Eigen::Index left = std::max<Eigen::Index>(k - 1, 0),
                         right = std::min<Eigen::Index>(k + 1, size - 1);
      const double reach = std::max((points_.row(k) - points_.row(left)).norm(),
                                    (points_.row(k) - points_.row(right)).norm());
      if (std::sqrt(here) - 2 * reach <= std::min(foot.distance, limit)) descend(point, k, foot);
    }
    before = here;
    here = after;
  }
  return foot;
}

bool CurveTable::closed(double tolerance) const {
  return (points_.row(0) - points_.row(points_.rows() - 1)).norm() <= tolerance;
}

}  // namespace knead::brep
