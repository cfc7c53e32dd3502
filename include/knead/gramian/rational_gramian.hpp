#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <span>

#include "knead/base/error.hpp"
#include "knead/gramian/band_matrix.hpp"
#include "knead/spline/knot_vector.hpp"

namespace knead {

/// A Gramian of rational functions with an error bound.
template <class Matrix>
struct RationalGramian {
  Matrix matrix;
  /// Bound on the error of any entry, rounding apart (about 1e-14 of the largest entry).
  double error_bound = 0;
  int pieces = 0;          ///< how many pieces the spans were cut into
  int largest_points = 0;  ///< Gauss points per piece and direction, at most
};

/// G^ab_ij = ∫ R_i^(a) R_j^(b) du with R_i = w_i N_i / Σ w N, to a tolerance.
///
/// Each span gets as many Gauss points as an error bound requires: with M a bound of the integrand
/// on the Bernstein ellipse of parameter ρ about the span and N points, the error is below (h/2)
/// (64/15) M ρ^(−2N) / (1 − ρ^(−2)) (L. N. Trefethen, Approximation Theory and Approximation
/// Practice, Thm 19.3). M comes from the Chebyshev coefficients of the functions, their derivatives
/// and the denominator; where the denominator has no positive lower bound on any suitable ellipse,
/// the span is halved. \param weights    one per function, positive. \param tolerance  largest
/// error of an entry, as a fraction of max_I sqrt(G^aa_II G^bb_II), which is the largest entry
/// where a = b; > 0. Below 1e-14 rounding dominates. Orders 0 <= a, b <= 2, derivatives span by
/// span. Errors: order or tolerance (usage); a wrong number of weights, a weight that is not
/// positive and finite (input).
[[nodiscard]] Expected<RationalGramian<BandMatrix>> rational_gramian(
    const KnotVector& knots, std::span<const double> weights, int a, int b, double tolerance);

/// The same on a surface: ∫∫ ∂^a R_I ∂^b R_J du dv, a and b per direction with a_0 + a_1 <= 2. Row
/// and column I = i n + j for function (i, j) of an m × n net, second direction fastest, as in
/// `Spline`; the pattern is that of the overlapping supports. Cost: O((N (p + 1)²)²) per piece with
/// N points in a direction.
[[nodiscard]] Expected<RationalGramian<Eigen::SparseMatrix<double>>> rational_gramian(
    const std::array<KnotVector, 2>& knots, std::span<const double> weights, std::array<int, 2> a,
    std::array<int, 2> b, double tolerance);

/// A Gramian of rational functions by antiderivatives.
struct ClosedFormGramian {
  BandMatrix matrix;
  int closed = 0;      ///< spans by antiderivatives
  int integrated = 0;  ///< spans by `rational_gramian`'s rules, since antiderivatives cancel there
  double estimated_error = 0;  ///< of an entry, on the spans by antiderivatives
};

/// G^ab_ij of a curve in closed form: on a span R_i^(a) R_j^(b) = P/W^m, m = a + b + 2, whose
/// partial fractions over the roots z of W have the antiderivatives log(x − z), that is a logarithm
/// and an arctangent, and powers.
///
/// Computed in extended precision (long double). The fractions grow and cancel where roots are far
/// away or close together, which is the usual case: weights that are nearly equal. What is lost is
/// estimated by repeating the span in double precision; where that exceeds the tolerance, a
/// fraction as in `rational_gramian`, the span is integrated as there. For comparison: slower than
/// `rational_gramian`, and its error is an estimate, not a bound. Errors as there.
[[nodiscard]] Expected<ClosedFormGramian> closed_form_rational_gramian(
    const KnotVector& knots, std::span<const double> weights, int a, int b, double tolerance);

/// The thesis' approximation (§ 5.8): on each span the denominator is replaced by its value at the
/// midpoint, so that the Gramian is a weighted polynomial one. On the knots of a circle the error
/// is 18 % of the largest entry for orders 0, 48 % for 1 and 52 % for 2, and it is unbounded where
/// weights differ much; it is provided under its own name for comparison and never used implicitly.
/// Errors as above.
[[nodiscard]] Expected<BandMatrix> constant_denominator_gramian(const KnotVector& knots,
                                                                std::span<const double> weights,
                                                                int a, int b);

}  // namespace knead
