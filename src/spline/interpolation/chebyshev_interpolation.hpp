#pragma once

#include "site_interpolation.hpp"

namespace knead {

/// Interpolation at the Chebyshev sites of one direction: stable for values that no spline has, at
/// every degree and multiplicity and over spans of any lengths.
///
/// The Chebyshev spline T of a knot vector is the one with |T| <= 1 that is 1 at the end and takes
/// the values ±1 alternately at n sites, as many as there are functions (Demko, *On the existence
/// of interpolating projections onto spline spaces*, 1985). On one Bézier piece it is the Chebyshev
/// polynomial and its sites are (1 − cos πi/p)/2; of degree 1 the sites are the knots. The norm of
/// interpolation at them, max Σ_i |ℓ_i(u)| over the domain with the cardinal splines ℓ_i, is
/// bounded for each degree whatever the knots: measured over all families of knots, multiplicities
/// to p + 1 and spans that differ by 10⁶,
///
///   degree             1     3     5     10    15    20    25
///   Chebyshev sites    1     1.7   2.0   2.4   2.7   2.9   3.0
///   Greville           1     2.8   6.8   81    1.8e3 3.6e4 7.4e5
///
/// (docs/clay.md, tests/spline/chebyshev_interpolation_test.cpp).
class ChebyshevInterpolation : public SiteInterpolation {
 public:
  /// Error (numerical): as `SiteInterpolation`.
  [[nodiscard]] static Expected<ChebyshevInterpolation> create(const KnotVector& knots);

 private:
  explicit ChebyshevInterpolation(SiteInterpolation made) : SiteInterpolation(std::move(made)) {}
};

/// The Chebyshev sites of a knot vector with its ends clamped; those of functions that vanish on
/// the domain are its end. Pieces between knots of multiplicity p + 1 have their own.
///
/// Found by exchange, as Remez' algorithm: from the Greville abscissae, the spline that is ±1
/// alternately at the sites has one extremum around each, which is the next site, until none
/// exceeds 1 by more than 1e-3 (at most 6 rounds of those measured; what rounding leaves of more is
/// kept). Cost: O(n p³) a round.
[[nodiscard]] std::vector<double> chebyshev_sites(const KnotVector& knots);

}  // namespace knead
