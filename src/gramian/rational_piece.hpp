#pragma once

#include <array>
#include <vector>

#include "knead/spline/knot_vector.hpp"
#include "span_basis.hpp"

namespace knead::detail {

inline constexpr int rational_order = 2;  ///< highest total derivative

/// Position of the multi-index (k, l), k + l <= 2, in 00, 10, 01, 20, 11, 02.
constexpr int order_index(int k, int l) { return (k + l) * (k + l + 1) / 2 + l; }

/// One direction of a piece of the domain on which all functions are polynomials: a part of a span, or, for the second
/// direction of curves, a dummy: one function that is 1 on an interval of length 1.
struct RationalAxis {
  const KnotVector* knots = nullptr;
  int span = 0;
  double lower = 0, upper = 1;
  /// Chebyshev coefficient k of N_{span-p+r}^(d) over [lower, upper] at [(d (p + 1) + r)(p + 1) + k].
  std::vector<double> chebyshev = {};

  [[nodiscard]] int degree() const { return knots != nullptr ? knots->degree() : 0; }
  [[nodiscard]] int first() const { return knots != nullptr ? span - degree() : 0; }
  [[nodiscard]] double length() const { return upper - lower; }
  /// N^(d), d = 0, 1, 2, at lower + t length.
  void values(double t, double complement, SpanValues<double> (&out)[3]) const;
  void tabulate();
  [[nodiscard]] RationalAxis half(int which) const;
};

/// The rational functions of one piece and their bounds on Bernstein ellipses.
class RationalPiece {
 public:
  /// `weights`: the (p + 1)(q + 1) weights of the functions on the piece, second direction fastest.
  RationalPiece(std::array<RationalAxis, 2> axes, const double* weights);

  [[nodiscard]] const RationalAxis& axis(int direction) const { return axes_[static_cast<std::size_t>(direction)]; }
  [[nodiscard]] const double* weights() const { return weights_; }
  [[nodiscard]] int functions() const { return (axis(0).degree() + 1) * (axis(1).degree() + 1); }

  /// ∂^(k,l) R at a point, k + l <= 2, for all functions of the piece: out[order_index(k, l) · functions() + r].
  void evaluate(const SpanValues<double> (&u)[3], const SpanValues<double> (&v)[3], double* out) const;

  /// A bound of |∂^a R_I ∂^b R_J| over all functions, for u on the ellipse rho_u and v on the ellipse rho_v (1: the
  /// interval itself). Infinite if the denominator has no positive lower bound there.
  [[nodiscard]] double bound(double rho_u, double rho_v, std::array<int, 2> a, std::array<int, 2> b) const;

  /// How much the denominator varies along a direction: decides where to halve.
  [[nodiscard]] double variation(int direction) const;

 private:
  [[nodiscard]] double denominator_coefficient(int order, int k, int l) const {
    return denominator_[static_cast<std::size_t>((order * (axis(0).degree() + 1) + k) * (axis(1).degree() + 1) + l)];
  }

  std::array<RationalAxis, 2> axes_;
  const double* weights_;
  /// Chebyshev coefficients (k, l) of ∂^o W, o = 0 … 5 by order_index.
  std::vector<double> denominator_;
};

}  // namespace knead::detail
