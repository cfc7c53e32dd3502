#include "form_model.hpp"

#include <fmt/format.h>

#include "contact/active_form.hpp"
#include "joined_shapes.hpp"
#include "knead/base/error_code.hpp"
#include "knead/energy/loads.hpp"
#include "shell_model.hpp"

namespace knead {
namespace {

template <int D>
std::unexpected<Error> has_none(const char* what, const char* field, const char* remedy) {
  return input_error(
      fmt::format("a {} that keeps its fundamental forms has no {}", kind_of(D), what), field,
      remedy);
}

/// What holds the shape at this place.
template <int D>
Expected<std::vector<LinearConstraint>> conditions_at(const ModelInputOf<D>& input,
                                                      const Points& present,
                                                      std::vector<std::string>& notes) {
  auto joined = join_shapes(input);
  if (!joined) return std::unexpected(joined.error());
  notes = std::move(joined->notes);
  return conditions_of(*joined, present - input.shapes.front().rest->control_points());
}

/// The forces that keep their direction.
template <int D>
Expected<Points> dead_forces_on(const Spline<D>& rest, const ActiveLoads& loads) {
  Points forces = loads.nodal.rows() > 0 ? loads.nodal : Points::Zero(rest.size(), 3);
  if (loads.force == Point::Zero()) return forces;
  const auto spread = load_forces<D>(
      rest, {}, LoadFunction<D>([&](const std::array<double, D>&) { return loads.force; }));
  if (!spread) return std::unexpected(spread.error());
  return forces + *spread;
}

// Curves that keep their metric and curvature, volumes that keep their metric. The energy is that
// of the shape, not of a displacement field, so that rotations are free of it; the price is a
// nonlinear problem in each step, and conditions that are measured from the present place.
template <int D>
class FormModel final : public Model {
 public:
  static Expected<std::unique_ptr<Model>> create(ModelInputOf<D> input, const Points& present) {
    std::vector<std::string> notes;
    const ShapeInput<D>& shape = input.shapes.front();
    auto conditions = conditions_at(input, present, notes);
    if (!conditions) return std::unexpected(conditions.error());
    auto energy = FormEnergy<D>::create(*shape.rest, std::get<FormWeights>(shape.elasticity));
    if (!energy) return std::unexpected(energy.error());
    const double mass = std::get<double>(shape.material.mass),
                 damping = std::get<double>(shape.material.damping);
    ActiveShellSettings settings{.evolution = input.evolution.mode,
                                 .lambda = input.evolution.lambda,
                                 .time_step = input.evolution.time_step,
                                 .damping = mass > 0 ? damping / mass : 0,
                                 .mass = mass,
                                 .constraints = *conditions,
                                 .detail = input.detail,
                                 .accuracy = input.evolution.accuracy};
    auto model = ActiveForm<D>::create(*shape.rest, *energy, std::move(settings));
    if (!model) return std::unexpected(model.error());
    return std::unique_ptr<Model>(new FormModel(std::move(input), *std::move(conditions),
                                                *std::move(energy), *std::move(model),
                                                std::move(notes)));
  }

  // Conditions contain places and can change where nothing in the input does; comparing them is
  // cheap against a model, whose structure and ordering are made anew otherwise.
  [[nodiscard]] bool serves(const Scene& scene, const EvolutionPolicy& evolution) const override {
    if (!(input_ == model_input<D>(scene, evolution))) return false;
    std::vector<std::string> notes;
    const auto conditions = conditions_at(input_, active_state(scene).control_points, notes);
    return conditions && *conditions == conditions_;
  }
  [[nodiscard]] bool measures(const Scene& scene) const override {
    const auto shapes = selected_shapes<D>(scene);
    return !shapes.empty() && shapes.front()->rest == shape().rest &&
           shapes.front()->elasticity == shape().elasticity;
  }
  [[nodiscard]] Expected<ActiveLoads> loads(
      const Scene& scene, const std::vector<PointForce>& /*grips*/) const override {
    auto loads = body_loads<D>(scene);
    if (!loads) return loads;
    if (loads->gravity != Point::Zero()) return has_none<D>("weight", "gravity", "use vector");
    auto forces = dead_forces_on<D>(*shape().rest, *loads);
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
                                          shape().rest->control_points(), conditions_);
    return step;
  }
  [[nodiscard]] double energy(const ActiveState& of) const override {
    return energy_.energy(of.control_points).sum();
  }
  [[nodiscard]] std::span<const std::string> notes() const override { return notes_; }
  [[nodiscard]] Eigen::Index size() const override { return shape().rest->size(); }

 private:
  [[nodiscard]] const ShapeInput<D>& shape() const { return input_.shapes.front(); }

  FormModel(ModelInputOf<D> input, std::vector<LinearConstraint> conditions, FormEnergy<D> energy,
            ActiveForm<D> model, std::vector<std::string> notes)
      : input_(std::move(input)),
        conditions_(std::move(conditions)),
        energy_(std::move(energy)),
        model_(std::move(model)),
        notes_(std::move(notes)) {}

  ModelInputOf<D> input_;
  std::vector<LinearConstraint> conditions_;  // at the places of the first step
  FormEnergy<D> energy_;
  ActiveForm<D> model_;
  std::vector<std::string> notes_;
};

}  // namespace

template <int D>
Expected<std::unique_ptr<Model>> form_model(const Scene& scene, const EvolutionPolicy& evolution) {
  const SceneShape<D>& shape = *selected_shapes<D>(scene).front();
  if (shape.mode == RestMode::none) {
    auto refused =
        has_none<D>("place without a rest shape", "rest", R"(use {"do":"rest","mode":"shape"})");
    return std::unexpected(std::move(refused.error()).with({ErrorCode::rest_shape_needed}));
  }
  return FormModel<D>::create(model_input<D>(scene, evolution), shape.current->control_points());
}

template Expected<std::unique_ptr<Model>> form_model<1>(const Scene&, const EvolutionPolicy&);
template Expected<std::unique_ptr<Model>> form_model<3>(const Scene&, const EvolutionPolicy&);

}  // namespace knead
