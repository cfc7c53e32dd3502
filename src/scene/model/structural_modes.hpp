#pragma once

#include "knead/solve/eigenmodes.hpp"
#include "scene/scene.hpp"

namespace knead {

/// Free vibrations of the selected surfaces about their present shape, on all that their holds
/// leave free: λ are the squares of angular frequencies. A shell has the tangent stiffness of its
/// present state and the mass density · thickness, in units of the file; the linear model those of
/// its dynamic steps, in the units it is computed in. Errors: those of `shell_problem`,
/// `make_model` and `vibration_modes`.
[[nodiscard]] Expected<std::vector<Eigenmode>> natural_modes(const Scene& scene, int count);

/// The factors of the present loads, and of what holds are moved by, at which the selected shell
/// buckles from its rest shape: the stresses of the geometric stiffness are those of the linear
/// solution. Errors (input): the model is linear; nothing loads it; no factor > 0 was found; and
/// those of `shell_problem` and `buckling_modes`.
[[nodiscard]] Expected<std::vector<Eigenmode>> linear_buckling(const Scene& scene, int count);

}  // namespace knead
