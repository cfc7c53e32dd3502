#pragma once

#include <span>
#include <utility>

#include "knead/energy/shell_energy.hpp"
#include "knead/exchange/numerical_files.hpp"
#include "scene.hpp"

namespace knead {

/// The results of a shell at one of its points; none of a surface that is no shell. Errors: a place
/// outside the domain.
[[nodiscard]] Expected<std::optional<ShellPointResults>> read_shell(const Scene& scene, int surface,
                                                                    const Fractions& at);

/// What one hold exerts on the selected shell.
struct HoldReaction {
  std::string hold;  ///< as messages name it: "edge u0"
  Point force = Point::Zero();
};

/// The reactions of all holds in the present state: internal forces less loads, ∂W/∂x − f, summed
/// over the control points that a hold names. A control point of several holds is counted to the
/// first one alone. In equilibrium all reactions and all loads sum to zero. Errors: those of a
/// static step of a shell.
[[nodiscard]] Expected<std::vector<HoldReaction>> hold_reactions(const Scene& scene);

/// A surface on `samples` × `samples` points, uniform in its parameters: its present points with
/// the fields `displacement` (from the rest shape), of shells `membrane`, `moment`, `von_mises` (as
/// in `ShellPointResults`) and `bending_strain`, and each of `shapes`: fields of displacements with
/// its control points, N × 3. Errors: fewer than 2 samples (input), those of `shell_results`.
[[nodiscard]] Expected<FieldGrid> result_grid(
    const SceneSurface& surface, int samples,
    std::span<const std::pair<std::string, Points>> shapes = {});

}  // namespace knead
