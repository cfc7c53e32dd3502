#include "knead/spline/knot_vector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace knead {

Expected<KnotVector> KnotVector::create(int degree, std::vector<double> knots) {
  if (degree < 1 || degree > max_degree) {
    return input_error(fmt::format("degree {} is out of range", degree), {},
                       fmt::format("use 1 to {}", max_degree));
  }
  const int p = degree, total = static_cast<int>(knots.size());
  if (total < 2 * (p + 1)) {
    return input_error(fmt::format("{} knots are too few for degree {}", total, p),
                       fmt::format("knot {}", total), fmt::format("give at least {}", 2 * (p + 1)));
  }
  for (int i = 0, run = 1; i < total; ++i) {
    const double x = knots[static_cast<std::size_t>(i)];
    if (!std::isfinite(x))
      return input_error("the knot is not a finite number", fmt::format("knot {}", i));
    if (i == 0) continue;
    const double before = knots[static_cast<std::size_t>(i - 1)];
    if (x < before) {
      return input_error(fmt::format("the knots decrease from {} to {}", before, x),
                         fmt::format("knot {}", i), "sort the knots");
    }
    run = x == before ? run + 1 : 1;
    if (run > p + 1) {
      return input_error(fmt::format("the knot {} is repeated more than {} times", x, p + 1),
                         fmt::format("knot {}", i),
                         fmt::format("degree {} allows a multiplicity of {} at most", p, p + 1));
    }
  }
  const int n = total - p - 1;
  if (!(knots[static_cast<std::size_t>(p)] < knots[static_cast<std::size_t>(n)])) {
    return input_error("the domain is empty", fmt::format("knots {} and {}", p, n),
                       "the knots of index p and n must differ");
  }
  return KnotVector(degree, std::move(knots));
}

Expected<KnotVector> KnotVector::clamped_uniform(int degree, int count, double a, double b) {
  if (degree < 1 || degree > max_degree) return create(degree, {});
  if (count < degree + 1) {
    return input_error(fmt::format("{} control points are too few for degree {}", count, degree),
                       {}, fmt::format("use at least {}", degree + 1));
  }
  std::vector<double> knots(static_cast<std::size_t>(count + degree + 1), a);
  const int spans = count - degree;
  for (int k = 1; k < spans; ++k) {
    knots[static_cast<std::size_t>(degree + k)] = a + (b - a) * k / spans;
  }
  std::fill(knots.begin() + count, knots.end(), b);
  return create(degree, std::move(knots));
}

int KnotVector::find_span(double u, Side side) const {
  assert(domain().contains(u));
  const auto first = knots_.begin() + degree_, last = knots_.begin() + count();
  // The right span starts at the last knot <= u, the left one at the last knot < u; both are kept
  // inside the domain.
  auto it =
      side == Side::right ? std::upper_bound(first, last, u) : std::lower_bound(first, last, u);
  if (it == first) it = std::upper_bound(first, last, *first);
  if (it == last) it = std::lower_bound(first, last, *last);
  return static_cast<int>(it - knots_.begin()) - 1;
}

std::vector<int> KnotVector::spans() const {
  std::vector<int> result;
  for (int s = degree_; s < count(); ++s) {
    if ((*this)[s] < (*this)[s + 1]) result.push_back(s);
  }
  return result;
}

int KnotVector::multiplicity(double u) const {
  const auto [first, last] = std::equal_range(knots_.begin(), knots_.end(), u);
  return static_cast<int>(last - first);
}

int KnotVector::max_interior_multiplicity() const {
  const auto [a, b] = domain();
  int largest = 0, run = 0;
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    if (!(a < knots_[i] && knots_[i] < b)) continue;
    run = i > 0 && knots_[i] == knots_[i - 1] ? run + 1 : 1;
    largest = std::max(largest, run);
  }
  return largest;
}

double KnotVector::greville(int i) const {
  const double first = (*this)[i + 1];
  // Offsets from the first knot, so that p equal knots give exactly that knot.
  double sum = 0;
  for (int k = 2; k <= degree_; ++k) sum += (*this)[i + k] - first;
  return first + sum / degree_;
}

}  // namespace knead
