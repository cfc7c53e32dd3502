#include <algorithm>

#include "body_forms.hpp"
#include "knead/scene/anchors.hpp"
#include "knead/scene/model.hpp"
#include "shell_model.hpp"

namespace knead {
namespace {

std::optional<ModelInput> input_like(const ModelInput& /*of*/, const Scene& scene, const EvolutionPolicy& evolution) {
  return model_input(scene, evolution);
}

/// None where what is selected is of another kind.
template <int D>
std::optional<BodyInput<D>> input_like(const BodyInput<D>& /*of*/, const Scene& scene,
                                       const EvolutionPolicy& evolution) {
  const SceneBody* body = selected_body<D>(scene);
  if (body == nullptr) return std::nullopt;
  return body_input<D>(scene, *body, evolution);
}

Expected<ActiveLoads> loads_on(const SceneModel& made, const Scene& scene, const std::vector<PointForce>& grips) {
  auto loads = active_loads(scene, made);
  if (!loads) return loads;
  loads->points.insert(loads->points.end(), grips.begin(), grips.end());
  auto anchored = anchors(scene, made.model, active_state(scene).control_points);
  if (!anchored) return std::unexpected(anchored.error());
  loads->points.insert(loads->points.end(), anchored->begin(), anchored->end());
  return loads;
}

template <int D>
Expected<ActiveLoads> loads_on(const BodyModel<D>& /*made*/, const Scene& scene,
                               const std::vector<PointForce>& /*grips*/) {
  return body_loads(scene, *scene.body);
}

/// \tparam Made `SceneModel` or `BodyModel`.
template <class Made>
class LinearModel final : public Model {
 public:
  explicit LinearModel(Made made) : made_(std::move(made)) {}

  [[nodiscard]] bool serves(const Scene& scene, const EvolutionPolicy& evolution) const override {
    return made_.input == input_like(made_.input, scene, evolution);
  }
  [[nodiscard]] bool measures(const Scene& scene) const override {
    auto input = input_like(made_.input, scene, made_.input.evolution);
    if (!input) return false;
    input->detail = made_.input.detail;
    return *input == made_.input;
  }
  [[nodiscard]] Expected<ActiveLoads> loads(const Scene& scene, const std::vector<PointForce>& grips) const override {
    return loads_on(made_, scene, grips);
  }
  [[nodiscard]] Expected<ActiveStep> step(const ActiveState& from, std::span<const Tool> tools,
                                          const ActiveLoads& loads, int /*increments*/) override {
    return made_.model.step(from, tools, loads);
  }
  [[nodiscard]] double energy(const ActiveState& of) const override { return made_.model.energy(of); }
  [[nodiscard]] std::span<const SeamReport> seams() const override {
    if constexpr (requires { made_.seams; }) return made_.seams;
    return {};
  }
  [[nodiscard]] std::span<const std::string> notes() const override { return made_.notes; }
  [[nodiscard]] Eigen::Index size() const override { return made_.model.rows().back(); }

 private:
  Made made_;
};

template <class Made>
Expected<std::unique_ptr<Model>> as_linear_model(Expected<Made> made) {
  if (!made) return std::unexpected(made.error());
  return std::make_unique<LinearModel<Made>>(*std::move(made));
}

constexpr std::size_t most_models = 3;
constexpr Eigen::Index most_kept_points = 10000;  // of all but the last one

template <int D>
Expected<std::unique_ptr<Model>> model_of_body(const Scene& scene, const SceneBody& body, const BodyShapes<D>& shapes,
                                               const EvolutionPolicy& evolution) {
  if (is_nonlinear(shapes.elasticity)) return form_model<D>(scene, body, evolution);
  return as_linear_model(make_body_model<D>(body_input<D>(scene, body, evolution)));
}

}  // namespace

Expected<std::unique_ptr<Model>> model_of(const Scene& scene, const EvolutionPolicy& evolution) {
  if (has_shells(scene)) return shell_model(scene, evolution);
  if (!scene.body) return as_linear_model(make_model(model_input(scene, evolution)));
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
