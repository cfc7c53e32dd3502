#include <algorithm>

#include "body_forms.hpp"
#include "knead/scene/body_model.hpp"
#include "knead/scene/model.hpp"
#include "linear_model.hpp"
#include "shell_model.hpp"

namespace knead {
namespace {

constexpr std::size_t most_models = 3;
constexpr Eigen::Index most_kept_points = 40000;  // of all but the last one

template <int D>
Expected<std::unique_ptr<Model>> model_of_body(const Scene& scene, const SceneBody& body, const BodyShapes<D>& shapes,
                                               const EvolutionPolicy& evolution) {
  return is_nonlinear(shapes.elasticity) ? form_model<D>(scene, body, evolution)
                                         : linear_model<D>(scene, body, evolution);
}

}  // namespace

Expected<std::unique_ptr<Model>> model_of(const Scene& scene, const EvolutionPolicy& evolution) {
  if (!scene.body) return has_shells(scene) ? shell_model(scene, evolution) : linear_model(scene, evolution);
  const SceneBody& body = scene.bodies[static_cast<std::size_t>(*scene.body)];
  return std::visit([&](const auto& shapes) { return model_of_body(scene, body, shapes, evolution); }, body.shapes);
}

Expected<Model*> Models::of(const Scene& scene, const EvolutionPolicy& evolution) {
  const auto found = std::ranges::find_if(kept_, [&](const auto& m) { return m->serves(scene, evolution); });
  if (found != kept_.end()) {
    std::rotate(kept_.begin(), found, found + 1);
    return kept_.front().get();
  }
  Eigen::Index size = 0;
  std::size_t keep = 0;
  while (keep < kept_.size() && keep + 1 < most_models && (size += kept_[keep]->size()) <= most_kept_points) ++keep;
  kept_.resize(keep);  // before another one needs the memory
  auto made = model_of(scene, evolution);
  if (!made) return std::unexpected(made.error());
  kept_.insert(kept_.begin(), *std::move(made));
  return kept_.front().get();
}

const Model* Models::measuring(const Scene& scene) const {
  const auto found = std::ranges::find_if(kept_, [&](const auto& m) { return m->measures(scene); });
  return found != kept_.end() ? found->get() : nullptr;
}

}  // namespace knead
