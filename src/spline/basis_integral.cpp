#include "knead/spline/basis.hpp"

#include <algorithm>
#include <cassert>

namespace knead {
namespace {

/// The knots of one basis function, t_0 … t_{p+1}, continued by repetition at both ends. Functions
/// k >= 0 of any degree on them depend only on these.
class LocalKnots {
 public:
  LocalKnots(const KnotVector& knots, int i) : knots_(knots), i_(i), p_(knots.degree()) {}

  double operator[](int k) const { return knots_[i_ + std::clamp(k, 0, p_ + 1)]; }
  [[nodiscard]] double first() const { return (*this)[0]; }
  [[nodiscard]] double last() const { return (*this)[p_ + 1]; }

  /// s with t_s <= u < t_{s+1}, or t_s < u <= t_{s+1}; −1 outside the support.
  [[nodiscard]] int span(double u, Side side) const {
    for (int s = 0; s <= p_; ++s) {
      const double a = (*this)[s], b = (*this)[s + 1];
      if (side == Side::right ? a <= u && u < b : a < u && u <= b) return s;
    }
    return -1;
  }

  /// values[r] = N_{s-q+r,q}(u), r = 0 … q, the piece of span s.
  [[nodiscard]] std::vector<double> values(int s, int q, double u) const {
    std::vector<double> values(static_cast<std::size_t>(q) + 1, 0.0);
    values[0] = 1;
    for (int degree = 1; degree <= q; ++degree) {
      double saved = 0;
      for (int r = 0; r < degree; ++r) {
        const double lower = (*this)[s + 1 - degree + r], upper = (*this)[s + 1 + r];
        double& value = values[static_cast<std::size_t>(r)];
        const double quotient = value / (upper - lower);
        value = saved + (upper - u) * quotient;
        saved = (u - lower) * quotient;
      }
      values[static_cast<std::size_t>(degree)] = saved;
    }
    return values;
  }

 private:
  const KnotVector& knots_;
  int i_, p_;
};

/// Σ_k c_k N_{k,q}(u) on span s, where c_k = 0 for k < 0.
double combine(const LocalKnots& t, const std::vector<double>& c, int s, int q, double u) {
  const std::vector<double> values = t.values(s, q, u);
  double sum = 0;
  for (int k = std::max(0, s - q); k <= std::min(s, static_cast<int>(c.size()) - 1); ++k) {
    sum += c[static_cast<std::size_t>(k)] * values[static_cast<std::size_t>(k - s + q)];
  }
  return sum;
}

/// The `times`-fold integral at u in [t_0, t_{p+1}].
double integral_on_support(const LocalKnots& t, int p, int times, double u) {
  const int s = t.span(u, Side::left);
  if (s < 0) return 0;  // u = t_0
  std::vector<double> c(static_cast<std::size_t>(s) + 1, 0.0);
  c[0] = 1;
  int q = p;
  for (int m = 0; m < times; ++m) {
    ++q;
    double sum = 0;
    for (int k = 0; k <= s; ++k) {
      double& coefficient = c[static_cast<std::size_t>(k)];
      sum += coefficient * (t[k + q] - t[k]) / q;
      coefficient = sum;
    }
  }
  return combine(t, c, s, q, u);
}

}  // namespace

double basis_function(const KnotVector& knots, int i, int derivative, double u, Side side) {
  assert(i >= 0 && i < knots.count() && derivative >= 0);
  const int p = knots.degree();
  if (derivative > p) return 0;
  const Interval domain = knots.domain();
  if (u == domain.lower) side = Side::right;
  if (u == domain.upper) side = Side::left;
  const LocalKnots t(knots, i);
  const int s = t.span(u, side);
  if (s < 0) return 0;
  // N^(d) as B-splines of degree p − d, differences of differences; a function without support
  // counts as zero.
  std::vector<double> c(static_cast<std::size_t>(derivative) + 1, 0.0);
  c[0] = 1;
  int q = p;
  for (int d = 1; d <= derivative; ++d, --q) {
    for (int k = d; k >= 0; --k) {
      const double length = t[k + q] - t[k];
      const double difference =
          c[static_cast<std::size_t>(k)] - (k > 0 ? c[static_cast<std::size_t>(k - 1)] : 0);
      c[static_cast<std::size_t>(k)] = length > 0 ? q * difference / length : 0;
    }
  }
  return combine(t, c, s, q, u);
}

double basis_integral(const KnotVector& knots, int i, int times, double u) {
  assert(i >= 0 && i < knots.count() && times >= 0);
  if (times == 0) return basis_function(knots, i, 0, u);
  const int p = knots.degree();
  const LocalKnots t(knots, i);
  if (!(u > t.first())) return 0;
  if (u <= t.last()) return integral_on_support(t, p, times, u);
  // Σ_k (u − t_{p+1})^(times−k)/(times−k)! I^k N(t_{p+1}), Horner's scheme from the lowest
  // integral.
  double result = 0;
  for (int k = 1; k <= times; ++k) {
    result = integral_on_support(t, p, k, t.last()) + (k > 1 ? result : 0);
    if (k < times) result *= (u - t.last()) / (times - k);
  }
  return result;
}

std::vector<double> extended_knots(const KnotVector& knots, int before, int after) {
  assert(before >= 0 && after >= 0);
  std::vector<double> result(static_cast<std::size_t>(before), knots.knots().front());
  result.insert(result.end(), knots.knots().begin(), knots.knots().end());
  result.insert(result.end(), static_cast<std::size_t>(after), knots.knots().back());
  return result;
}

}  // namespace knead
