#pragma once

#include "knead/spline/spline.hpp"

namespace knead::detail {

/// ∫ R_i f du for a rational shape and a polynomial load f on the same domain, one row per control
/// point: to 1e-10 of max |f| ∫ R_i, by the Gauss rules that a bound asks for (`RationalRule`),
/// spans cut at the knots of the load. Errors (numerical): a denominator that is not positive,
/// weights that differ too much.
template <int D>
[[nodiscard]] Expected<Points> rational_load(const Spline<D>& shape, const Spline<D>& load);

}  // namespace knead::detail
