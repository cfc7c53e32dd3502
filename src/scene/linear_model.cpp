#include "linear_model.hpp"

#include "knead/scene/anchors.hpp"

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

}  // namespace

Expected<std::unique_ptr<Model>> linear_model(const Scene& scene, const EvolutionPolicy& evolution) {
  return as_linear_model(make_model(model_input(scene, evolution)));
}

template <int D>
Expected<std::unique_ptr<Model>> linear_model(const Scene& scene, const SceneBody& body,
                                              const EvolutionPolicy& evolution) {
  return as_linear_model(make_body_model<D>(body_input<D>(scene, body, evolution)));
}

template Expected<std::unique_ptr<Model>> linear_model<1>(const Scene&, const SceneBody&, const EvolutionPolicy&);
template Expected<std::unique_ptr<Model>> linear_model<3>(const Scene&, const SceneBody&, const EvolutionPolicy&);

}  // namespace knead
