#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "entity.hpp"
#include "knead/spline/knot_vector.hpp"

namespace knead::step {

/// The knots implied by an entity without a knot list (ISO 10303-42, default_b_spline_knots and
/// default_b_spline_knot_mult): spaced by 1, beginning
///   uniform:       at -p, each once (n + p + 1 knots, unclamped, domain [0, n - p]);
///   quasi-uniform: at 0, p + 1 times at the ends, once inside;
///   Bézier:        at 0, p + 1 times at the ends, p times inside (n - 1 a multiple of p).
enum class ImpliedKnots { uniform, quasi_uniform, bezier };

/// The implied knots of degree p for n control points.
[[nodiscard]] Expected<KnotVector> implied_knots(ImpliedKnots form, int degree, int count);

/// Knots listed as multiplicities and values, each as often as it counts, `count` + `degree` + 1 of
/// them. \param direction for errors: "u", "v", or "" on a curve.
[[nodiscard]] Expected<std::vector<double>> read_knot_list(const Reader& reader,
                                                           std::uint32_t instance, int degree,
                                                           int count, std::uint32_t multiplicities,
                                                           std::uint32_t values,
                                                           const std::string& direction);

/// Such a list as a knot vector; parameters as above.
[[nodiscard]] Expected<KnotVector> knots_of_list(const Reader& reader, std::uint32_t instance,
                                                 int degree, std::vector<double> list,
                                                 const std::string& direction);

/// Both. Equal neighbouring values are accepted and their multiplicities add up.
[[nodiscard]] Expected<KnotVector> read_knots(const Reader& reader, std::uint32_t instance,
                                              int degree, int count, std::uint32_t multiplicities,
                                              std::uint32_t values, const std::string& direction);

}  // namespace knead::step
