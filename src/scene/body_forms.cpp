#include <fmt/format.h>

#include "knead/scene/body_model.hpp"
#include "knead/sculpt/loads.hpp"
#include "knead/solve/form_statics.hpp"
#include "shell_model.hpp"

namespace knead {
namespace {

Expected<void> check_forms(const Scene& scene, const SceneBody& body, const EvolutionPolicy& evolution,
                           const ActiveLoads& loads) {
  const auto refused = [&](const char* what, const char* field, const char* remedy) {
    return input_error(fmt::format("a {} that keeps its fundamental forms has no {}", kind_of(body), what), field,
                       remedy);
  };
  if (evolution.mode != Evolution::stationary) {
    return refused("steps but static ones", "mode", R"(use {"do":"evolve","mode":"static"})");
  }
  if (body.mode == RestMode::none)
    return refused("place without a rest shape", "rest", R"(use {"do":"rest","mode":"shape"})");
  if (!scene.tools.empty()) {
    return refused("tools", "tool", R"(remove them, or use {"do":"material","model":"linear"})");
  }
  if (!loads.points.empty()) return refused("springs and volcanoes", "force", R"(use "kind":"dead")");
  if (loads.gravity != Point::Zero()) return refused("mass", "gravity", "use vector");
  if (scene.limit) return refused("limit", "limit", R"(end it: {"do":"limit"})");
  return {};
}

template <int D>
Expected<ActiveStep> settle(const Scene& scene, const SceneBody& body, const BodyShapes<D>& shapes,
                            const ActiveLoads& loads, const EvolutionPolicy& evolution,
                            std::vector<std::string>& notes) {
  const Points &rest = shapes.rest->control_points(), &present = shapes.current->control_points();
  const auto conditions = body_conditions<D>(body_input<D>(scene, body, evolution), present, notes);
  if (!conditions) return std::unexpected(conditions.error());
  const auto energy = FormEnergy<D>::create(*shapes.rest, *body.fundamental);
  if (!energy) return std::unexpected(energy.error());
  Points forces = loads.nodal.rows() > 0 ? loads.nodal : Points::Zero(rest.rows(), 3);
  if (loads.force != Point::Zero()) {
    const auto spread =
        load_forces<D>(*shapes.rest, {}, LoadFunction<D>([&](const std::array<double, D>&) { return loads.force; }));
    if (!spread) return std::unexpected(spread.error());
    forces += *spread;
  }
  auto found = form_equilibrium<D>(*energy, rest, present, *conditions, forces);
  if (!found) return std::unexpected(found.error());
  ActiveStep step;
  step.control_points = with_held_bits(std::move(found->control_points), present, rest, *conditions);
  const ShellParts parts = energy->energy(step.control_points);
  step.stretch = parts.membrane;
  step.bend = parts.bending;
  step.energy = parts.sum();
  step.residual = found->residual;
  step.iterations = found->iterations;
  step.converged = found->converged;
  step.note = found->note;
  return step;
}

}  // namespace

Expected<ActiveStep> settle_forms(const Scene& scene, int index, const EvolutionPolicy& evolution,
                                  std::vector<std::string>& notes) {
  const SceneBody& body = scene.bodies[static_cast<std::size_t>(index)];
  const auto loads = body_loads(scene, index);
  if (!loads) return std::unexpected(loads.error());
  if (auto fits = check_forms(scene, body, evolution, *loads); !fits) return std::unexpected(fits.error());
  return std::visit([&](const auto& shapes) { return settle(scene, body, shapes, *loads, evolution, notes); },
                    body.shapes);
}

Expected<double> form_energy_of(const SceneBody& body) {
  return std::visit(
      [&]<int D>(const BodyShapes<D>& shapes) -> Expected<double> {
        const auto energy = FormEnergy<D>::create(*shapes.rest, *body.fundamental);
        if (!energy) return std::unexpected(energy.error());
        return energy->energy(shapes.current->control_points()).sum();
      },
      body.shapes);
}

}  // namespace knead
