#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "brush_path.hpp"
#include "brushing.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "scene/places.hpp"
#include "session/acts/following.hpp"
#include "session/acts/notes.hpp"
#include "session/acts/refining.hpp"
#include "session/acts/trimming.hpp"

namespace knead {
namespace {

// How far held points are felt, and what smoothing evens out, in radii.
// The model of a brush presses nothing. It projects what a brush asks for onto what constraints
// allow, in the norm of a plate on an elastic bed, D_uu² + 2 D_uv² + D_vv² + λ D²: the nearest
// displacement then differs from the one asked for near what is held and fades over the bed's
// length, a quarter of the radius. A projection in the norm of coefficients would end abruptly at
// the first free row.
constexpr double felt_radii = 0.25;
// Longest spans under a brush where nets may be refined, in radii.
constexpr double spans_wanted = 0.25;
constexpr double sharp_wanted = 1. / 16;
constexpr double least_size = 0.25;  // of a pen's pressure on the size, for which nets are refined
constexpr int most_halvings = 6;
constexpr int most_control_points = 25000;  // of a surface that is refined under a brush

/// Midpoints of the spans within the radius of a place that are longer than wanted, both in space
/// as they are there.
/// Lengths by the first derivatives at the place: exact enough for spans within a radius, and no
/// search.
Expected<std::array<std::vector<double>, 2>> halving(const Surface& s, const Fractions& at,
                                                     double radius, double wanted,
                                                     double& longest) {
  const auto u = parameters_at(s, at, "path");
  if (!u) return std::unexpected(u.error());
  Parameters<2> here(1, 2);
  here << (*u)[0], (*u)[1];
  const auto jet = evaluate<2>(s, here, 1);
  if (!jet) return std::unexpected(jet.error());
  std::array<std::vector<double>, 2> middles;
  longest = 0;
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& knots = s.knots()[d];
    const double speed = (d == 0 ? jet->at({1, 0}) : jet->at({0, 1})).row(0).norm();
    for (int span : knots.spans()) {
      const double lower = knots[span], upper = knots[span + 1];
      if (speed * (lower - (*u)[d]) > radius || speed * ((*u)[d] - upper) > radius) continue;
      longest = std::max(longest, speed * (upper - lower));
      if (speed * (upper - lower) > wanted) middles[d].push_back(0.5 * (lower + upper));
    }
  }
  return middles;
}

/// Finer nets of a surface at one place of a brush, where the edges of faces are held or refining
/// is permitted. Returns the length of the longest span there that is left.
Expected<double> refine_under_brush(Act& act, SceneSurface& s, const Fractions& at,
                                    double pressure) {
  const Brush& brush = act.state.brush->brush;
  const bool sized = brush.pressure == PressureUse::size || brush.pressure == PressureUse::both;
  const bool sharp = brush.kind == BrushKind::crease || brush.kind == BrushKind::ridge ||
                     brush.kind == BrushKind::stamp;
  const double wanted = (sized ? std::max(pressure, least_size) : 1) * brush.radius *
                        (sharp ? sharp_wanted : spans_wanted);
  if (auto refined = refine_at_trims(act, s, at, brush.radius); !refined)
    return std::unexpected(refined.error());
  double longest = 0;
  for (int k = 0; k < most_halvings; ++k) {
    const auto middles = halving(*s.current, at, brush.radius, wanted, longest);
    if (!middles) return std::unexpected(middles.error());
    if (act.state.permission != RefinePermission::automatic || !s.pins.empty()) break;
    if ((*middles)[0].empty() && (*middles)[1].empty()) break;
    const auto [m, n] = s.current->net();
    if ((m + static_cast<int>((*middles)[0].size())) *
            (n + static_cast<int>((*middles)[1].size())) >
        most_control_points) {
      break;
    }
    auto status =
        change_net(act, s, [&](const Surface& shape) { return insert_knots<2>(shape, *middles); });
    if (!status) return std::unexpected(status.error());
  }
  return longest;
}

}  // namespace

/// Finer nets under a brush, also of the surfaces beside those on which it is; the shapes from
/// before the stroke follow.
Expected<void> refine_for_brush(Act& act, const std::vector<BrushPoint>& places) {
  OpenBrush& open = *act.state.brush;
  const double radius = open.brush.radius;
  const std::vector<int> selection = act.state.selection();
  const BrushPath way(selection, open.before, radius, 0);
  if (selection.size() > 1 && act.state.permission != RefinePermission::never) {
    if (auto made = prepare_brush_model(act); !made) return made;
    for (const BrushPoint& at : places) {
      const auto place = way.place(at);
      if (!place) return std::unexpected(place.error());
      if (auto united = unite_restricted(act, act.cache.stroke->scene.seams, place->at, radius);
          !united)
        return united;
    }
  }
  const bool beside = act.state.permission == RefinePermission::automatic && selection.size() > 1;
  std::map<int, double> coarsest;
  for (const BrushPoint& at : places) {
    SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(at.surface)];
    const auto longest = refine_under_brush(act, s, at.at, at.pen.pressure);
    if (!longest) return std::unexpected(longest.error());
    coarsest[at.surface] = std::max(coarsest[at.surface], *longest);
    if (!beside) continue;
    const auto place = way.place(at);
    if (!place) return std::unexpected(place.error());
    for (int other : selection) {
      if (other == at.surface) continue;
      const BrushPoint foot = way.nearest(other, place->at);
      const auto there = way.place(foot);
      if (!there) return std::unexpected(there.error());
      if ((there->at - place->at).norm() >= radius) continue;
      const auto refined = refine_under_brush(
          act, act.state.surfaces[static_cast<std::size_t>(other)], foot.at, at.pen.pressure);
      if (!refined) return std::unexpected(refined.error());
    }
  }
  if (act.state.permission == RefinePermission::automatic) {
    if (auto united = refine_seams(act); !united) return united;
  }
  if (auto united = unite_followed(act); !united) return united;
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const SceneSurface& now = act.state.surfaces[static_cast<std::size_t>(selection[k])];
    open.before[k] = {now.rest, now.current};
    open.masks[k] = now.mask;
  }
  for (const auto& [surface, longest] : coarsest) {
    if (longest <= radius) continue;
    std::string note = fmt::format(
        R"({}: the net is coarse for the brush: its spans are up to {:.2g} times the radius; )"
        R"(let it be refined with {{"do":"refine","permission":"auto"}})",
        act.state.surfaces[static_cast<std::size_t>(surface)].id, longest / radius);
    note_once(act.state, std::move(note));
  }
  return {};
}

namespace {

/// Of the normalised scaling of the first selected surface, which the model from before may know.
Expected<double> length_of_brush_model(const Act& act) {
  const auto& reference =
      std::as_const(act.state).surfaces[static_cast<std::size_t>(*act.state.selected)].reference;
  if (act.cache.stroke && act.cache.stroke->scene.input.scaling == ScalingMode::normalised &&
      act.cache.stroke->scene.input.shapes.front().reference == reference) {
    return act.cache.stroke->scene.model.scaling().length;
  }
  const auto scaling = normalised_scaling<2>(*reference);
  if (!scaling) return std::unexpected(scaling.error());
  return scaling->length;
}

}  // namespace

/// The constraints, and a plate on a bed that tells how far they are felt.
Expected<void> prepare_brush_model(Act& act) {
  if (auto known = know_trims(act); !known) return known;
  if (auto known = know_followed(act); !known) return known;
  const OpenBrush& open = *act.state.brush;
  const auto length = length_of_brush_model(act);
  if (!length) return std::unexpected(length.error());
  EvolutionPolicy evolution;
  evolution.lambda = locality_of(1, felt_radii * open.brush.radius / *length).lambda;
  ModelInput input = model_input(act.state, evolution);
  input.scaling = ScalingMode::normalised;
  input.detail = 0;
  for (std::size_t k = 0; k < input.shapes.size(); ++k) {
    SurfaceInput& s = input.shapes[k];
    s.mode = RestMode::shape;
    s.material = MaterialFieldOf<2>(MaterialOf<2>{{0, 0, 0}, {1, 1, 1}});
    if (s.rest) s.rest = open.before[k].rest;
  }
  return keep_stroke_model(act.cache.stroke, std::move(input), open.before);
}

}  // namespace knead
