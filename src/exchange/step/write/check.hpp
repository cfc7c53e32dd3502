#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>

#include "exchange/step/data.hpp"
#include "knead/spline/spline.hpp"
#include "surgeon.hpp"

namespace knead::step {

/// Equal to the last bit.
template <int D>
[[nodiscard]] bool same_spline(const Spline<D>& a, const Spline<D>& b) {
  return a.knots() == b.knots() && same_bits(a.control_points(), b.control_points()) &&
         same_bits(a.weights(), b.weights());
}

/// By their index in the file; what is left out stays.
using WantedSurfaces = std::unordered_map<std::size_t, const Surface*>;
using WantedCurves = std::unordered_map<std::size_t, const Curve*>;

/// The bytes, once they have been read again: the whole file as an exchange structure without names
/// given twice, and every surface and free curve as wanted, or as before, bit for bit. Errors
/// (numerical): something is not. Memory: the names of the entities, 16 bytes each, and some of the
/// geometry at a time.
[[nodiscard]] Expected<std::string> checked(std::string bytes, const File::Data& before,
                                            const WantedSurfaces& surfaces,
                                            const WantedCurves& curves);

}  // namespace knead::step
