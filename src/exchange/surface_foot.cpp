#include "surface_foot.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "step_surfaces.hpp"

namespace knead::step {
namespace {

constexpr double single_point = 1e-6;  // of the net's diagonal: an edge of the domain no longer than that is a pole
constexpr double at_pole = 1e-5;       // fractions
constexpr int iterations = 40;
constexpr int starts = 4;

}  // namespace

Expected<SurfaceFoot> SurfaceFoot::create(const Surface& surface) {
  SurfaceFoot result(surface);
  for (int d = 0; d < 2; ++d) {
    const KnotVector& knots = surface.knots(d);
    const int pieces = std::max(knots.degree() + 1, 4);
    auto& grid = result.grid_[static_cast<std::size_t>(d)];
    for (const int s : knots.spans()) {
      for (int k = 0; k < pieces; ++k) grid.push_back(knots[s] + (knots[s + 1] - knots[s]) * k / pieces);
    }
    grid.push_back(knots.domain().upper);
  }
  auto evaluation = evaluate_grid<2>(surface, {std::span<const double>(result.grid_[0]), result.grid_[1]});
  if (!evaluation) return std::unexpected(std::move(evaluation.error()));
  result.points_ = evaluation->points();
  const auto closed = closed_directions(surface);
  const double size = net_diagonal(surface.control_points());
  for (int d = 0; d < 2; ++d) {
    if (closed[static_cast<std::size_t>(d)]) result.space_.periods[static_cast<std::size_t>(d)] = 1;
    for (int end = 0; end < 2; ++end) {
      const auto side = boundary_curve(surface, d, end);
      if (side && net_diagonal(side->control_points()) <= single_point * size) {
        result.space_.poles[static_cast<std::size_t>(d)][static_cast<std::size_t>(end)] = end;
      }
    }
  }
  return result;
}

SurfaceFoot::Result SurfaceFoot::descend(const Point& p, Eigen::Vector2d at) const {
  Eigen::Vector2d lower, length;
  for (int d = 0; d < 2; ++d) {
    lower[d] = surface_->knots(d).domain().lower;
    length[d] = surface_->knots(d).domain().length();
  }
  // Levenberg and Marquardt: points lie on the surface nearly, so that Gauss and Newton's step converges quadratically;
  // damped where it overshoots, as beside a pole.
  Result best{{at}, std::numeric_limits<double>::infinity()};
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Identity();
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  double damping = 1e-6;
  for (int k = 0; k < iterations; ++k) {
    Parameters<2> parameters(1, 2);
    for (int d = 0; d < 2; ++d) {
      parameters(0, d) = std::clamp(lower[d] + at[d] * length[d], lower[d], surface_->knots(d).domain().upper);
    }
    const auto value = evaluate<2>(*surface_, parameters, 1);
    if (!value) break;
    const auto row = [&](int i, int j) { return Point(value->at({i, j}).row(0).transpose()); };
    const Point off = row(0, 0) - p;
    if (off.norm() < best.distance) {
      best = {{at}, off.norm()};
      damping /= 10;
      // In fractions, so that both directions count alike.
      const Point u = row(1, 0) * length[0], v = row(0, 1) * length[1];
      matrix << u.dot(u), u.dot(v), u.dot(v), v.dot(v);
      gradient = {off.dot(u), off.dot(v)};
    } else {
      damping = std::max(10 * damping, 1e-6);
      if (damping > 1e6) break;
    }
    const Eigen::Vector2d& from = best.foot.parameters;
    Eigen::Matrix2d damped = matrix;
    damped.diagonal() += damping * matrix.diagonal();
    damped.diagonal().array() += 1e-14 * matrix.trace() + 1e-300;
    Eigen::Vector2d next = from - damped.inverse() * gradient;
    for (int d = 0; d < 2; ++d) {
      const bool closed = space_.periods[static_cast<std::size_t>(d)] > 0;
      if (closed && (next[d] < -1e-12 || next[d] > 1 + 1e-12)) next[d] -= std::floor(next[d]);
      if (next[d] >= 0 && next[d] <= 1) continue;
      // At an edge of the domain: along it.
      next[d] = std::clamp(next[d], 0.0, 1.0);
      const int e = 1 - d;
      next[e] = from[e] - (gradient[e] + matrix(e, d) * (next[d] - from[d])) / damped(e, e);
      if (space_.periods[static_cast<std::size_t>(e)] > 0) next[e] -= std::floor(next[e]);
      next[e] = std::clamp(next[e], 0.0, 1.0);
    }
    if ((next - from).norm() <= 1e-12) break;
    at = next;
  }
  for (int d = 0; d < 2; ++d) {
    const auto& ends = space_.poles[static_cast<std::size_t>(d)];
    for (const auto& end : ends) {
      if (end && std::abs(best.foot.parameters[d] - *end) <= at_pole)
        best.foot.free[static_cast<std::size_t>(1 - d)] = true;
    }
  }
  return best;
}

SurfaceFoot::Result SurfaceFoot::nearest(const Point& p, const std::optional<Eigen::Vector2d>& hint,
                                         double tolerance) const {
  Result best{{}, std::numeric_limits<double>::infinity()};
  if (hint) {
    best = descend(p, *hint);
    if (best.distance <= tolerance) return best;
  }
  // From the nearest points of the grid that are not neighbours.
  const auto columns = static_cast<Eigen::Index>(grid_[1].size());
  Eigen::VectorXd distances = (points_.rowwise() - p.transpose()).rowwise().squaredNorm();
  for (int k = 0; k < starts; ++k) {
    Eigen::Index at = 0;
    if (distances.minCoeff(&at) == std::numeric_limits<double>::infinity()) break;
    const auto i = at / columns, j = at % columns;
    Eigen::Vector2d start;
    for (int d = 0; d < 2; ++d) {
      const Interval domain = surface_->knots(d).domain();
      start[d] = (grid_[std::size_t(d)][static_cast<std::size_t>(d == 0 ? i : j)] - domain.lower) / domain.length();
    }
    const auto found = descend(p, start);
    if (found.distance < best.distance) best = found;
    if (best.distance <= tolerance) break;
    for (auto r = std::max<Eigen::Index>(0, i - 2); r <= std::min<Eigen::Index>(i + 2, points_.rows() / columns - 1);
         ++r) {
      for (auto c = std::max<Eigen::Index>(0, j - 2); c <= std::min<Eigen::Index>(j + 2, columns - 1); ++c) {
        distances[r * columns + c] = std::numeric_limits<double>::infinity();
      }
    }
  }
  return best;
}

}  // namespace knead::step
