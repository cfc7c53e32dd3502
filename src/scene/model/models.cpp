#include <algorithm>

#include "form_model.hpp"
#include "model.hpp"
#include "scene/anchors.hpp"
#include "shell_model.hpp"

namespace knead {
namespace {

Expected<ActiveLoads> loads_on(const SceneModel& made, const Scene& scene,
                               const std::vector<PointForce>& grips) {
  auto loads = active_loads(scene, made);
  if (!loads) return loads;
  loads->points.insert(loads->points.end(), grips.begin(), grips.end());
  auto anchored = anchors(scene, made.model, active_state(scene).control_points);
  if (!anchored) return std::unexpected(anchored.error());
  loads->points.insert(loads->points.end(), anchored->begin(), anchored->end());
  return loads;
}

template <int D>
Expected<ActiveLoads> loads_on(const SceneModelOf<D>& /*made*/, const Scene& scene,
                               const std::vector<PointForce>& /*grips*/) {
  return body_loads<D>(scene);
}

template <int D>
class LinearModel final : public Model {
 public:
  explicit LinearModel(SceneModelOf<D> made) : made_(std::move(made)) {}

  [[nodiscard]] bool serves(const Scene& scene, const EvolutionPolicy& evolution) const override {
    return made_.input == model_input<D>(scene, evolution);
  }
  [[nodiscard]] bool measures(const Scene& scene) const override {
    auto input = model_input<D>(scene, made_.input.evolution);
    input.detail = made_.input.detail;
    return input == made_.input;
  }
  [[nodiscard]] Expected<ActiveLoads> loads(const Scene& scene,
                                            const std::vector<PointForce>& grips) const override {
    return loads_on(made_, scene, grips);
  }
  [[nodiscard]] Expected<ActiveStep> step(const ActiveState& from, std::span<const Tool> tools,
                                          const ActiveLoads& loads, int /*increments*/) override {
    return made_.model.step(from, tools, loads);
  }
  [[nodiscard]] double energy(const ActiveState& of) const override {
    return made_.model.energy(of);
  }
  [[nodiscard]] std::span<const SeamReport> seams() const override { return made_.seams; }
  [[nodiscard]] std::span<const std::string> notes() const override { return made_.notes; }
  [[nodiscard]] Eigen::Index size() const override { return made_.model.rows().back(); }

 private:
  SceneModelOf<D> made_;
};

template <int D>
Expected<std::unique_ptr<Model>> linear_model(const Scene& scene,
                                              const EvolutionPolicy& evolution) {
  auto made = make_model(model_input<D>(scene, evolution));
  if (!made) return std::unexpected(made.error());
  return std::make_unique<LinearModel<D>>(*std::move(made));
}

// A few models are kept, the last one used first: a gesture often alternates between two of them,
// and a model keeps its factor. All but the last one are bounded by the sum of their control
// points, which bounds the memory.
constexpr std::size_t most_models = 3;
constexpr Eigen::Index most_kept_points = 10000;  // of all but the last one

}  // namespace

Expected<std::unique_ptr<Model>> model_of(const Scene& scene, const EvolutionPolicy& evolution) {
  if (has_shells(scene)) return shell_model(scene, evolution);
  if (!scene.body) return linear_model<2>(scene, evolution);
  const auto of_body = [&]<int D>(const SceneShape<D>& shape) {
    return is_nonlinear(shape.elasticity) ? form_model<D>(scene, evolution)
                                          : linear_model<D>(scene, evolution);
  };
  return std::visit(of_body, scene.bodies[static_cast<std::size_t>(*scene.body)]);
}

Expected<Model*> Models::of(const Scene& scene, const EvolutionPolicy& evolution) {
  const auto found =
      std::ranges::find_if(kept_, [&](const auto& m) { return m->serves(scene, evolution); });
  if (found != kept_.end()) {
    std::rotate(kept_.begin(), found, found + 1);
    return kept_.front().get();
  }
  Eigen::Index size = 0;
  std::size_t keep = 0;
  while (keep < kept_.size() && keep + 1 < most_models &&
         (size += kept_[keep]->size()) <= most_kept_points)
    ++keep;
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
