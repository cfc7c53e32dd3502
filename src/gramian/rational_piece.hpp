#pragma once

#include <array>
#include <utility>
#include <vector>

#include "span_basis.hpp"
#include "spline/quotient_rule.hpp"

namespace knead::detail {

inline constexpr int rational_order = 2;  ///< highest total derivative

/// One direction of a piece of the domain on which all functions are polynomials: a part of a span.
struct RationalAxis {
  const KnotVector* knots = nullptr;
  int span = 0;
  double lower = 0, upper = 0;
  /// Chebyshev coefficient k of N_{span-p+r}^(d) over [lower, upper] at [(d (p + 1) + r)(p + 1) +
  /// k].
  std::vector<double> chebyshev = {};

  RationalAxis() = default;
  RationalAxis(const KnotVector& knots, int span, double lower, double upper);

  [[nodiscard]] int degree() const { return knots->degree(); }
  [[nodiscard]] int first() const { return span - degree(); }
  [[nodiscard]] double length() const { return upper - lower; }
  /// N^(d), d = 0, 1, 2, at lower + t length.
  void values(double t, double complement, SpanValues<double>* out) const;
  [[nodiscard]] RationalAxis half(int which) const;
};

/// The values of an axis at Gauss points: N^(d) of function r at point g at values[(d (p + 1) + r)
/// n + g].
struct RationalPoints {
  std::vector<double> values, weights;

  [[nodiscard]] std::size_t size() const { return weights.size(); }
  /// The Gauss rule with n points on the axis. Of a `line` the last point comes again, without
  /// weight, until their number is a multiple of `RationalKernels::line_step`.
  void tabulate(const RationalAxis& axis, int n, bool line);
};

/// A line of points along the last direction of a piece, tabulated as one.
template <int D>
struct RationalLine {
  std::array<const RationalPoints*, D> points;
  std::array<std::size_t, D> at;  ///< which point of all directions but the last

  [[nodiscard]] std::size_t size() const { return points[D - 1]->size(); }
  /// The Gauss weights of all directions but the last.
  [[nodiscard]] double outer_weight() const {
    double product = 1;
    for (std::size_t d = 0; d + 1 < D; ++d) product *= points[d]->weights[at[d]];
    return product;
  }
  /// Goes to the next line; false after the last.
  [[nodiscard]] bool next() {
    for (std::size_t d = D - 1; d-- > 0;) {
      if (++at[d] < points[d]->size()) return true;
      at[d] = 0;
    }
    return false;
  }
};

/// The rational functions R_i = w_i N_i / Σ w N of one piece, their derivatives of total order <= 2
/// and bounds of them on Bernstein ellipses. Derivatives are numbered as in `multi_indices<D>(2)`;
/// functions as the control points, last direction fastest.
template <int D>
class RationalPiece {
 public:
  /// How many derivatives there are, and how many of a total order up to `order`.
  static constexpr std::size_t orders = D == 1 ? 3 : D == 2 ? 6 : 10;
  static constexpr std::size_t orders_up_to(int order) {
    return order == 0 ? 1 : order == 1 ? D + 1 : orders;
  }

  /// `weights`: those of the functions on the piece. Axes and weights must outlive the piece.
  RationalPiece(std::array<const RationalAxis*, D> axes, const double* weights);

  [[nodiscard]] const RationalAxis& axis(std::size_t direction) const { return *axes_[direction]; }
  [[nodiscard]] const std::array<const RationalAxis*, D>& axes() const { return axes_; }
  [[nodiscard]] const double* weights() const { return weights_; }
  [[nodiscard]] std::size_t functions() const { return functions_; }
  /// Length, area or volume.
  [[nodiscard]] double measure() const;

  /// The first `orders` derivatives of all functions at the points of a line along the last
  /// direction: out[(a functions() + r) n + g]. Cost for second derivatives of a surface: about 20
  /// operations per function and point, in vectors. False: the denominator is not positive
  /// somewhere.
  [[nodiscard]] bool evaluate(const RationalLine<D>& line, std::size_t orders, double* out) const;
  /// The same of w_i N_i / c with a constant c.
  void evaluate_polynomial(const RationalLine<D>& line, double denominator, std::size_t orders,
                           double* out) const;
  /// Σ w N at the middle of the piece.
  [[nodiscard]] double middle_denominator() const;

  /// Bounds of |∂^a R| for one parameter on the Bernstein ellipse rho and the others on their
  /// intervals, in the order of the derivatives: out[a functions() + r]. False: the denominator has
  /// no positive lower bound there.
  [[nodiscard]] bool bounds(std::size_t direction, double rho, std::size_t orders,
                            double* out) const;

  /// How much the denominator varies along a direction: decides where to halve.
  [[nodiscard]] double variation(std::size_t direction) const;

 private:
  void transform(std::size_t d, int order, const double* from, double* to) const;
  [[nodiscard]] std::array<double, orders> denominator_bounds(
      std::size_t direction, std::size_t count, const std::array<SpanValues<double>, D>& growth,
      double& lowest) const;
  void numerators(const RationalLine<D>& line, std::size_t orders, double* out, double* sums) const;

  /// Chebyshev coefficients of ∂^order W in direction d, in that direction only: the others keep
  /// their functions.
  [[nodiscard]] const double* along(std::size_t d, int order) const {
    return denominator_.data() + (orders + 3 * d + static_cast<std::size_t>(order)) * functions_;
  }
  [[nodiscard]] double* along(std::size_t d, int order) {
    return const_cast<double*>(std::as_const(*this).along(d, order));
  }

  std::array<const RationalAxis*, D> axes_;
  const double* weights_;
  std::size_t functions_;
  /// Chebyshev coefficients of ∂^a W, a in the order of the derivatives, last direction fastest;
  /// then those `along` one direction.
  std::vector<double> denominator_;
};

extern template class RationalPiece<1>;
extern template class RationalPiece<2>;
extern template class RationalPiece<3>;

}  // namespace knead::detail
