#pragma once

#include "knead/scene/body_model.hpp"
#include "knead/scene/model.hpp"

namespace knead {

// The models that resist linearly: `ActiveSpline`.

/// Of the selected surfaces, whatever their elasticity is. Errors: those of `make_model`.
[[nodiscard]] Expected<std::unique_ptr<Model>> linear_model(const Scene& scene, const EvolutionPolicy& evolution);

/// Of a body. Errors: those of `make_body_model`.
template <int D>
[[nodiscard]] Expected<std::unique_ptr<Model>> linear_model(const Scene& scene, const SceneBody& body,
                                                            const EvolutionPolicy& evolution);

}  // namespace knead
