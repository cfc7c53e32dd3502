#include "shell_model.hpp"

#include <algorithm>
#include <cmath>

#include "constraints.hpp"
#include "dead_loads.hpp"
#include "knead/sculpt/loads.hpp"

namespace knead {
namespace {

Expected<void> check_scope(const Scene& scene, const SceneSurface& s) {
  if (!scene.together.empty()) {
    return input_error("shells are not coupled along seams", "select", "select one surface alone");
  }
  if (!scene.tools.empty()) {
    return input_error("a shell has no contact with tools", "tool",
                       R"(remove them, or use {"do":"material","model":"linear"})");
  }
  if (scene.limit) return input_error("a shell has no limit", "limit", R"(end it: {"do":"limit"})");
  if (s.mode == RestMode::none)
    return input_error("a shell needs a rest shape", "rest", R"(use {"do":"rest","mode":"shape"})");
  const Load& load = scene.load;
  if (load.pressure != 0 || load.wind != Vector3{0, 0, 0} || load.varies()) {
    return input_error("on a shell only loads act that are constant and keep their direction", "load",
                       "use vector and gravity, and leave out pressure, wind, samples and formulas");
  }
  for (const SceneForce& f : scene.forces) {
    if (!keeps_direction(f.kind) && f.kind != PointForceKind::moment) {
      return input_error("springs and volcanoes do not act on shells", f.name, "use kind dead, line or moment");
    }
  }
  return {};
}

/// Control points that do not move, as conditions.
void append_held(const ConstraintList& list, const Points& displacement, std::vector<LinearConstraint>& to) {
  for (std::size_t k = 0; k < list.held.size(); ++k) {
    if (!list.held[k]) continue;
    const int row = static_cast<int>(k);
    to.push_back({list.held_by[k], {{row, 1.0}}, displacement.row(row).transpose()});
  }
}

Expected<Points> load_on(const Scene& scene, const SceneSurface& s, const ShellEnergy& shell) {
  const Point vector(scene.load.vector.data()), gravity(scene.load.gravity.data());
  Points load = shell.area_load(shell.mass_per_area() * gravity);
  if (scene.load.per.value_or(LoadMeasure::area) == LoadMeasure::area) {
    load += shell.area_load(vector);
  } else {
    const auto forces = load_forces<2>(*s.rest, {}, [&](const std::array<double, 2>&) { return vector; });
    if (!forces) return std::unexpected(forces.error());
    load += *forces;
  }
  for (const SceneForce& f : scene.forces) {
    if (f.surface != *scene.selected || f.kind == PointForceKind::moment) continue;
    const auto forces = dead_forces(s, f, 1);
    if (!forces) return std::unexpected(forces.error());
    load += *forces;
  }
  return load;
}

Expected<std::vector<EdgeMoment>> moments_on(const Scene& scene, const SceneSurface& s) {
  std::vector<EdgeMoment> moments;
  for (const SceneForce& f : scene.forces) {
    if (f.surface != *scene.selected || f.kind != PointForceKind::moment) continue;
    if (std::ranges::any_of(s.constraints, [](const KeptConstraint& kept) {
          return std::holds_alternative<MirrorSymmetry>(kept.constraint);
        })) {
      return input_error("a moment has no mirror image", f.name,
                         "sculpt one half, with a symmetry of its edge, or release the mirror");
    }
    for (const SurfaceEdge edge : edges_of(*f.edge)) {
      auto moment = EdgeMoment::create(*s.rest, edge_across(edge), edge_at_end(edge), *f.moment);
      if (!moment) return std::unexpected(moment.error());
      moments.push_back(std::move(*moment));
    }
  }
  return moments;
}

}  // namespace

Expected<ShellProblem> shell_problem(const Scene& scene) {
  const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(*scene.selected)];
  if (auto within = check_scope(scene, s); !within) return std::unexpected(within.error());
  auto shell = s.shell ? ShellEnergy::create(*s.rest, *s.shell) : ShellEnergy::of_forms(*s.rest, *s.fundamental);
  if (!shell) return std::unexpected(shell.error());
  ShellProblem problem{std::move(*shell), {}, {}, {}, {}};
  SurfaceInput input = model_input(scene, scene.evolution).surfaces.front();
  input.rest = s.rest;
  auto list = constraints_of(input, problem.notes);
  if (!list) return std::unexpected(list.error());
  append_held(*list, s.current->control_points() - s.rest->control_points(), problem.constraints);
  problem.constraints.insert(problem.constraints.end(), list->constraints.begin(), list->constraints.end());
  auto load = load_on(scene, s, problem.energy);
  if (!load) return std::unexpected(load.error());
  problem.load = std::move(*load);
  auto moments = moments_on(scene, s);
  if (!moments) return std::unexpected(moments.error());
  problem.moments = std::move(*moments);
  return problem;
}

Points with_held_bits(const ShellProblem& problem, const Points& rest, const Points& present, Points solved) {
  constexpr double rounding = 1e-15;
  for (const LinearConstraint& c : problem.constraints) {
    if (c.terms.size() != 1) continue;
    const Eigen::Index row = c.terms.front().first;
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (c.normal && (*c.normal)[k] == 0) continue;
      double& x = solved(row, k);
      if (std::abs(x - present(row, k)) <= rounding * (std::abs(x) + std::abs(rest(row, k)))) x = present(row, k);
    }
  }
  return solved;
}

}  // namespace knead
