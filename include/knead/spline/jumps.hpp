#pragma once

#include <vector>

#include "knead/spline/knot_vector.hpp"

namespace knead {

/// Where a basis function is not smooth: all derivatives that jump at one knot of its support.
struct KnotJumps {
  double knot = 0;
  /// How often the knot occurs among x_i … x_{i+p+1}, the knots of the function: 1 … p + 1.
  int multiplicity = 0;
  /// Jumps, right limit minus left limit, of N_i^(r) for r = p − multiplicity + 1 … p. Lower derivatives are
  /// continuous.
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

/// The jumps of every derivative of N_i at every knot of its support, ascending, with N_i on the whole line.
///
/// From the divided difference N_i(u) = (x_{i+p+1} − x_i) [x_i, …, x_{i+p+1}] (· − u)₊^p: with Q(x) = Π (x − x_l) over
/// the knots other than ξ and m the multiplicity of ξ,
///   [N_i^(r)]_ξ = (−1)^(r+1) p!/t! (x_{i+p+1} − x_i) e_{m−1−t},   t = p − r,   1/Q(ξ + h) = Σ e_k h^k.
/// At a simple knot this is the single jump of order p, the weight of the Dirac impulse in the derivative of order p +
/// 1 (thesis § 5.4.1); at a knot of multiplicity m the (p + 1)th derivative also holds derivatives of impulses,
/// N_i^(p+1) = Σ_ξ Σ_r [N_i^(r)]_ξ δ_ξ^(p−r). Requires: 0 <= i < count (asserted). Cost: O(p²) per knot. Accuracy: the
/// jump of the lowest order at a knot is a product, relative error below 2 (p + 3) ulp (so all jumps at simple knots);
/// those above it are sums that can cancel where there are knots on both sides.
[[nodiscard]] std::vector<KnotJumps> derivative_jumps(const KnotVector& knots, int i);

}  // namespace knead
