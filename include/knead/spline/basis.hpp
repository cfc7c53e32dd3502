#pragma once

#include <span>
#include <vector>

#include "knead/spline/knot_vector.hpp"

namespace knead {

/// Values and derivatives of the p + 1 basis functions that are non-zero on one span, at one
/// parameter.
///
/// N_{s-p+r}^(d)(u) for r = 0 … p, d = 0 … order, the polynomial piece of span s: Cox–de Boor by
/// spans and Piegl & Tiller, The NURBS Book, A2.3. Derivatives above p are zero. Because the span
/// is given, one-sided derivatives at repeated knots are exact: ask for `find_span(u, side)` first.
///
/// \param span   a span of positive length, as `KnotVector::find_span` or `spans` return it; u may
/// lie anywhere on it,
///               both ends included (outside it the piece is extrapolated).
/// \param out    (order + 1)(p + 1) numbers, out[d (p + 1) + r].
/// Cost: O(p² + p² order), no allocation. Accuracy: values are sums of non-negative terms, relative
/// error below 4 p ulp inside the span.
void basis_derivatives(const KnotVector& knots, int span, double u, int order, double* out);

/// The values alone, out[r] = N_{span-p+r}(u), r = 0 … p. Non-negative; they sum to 1 up to
/// rounding.
void basis_values(const KnotVector& knots, int span, double u, double* out);

/// Basis functions of one direction tabulated at many parameters: the unit of work of every
/// evaluation.
struct BasisTable {
  int degree = 0;
  int order = 0;  ///< highest derivative tabulated
  std::vector<int>
      first;  ///< first[k] = index of the first function that is non-zero at parameter k
  std::vector<double>
      derivatives;  ///< N^(d)_{first[k]+r}(u_k) at [(k (order + 1) + d) (p + 1) + r]

  [[nodiscard]] int size() const { return static_cast<int>(first.size()); }
  /// The p + 1 numbers N^(d)_{first[k]+r}(u_k), r = 0 … p.
  [[nodiscard]] const double* row(int k, int d) const {
    return derivatives.data() + (static_cast<std::size_t>(k) * static_cast<std::size_t>(order + 1) +
                                 static_cast<std::size_t>(d)) *
                                    static_cast<std::size_t>(degree + 1);
  }
  /// The parameters begin … end − 1 alone.
  [[nodiscard]] BasisTable slice(int begin, int end) const {
    return {
        degree, order, {first.begin() + begin, first.begin() + end}, {row(begin, 0), row(end, 0)}};
  }
};

/// Tabulates the basis and its derivatives up to `order` at `parameters` (any order, repetitions
/// allowed). At a knot the limit from `side` is taken; at the ends of the domain the limit from
/// inside. Errors: a parameter outside the domain or not finite, named by its index; a negative
/// order.
[[nodiscard]] Expected<BasisTable> tabulate_basis(const KnotVector& knots,
                                                  std::span<const double> parameters, int order,
                                                  Side side = Side::right);

/// Gauss points of one direction with their basis: `points_per_piece` Gauss–Legendre points on each
/// of `pieces[k]` equal pieces of the k-th span of positive length.
struct BasisQuadrature {
  std::vector<double> parameters;  ///< ascending
  std::vector<double> weights;  ///< ∫ f du ≈ Σ weights[k] f(parameters[k]) over the whole domain
  BasisTable basis;
};

/// \param pieces one positive number for each entry of `knots.spans()`, or empty for one piece
/// each.
[[nodiscard]] BasisQuadrature gauss_basis(const KnotVector& knots, int points_per_piece, int order,
                                          std::span<const int> pieces = {});

/// N_i^(derivative)(u) anywhere on the line; zero outside the support [x_i, x_{i+p+1}] and above
/// the degree.
///
/// N_i is a function on the whole line, as its own knots define it, inside the domain and out.
/// Where a derivative jumps, the limit from `side` is taken, at the ends of the domain the limit
/// from inside. Requires: 0 <= i < count, derivative >= 0 (asserted). Cost: O(p²). Accuracy: the
/// value (derivative 0) is a sum of non-negative terms, relative error below 4 p ulp; derivatives
/// are differences of such values of degree p − derivative.
[[nodiscard]] double basis_function(const KnotVector& knots, int i, int derivative, double u,
                                    Side side = Side::right);

/// The `times`-fold integral of N_i from −∞ to u, anywhere on the line, left of the support (0), on
/// it and right of it.
///
/// On the support by thesis Thm 5.2, ∫ N_{i,q} = (x_{i+q+1} − x_i)/(q + 1) Σ_{j>=i} N_{j,q+1},
/// repeated, on knots extended at the end; right of it the integral is the Taylor polynomial of its
/// values at the last knot (thesis Alg. 5.2 stops there). times = 0 is the function itself. ∫ N_i
/// over the line is (x_{i+p+1} − x_i)/(p + 1). Requires: 0 <= i < count, times >= 0 (asserted).
/// Cost: O((p + times)²). Accuracy: sums of products of non-negative numbers only, so nothing
/// cancels: relative error below 4 (p + 2 times + 2) ulp.
[[nodiscard]] double basis_integral(const KnotVector& knots, int i, int times, double u);

/// The knots with `before` copies of the first in front and `after` copies of the last behind: the
/// knots of repeated integrals of all basis functions. Not a valid knot vector, as the ends are
/// repeated more than p + 1 times.
[[nodiscard]] std::vector<double> extended_knots(const KnotVector& knots, int before, int after);

/// Where a basis function is not smooth: all derivatives that jump at one knot of its support.
struct KnotJumps {
  double knot = 0;
  /// How often the knot occurs among x_i … x_{i+p+1}, the knots of the function: 1 … p + 1.
  int multiplicity = 0;
  /// Jumps, right limit minus left limit, of N_i^(r) for r = p − multiplicity + 1 … p. Lower
  /// derivatives are continuous.
  std::vector<double> jumps;

  /// [N_i^(order)] at the knot, for any order >= 0.
  [[nodiscard]] double of_order(int order, int degree) const {
    const int lowest = degree - multiplicity + 1;
    return order < lowest || order > degree ? 0 : jumps[static_cast<std::size_t>(order - lowest)];
  }
  /// What N_i^(p+1) has at the knot: the weights of δ, δ', … up to the last that is not 0.
  [[nodiscard]] std::vector<double> impulses() const {
    std::vector<double> weights(jumps.rbegin(), jumps.rend());
    while (!weights.empty() && weights.back() == 0) weights.pop_back();
    return weights;
  }
};

/// The jumps of every derivative of N_i at every knot of its support, ascending, with N_i on the
/// whole line.
///
/// From the divided difference N_i(u) = (x_{i+p+1} − x_i) [x_i, …, x_{i+p+1}] (· − u)₊^p: with Q(x)
/// = Π (x − x_l) over the knots other than ξ and m the multiplicity of ξ,
///   [N_i^(r)]_ξ = (−1)^(r+1) p!/t! (x_{i+p+1} − x_i) e_{m−1−t},   t = p − r,   1/Q(ξ + h) = Σ e_k
///   h^k.
/// At a simple knot this is the single jump of order p, the weight of the Dirac impulse in the
/// derivative of order p + 1 (thesis § 5.4.1); at a knot of multiplicity m the (p + 1)th derivative
/// also holds derivatives of impulses, N_i^(p+1) = Σ_ξ Σ_r [N_i^(r)]_ξ δ_ξ^(p−r). Requires: 0 <= i
/// < count (asserted). Cost: O(p²) per knot. Accuracy: the jump of the lowest order at a knot is a
/// product, relative error below 2 (p + 3) ulp (so all jumps at simple knots); those above it are
/// sums that can cancel where there are knots on both sides.
[[nodiscard]] std::vector<KnotJumps> derivative_jumps(const KnotVector& knots, int i);

}  // namespace knead
