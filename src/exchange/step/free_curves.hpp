#pragma once

#include <cstdint>
#include <vector>

#include "entity.hpp"
#include "knead/spline/spline.hpp"

namespace knead::step {

/// A curve that stands for itself, with the values that refer to its control points, in order.
struct ReadCurve {
  std::uint32_t instance;
  Curve curve;
  std::vector<std::uint32_t> references;
};

/// One that cannot be read.
struct UnreadableCurve {
  std::uint32_t instance;
  Error reason;
};

/// The free B-spline curves of a file, in its order: those in space that only representations, sets
/// of geometry, styles and layers refer to, and at least one of them. Curves of edges, of surfaces,
/// trimmed ones and those of parameters are not. Curves that cannot be read are left out, and added
/// to `unreadable` if that is given. Cost: linear in the size of the file.
[[nodiscard]] std::vector<ReadCurve> free_curves(
    const Reader& reader, std::vector<UnreadableCurve>* unreadable = nullptr);

/// Whether an instance is a B-spline curve in any of its forms.
[[nodiscard]] bool is_b_spline_curve(const Reader& reader, std::uint32_t instance);

}  // namespace knead::step
