#include "relax.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "knead/energy/domain_scaling.hpp"
#include "knead/spline/evaluate.hpp"
#include "scene/places.hpp"
#include "session/acts/limits.hpp"
#include "session/acts/selection.hpp"
#include "session/acts/stepping.hpp"

namespace knead {
namespace {

/// Of the bump w = (1 - ρ²)² on a disc of radius 1, clamped at its edge: ∫|∇w|² / ∫w² = 20/3 and
/// ∫(Δw)² / ∫w² = 320/3. A plate under tension with β = r²/16 · α resists it equally by stretch and
/// by bend, with 2 · 20/3 · α / r² in all.
constexpr double bend_share = 1. / 16;
constexpr double resistance = 2 * 20. / 3;

/// Whether each control point acts mainly within the ball: the surface point at its Greville
/// abscissae lies there. With `some` the one whose point is nearest to the centre always counts.
Expected<std::vector<bool>> within(const Surface& surface, const Point& centre, double radius,
                                   bool some) {
  const auto [m, n] = surface.net();
  Parameters<2> places(surface.size(), 2);
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      const Interval u = surface.knots(0).domain(), v = surface.knots(1).domain();
      places.row(i * n + j) << std::clamp(surface.knots(0).greville(i), u.lower, u.upper),
          std::clamp(surface.knots(1).greville(j), v.lower, v.upper);
    }
  }
  const auto points = evaluate<2>(surface, places, 0);
  if (!points) return std::unexpected(points.error());
  const Eigen::VectorXd distances =
      (points->points().rowwise() - centre.transpose()).rowwise().norm();
  std::vector<bool> result(static_cast<std::size_t>(surface.size()));
  for (Eigen::Index k = 0; k < distances.size(); ++k)
    result[static_cast<std::size_t>(k)] = distances[k] <= radius;
  Eigen::Index nearest = 0;
  distances.minCoeff(&nearest);
  if (some) result[static_cast<std::size_t>(nearest)] = true;
  return result;
}

/// Partners move together.
void add_mirror_images(const SceneSurface& surface, std::vector<bool>& free) {
  const auto [m, n] = surface.current->net();
  for (const KeptConstraint& kept : surface.constraints) {
    const auto* symmetry = std::get_if<MirrorSymmetry>(&kept.constraint);
    if (!symmetry) continue;
    const std::vector<bool> inside = free;
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < n; ++j) {
        const auto [k, l] = mirror_image(*symmetry, {m, n}, {i, j});
        if (inside[static_cast<std::size_t>(i * n + j)])
          free[static_cast<std::size_t>(k * n + l)] = true;
      }
    }
  }
}

}  // namespace

void describe(RelaxCommand& c, Fields& fields) {
  fields.name("relax", "smooth the surface around a point");
  fields.add("at", c.at,
             {.help = "`[s, t]`: the point",
              .unit = Unit::fraction,
              .range = between(0, 1),
              .presence = Presence::required});
  fields.add("radius", c.radius,
             {.help = "how far it reaches, a length",
              .unit = Unit::length,
              .range = above(0),
              .fallback = "a tenth of the diagonal"});
  fields.add("strength", c.strength,
             {.help = "about the share removed of a bump (1 − ρ²/r²)² on a sheet: λ = 40 (1 − "
                      "strength) / (3 r² strength); smaller bumps lose more",
              .range = {.least = 0, .most = 1, .open_below = true}});
  fields.add("surface", c.surface,
             {.help = "id of the surface of the point", .fallback = "the first selected one"});
  fields.add("relative", c.relative, {.help = "`radius` is a fraction of the diagonal"});
  describe_allowance(c.allow, fields);
}

// One implicit step of α |∇S|² + β |∇²S|² + λ |S − S_before|² on the control points near a place,
// all others pinned. A component that the plate resists with μ times its square is reduced to λ/(μ
// + λ). Of the bump above μ = `resistance` α/r², hence λ = μ (1 − share)/share for the share that
// is to be removed.
Expected<void> execute(const RelaxCommand& c, Act& act) {
  const auto chosen = selected_surface(act, c.surface);
  if (!chosen) return std::unexpected(chosen.error());
  const SceneSurface& surface = act.state.surfaces[static_cast<std::size_t>(*chosen)];
  const auto length = diagonal(act);
  if (!length) return std::unexpected(length.error());
  const double radius = c.radius ? *c.radius * (c.relative ? *length : 1) : 0.1 * *length;
  if (auto possible = check_radius(radius); !possible) return possible;
  const auto centre_at = parameters_at(*surface.current, c.at);
  if (!centre_at) return std::unexpected(centre_at.error());
  const auto centre = evaluate_point<2>(*surface.current, *centre_at);
  if (!centre) return std::unexpected(centre.error());
  const auto scaling = normalised_scaling(
      *act.state.surfaces[static_cast<std::size_t>(*act.state.selected)].reference);
  if (!scaling) return std::unexpected(scaling.error());

  // A thin plate without a rest shape, with everything outside pinned: the step of the model in a
  // state of its own.
  const double unit_radius = radius / scaling->length,
               bend = bend_share * unit_radius * unit_radius;
  SessionState trial = act.state;
  trial.tools.clear();
  trial.forces.clear();
  trial.load = {};
  trial.scaling = ScalingMode::normalised;
  trial.permission = RefinePermission::never;
  for (int index : trial.selection()) {
    SceneSurface& s = trial.surfaces[static_cast<std::size_t>(index)];
    s.mode = RestMode::none;
    s.elasticity = {};
    s.material = MaterialFieldOf<2>(MaterialOf<2>{{1, 0, 1}, {bend, bend, bend}});
    s.velocity = Points(0, 3);
    auto free = within(*s.current, *centre, radius, index == *chosen);
    if (!free) return std::unexpected(free.error());
    add_mirror_images(s, *free);
    const auto [m, n] = s.current->net();
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < n; ++j) {
        if (!(*free)[static_cast<std::size_t>(i * n + j)]) s.pins.insert({i, j});
      }
    }
  }
  EvolutionPolicy plate;
  const double share = std::min(c.strength, 0.999);  // 1 would be the static solution
  plate.lambda = resistance / (unit_radius * unit_radius) * (1 - share) / share;
  // A state of its own: tools, forces and the rest shape of the scene take no part, and if the step
  // fails nothing has changed.
  Act trial_act{act.document, trial, act.cache, act.progress};
  Models of_steps = std::exchange(act.cache.models, {});  // they stay
  const auto status = run(trial_act, {.evolution = plate});
  act.cache.models = std::move(of_steps);
  if (!status) return std::unexpected(status.error());

  for (int index : act.state.selection()) {
    SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(index)];
    const auto& relaxed = trial.surfaces[static_cast<std::size_t>(index)].current;
    if (relaxed->control_points() == s.current->control_points()) continue;
    auto rest = s.rest->with_control_points(s.rest->control_points() + relaxed->control_points() -
                                            s.current->control_points());
    if (!rest) return std::unexpected(rest.error());
    s.rest = s.rest == s.current ? relaxed : std::make_shared<const Surface>(std::move(*rest));
    s.current = relaxed;
  }
  return {};
}

}  // namespace knead
