#include "shell_model.hpp"

#include <algorithm>
#include <cmath>

#include "constraints.hpp"
#include "contact/active_shell.hpp"
#include "dead_loads.hpp"
#include "knead/base/error_code.hpp"
#include "knead/energy/loads.hpp"
#include "scene/anchors.hpp"
#include "solve/shell_statics.hpp"

namespace knead {
namespace {

Expected<void> check_scope(const SceneSurface& s) {
  if (!is_nonlinear(s.elasticity)) {
    return input_error("it is no shell, but is selected with shells", s.id,
                       "give all of them the same kind of model");
  }
  if (s.mode == RestMode::none)
    return input_error("a shell needs a rest shape", "rest", R"(use {"do":"rest","mode":"shape"})",
                       {ErrorCode::rest_shape_needed});
  return {};
}

/// Whether all forces are known before the shape is.
/// Pressure and wind turn with the surface, springs and the limit depend on where it is. Without
/// them the equilibrium ∇E(x) = f is sought by Newton's method along an increasing load from the
/// rest shape, and need not be stable (`equilibrium_of`); with them, or with tools, steps lead to
/// it from the present shape (`press`).
bool keep_direction(const ActiveLoads& loads) {
  return loads.limit == 0 && loads.pressure == 0 && loads.wind == Point::Zero() &&
         loads.points.empty();
}

/// On the surface of this index.
Expected<Points> load_on(const Scene& scene, int surface, const ShellEnergy& shell) {
  const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(surface)];
  const Point vector(scene.load.vector.data()), gravity(scene.load.gravity.data());
  if (gravity != Point::Zero() && shell.mass_per_area() == 0) {
    return input_error("a shell without density has no weight", "gravity",
                       std::holds_alternative<ShellMaterial>(s.elasticity)
                           ? "give its material a density"
                           : "use vector");
  }
  Points load = shell.weight(gravity);
  const bool by_area = scene.load.per.value_or(LoadMeasure::area) == LoadMeasure::area;
  if (by_area) {
    load += shell.area_load(vector);
  } else {
    const auto forces =
        load_forces<2>(*s.rest, {}, [&](const std::array<double, 2>&) { return vector; });
    if (!forces) return std::unexpected(forces.error());
    load += *forces;
  }
  const auto fields = load_fields(scene.load, *s.reference);
  if (!fields) return std::unexpected(fields.error());
  for (const Surface& field : *fields) {
    const auto forces =
        by_area ? area_load_forces(*s.rest, field) : load_forces<2>(*s.rest, {}, field);
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

Expected<void> append_moments(const Scene& scene, int surface, int first, int size,
                              std::vector<EdgeMoment>& moments) {
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
      auto moment = EdgeMoment::create(*s.rest, edge_across(edge), edge_at_end(edge),
                                       acting->moment, first, size);
      if (!moment) return std::unexpected(moment.error());
      moments.push_back(std::move(*moment));
    }
  }
  return {};
}

/// What keeps the angle at a seam that constraints join in position only; none where it cannot have
/// one.
/// Seams with common positions and no common derivatives are hinges for a shell whose energy ends
/// at its boundary. A spring on the angle, per length of the seam, replaces the stiffness of the
/// material there. Rigid seams and those that coincide along a part only have no angle of their
/// own.
Expected<std::optional<ShellCrease>> crease_at(const SeamReport& report,
                                               std::span<const SceneSurface* const> surfaces,
                                               std::span<const ShellEnergy> shells,
                                               std::span<const int> rows) {
  // A moment that bends the shell to a radius of ten thicknesses opens the seam by a
  // ten-thousandth.
  constexpr double stiffening = 1000;
  const Seam& seam = report.seam;
  if (report.continuity != SeamContinuity::c0 || report.rigid || seam.kind != SeamKind::whole)
    return std::nullopt;
  const auto side = [&](const PatchEdge& edge) {
    const auto k = static_cast<std::size_t>(edge.patch);
    return CreaseSide{surfaces[k]->rest.get(), rows[k], edge_across(edge.edge),
                      edge_at_end(edge.edge)};
  };
  const auto stiffness = [&](const PatchEdge& edge) {
    const ShellEnergy& shell = shells[static_cast<std::size_t>(edge.patch)];
    // D / h is the stiffness, per length, of a strip as long as the shell is thick: the natural
    // unit of an angle's spring.
    return shell.bending_stiffness() / shell.effective_thickness();
  };
  auto crease = ShellCrease::create(side(seam.a), side(seam.b), seam.reversed,
                                    stiffening * std::max(stiffness(seam.a), stiffness(seam.b)));
  if (!crease) return std::unexpected(crease.error());
  return std::optional(std::move(*crease));
}

Expected<ShellEnergy> energy_of(const SceneSurface& s) {
  if (const auto* shell = std::get_if<ShellMaterial>(&s.elasticity))
    return ShellEnergy::create(*s.rest, *shell);
  return ShellEnergy::of_forms(*s.rest, std::get<FundamentalMaterial>(s.elasticity));
}

/// As that of linear surfaces, with all rest shapes: what holds shells is in places of these.
ModelInput shell_input(const Scene& scene, const EvolutionPolicy& evolution) {
  ModelInput input = model_input(scene, evolution);
  const auto surfaces = selected_shapes<2>(scene);
  for (std::size_t k = 0; k < surfaces.size(); ++k) input.shapes[k].rest = surfaces[k]->rest;
  return input;
}

/// The energies of the surfaces and of the creases between them.
Expected<ShellStructure> structure_of(std::span<const SceneSurface* const> surfaces,
                                      const JoinedShapes<2>& joined) {
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

Expected<ShellSetup> shell_setup(const Scene& scene, const EvolutionPolicy& evolution) {
  const auto surfaces = selected_shapes<2>(scene);
  for (const SceneSurface* s : surfaces) {
    if (auto within = check_scope(*s); !within) return std::unexpected(within.error());
  }
  ModelInput input = shell_input(scene, evolution);
  auto joined = join_shapes(input);
  if (!joined) return std::unexpected(joined.error());
  auto structure = structure_of(surfaces, *joined);
  if (!structure) return std::unexpected(structure.error());
  return ShellSetup{std::move(input), *std::move(joined), *std::move(structure)};
}

/// The loads and forces that keep their direction or follow edges.
Expected<ActiveLoads> forces_on(const Scene& scene, const ShellStructure& structure) {
  const std::vector<int> selection = scene.selection();
  ActiveLoads loads;
  loads.nodal.resize(structure.size(), 3);
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const int first = structure.rows()[k], n = structure.rows()[k + 1] - first;
    const auto forces = load_on(scene, selection[k], structure.shells()[k]);
    if (!forces) return std::unexpected(forces.error());
    loads.nodal.middleRows(first, n) = *forces;
    if (auto ok = append_moments(scene, selection[k], first, structure.size(), loads.moments);
        !ok) {
      return std::unexpected(ok.error());
    }
  }
  return loads;
}

/// Equilibrium under dead loads and moments, which need not be stable, from the rest shape.
Expected<ActiveStep> equilibrium_of(const ShellStructure& structure, const Points& rest,
                                    const std::vector<LinearConstraint>& constraints,
                                    const ActiveLoads& loads, int increments) {
  auto found = shell_equilibrium(structure, rest, constraints, loads.nodal,
                                 {.increments = increments}, loads.moments);
  if (!found) return std::unexpected(found.error());
  ActiveStep step;
  step.control_points = std::move(found->control_points);
  step.converged = found->converged;
  step.note = found->note;
  step.load_factor = found->load_factor;
  for (const ShellIncrement& part : found->increments) {
    step.increments.push_back(part.iterations);
    step.iterations += part.iterations;
    step.residual = part.residual;
  }
  return step;
}

class ShellModel final : public Model {
 public:
  explicit ShellModel(ShellSetup setup) : setup_(std::move(setup)) {}

  [[nodiscard]] bool serves(const Scene& scene, const EvolutionPolicy& evolution) const override {
    return setup_.input == shell_input(scene, evolution);
  }
  [[nodiscard]] bool measures(const Scene& scene) const override {
    ModelInput input = shell_input(scene, setup_.input.evolution);
    input.detail = setup_.input.detail;
    return input == setup_.input;
  }
  [[nodiscard]] Expected<ActiveLoads> loads(const Scene& scene,
                                            const std::vector<PointForce>& grips) const override;
  [[nodiscard]] Expected<ActiveStep> step(const ActiveState& from, std::span<const Tool> tools,
                                          const ActiveLoads& loads, int increments) override;
  [[nodiscard]] double energy(const ActiveState& of) const override {
    return setup_.structure.energy(of.control_points).sum();
  }
  [[nodiscard]] std::span<const SeamReport> seams() const override { return setup_.joined.seams; }
  [[nodiscard]] std::span<const std::string> notes() const override { return setup_.joined.notes; }
  [[nodiscard]] Eigen::Index size() const override { return setup_.structure.size(); }

 private:
  [[nodiscard]] bool is_stationary() const {
    return setup_.input.evolution.mode == Evolution::stationary;
  }
  [[nodiscard]] Expected<ActiveShell> pressed() const;
  Expected<ActiveStep> press(const ActiveState& from, std::span<const Tool> tools,
                             const ActiveLoads& loads, int increments);

  ShellSetup setup_;
  std::optional<ActiveShell> pressed_ = {};  // made by the first step that needs it
};

Expected<ActiveLoads> ShellModel::loads(const Scene& scene,
                                        const std::vector<PointForce>& grips) const {
  auto loads = forces_on(scene, setup_.structure);
  if (!loads) return loads;
  loads->pressure = scene.load.pressure;
  loads->wind = Point(scene.load.wind.data());
  auto points = active_point_forces(scene);
  if (!points) return std::unexpected(points.error());
  loads->points = *std::move(points);
  loads->points.insert(loads->points.end(), grips.begin(), grips.end());
  if (scene.limit) {
    loads->limit = *scene.limit;
    loads->original = opened_points(scene);
  }
  if (is_stationary() && scene.tools.empty() && keep_direction(*loads)) return loads;
  auto anchored = shell_anchors(scene, active_state(scene).control_points);
  if (!anchored) return std::unexpected(anchored.error());
  loads->points.insert(loads->points.end(), anchored->begin(), anchored->end());
  return loads;
}

Expected<ActiveStep> ShellModel::step(const ActiveState& from, std::span<const Tool> tools,
                                      const ActiveLoads& loads, int increments) {
  const std::vector<LinearConstraint> constraints =
      conditions_of(setup_.joined, from.control_points - from.rest);
  const bool dead = is_stationary() && tools.empty() && keep_direction(loads);
  auto step = dead ? equilibrium_of(setup_.structure, from.rest, constraints, loads, increments)
                   : press(from, tools, loads, is_stationary() ? increments : 1);
  if (!step) return step;
  if (!from.balanced) {
    step->control_points = with_held_bits(std::move(step->control_points), from.control_points,
                                          from.rest, constraints);
  }
  if (!dead) return step;
  const ShellParts energy = setup_.structure.energy(step->control_points);
  step->stretch = energy.membrane;
  step->bend = energy.bending;
  step->energy = energy.sum();
  return step;
}

/// How the shells move under tools, or in time.
Expected<ActiveShell> ShellModel::pressed() const {
  const auto& [input, joined, structure] = setup_;
  const MaterialFieldOf<2>& material = input.shapes.front().material;
  const auto *mass = std::get_if<double>(&material.mass),
             *damping = std::get_if<double>(&material.damping);
  // A shell has a mass by its density; a surface that keeps its fundamental forms has the linear
  // model's. Damping there is per mass.
  const bool forms = std::ranges::none_of(input.shapes, [](const SurfaceInput& s) {
    return std::holds_alternative<ShellMaterial>(s.elasticity);
  });
  ActiveShellSettings settings{
      .evolution = input.evolution.mode,
      .lambda = input.evolution.lambda,
      .time_step = input.evolution.time_step,
      .damping = mass != nullptr && damping != nullptr && *mass > 0 ? *damping / *mass : 0,
      .mass = forms && mass != nullptr ? *mass : 0,
      .held = joined.settings.held,
      .constraints = joined.settings.constraints,
      .visible = joined.settings.visible,
      .detail = input.detail,
      .accuracy = input.evolution.accuracy};
  std::vector<Surface> patches;
  for (const SurfaceInput& s : input.shapes) patches.push_back(*s.rest);
  return ActiveShell::create(std::move(patches), structure, std::move(settings));
}

Expected<ActiveStep> ShellModel::press(const ActiveState& from, std::span<const Tool> tools,
                                       const ActiveLoads& loads, int increments) {
  if (!pressed_) {
    auto made = pressed();
    if (!made) return std::unexpected(made.error());
    pressed_ = *std::move(made);
  }
  ActiveState state = from;
  ActiveStep step;
  std::vector<int> iterations;
  // Loads are put on in equal parts, each from the equilibrium of the one before: Newton's method
  // for a shell converges from near by only. Tools are where they are in all parts.
  for (int part = 1; part <= increments; ++part) {
    const double share = static_cast<double>(part) / increments;
    ActiveLoads put_on = loads;
    put_on.nodal = share * loads.nodal;
    put_on.pressure = share * loads.pressure;
    auto taken = pressed_->step(state, tools, put_on);
    if (!taken) return taken;
    iterations.push_back(taken->iterations);
    state.control_points = taken->control_points;
    step = *std::move(taken);
  }
  if (is_stationary()) {
    step.load_factor = 1;
    step.increments = std::move(iterations);
  }
  return step;
}

}  // namespace

bool has_shells(const Scene& scene) {
  return std::ranges::any_of(selected_shapes<2>(scene),
                             [](const SceneSurface* s) { return is_nonlinear(s->elasticity); });
}

Expected<ShellProblem> shell_problem(const Scene& scene) {
  auto setup = shell_setup(scene, scene.evolution);
  if (!setup) return std::unexpected(setup.error());
  auto loads = forces_on(scene, setup->structure);
  if (!loads) return std::unexpected(loads.error());
  ActiveState now = active_state(scene);
  auto constraints = conditions_of(setup->joined, now.control_points - now.rest);
  return ShellProblem{
      *std::move(setup),      std::move(now.rest),     std::move(now.control_points),
      std::move(constraints), std::move(loads->nodal), std::move(loads->moments)};
}

Expected<std::unique_ptr<Model>> shell_model(const Scene& scene, const EvolutionPolicy& evolution) {
  auto setup = shell_setup(scene, evolution);
  if (!setup) return std::unexpected(setup.error());
  return std::make_unique<ShellModel>(*std::move(setup));
}

// A coordinate that one condition on one control point determines is x = rest + value, which
// rounding may put one bit beside where it stands. Where that is all the difference, it keeps its
// bits: what is held does not move, and files keep their bytes there. Two roundings of a sum are
// bounded by 1e-15 of its terms.
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
