#pragma once

#include <array>

#include "knead/base/error.hpp"

namespace knead {

/// The constants of the stretch and bend energy of a surface (thesis Eq. 4.8), in the order 11, 12, 22:
///
///   E(S) = ∫ α11|S_u|² + 2α12 S_u·S_v + α22|S_v|² + β11|S_uu|² + 2β12|S_uv|² + β22|S_vv|² du dv.
///
/// α resists stretch, β resists bending. Units: those of the equation; see `DomainScaling` for the normalised ones.
struct Material {
  std::array<double, 3> alpha = {1, 0, 1};
  std::array<double, 3> beta = {0.01, 0.01, 0.01};

  friend bool operator==(const Material&, const Material&) = default;
};

/// Accepts exactly the materials whose energy is convex: all finite, α11 >= 0, α22 >= 0, α11 α22 >= α12², every β >= 0.
/// The error names the coefficient.
[[nodiscard]] Expected<Material> validated(const Material& material);

}  // namespace knead
