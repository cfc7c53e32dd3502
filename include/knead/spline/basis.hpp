#pragma once

#include <span>
#include <vector>

#include "knead/spline/knot_vector.hpp"

namespace knead {

/// Values and derivatives of the p + 1 basis functions that are non-zero on one span, at one parameter.
///
/// N_{s-p+r}^(d)(u) for r = 0 … p, d = 0 … order, the polynomial piece of span s: Cox–de Boor by spans and Piegl &
/// Tiller, The NURBS Book, A2.3. Derivatives above p are zero. Because the span is given, one-sided derivatives at
/// repeated knots are exact: ask for `find_span(u, side)` first.
///
/// \param span   a span of positive length, as `KnotVector::find_span` or `spans` return it; u may lie anywhere on it,
///               both ends included (outside it the piece is extrapolated).
/// \param out    (order + 1)(p + 1) numbers, out[d (p + 1) + r].
/// Cost: O(p² + p² order), no allocation. Accuracy: values are sums of non-negative terms, relative error below
/// 4 p ulp inside the span.
void basis_derivatives(const KnotVector& knots, int span, double u, int order, double* out);

/// The values alone, out[r] = N_{span-p+r}(u), r = 0 … p. Non-negative; they sum to 1 up to rounding.
void basis_values(const KnotVector& knots, int span, double u, double* out);

/// Basis functions of one direction tabulated at many parameters: the unit of work of every evaluation.
struct BasisTable {
  int degree = 0;
  int order = 0;                    ///< highest derivative tabulated
  std::vector<int> first;           ///< first[k] = index of the first function that is non-zero at parameter k
  std::vector<double> derivatives;  ///< N^(d)_{first[k]+r}(u_k) at [(k (order + 1) + d) (p + 1) + r]

  [[nodiscard]] int size() const { return static_cast<int>(first.size()); }
  /// The p + 1 numbers N^(d)_{first[k]+r}(u_k), r = 0 … p.
  [[nodiscard]] const double* row(int k, int d) const {
    return derivatives.data() +
           (static_cast<std::size_t>(k) * static_cast<std::size_t>(order + 1) + static_cast<std::size_t>(d)) *
               static_cast<std::size_t>(degree + 1);
  }
  /// The parameters begin … end − 1 alone.
  [[nodiscard]] BasisTable slice(int begin, int end) const {
    return {degree, order, {first.begin() + begin, first.begin() + end}, {row(begin, 0), row(end, 0)}};
  }
};

/// Tabulates the basis and its derivatives up to `order` at `parameters` (any order, repetitions allowed).
/// At a knot the limit from `side` is taken; at the ends of the domain the limit from inside.
/// Errors: a parameter outside the domain or not finite, named by its index; a negative order.
[[nodiscard]] Expected<BasisTable> tabulate_basis(const KnotVector& knots, std::span<const double> parameters,
                                                  int order, Side side = Side::right);

/// Gauss points of one direction with their basis: `points_per_piece` Gauss–Legendre points on each of `pieces[k]`
/// equal pieces of the k-th span of positive length.
struct BasisQuadrature {
  std::vector<double> parameters;  ///< ascending
  std::vector<double> weights;     ///< ∫ f du ≈ Σ weights[k] f(parameters[k]) over the whole domain
  BasisTable basis;
};

/// \param pieces one positive number for each entry of `knots.spans()`, or empty for one piece each.
[[nodiscard]] BasisQuadrature gauss_basis(const KnotVector& knots, int points_per_piece, int order,
                                          std::span<const int> pieces = {});

}  // namespace knead
