#pragma once

#include "knead/base/instruction_set.hpp"
#include "knead/gramian/gramian.hpp"

namespace knead::detail {

/// G^ab for any a, b >= 0 with this many Gauss points on each span (thesis Alg. 5.1).
[[nodiscard]] BandMatrix gauss_gramian(const KnotVector& knots, int a, int b, int points);

/// The number of Gauss points that integrate G^ab exactly: n points suffice for degrees below 2n,
/// and N_i^(a) N_j^(b) has degree 2p − a − b.
[[nodiscard]] constexpr int sufficient_points(int degree, int a, int b) {
  return a + b > 2 * degree ? 1 : (2 * degree - a - b) / 2 + 1;
}

/// All four terms, each with as many Gauss points as it needs, into matrices of any size.
void reduced_gauss_gramians(const KnotVector& knots, InstructionSet instructions, GramianSet& set);

/// Whether the Gauss kernels compute these Gramians: degrees to 7 whose knots are
/// `within_kernel_range`.
[[nodiscard]] bool has_gauss_kernels(const KnotVector& knots);

/// G^ab for any a, b >= 0 from jumps and repeated integrals (thesis Alg. 5.5, corrected).
[[nodiscard]] BandMatrix analytic_gramian(const KnotVector& knots, int a, int b);

/// All four terms by Gauss points, into matrices of any size.
void gauss_gramians(const KnotVector& knots, InstructionSet instructions, GramianSet& set);

/// Integrates the entries of functions whose common support extends beyond the domain again, over
/// the spans of the domain only: at most p(p + 1)/2 entries at either end, none if the knots are
/// clamped.
void cut_to_domain(const KnotVector& knots, GramianSet& set);

/// False if knot distances are so extreme that products of two of them could leave the range of
/// doubles, or the degree is above `max_kernel_degree`.
[[nodiscard]] bool within_kernel_range(const KnotVector& knots);

/// All four terms by the positive recurrence, into matrices of any size.
void recurrence_gramians(const KnotVector& knots, InstructionSet instructions, GramianSet& set);

[[nodiscard]] inline BandSymmetry symmetry_of(int a, int b) {
  return a == b ? BandSymmetry::symmetric : BandSymmetry::general;
}

}  // namespace knead::detail
