#pragma once

#include <span>
#include <vector>

#include "knead/base/error.hpp"

namespace knead {

/// The highest degree of a knot vector; what CAD systems write ends at 25.
inline constexpr int max_degree = 25;

/// Which one-sided limit to take where a piecewise polynomial jumps.
enum class Side { left, right };

/// A closed interval [lower, upper] of the parameter line.
struct Interval {
  double lower = 0;
  double upper = 0;
  [[nodiscard]] double length() const { return upper - lower; }
  [[nodiscard]] bool contains(double u) const { return lower <= u && u <= upper; }
};

/// A knot vector x_0 <= x_1 <= … <= x_{n+p} of degree p with its n basis functions N_0 … N_{n-1}.
///
/// The domain is [x_p, x_n]. Clamped or not; a knot may be repeated up to p + 1 times, in the
/// interior as at the ends. Spans are numbered by the index s of their left knot, [x_s, x_{s+1}];
/// only spans of positive length inside the domain carry basis functions N_{s-p} … N_s. Knots are
/// kept exactly as given: nothing is snapped, merged or rescaled. Immutable.
class KnotVector {
 public:
  /// Checks: degree 1 to 15, at least 2(p + 1) knots, all finite, non-decreasing, none repeated
  /// more than p + 1 times, x_p < x_n. An `Error` names the index of the first offending knot.
  [[nodiscard]] static Expected<KnotVector> create(int degree, std::vector<double> knots);

  /// Clamped, with `count` functions (count >= degree + 1) and equal spans over [a, b]: interior
  /// knot k is a + (b − a) k / (count − degree).
  [[nodiscard]] static Expected<KnotVector> clamped_uniform(int degree, int count, double a = 0,
                                                            double b = 1);

  [[nodiscard]] int degree() const { return degree_; }
  /// Number n of basis functions.
  [[nodiscard]] int count() const { return static_cast<int>(knots_.size()) - degree_ - 1; }
  [[nodiscard]] std::span<const double> knots() const { return knots_; }
  [[nodiscard]] double operator[](int i) const { return knots_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] Interval domain() const { return {(*this)[degree_], (*this)[count()]}; }

  /// The span of positive length that contains u: the one to the right of u, or to the left with
  /// `Side::left`. At the ends of the domain the only adjacent span is taken, so functions are
  /// defined on the closed domain, last knot included. Requires: u in the domain (asserted). Cost:
  /// O(log n).
  [[nodiscard]] int find_span(double u, Side side = Side::right) const;

  /// Indices s of all spans of positive length in the domain, ascending; never empty.
  [[nodiscard]] std::vector<int> spans() const;

  /// x_0 = … = x_p, and x_n = … = x_{n+p}.
  [[nodiscard]] bool clamped_start() const { return knots_.front() == (*this)[degree_]; }
  [[nodiscard]] bool clamped_end() const { return knots_.back() == (*this)[count()]; }
  [[nodiscard]] bool clamped() const { return clamped_start() && clamped_end(); }

  /// How often the value u occurs in the knot vector (exact comparison).
  [[nodiscard]] int multiplicity(double u) const;
  /// The largest multiplicity of a knot strictly inside the domain; 0 if there is none.
  [[nodiscard]] int max_interior_multiplicity() const;

  /// Greville abscissa of function i: the mean of x_{i+1} … x_{i+p}, 0 <= i < n. For a knot of
  /// multiplicity p + 1 it is that knot exactly.
  [[nodiscard]] double greville(int i) const;

  friend bool operator==(const KnotVector&, const KnotVector&) = default;

 private:
  KnotVector(int degree, std::vector<double> knots) : degree_(degree), knots_(std::move(knots)) {}

  int degree_;
  std::vector<double> knots_;
};

}  // namespace knead
