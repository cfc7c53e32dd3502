#include <fmt/format.h>

#include "knead/scene/body_model.hpp"
#include "knead/sculpt/active_form.hpp"
#include "knead/sculpt/loads.hpp"
#include "scene_settings.hpp"
#include "shell_model.hpp"

namespace knead {
namespace {

Expected<void> check_forms(const SceneBody& body, const ActiveLoads& loads) {
  const auto refused = [&](const char* what, const char* field, const char* remedy) {
    return input_error(fmt::format("a {} that keeps its fundamental forms has no {}", kind_of(body), what), field,
                       remedy);
  };
  if (body.mode == RestMode::none) {
    return refused("place without a rest shape", "rest", R"(use {"do":"rest","mode":"shape"})");
  }
  if (loads.gravity != Point::Zero()) return refused("weight", "gravity", "use vector");
  return {};
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
Expected<ActiveStep> settle(const Scene& scene, const SceneBody& body, const BodyShapes<D>& shapes,
                            const FormWeights& weights, const ActiveLoads& loads, const EvolutionPolicy& evolution,
                            std::vector<std::string>& notes) {
  const Points &rest = shapes.rest->control_points(), &present = shapes.current->control_points();
  const auto conditions = body_conditions<D>(body_input<D>(scene, body, evolution), present, notes);
  if (!conditions) return std::unexpected(conditions.error());
  auto energy = FormEnergy<D>::create(*shapes.rest, weights);
  if (!energy) return std::unexpected(energy.error());
  ActiveShellSettings settings{.evolution = evolution.mode,
                               .lambda = evolution.lambda,
                               .time_step = evolution.time_step,
                               .damping = body.mass > 0 ? body.damping / body.mass : 0,
                               .mass = body.mass,
                               .constraints = *conditions,
                               .detail = detail_of(scene.tools),
                               .accuracy = evolution.accuracy};
  const auto model = ActiveForm<D>::create(*shapes.rest, std::move(*energy), std::move(settings));
  if (!model) return std::unexpected(model.error());
  auto forces = dead_forces_on<D>(*shapes.rest, loads);
  if (!forces) return std::unexpected(forces.error());
  auto step =
      model->step(active_state(body), scene.tools, {std::move(*forces), loads.points, loads.limit, loads.original});
  if (step) step->control_points = with_held_bits(std::move(step->control_points), present, rest, *conditions);
  return step;
}

}  // namespace

Expected<ActiveStep> settle_forms(const Scene& scene, int index, const EvolutionPolicy& evolution,
                                  std::vector<std::string>& notes) {
  const SceneBody& body = scene.bodies[static_cast<std::size_t>(index)];
  const auto loads = body_loads(scene, index);
  if (!loads) return std::unexpected(loads.error());
  if (auto fits = check_forms(body, *loads); !fits) return std::unexpected(fits.error());
  return std::visit(
      [&](const auto& shapes) {
        return settle(scene, body, shapes, std::get<FormWeights>(shapes.elasticity), *loads, evolution, notes);
      },
      body.shapes);
}

Expected<double> form_energy_of(const SceneBody& body) {
  return std::visit(
      [&]<int D>(const BodyShapes<D>& shapes) -> Expected<double> {
        const auto energy = FormEnergy<D>::create(*shapes.rest, std::get<FormWeights>(shapes.elasticity));
        if (!energy) return std::unexpected(energy.error());
        return energy->energy(shapes.current->control_points()).sum();
      },
      body.shapes);
}

}  // namespace knead
