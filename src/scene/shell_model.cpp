#include "shell_model.hpp"

#include <algorithm>
#include <cmath>

#include "constraints.hpp"
#include "dead_loads.hpp"
#include "knead/sculpt/loads.hpp"

namespace knead {
namespace {

Expected<void> check_scope(const SceneSurface& s) {
  if (!is_nonlinear(s.elasticity)) {
    return input_error("it is no shell, but is selected with shells", s.id, "give all of them the same kind of model");
  }
  if (s.mode == RestMode::none)
    return input_error("a shell needs a rest shape", "rest", R"(use {"do":"rest","mode":"shape"})");
  return {};
}

/// Control points that do not move, as conditions.
void append_held(const JoinedSurfaces& joined, const Points& displacement, std::vector<LinearConstraint>& to) {
  for (std::size_t k = 0; k < joined.settings.held.size(); ++k) {
    if (!joined.settings.held[k]) continue;
    const int row = static_cast<int>(k);
    to.push_back({joined.held_by[k], {{row, 1.0}}, displacement.row(row).transpose()});
  }
}

/// On the surface of this index.
Expected<Points> load_on(const Scene& scene, int surface, const ShellEnergy& shell) {
  const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(surface)];
  const Point vector(scene.load.vector.data()), gravity(scene.load.gravity.data());
  if (gravity != Point::Zero() && shell.mass_per_area() == 0) {
    return input_error(
        "a shell without density has no weight", "gravity",
        std::holds_alternative<ShellMaterial>(s.elasticity) ? "give its material a density" : "use vector");
  }
  Points load = shell.weight(gravity);
  const bool by_area = scene.load.per.value_or(LoadMeasure::area) == LoadMeasure::area;
  if (by_area) {
    load += shell.area_load(vector);
  } else {
    const auto forces = load_forces<2>(*s.rest, {}, [&](const std::array<double, 2>&) { return vector; });
    if (!forces) return std::unexpected(forces.error());
    load += *forces;
  }
  const auto fields = load_fields(scene.load, *s.reference);
  if (!fields) return std::unexpected(fields.error());
  for (const Surface& field : *fields) {
    const auto forces = by_area ? area_load_forces(*s.rest, field) : load_forces<2>(*s.rest, {}, field);
    if (!forces) return std::unexpected(forces.error());
    load += *forces;
  }
  for (const SceneForce& f : scene.forces) {
    if (f.surface != surface || !f.keeps_direction()) continue;
    const auto forces = dead_forces(s, f, 1);
    if (!forces) return std::unexpected(forces.error());
    load += *forces;
  }
  return load;
}

Expected<void> append_moments(const Scene& scene, int surface, int first, int size, std::vector<EdgeMoment>& moments) {
  const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(surface)];
  for (const SceneForce& f : scene.forces) {
    const auto* acting = std::get_if<MomentForce>(&f.force);
    if (f.surface != surface || acting == nullptr) continue;
    if (std::ranges::any_of(s.constraints, [](const KeptConstraint& kept) {
          return std::holds_alternative<MirrorSymmetry>(kept.constraint);
        })) {
      return input_error("a moment has no mirror image", f.name,
                         "sculpt one half, with a symmetry of its edge, or release the mirror");
    }
    for (const SurfaceEdge edge : edges_of(acting->edge)) {
      auto moment = EdgeMoment::create(*s.rest, edge_across(edge), edge_at_end(edge), acting->moment, first, size);
      if (!moment) return std::unexpected(moment.error());
      moments.push_back(std::move(*moment));
    }
  }
  return {};
}

/// What keeps the angle at a seam that constraints join in position only; none where it cannot have one.
Expected<std::optional<ShellCrease>> crease_at(const SeamReport& report, std::span<const SceneSurface* const> surfaces,
                                               std::span<const ShellEnergy> shells, std::span<const int> rows) {
  // A moment that bends the shell to a radius of ten thicknesses opens the seam by a ten-thousandth.
  constexpr double stiffening = 1000;
  const Seam& seam = report.seam;
  if (report.continuity != SeamContinuity::c0 || report.rigid || seam.kind != SeamKind::whole) return std::nullopt;
  const auto side = [&](const PatchEdge& edge) {
    const auto k = static_cast<std::size_t>(edge.patch);
    return CreaseSide{surfaces[k]->rest.get(), rows[k], edge_across(edge.edge), edge_at_end(edge.edge)};
  };
  const auto stiffness = [&](const PatchEdge& edge) {
    const ShellEnergy& shell = shells[static_cast<std::size_t>(edge.patch)];
    return shell.bending_stiffness() / shell.effective_thickness();
  };
  auto crease = ShellCrease::create(side(seam.a), side(seam.b), seam.reversed,
                                    stiffening * std::max(stiffness(seam.a), stiffness(seam.b)));
  if (!crease) return std::unexpected(crease.error());
  return std::optional(std::move(*crease));
}

Expected<ShellEnergy> energy_of(const SceneSurface& s) {
  if (const auto* shell = std::get_if<ShellMaterial>(&s.elasticity)) return ShellEnergy::create(*s.rest, *shell);
  return ShellEnergy::of_forms(*s.rest, std::get<FundamentalMaterial>(s.elasticity));
}

/// The input of the models of linear surfaces, for what holds shells: in places of the rest shape.
ModelInput held_input(const Scene& scene) {
  ModelInput input = model_input(scene, scene.evolution);
  const std::vector<int> selection = scene.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    input.surfaces[k].rest = scene.surfaces[static_cast<std::size_t>(selection[k])].rest;
  }
  return input;
}

ShellInput shell_input(const Scene& scene) {
  ShellInput input{held_input(scene), {}};
  for (const int k : scene.selection()) {
    input.elasticities.push_back(scene.surfaces[static_cast<std::size_t>(k)].elasticity);
  }
  return input;
}

/// The energies of the surfaces and of the creases between them.
Expected<ShellStructure> structure_of(std::span<const SceneSurface* const> surfaces, const JoinedSurfaces& joined) {
  std::vector<ShellEnergy> shells;
  for (const SceneSurface* s : surfaces) {
    auto shell = energy_of(*s);
    if (!shell) return std::unexpected(shell.error());
    shells.push_back(std::move(*shell));
  }
  std::vector<ShellCrease> creases;
  for (const SeamReport& report : joined.seams) {
    auto crease = crease_at(report, surfaces, shells, joined.rows);
    if (!crease) return std::unexpected(crease.error());
    if (*crease) creases.push_back(std::move(**crease));
  }
  return ShellStructure(std::move(shells), std::move(creases));
}

}  // namespace

Expected<ShellProblem> shell_problem(const Scene& scene, const ShellProblem* kept) {
  const std::vector<int> selection = scene.selection();
  std::vector<const SceneSurface*> surfaces;
  for (const int k : selection) {
    surfaces.push_back(&scene.surfaces[static_cast<std::size_t>(k)]);
    if (auto within = check_scope(*surfaces.back()); !within) return std::unexpected(within.error());
  }
  ShellInput input = shell_input(scene);
  const bool same = kept != nullptr && kept->surfaces == selection && kept->input == input;
  auto joined = same ? Expected<JoinedSurfaces>(kept->joined) : join_surfaces(input.model);
  if (!joined) return std::unexpected(joined.error());
  auto structure = same ? Expected<ShellStructure>(kept->structure) : structure_of(surfaces, *joined);
  if (!structure) return std::unexpected(structure.error());
  const std::vector<int>& rows = joined->rows;
  Points rest(rows.back(), 3), present(rows.back(), 3), load(rows.back(), 3);
  std::vector<EdgeMoment> moments;
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const auto forces = load_on(scene, selection[k], structure->shells()[k]);
    if (!forces) return std::unexpected(forces.error());
    const int first = rows[k], n = rows[k + 1] - first;
    rest.middleRows(first, n) = surfaces[k]->rest->control_points();
    present.middleRows(first, n) = surfaces[k]->current->control_points();
    load.middleRows(first, n) = *forces;
    if (auto ok = append_moments(scene, selection[k], first, rows.back(), moments); !ok) {
      return std::unexpected(ok.error());
    }
  }
  std::vector<LinearConstraint> constraints;
  append_held(*joined, present - rest, constraints);
  constraints.insert(constraints.end(), joined->settings.constraints.begin(), joined->settings.constraints.end());
  return ShellProblem{std::move(input),       std::move(*joined), selection,
                      std::move(*structure),  std::move(rest),    std::move(present),
                      std::move(constraints), std::move(load),    std::move(moments)};
}

bool touches_shell(const Scene& scene) {
  const std::vector<int> selection = scene.selection();
  return !scene.tools.empty() || scene.limit || scene.load.pressure != 0 || scene.load.wind != Vector3{0, 0, 0} ||
         std::ranges::any_of(scene.forces, [&](const SceneForce& f) {
           return f.pulls_a_point() && std::ranges::find(selection, f.surface) != selection.end();
         });
}

Expected<ShellModel> make_shell_model(const Scene& scene, const ShellProblem& problem,
                                      const EvolutionPolicy& evolution) {
  const ActiveSettings<2>& joined = problem.joined.settings;
  const SceneSurface& first = scene.surfaces[static_cast<std::size_t>(problem.surfaces.front())];
  const auto *mass = std::get_if<double>(&first.material.mass), *damping = std::get_if<double>(&first.material.damping);
  const bool forms = std::ranges::none_of(problem.input.elasticities, [](const Elasticity<2>& elasticity) {
    return std::holds_alternative<ShellMaterial>(elasticity);
  });
  ActiveShellSettings settings{.evolution = evolution.mode,
                               .lambda = evolution.lambda,
                               .time_step = evolution.time_step,
                               .damping = mass != nullptr && damping != nullptr && *mass > 0 ? *damping / *mass : 0,
                               .mass = forms && mass != nullptr ? *mass : 0,
                               .held = joined.held,
                               .constraints = joined.constraints,
                               .visible = joined.visible,
                               .detail = problem.input.model.detail,
                               .accuracy = evolution.accuracy};
  std::vector<Surface> patches;
  for (const int k : problem.surfaces) patches.push_back(*scene.surfaces[static_cast<std::size_t>(k)].rest);
  auto model = ActiveShell::create(std::move(patches), problem.structure, std::move(settings));
  if (!model) return std::unexpected(model.error());
  return ShellModel{problem, evolution, std::move(*model)};
}

Expected<ActiveShellLoads> shell_loads(const Scene& scene, const ShellProblem& problem, double share) {
  auto acting = active_point_forces(scene);
  if (!acting) return std::unexpected(acting.error());
  ActiveShellLoads loads{.nodal = share * problem.load,
                         .moments = problem.moments,
                         .pressure = share * scene.load.pressure,
                         .wind = Point(scene.load.wind.data()),
                         .points = std::move(*acting)};
  if (scene.limit) {
    loads.limit = *scene.limit;
    loads.original = opened_points(scene);
  }
  return loads;
}

Points with_held_bits(Points solved, const Points& present, const Points& rest,
                      std::span<const LinearConstraint> conditions) {
  constexpr double rounding = 1e-15;
  for (const LinearConstraint& c : conditions) {
    if (c.terms.size() != 1) continue;
    const Eigen::Index row = c.terms.front().first;
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (c.normal && (*c.normal)[k] == 0) continue;
      double& x = solved(row, k);
      const double was = present(row, k);
      if (std::abs(x - was) <= rounding * (std::abs(x) + std::abs(rest(row, k)))) x = was;
    }
  }
  return solved;
}

}  // namespace knead
