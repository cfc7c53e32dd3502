#include "drag.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knead/spline/evaluate.hpp"
#include "scene/places.hpp"
#include "session/acts/limits.hpp"
#include "session/acts/refining.hpp"
#include "session/acts/selection.hpp"
#include "session/acts/stepping.hpp"
#include "session/acts/trimming.hpp"
#include "spline/basis_terms.hpp"

namespace knead {
namespace {

constexpr int footprint_samples = 13;  // in either direction

/// The points of a footprint: all samples of the domain within `radius` of the centre in space,
/// each with its share of the force. Control points are numbered from `first`.
/// Springs at 13 × 13 samples with weights (1 − ρ²/r²)², in sum `strength`: a single spring would
/// pull out a spike whose height depends on the net.
Expected<std::vector<PointForce>> footprint(const Surface& surface, int first, const Fractions& at,
                                            double radius, double strength) {
  const auto centre_at = parameters_at(surface, at);
  if (!centre_at) return std::unexpected(centre_at.error());
  const auto centre = evaluate_point<2>(surface, *centre_at);
  if (!centre) return std::unexpected(centre.error());
  Parameters<2> here(1, 2);
  here << (*centre_at)[0], (*centre_at)[1];
  const auto jet = evaluate<2>(surface, here, 1);
  if (!jet) return std::unexpected(jet.error());
  // A rectangle of parameters that contains the disc in the tangent plane, enlarged by half.
  std::array<std::vector<double>, 2> parameters;
  for (std::size_t d = 0; d < 2; ++d) {
    const double speed = (d == 0 ? jet->at({1, 0}) : jet->at({0, 1})).row(0).norm();
    const Interval domain = surface.knots()[d].domain();
    const double reach =
        speed > 0 ? std::min(1.5 * radius / speed, domain.length()) : domain.length();
    const double lower = std::max(domain.lower, (*centre_at)[d] - reach);
    const double upper = std::min(domain.upper, (*centre_at)[d] + reach);
    for (int k = 0; k < footprint_samples; ++k) {
      parameters[d].push_back(
          std::min(lower + (upper - lower) * (k + 0.5) / footprint_samples, domain.upper));
    }
  }
  std::vector<PointForce> forces;
  double total = 0;
  for (double u : parameters[0]) {
    for (double v : parameters[1]) {
      const auto place = evaluate_point<2>(surface, {u, v});
      if (!place) return std::unexpected(place.error());
      const double s = 1 - (*place - *centre).squaredNorm() / (radius * radius);
      if (s <= 0) continue;
      PointForce force;
      force.terms = basis_terms<2>(surface, {u, v}, first);
      force.to = *place;
      force.strength = s * s;
      total += force.strength;
      forces.push_back(std::move(force));
    }
  }
  if (forces.empty()) {  // smaller than the sample distance: a single point
    PointForce force;
    force.terms = basis_terms<2>(surface, *centre_at, first);
    force.to = *centre;
    forces.push_back(std::move(force));
    total = 1;
  }
  for (PointForce& force : forces) force.strength *= strength / total;
  return forces;
}

}  // namespace

void describe(DragCommand& c, Fields& fields) {
  fields.name("drag", "grip a surface point, drag it and let it go, as one command");
  fields.add(
      "at", c.at,
      {.help = "`[s, t]`: the point; or `\"middle\"`, the visible point farthest from all edges",
       .unit = Unit::fraction,
       .range = between(0, 1)});
  fields.add("by", c.by,
             {.help = "`[dx, dy, dz]`", .unit = Unit::length, .presence = Presence::required});
  fields.add("radius", c.radius,
             {.help = "of the footprint, a length",
              .unit = Unit::length,
              .range = above(0),
              .fallback = "a tenth of the diagonal"});
  fields.add("strength", c.strength,
             {.help = "spring constant of the grip", .range = between(0, max_tool_stiffness)});
  fields.add("steps", c.steps,
             {.help = "number of steps along the way", .range = between(1, max_steps)});
  fields.add("plasticity", c.plasticity,
             {.help = "share of the displacement that becomes rest shape",
              .unit = Unit::fraction,
              .range = between(0, 1)});
  fields.add("relative", c.relative, {.help = "`by` and `radius` are fractions of the diagonal"});
  fields.add("surface", c.surface,
             {.help = "id of the surface of the point", .fallback = "the first selected one"});
  fields.add("middle", c.middle, {.help = "`true` is the same as `\"at\": \"middle\"`"});
  describe_allowance(c.allow, fields);
}

Expected<void> execute(const DragCommand& c, Act& act) {
  const auto chosen = selected_surface(act, c.surface);
  if (!chosen) return std::unexpected(chosen.error());
  SceneSurface& surface = act.state.surfaces[static_cast<std::size_t>(*chosen)];
  const auto length = diagonal(act);
  if (!length) return std::unexpected(length.error());
  const double unit = c.relative ? *length : 1,
               radius = c.radius ? *c.radius * unit : 0.1 * *length;
  if (auto possible = check_radius(radius); !possible) return possible;
  const auto at = place_on(act, surface, {c.at, c.middle.value_or(false)});
  if (!at) return std::unexpected(at.error());
  if (auto refined = refine_at_trims(act, surface, *at, radius); !refined) return refined;
  int first = 0;
  for (int k : act.state.selection()) {
    if (k == *chosen) break;
    first += act.state.surfaces[static_cast<std::size_t>(k)].current->size();
  }
  const auto grip = footprint(*surface.current, first, *at, radius, c.strength);
  if (!grip) return std::unexpected(grip.error());
  bool at_fold = false;
  for (int k = 0; k < c.steps && !at_fold; ++k) {
    Steps steps{.evolution = act.state.evolution, .grips = *grip, .before = k, .of = c.steps};
    const double share = static_cast<double>(k + 1) / c.steps;
    for (PointForce& force : steps.grips)
      force.to += share * unit * Point(c.by[0], c.by[1], c.by[2]);
    const auto made = run(act, steps);
    if (!made) return std::unexpected(made.error());
    at_fold = made->at_fold;
  }
  return yield(act, c.plasticity);
}

}  // namespace knead
