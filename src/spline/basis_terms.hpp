#pragma once

#include <utility>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead {

/// R_i(u) of all control points that affect the place u, as (row, value), rows counted from
/// `first`: S(u) = Σ R_i P_i, R_i = w_i N_i / Σ w N. At a knot the functions of one side are taken,
/// at the ends of the domain those inside. Requires: u in the domain (asserted). Cost: O((p +
/// 1)^D). A denominator that is 0 gives values that are not finite.
template <int D>
[[nodiscard]] std::vector<std::pair<int, double>> basis_terms(const Spline<D>& spline,
                                                              const std::array<double, D>& u,
                                                              int first = 0,
                                                              Side side = Side::right);

}  // namespace knead
