#pragma once

#include <span>

#include "knead/sculpt/surface_load.hpp"
#include "knead/solve/implicit_euler.hpp"

namespace knead {

/// How the minimisation of one step ended.
struct ContactSummary {
  int iterations = 0;  ///< Newton iterations
  int solves = 0;      ///< back substitutions
  bool converged = false;
  bool finite = true;  ///< false: a number overflowed on the way
};

/// Minimises ½ XᵀKX + λ/2 |X − X₀|²_W + Ψ(X) over the free unknowns, starting from X₀ = `x`, which becomes the minimum.
/// `euler` holds K and K + λW with its factor; `load` and `tools` the potential Ψ of the surface whose control points
/// are `origin` + X. All in normalised units.
[[nodiscard]] ContactSummary minimise_step(const ImplicitEuler& euler, const SurfaceLoad& load,
                                           std::span<const Tool> tools, const Points& origin, Points& x);

}  // namespace knead
