#pragma once

#include <vector>

#include "knead/base/error.hpp"

namespace knead::examples {

/// The lowest frequencies of a simply supported unit plate, ascending: ω with K x = ω² M x, K of
/// the thin-plate energy (α = 0, β = 1, raw units, thesis Eq. 4.15) and M of unit mass (Eq. 5.41)
/// on a clamped uniform net of `spans` × `spans` spans, the border held. Dense, O(spans^6): 32
/// spans take some seconds. Error: degree below 2, no spans.
[[nodiscard]] Expected<std::vector<double>> plate_frequencies(int degree, int spans, int count);

/// The same of the plate itself: (m² + n²) π² for m, n = 1, 2, …, ascending.
[[nodiscard]] std::vector<double> exact_plate_frequencies(int count);

/// An upper bound of `plate_frequencies` for cubics, also ascending: the frequencies of the smaller
/// space of splines that are odd about the border, in closed form. With a = mπ and the
/// one-dimensional stencils' symbols s(a) of G22 and G11 over that of G00, ω² = s22(a) + 2 s11(a)
/// s11(b) + s22(b).
[[nodiscard]] std::vector<double> bounding_plate_frequencies(int spans, int count);

}  // namespace knead::examples
