#pragma once

#include <vector>

#include "knead/spline/knot_vector.hpp"

namespace knead {

/// N_i^(derivative)(u) anywhere on the line; zero outside the support [x_i, x_{i+p+1}] and above the degree.
///
/// N_i is a function on the whole line, as its own knots define it, inside the domain and out. Where a
/// derivative jumps, the limit from `side` is taken, at the ends of the domain the limit from inside. Requires: 0 <= i
/// < count, derivative >= 0 (asserted). Cost: O(p²). Accuracy: the value (derivative 0) is a sum of non-negative terms,
/// relative error below 4 p ulp; derivatives are differences of such values of degree p − derivative.
[[nodiscard]] double basis_function(const KnotVector& knots, int i, int derivative, double u, Side side = Side::right);

/// The `times`-fold integral of N_i from −∞ to u, anywhere on the line, left of the support (0), on it and right of it.
///
/// On the support by thesis Thm 5.2, ∫ N_{i,q} = (x_{i+q+1} − x_i)/(q + 1) Σ_{j>=i} N_{j,q+1}, repeated, on knots
/// extended at the end; right of it the integral is the Taylor polynomial of its values at the last knot (thesis
/// Alg. 5.2 stops there). times = 0 is the function itself. ∫ N_i over the line is (x_{i+p+1} − x_i)/(p + 1). Requires:
/// 0 <= i < count, times >= 0 (asserted). Cost: O((p + times)²). Accuracy: sums of products of non-negative numbers
/// only, so nothing cancels: relative error below 4 (p + 2 times + 2) ulp.
[[nodiscard]] double basis_integral(const KnotVector& knots, int i, int times, double u);

/// The knots with `before` copies of the first in front and `after` copies of the last behind: the knots of repeated
/// integrals of all basis functions. Not a valid knot vector, as the ends are repeated more than p + 1 times.
[[nodiscard]] std::vector<double> extended_knots(const KnotVector& knots, int before, int after);

}  // namespace knead
