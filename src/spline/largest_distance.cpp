#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <set>

#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {
namespace {

/// p + 3 parameters in each span of either, ends included.
std::vector<double> samples(const KnotVector& a, const KnotVector& b) {
  const Interval domain = a.domain();
  std::set<double> ends;
  for (const KnotVector* knots : {&a, &b}) {
    for (double x : knots->knots()) {
      if (domain.contains(x)) ends.insert(x);
    }
  }
  const int pieces = std::max(a.degree(), b.degree()) + 2;
  std::vector<double> result;
  double from = *ends.begin();
  for (double to : ends) {
    for (int k = 0; k < pieces && to > from; ++k) result.push_back(from + (to - from) * k / pieces);
    from = to;
  }
  result.push_back(domain.upper);
  return result;
}

}  // namespace

bool same_basis(const Surface& a, const Surface& b) {
  return a.knots() == b.knots() && std::ranges::equal(a.weights(), b.weights());
}

double largest_distance(const Surface& a, const Surface& b) {
  if (same_basis(a, b)) {
    const auto field = a.with_control_points(a.control_points() - b.control_points());
    return field ? largest_norm(*field).value : std::numeric_limits<double>::quiet_NaN();
  }
  std::array<std::vector<double>, 2> at;
  std::array<double, 2> best{}, step{};
  for (std::size_t d = 0; d < 2; ++d) {
    assert(a.knots()[d].domain().lower == b.knots()[d].domain().lower &&
           a.knots()[d].domain().upper == b.knots()[d].domain().upper);
    at[d] = samples(a.knots()[d], b.knots()[d]);
    for (std::size_t k = 1; k < at[d].size(); ++k)
      step[d] = std::max(step[d], at[d][k] - at[d][k - 1]);
  }
  const std::array<std::span<const double>, 2> grid = {at[0], at[1]};
  const auto on_a = evaluate_grid<2>(a, grid), on_b = evaluate_grid<2>(b, grid);
  if (!on_a || !on_b) return std::numeric_limits<double>::quiet_NaN();
  Eigen::Index row = 0;
  double largest =
      std::sqrt((on_a->points() - on_b->points()).rowwise().squaredNorm().maxCoeff(&row));
  const auto columns = static_cast<Eigen::Index>(at[1].size());
  best = {at[0][static_cast<std::size_t>(row / columns)],
          at[1][static_cast<std::size_t>(row % columns)]};
  for (double share = 1; share > 1e-6;) {
    bool better = false;
    for (std::size_t d = 0; d < 2; ++d) {
      const Interval domain = a.knots()[d].domain();
      for (double sign : {-1.0, 1.0}) {
        std::array<double, 2> there = best;
        there[d] = std::clamp(best[d] + sign * share * step[d], domain.lower, domain.upper);
        const auto p = evaluate_point<2>(a, there), q = evaluate_point<2>(b, there);
        if (!p || !q) continue;  // a denominator vanishes between the samples: their maximum stands
        const double distance = (*p - *q).norm();
        if (distance <= largest) continue;
        largest = distance;
        best = there;
        better = true;
      }
    }
    if (!better) share /= 2;
  }
  return largest;
}

}  // namespace knead
