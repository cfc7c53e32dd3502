#pragma once

#include <vector>

#include "knead/spline/basis.hpp"

namespace knead {

/// Interpolation at the Greville abscissae of one direction: the collocation matrix C_ij = N_j(g_i), factored once.
///
/// The abscissae are those of the knot vector with its ends clamped, g_i = (x_{i+1} + … + x_{i+p})/p with every knot
/// outside the domain moved to its end: clamping changes the basis, not the space of functions on the domain, so that
/// the interpolation problem is the same and all abscissae lie in the domain. A knot of multiplicity p + 1 inside is
/// the abscissa of two functions; there the function that ends uses the limit from the left and the one that begins the
/// limit from the right. No abscissa is moved. Functions that vanish on the domain (knots repeated at the end of an
/// unclamped vector) have the coefficient 0, whatever the values.
///
/// C is banded and totally positive, so that elimination without pivoting is stable (de Boor & Pinkus 1977). Cost: O(n
/// p²) to factor. For clamped knots |C⁻¹| in the maximum norm grows with the degree, hardly with the spans: at most 4,
/// 8, 20, 44 for p = 2, 3, 4, 5 over all knots tried, including lengths over ten decades. In an unclamped basis
/// functions can be so small on the domain that their coefficients are ill-conditioned; the resulting spline is not.
/// Immutable.
class GrevilleInterpolation {
 public:
  /// Error (numerical): two abscissae coincide or swap by rounding (spans of single ulps), so that C is
  /// singular.
  [[nodiscard]] static Expected<GrevilleInterpolation> create(const KnotVector& knots);

  /// Number of functions and of abscissae.
  [[nodiscard]] int size() const { return static_cast<int>(abscissae_.size()); }
  /// Non-decreasing; one per function. Those of vanishing functions are the end of the domain.
  [[nodiscard]] const std::vector<double>& abscissae() const { return abscissae_; }
  /// The side from which each is taken: left for a function that ends in a knot of multiplicity p + 1 there.
  [[nodiscard]] const std::vector<Side>& sides() const { return sides_; }
  /// The basis at the abscissae, each from its side.
  [[nodiscard]] const BasisTable& basis() const { return basis_; }
  /// The basis of other knots at the abscissae, each from its side. Requires: a domain that contains this one
  /// (asserted).
  [[nodiscard]] BasisTable tabulate(const KnotVector& other) const;

  /// Replaces values at the abscissae by coefficients, along one direction of a tensor [outer][size()][inner], last
  /// index fastest. Cost: (2p + 1) multiply-adds per number.
  void solve(double* values, std::size_t outer, std::size_t inner) const;

 private:
  GrevilleInterpolation() = default;

  std::vector<double> abscissae_;
  std::vector<Side> sides_;
  BasisTable basis_;
  int degree_ = 0, begin_ = 0, end_ = 0;  // functions that do not vanish on the domain
  std::vector<double> lu_;                // entry (i, j) at [i (2p + 1) + j − i + p], unit lower factor
};

}  // namespace knead
