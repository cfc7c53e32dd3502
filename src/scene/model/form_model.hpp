#pragma once

#include "model.hpp"

namespace knead {

/// The model of the selected curve or volume, which keeps its fundamental forms, its mass and
/// damping those of the linear one. Errors (input): no rest shape, constraints that contradict each
/// other; those of `FormEnergy::create` and `ActiveForm`.
template <int D>
[[nodiscard]] Expected<std::unique_ptr<Model>> form_model(const Scene& scene,
                                                          const EvolutionPolicy& evolution);

}  // namespace knead
