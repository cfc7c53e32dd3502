#include "structural_modes.hpp"

#include "knead/base/error_code.hpp"
#include "model.hpp"
#include "shell_model.hpp"
#include "solve/shell_statics.hpp"

namespace knead {
namespace {

const SceneSurface& selected_surface_of(const Scene& scene) {
  return scene.surfaces[static_cast<std::size_t>(*scene.selected)];
}

}  // namespace

Expected<std::vector<Eigenmode>> natural_modes(const Scene& scene, int count) {
  const SceneSurface& s = selected_surface_of(scene);
  if (is_nonlinear(s.elasticity)) {
    const auto problem = shell_problem(scene);
    if (!problem) return std::unexpected(problem.error());
    const Points& x = problem->present;
    SparseMatrix stiffness = problem->structure.hessian(x);
    for (const EdgeMoment& moment : problem->moments) stiffness -= moment.stiffness(x);
    return vibration_modes(stiffness, on_coordinates(problem->structure.mass()),
                           problem->constraints, count);
  }
  // Modes do not depend on how steps are made; a large lambda gives a model for anything that can
  // be stepped.
  EvolutionPolicy any;
  any.lambda = 1e6;
  const auto made = make_model(model_input(scene, any));
  if (!made) return std::unexpected(made.error());
  return made->model.modes(count);
}

Expected<std::vector<Eigenmode>> linear_buckling(const Scene& scene, int count) {
  const SceneSurface& s = selected_surface_of(scene);
  if (!is_nonlinear(s.elasticity)) {
    return input_error("the linear model does not buckle", "model",
                       R"(give {"do":"material","model":"shell"} with young and thickness)",
                       {ErrorCode::shell_needed});
  }
  const auto problem = shell_problem(scene);
  if (!problem) return std::unexpected(problem.error());
  const Points& rest = problem->rest;
  Points load = problem->load;
  for (const EdgeMoment& moment : problem->moments) load += moment.forces(rest);
  const auto displacement =
      linear_displacement(problem->structure, rest, problem->constraints, load);
  if (!displacement) return std::unexpected(displacement.error());
  if (displacement->isZero(0)) {
    return input_error("nothing loads the shell", "load",
                       "give a load or a force; factors are multiples of it");
  }
  const SparseMatrix stiffness = problem->structure.material_hessian(rest);
  const SparseMatrix geometric =
      problem->structure.hessian(rest, problem->structure.stress(rest, *displacement)) - stiffness;
  auto modes = buckling_modes(stiffness, geometric, problem->constraints, count);
  if (modes && modes->empty()) {
    return input_error("no multiple of the load buckles the shell", "load",
                       "loads that only pull do not");
  }
  return modes;
}

}  // namespace knead
