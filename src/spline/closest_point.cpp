#include "knead/spline/closest_point.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "bezier_patch.hpp"
#include "foot_search.hpp"
#include "knead/spline/evaluate.hpp"
#include "point_evaluator.hpp"

namespace knead {
namespace {

constexpr int iterations = 40;
constexpr int starts = 4;

std::size_t at(int d) { return static_cast<std::size_t>(d); }

Expected<std::vector<std::unique_ptr<detail::Patch>>> pieces_of(const Curve& curve) {
  return detail::bezier_patches(curve);
}
Expected<std::vector<std::unique_ptr<detail::Patch>>> pieces_of(const Surface& surface) {
  return detail::bezier_patches(surface, Point::Ones());
}

/// |x − S|²/2 with its derivatives by fractions of the domain, so that all directions have equal
/// weight.
template <int D>
struct LocalModel {
  double distance = std::numeric_limits<double>::infinity();
  Point point = Point::Zero();
  Eigen::Matrix<double, D, 1> gradient = Eigen::Matrix<double, D, 1>::Zero();
  Eigen::Matrix<double, D, D> hessian = Eigen::Matrix<double, D, D>::Identity();
};

template <int D>
std::optional<LocalModel<D>> model_at(const Spline<D>& spline, detail::PointEvaluator<D>& value,
                                      const Point& x, const std::array<double, D>& u) {
  if (!value.at(u)) return std::nullopt;
  const auto derivative = [&](MultiIndex<D> a) {
    Point result = value.derivative(a);
    for (int d = 0; d < D; ++d) result *= std::pow(spline.knots(d).domain().length(), a[at(d)]);
    return result;
  };
  LocalModel<D> model;
  model.point = value.derivative(0);
  const Point off = model.point - x;
  model.distance = off.norm();
  Eigen::Matrix<double, 3, D> tangents;
  Eigen::Matrix<double, D, D> bend;
  for (int d = 0; d < D; ++d) {
    MultiIndex<D> a{};
    a[at(d)] = 1;
    tangents.col(d) = derivative(a);
    for (int e = 0; e < D; ++e) {
      MultiIndex<D> b = a;
      ++b[at(e)];
      bend(d, e) = off.dot(derivative(b));
    }
  }
  model.gradient = tangents.transpose() * off;
  const Eigen::Matrix<double, D, D> metric = tangents.transpose() * tangents, full = metric + bend;
  // Newton's matrix converges quadratically but may lead to maxima where it is indefinite, beyond
  // the centre of curvature; there the metric (Gauss–Newton) still leads downhill.
  const bool convex = full(0, 0) > 0 && full.determinant() > 1e-12 * metric.determinant();
  model.hessian = convex ? full : metric;
  return model;
}

// Levenberg and Marquardt's iteration in fractions of the domain: damping falls by ten where a step
// leads nearer, and grows by ten where it does not. Projected onto the domain: where a step would
// leave it in one direction, the other is minimised along the border.
template <int D>
ClosestPoint<D> descend(const Spline<D>& spline, const Point& x, const std::array<double, D>& start,
                        const std::array<bool, D>& closed) {
  using Vector = Eigen::Matrix<double, D, 1>;
  const auto parameter = [&spline](int d, double fraction) {
    const Interval domain = spline.knots(d).domain();
    return std::clamp(domain.lower + fraction * domain.length(), domain.lower, domain.upper);
  };
  Vector here, best_at;
  for (int d = 0; d < D; ++d) {
    const Interval domain = spline.knots(d).domain();
    here[d] = std::clamp((start[at(d)] - domain.lower) / domain.length(), 0.0, 1.0);
  }
  best_at = here;
  LocalModel<D> best;
  detail::PointEvaluator<D> value(spline, 2);
  double damping = 1e-6;
  for (int k = 0; k < iterations; ++k) {
    std::array<double, D> u;
    for (int d = 0; d < D; ++d) u[at(d)] = parameter(d, here[d]);
    const auto model = model_at<D>(spline, value, x, u);
    if (!model) break;
    // Where rounding hides the decrease of the distance, that of the gradient decides.
    const bool level = model->distance <= best.distance * (1 + 1e-14);
    if (model->distance < best.distance * (1 - 1e-14) ||
        (level && model->gradient.norm() < best.gradient.norm())) {
      best = *model;
      best_at = here;
      damping /= 10;
    } else {
      damping = std::max(10 * damping, 1e-6);
      if (level || damping > 1e6) break;
    }
    Eigen::Matrix<double, D, D> damped = best.hessian;
    damped.diagonal() += damping * best.hessian.diagonal();
    damped.diagonal().array() += 1e-14 * best.hessian.trace() + 1e-300;
    Vector next = best_at - damped.inverse() * best.gradient;
    for (int d = 0; d < D; ++d) {
      if (closed[at(d)] && (next[d] < -1e-12 || next[d] > 1 + 1e-12))
        next[d] -= std::floor(next[d]);
      if (next[d] >= 0 && next[d] <= 1) continue;
      next[d] = std::clamp(next[d], 0.0, 1.0);
      if constexpr (D == 2) {  // along the border
        const int e = 1 - d;
        next[e] = best_at[e] -
                  (best.gradient[e] + best.hessian(e, d) * (next[d] - best_at[d])) / damped(e, e);
        if (closed[at(e)]) next[e] -= std::floor(next[e]);
        next[e] = std::clamp(next[e], 0.0, 1.0);
      }
    }
    if ((next - best_at).norm() <= 1e-15) break;
    here = next;
  }
  ClosestPoint<D> result;
  for (int d = 0; d < D; ++d) result.parameters[at(d)] = parameter(d, best_at[d]);
  result.point = best.point;
  result.distance = best.distance;
  return result;
}

}  // namespace

template <int D>
struct ClosestPointSearch<D>::Data {
  explicit Data(Spline<D> given) : spline(std::move(given)) {}

  Spline<D> spline;
  std::array<std::vector<Interval>, D> spans;  // of positive length
  std::optional<detail::FootSearch>
      search;  // none: a Bézier weight is not positive, or the spline is one point
  std::array<std::vector<double>, D> samples;  // if there is no search
  Points points;
};

template <int D>
Expected<ClosestPointSearch<D>> ClosestPointSearch<D>::create(const Spline<D>& spline) {
  auto data = std::make_shared<Data>(spline);
  for (int d = 0; d < D; ++d) {
    const KnotVector& knots = spline.knots(d);
    for (const int span : knots.spans())
      data->spans[at(d)].push_back({knots[span], knots[span + 1]});
  }
  const Points& net = spline.control_points();
  const double size = 0.5 * (net.colwise().maxCoeff() - net.colwise().minCoeff()).norm();
  if (auto pieces = pieces_of(spline); pieces && size > 0) {
    data->search.emplace(std::move(*pieces), size);
    return ClosestPointSearch(std::move(data));
  }
  std::array<std::span<const double>, D> grid;
  for (int d = 0; d < D; ++d) {
    auto& samples = data->samples[at(d)];
    const int parts = std::max(spline.knots(d).degree() + 1, 4);
    for (const Interval& span : data->spans[at(d)]) {
      for (int k = 0; k < parts; ++k) samples.push_back(span.lower + span.length() * k / parts);
    }
    samples.push_back(spline.knots(d).domain().upper);
    grid[at(d)] = samples;
  }
  auto evaluation = evaluate_grid<D>(spline, grid);
  if (!evaluation) return std::unexpected(std::move(evaluation.error()));
  data->points = evaluation->points();
  return ClosestPointSearch(std::move(data));
}

template <int D>
ClosestPoint<D> ClosestPointSearch<D>::nearest(const Point& x) const {
  if (data_->search) {
    const detail::FootResult found = data_->search->nearest(x);
    ClosestPoint<D> result;
    auto piece = static_cast<std::size_t>(found.best.patch);
    for (int d = D - 1; d >= 0; --d) {
      const auto& spans = data_->spans[at(d)];
      const Interval& span = spans[piece % spans.size()];
      const double t = found.best.at[at(d)];
      result.parameters[at(d)] =
          std::clamp((1 - t) * span.lower + t * span.upper, span.lower, span.upper);
      piece /= spans.size();
    }
    result.point = found.best.jet[0];
    result.distance = std::sqrt(found.best.squared);
    result.certified = found.certified;
    return result;
  }
  // From the nearest non-adjacent samples.
  Eigen::VectorXd distances = (data_->points.rowwise() - x.transpose()).rowwise().squaredNorm();
  std::array<int, D> counts;
  for (int d = 0; d < D; ++d) counts[at(d)] = static_cast<int>(data_->samples[at(d)].size());
  const auto place = [&counts](Eigen::Index k) {
    std::array<int, D> result;
    for (int d = D - 1; d >= 0; k /= counts[at(d)], --d)
      result[at(d)] = static_cast<int>(k % counts[at(d)]);
    return result;
  };
  ClosestPoint<D> best;
  for (int k = 0; k < starts; ++k) {
    Eigen::Index least = 0;
    if (distances.minCoeff(&least) == std::numeric_limits<double>::infinity()) break;
    const auto from = place(least);
    std::array<double, D> start;
    for (int d = 0; d < D; ++d) start[at(d)] = data_->samples[at(d)][at(from[at(d)])];
    const auto found = nearest_from(x, start);
    if (found.distance < best.distance) best = found;
    for (Eigen::Index other = 0; other < distances.size(); ++other) {
      const auto there = place(other);
      bool close = true;
      for (int d = 0; d < D; ++d) close = close && std::abs(there[at(d)] - from[at(d)]) <= 2;
      if (close) distances[other] = std::numeric_limits<double>::infinity();
    }
  }
  best.certified =
      (data_->points.rowwise() - data_->points.row(0)).isZero(0) && !data_->spline.rational();
  return best;
}

template <int D>
ClosestPoint<D> ClosestPointSearch<D>::nearest_from(const Point& x,
                                                    const std::array<double, D>& start,
                                                    const std::array<bool, D>& closed) const {
  return descend<D>(data_->spline, x, start, closed);
}

template <int D>
Expected<ClosestPoint<D>> closest_point(const Spline<D>& spline, const Point& x) {
  const auto search = ClosestPointSearch<D>::create(spline);
  if (!search) return std::unexpected(search.error());
  return search->nearest(x);
}

template <int D>
ClosestPoint<D> closest_point_from(const Spline<D>& spline, const Point& x,
                                   const std::array<double, D>& start,
                                   const std::array<bool, D>& closed) {
  return descend<D>(spline, x, start, closed);
}

template class ClosestPointSearch<1>;
template class ClosestPointSearch<2>;
template Expected<ClosestPoint<1>> closest_point(const Curve&, const Point&);
template Expected<ClosestPoint<2>> closest_point(const Surface&, const Point&);
template ClosestPoint<1> closest_point_from<1>(const Curve&, const Point&,
                                               const std::array<double, 1>&,
                                               const std::array<bool, 1>&);
template ClosestPoint<2> closest_point_from<2>(const Surface&, const Point&,
                                               const std::array<double, 2>&,
                                               const std::array<bool, 2>&);

}  // namespace knead
