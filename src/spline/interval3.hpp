#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace knead::detail {

/// A subscript of a standard container.
[[nodiscard]] constexpr std::size_t index(Eigen::Index k) { return static_cast<std::size_t>(k); }

/// [lower, upper], closed. Bounds are not rounded outwards: they carry the rounding of ordinary
/// arithmetic.
struct Range {
  double lower = 0, upper = 0;

  [[nodiscard]] double length() const { return upper - lower; }
  [[nodiscard]] bool holds_zero() const { return lower <= 0 && upper >= 0; }
  [[nodiscard]] double magnitude() const { return std::max(std::abs(lower), std::abs(upper)); }
  friend Range operator+(Range a, Range b) { return {a.lower + b.lower, a.upper + b.upper}; }
  friend Range operator-(Range a, Range b) { return {a.lower - b.upper, a.upper - b.lower}; }
  friend Range operator+(Range a, double b) { return {a.lower + b, a.upper + b}; }
  friend Range operator*(Range a, Range b) {
    const double p = a.lower * b.lower, q = a.lower * b.upper, r = a.upper * b.lower,
                 s = a.upper * b.upper;
    return {std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))};
  }
  friend Range operator*(double a, Range b) {
    return a >= 0 ? Range{a * b.lower, a * b.upper} : Range{a * b.upper, a * b.lower};
  }
  /// Requires 0 < b.lower.
  friend Range operator/(Range a, Range b) { return a * Range{1 / b.upper, 1 / b.lower}; }
  [[nodiscard]] Range squared() const {
    const double p = lower * lower, q = upper * upper;
    return {holds_zero() ? 0 : std::min(p, q), std::max(p, q)};
  }
};

/// A box: one range per coordinate.
struct Range3 {
  std::array<Range, 3> axis;

  [[nodiscard]] double squared_distance(const Eigen::Vector3d& x) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const Range& a = axis[static_cast<std::size_t>(k)];
      const double d = std::max(std::max(a.lower - x[k], x[k] - a.upper), 0.0);
      sum += d * d;
    }
    return sum;
  }
  [[nodiscard]] double diagonal() const {
    return std::hypot(axis[0].upper - axis[0].lower, axis[1].upper - axis[1].lower,
                      axis[2].upper - axis[2].lower);
  }
  void include(const Range3& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      axis[k] = {std::min(axis[k].lower, other.axis[k].lower),
                 std::max(axis[k].upper, other.axis[k].upper)};
    }
  }
  [[nodiscard]] Range dot(const Range3& o) const {
    return axis[0] * o.axis[0] + axis[1] * o.axis[1] + axis[2] * o.axis[2];
  }
  [[nodiscard]] Range squared_norm() const {
    return axis[0].squared() + axis[1].squared() + axis[2].squared();
  }
  [[nodiscard]] double magnitude() const {
    return std::hypot(axis[0].magnitude(), axis[1].magnitude(), axis[2].magnitude());
  }
  friend Range3 operator-(const Range3& a, const Eigen::Vector3d& x) {
    return {{a.axis[0] + -x[0], a.axis[1] + -x[1], a.axis[2] + -x[2]}};
  }
};

}  // namespace knead::detail
