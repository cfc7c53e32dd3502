#pragma once

#include <optional>
#include <vector>

#include "greville_force.hpp"
#include "knead/contact/active_spline.hpp"
#include "net_operator.hpp"
#include "tool/tool_load.hpp"

namespace knead {

/// The operators and forces, patch by patch; everything in the units of the first patch's scaling.
template <int D>
struct Assembly {
  std::vector<DomainScaling<D>> scalings;
  std::vector<ToolGrids<D>> loads;
  std::vector<GrevilleForce<D>> greville;  // for the analytic route
  NetOperator<D> stretch, bend, stiffness, weight, mass, damping;
  std::optional<double> energy_error;  // of rational patches

  explicit Assembly(int size)
      : stretch(size), bend(size), stiffness(size), weight(size), mass(size), damping(size) {}
};

/// Of all patches, with the forces that the settings ask for. Error: of a patch.
template <int D>
[[nodiscard]] Expected<Assembly<D>> assemble(const std::vector<Spline<D>>& patches,
                                             const ActiveSettings<D>& settings);

/// The operator A of a step (see `ActiveSpline`), of `size` control points.
template <int D>
[[nodiscard]] NetOperator<D> step_operator(const std::vector<Spline<D>>& patches,
                                           const ActiveSettings<D>& settings,
                                           const Assembly<D>& from, int size);

}  // namespace knead
