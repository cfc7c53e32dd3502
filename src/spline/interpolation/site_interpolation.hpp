#pragma once

#include <span>
#include <vector>

#include "knead/spline/basis.hpp"

namespace knead {

/// Interpolation at one site per function of one direction: the collocation matrix C_ij = N_j(g_i),
/// factored once.
///
/// Where the sites are is told by what is derived from this: `GrevilleInterpolation`,
/// `ChebyshevInterpolation`. A knot of multiplicity p + 1 inside is the site of two functions;
/// there the function that ends uses the limit from the left and the one that begins the limit from
/// the right. No site is moved. Functions that vanish on the domain (knots repeated at the end of
/// an unclamped vector) have the coefficient 0, whatever the values.
///
/// C is banded and totally positive, so that elimination without pivoting is stable (de Boor &
/// Pinkus 1977). Cost: O(n p²) to factor. In an unclamped basis functions can be so small on the
/// domain that their coefficients are ill-conditioned; the resulting spline is not. Immutable.
class SiteInterpolation {
 public:
  /// \param sites `knots.count()` parameters in the domain, non-decreasing; site i in the support
  /// of function i. Error (numerical): two sites coincide or swap by rounding (spans of single
  /// ulps), so that C is singular.
  [[nodiscard]] static Expected<SiteInterpolation> create(const KnotVector& knots,
                                                          std::vector<double> sites);

  /// Number of functions and of sites.
  [[nodiscard]] int size() const { return static_cast<int>(abscissae_.size()); }
  /// Non-decreasing; one per function. Those of vanishing functions are the end of the domain.
  [[nodiscard]] const std::vector<double>& abscissae() const { return abscissae_; }
  /// The side from which each is taken: left for a function that ends in a knot of multiplicity p +
  /// 1 there.
  [[nodiscard]] const std::vector<Side>& sides() const { return sides_; }
  /// The basis at the sites, each from its side.
  [[nodiscard]] const BasisTable& basis() const { return basis_; }
  /// The basis of other knots at the sites, each from its side. Requires: a domain that contains
  /// this one (asserted).
  [[nodiscard]] BasisTable tabulate(const KnotVector& other) const;

  /// Replaces values at the sites by coefficients, along one direction of a tensor
  /// [outer][size()][inner], last index fastest. Cost: (2p + 1) multiply-adds per number.
  void solve(double* values, std::size_t outer, std::size_t inner) const;

 private:
  SiteInterpolation() = default;
  [[nodiscard]] Expected<void> factor();

  std::vector<double> abscissae_;
  std::vector<Side> sides_;
  BasisTable basis_;
  int degree_ = 0, begin_ = 0, end_ = 0;  // functions that do not vanish on the domain
  std::vector<double> lu_;  // entry (i, j) at [i (2p + 1) + j − i + p], unit lower factor
};

/// The functions begin … end − 1 that do not vanish on the domain.
struct FunctionsOnDomain {
  int begin = 0, end = 0;
};
[[nodiscard]] FunctionsOnDomain functions_on_domain(const KnotVector& knots);

}  // namespace knead
