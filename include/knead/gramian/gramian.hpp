#pragma once

#include <string_view>

#include "knead/base/error.hpp"
#include "knead/base/instruction_set.hpp"
#include "knead/gramian/band_matrix.hpp"
#include "knead/spline/knot_vector.hpp"

namespace knead {

/// How a Gramian is computed; docs/gramians compares them.
enum class GramianMethod {
  gauss,  ///< p + 1 Gauss–Legendre points per span (thesis Alg. 5.1): accurate for every order.
  gauss_reduced,  ///< as many points as the degree 2p − a − b of the integrand needs, ⌈(2p − a − b
                  ///< + 1)/2⌉: p + 1 for 00, p for 10 and 11, p − 1 for 22, one for pp. The same
                  ///< numbers to rounding. Cheaper for one term of high order; all four at once are
                  ///< cheaper by gauss, which evaluates the functions once.
  analytic,    ///< the thesis' Dirac weights (Alg. 5.5), with jumps of every order, for repeated
               ///< knots.
  recurrence,  ///< a recurrence of non-negative terms: exact to the last digits and the fastest.
               ///< Orders other than 00, 10, 01, 11 and 22 use gauss.
};

inline constexpr GramianMethod default_gramian_method = GramianMethod::recurrence;

/// The method of that name ("gauss", "gauss-reduced", "analytic", "recurrence"); a usage error
/// lists the known ones.
[[nodiscard]] Expected<GramianMethod> gramian_method(std::string_view name);
[[nodiscard]] std::string_view name(GramianMethod method);

/// The method that computes G^ab when `wanted` is requested: gauss instead of recurrence for orders
/// that the recurrence does not cover, and on knots so extreme (domain longer than 2^240 or spans
/// shorter than 2^-240) that its products could leave the range of doubles; otherwise `wanted`
/// itself.
[[nodiscard]] GramianMethod used_gramian_method(const KnotVector& knots, int a, int b,
                                                GramianMethod wanted);

/// The Gramian G^ab_ij = ∫ N_i^(a) N_j^(b) du over the domain [x_p, x_n], i the row.
///
/// Derivatives are taken span by span ("broken"): a jump at a knot of high multiplicity contributes
/// nothing. The result is n × n with half bandwidth p; it is stored as symmetric where a = b. Any
/// degree, clamped or not, any multiplicity. Orders: 0 <= a, b <= max_degree; above the degree the
/// Gramian is zero. `used_gramian_method` tells which method computes it. Errors: any other order
/// (usage). Cost: O(n p²) for the Gauss methods and analytic, times the number of points and knots
/// per function respectively. Accuracy: the Gauss methods below 1e-14 of ∫|N_i^(a) N_j^(b)| to
/// degree 7 and for a, b <= 2; 3e-14 to degree 10 for other orders, where no derivative above the
/// second changes sign within a cluster of knots. analytic loses digits as spans shrink: about
/// 1e-12 on uniform knots at p = 3, no digits at all where knots cluster 1e-8 apart.
[[nodiscard]] Expected<BandMatrix> gramian(const KnotVector& knots, int a, int b,
                                           GramianMethod method = default_gramian_method);

/// Decimal digits of the largest entry of G^ab to which a computed one agrees with that of the
/// recurrence, which loses none: at most 17, below 0 where they differ by more. For `analytic`,
/// which cancels where knots are close. Errors: those of `gramian`. Cost: that of the recurrence.
[[nodiscard]] Expected<double> digits_left(const KnotVector& knots, int a, int b,
                                           const BandMatrix& computed);

/// The four Gramians from which stiffness, mass and damping are built; G01 is `g10.transposed()`.
struct GramianSet {
  BandMatrix g00, g11, g22, g10;
};

/// 00, 11, 22 and 10 at once, which costs less than one at a time.
[[nodiscard]] Expected<GramianSet> gramians(const KnotVector& knots,
                                            GramianMethod method = default_gramian_method);

/// The same into existing storage: matrices of the right shape are overwritten, others replaced.
/// `instructions` is the instruction set to use (recurrence and gauss; the result does not depend
/// on it).
void recompute_gramians(const KnotVector& knots, GramianMethod method, GramianSet& set,
                        InstructionSet instructions = best_instruction_set());

}  // namespace knead
