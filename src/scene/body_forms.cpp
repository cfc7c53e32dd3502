#include "body_forms.hpp"

#include <fmt/format.h>

#include "knead/sculpt/active_form.hpp"
#include "knead/sculpt/loads.hpp"
#include "shell_model.hpp"

namespace knead {
namespace {

std::unexpected<Error> has_none(const SceneBody& body, const char* what, const char* field, const char* remedy) {
  return input_error(fmt::format("a {} that keeps its fundamental forms has no {}", kind_of(body), what), field,
                     remedy);
}

/// The forces that keep their direction.
template <int D>
Expected<Points> dead_forces_on(const Spline<D>& rest, const ActiveLoads& loads) {
  Points forces = loads.nodal.rows() > 0 ? loads.nodal : Points::Zero(rest.size(), 3);
  if (loads.force == Point::Zero()) return forces;
  const auto spread =
      load_forces<D>(rest, {}, LoadFunction<D>([&](const std::array<double, D>&) { return loads.force; }));
  if (!spread) return std::unexpected(spread.error());
  return forces + *spread;
}

template <int D>
class FormModel final : public Model {
 public:
  static Expected<std::unique_ptr<Model>> create(BodyInput<D> input, const Points& present) {
    std::vector<std::string> notes;
    auto conditions = body_conditions<D>(input, present, notes);
    if (!conditions) return std::unexpected(conditions.error());
    auto energy = FormEnergy<D>::create(*input.rest, std::get<FormWeights>(input.elasticity));
    if (!energy) return std::unexpected(energy.error());
    ActiveShellSettings settings{.evolution = input.evolution.mode,
                                 .lambda = input.evolution.lambda,
                                 .time_step = input.evolution.time_step,
                                 .damping = input.mass > 0 ? input.damping / input.mass : 0,
                                 .mass = input.mass,
                                 .constraints = *conditions,
                                 .detail = input.detail,
                                 .accuracy = input.evolution.accuracy};
    auto model = ActiveForm<D>::create(*input.rest, *energy, std::move(settings));
    if (!model) return std::unexpected(model.error());
    return std::unique_ptr<Model>(new FormModel(std::move(input), *std::move(conditions), *std::move(energy),
                                                *std::move(model), std::move(notes)));
  }

  [[nodiscard]] bool serves(const Scene& scene, const EvolutionPolicy& evolution) const override {
    const SceneBody* body = selected_body<D>(scene);
    if (body == nullptr || !(input_ == body_input<D>(scene, *body, evolution))) return false;
    std::vector<std::string> notes;
    const auto conditions = body_conditions<D>(input_, control_points_of(*body), notes);
    return conditions && *conditions == conditions_;
  }
  [[nodiscard]] bool measures(const Scene& scene) const override {
    const SceneBody* body = selected_body<D>(scene);
    if (body == nullptr) return false;
    const auto& shapes = std::get<BodyShapes<D>>(body->shapes);
    return shapes.rest == input_.rest && shapes.elasticity == input_.elasticity;
  }
  [[nodiscard]] Expected<ActiveLoads> loads(const Scene& scene,
                                            const std::vector<PointForce>& /*grips*/) const override {
    auto loads = body_loads(scene, *scene.body);
    if (!loads) return loads;
    if (loads->gravity != Point::Zero()) {
      return has_none(scene.bodies[static_cast<std::size_t>(*scene.body)], "weight", "gravity", "use vector");
    }
    auto forces = dead_forces_on<D>(*input_.rest, *loads);
    if (!forces) return std::unexpected(forces.error());
    loads->nodal = *std::move(forces);
    loads->force = Point::Zero();
    return loads;
  }
  [[nodiscard]] Expected<ActiveStep> step(const ActiveState& from, std::span<const Tool> tools,
                                          const ActiveLoads& loads, int /*increments*/) override {
    auto step = model_.step(from, tools, loads);
    if (!step) return step;
    step->control_points = with_held_bits(std::move(step->control_points), from.control_points,
                                          input_.rest->control_points(), conditions_);
    return step;
  }
  [[nodiscard]] double energy(const ActiveState& of) const override { return energy_.energy(of.control_points).sum(); }
  [[nodiscard]] std::span<const std::string> notes() const override { return notes_; }
  [[nodiscard]] Eigen::Index size() const override { return input_.rest->size(); }

 private:
  FormModel(BodyInput<D> input, std::vector<LinearConstraint> conditions, FormEnergy<D> energy, ActiveForm<D> model,
            std::vector<std::string> notes)
      : input_(std::move(input)),
        conditions_(std::move(conditions)),
        energy_(std::move(energy)),
        model_(std::move(model)),
        notes_(std::move(notes)) {}

  BodyInput<D> input_;
  std::vector<LinearConstraint> conditions_;  // at the places of the first step
  FormEnergy<D> energy_;
  ActiveForm<D> model_;
  std::vector<std::string> notes_;
};

}  // namespace

template <int D>
Expected<std::unique_ptr<Model>> form_model(const Scene& scene, const SceneBody& body,
                                            const EvolutionPolicy& evolution) {
  if (body.mode == RestMode::none) {
    return has_none(body, "place without a rest shape", "rest", R"(use {"do":"rest","mode":"shape"})");
  }
  return FormModel<D>::create(body_input<D>(scene, body, evolution), control_points_of(body));
}

template Expected<std::unique_ptr<Model>> form_model<1>(const Scene&, const SceneBody&, const EvolutionPolicy&);
template Expected<std::unique_ptr<Model>> form_model<3>(const Scene&, const SceneBody&, const EvolutionPolicy&);

}  // namespace knead
