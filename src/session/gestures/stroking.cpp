#include "stroking.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "knead/base/error_code.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "scene/anchors.hpp"
#include "session/acts/following.hpp"
#include "session/acts/holding.hpp"
#include "session/acts/notes.hpp"
#include "session/acts/refining.hpp"
#include "session/acts/selection.hpp"
#include "session/acts/stepping.hpp"
#include "session/acts/trimming.hpp"
#include "spline/onto_net.hpp"

namespace knead {
namespace {

// A stroke that leaves its groove as it goes. At every place the tool is pressed into the shapes
// from before the stroke, a step u_k from rest; m = the largest of all u_k point by point, at
// Chebyshev abscissae, is what it remembers, and the plastic part of m is what stays. Each place is
// solved independently, with the dent of the place before moved along as first guess: the result
// depends on the path alone, not on how many events drew it, and no errors add up.
constexpr double places_per_size = 8;  // of a stroke, along its path
// Sizes of the tool from its centre within which seams have to bend.
constexpr double near_seam = 2;
constexpr int max_places = 20000;  // of one command
constexpr double hard = 300;  // stiffness of a tool, in λ: it gives way by about 1 % of its depth

double mean(const Coefficient<2>& c) {
  if (const double* constant = std::get_if<double>(&c)) return *constant;
  const std::vector<double>& all = std::get<SplineField<2>>(c).coefficients();
  double sum = 0;
  for (double x : all) sum += x;
  return sum / static_cast<double>(all.size());
}

/// The bed on which a dent in the selected surfaces is felt no further than `reach` (file units),
/// but over one span at least: on a shorter length the net could not show it.
Locality bed_of(const Scene& scene, const std::map<int, DomainScaling<2>>& scalings, double reach) {
  double unit = 0, beta = 0, alpha = 0;
  for (int k : scene.selection()) {
    const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(k)];
    const DomainScaling<2>& scaling = scalings.at(k);
    if (unit == 0) unit = scaling.length;
    for (int d = 0; d < 2; ++d) {
      const KnotVector& knots = s.reference->knots(d);
      const double side =
          scaling.length * scaling.factors[static_cast<std::size_t>(d)] * knots.domain().length();
      reach = std::max(reach, side / static_cast<double>(knots.spans().size()));
    }
    if (is_nonlinear(s.elasticity))
      alpha = std::max(alpha, 1.0);  // its membrane; bending is felt less far
    for (std::size_t i : pure_terms) {
      if (is_nonlinear(s.elasticity)) break;
      beta = std::max(beta, mean(s.material.beta[i]));
      alpha = std::max(alpha, mean(s.material.alpha[i]));
    }
  }
  const double length = reach / unit;
  if (beta > 0) return locality_of(beta, length);
  return Locality{alpha > 0 ? alpha / (length * length) : 1,
                  0};  // a membrane: its dents have no rim
}

/// The square of how far a dent is felt on a bed, file units.
double felt_area(const Scene& scene, const DomainScaling<2>& scaling, const OpenStroke& stroke) {
  const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(*scene.selected)];
  if (is_nonlinear(s.elasticity)) return scaling.length * scaling.length / stroke.lambda;
  double area = 0;
  for (std::size_t i : pure_terms) {
    area = std::max({area, std::sqrt(mean(s.material.beta[i]) / stroke.lambda),
                     mean(s.material.alpha[i]) / stroke.lambda});
  }
  return area * scaling.length * scaling.length;
}

std::vector<Travel> travels_of(const std::vector<Tool>& was, const std::vector<Tool>& is) {
  std::vector<Travel> travels;
  for (std::size_t t = 0; t < std::min(was.size(), is.size()); ++t)
    travels.push_back({was[t].shape.placement().position, is[t].shape.placement().position});
  return travels;
}

}  // namespace

Expected<void> Stroke::begin(const Begin& begin) {
  auto surface = selected(act_);
  if (!surface) return std::unexpected(surface.error());
  const auto tool = find_tool(act_, begin.tool);
  if (!tool) return std::unexpected(tool.error());
  if (act_.state.scaling == ScalingMode::raw) {
    return input_error(
        "strokes that leave their groove as they go need a model in normalised units", "plastic",
        R"(give {"do":"scaling","mode":"normalised"}, or "plastic":"release")",
        {ErrorCode::scaling_is_raw});
  }
  if (act_.state.permission == RefinePermission::automatic) {
    if (auto refined = refine_seams(act_); !refined) return refined;
  }
  double size = (*tool)->shape.size();
  if (!std::isfinite(size)) {
    const auto length = diagonal(act_);
    if (!length) return std::unexpected(length.error());
    size = 0.1 * *length;
  }
  const PlasticPolicy& policy = (*surface)->plastic;
  const double unit = policy.in_radii ? size : 1;
  OpenStroke stroke;
  stroke.tool = begin.tool;
  stroke.home = (*tool)->shape.placement().position;
  stroke.path.spacing = size / places_per_size;
  stroke.plasticity = {begin.share * policy.share, policy.yield * unit};
  stroke.lambda = act_.state.evolution.lambda > 0 ? act_.state.evolution.lambda : 1;
  std::map<int, DomainScaling<2>> scalings;
  for (const int k : act_.state.selection()) {
    const auto scaling =
        normalised_scaling<2>(*act_.state.surfaces[static_cast<std::size_t>(k)].reference);
    if (!scaling) return std::unexpected(scaling.error());
    scalings.emplace(k, *scaling);
  }
  if (policy.locality > 0) {
    const Locality bed = bed_of(act_.state, scalings, policy.locality * unit);
    stroke.lambda = bed.lambda;
    stroke.tension = bed.tension;
  }
  // The further a dent is felt, the more a tool has to bear.
  const double felt = felt_area(act_.state, scalings.at(*act_.state.selected), stroke);
  // The bed alone resists with λ per area of the tool; the plate spreads the dent over the area
  // that it is felt in, and brings as much more of the bed to bear.
  stroke.stiffness = hard * stroke.lambda * std::max(1.0, 16 * felt / (size * size));
  Eigen::Index rows = 0;
  for (const SceneSurface& s : selected_surfaces(act_.state)) {
    stroke.before.push_back({s.rest, s.current});
    rows += s.current->size();
  }
  stroke.history = Points::Zero(rows, 3);
  act_.state.stroke = std::move(stroke);
  return {};
}

namespace {

/// Moves the tool of the open stroke.
Expected<void> put_tool(Act& act, const Point& place) {
  auto tool = find_tool(act, act.state.stroke->tool);
  if (!tool) return std::unexpected(tool.error());
  auto moved = (*tool)->shape.moved((*tool)->shape.placement().rotation, place);
  if (!moved) return std::unexpected(moved.error().within("path"));
  (*tool)->shape = std::move(*moved);
  return {};
}

/// Lets seams bend under the tool.
Expected<void> unite_under_stroke(Act& act) {
  if (act.state.together.empty() || act.state.permission == RefinePermission::never) return {};
  if (auto made = prepare_stroke_model(act); !made) return made;
  const auto tool = find_tool(act, act.state.stroke->tool);
  if (!tool) return std::unexpected(tool.error());
  const PlacedShape& shape = (*tool)->shape;
  return unite_restricted(act, act.cache.stroke->scene.seams, shape.placement().position,
                          near_seam * shape.size());
}

/// Finer nets where held edges of faces need them (before a step), or where the spans under the
/// tool are too long for it (after one) and may be refined; what the stroke remembers follows.
/// The history is values at abscissae, which move with the net: it is made a spline on the old net,
/// refined exactly, and evaluated at the new abscissae.
Expected<bool> refine_stroke(Act& act, const ActiveStep* step) {
  OpenStroke& stroke = *act.state.stroke;
  if (step == nullptr) {
    if (auto united = unite_under_stroke(act); !united) return std::unexpected(united.error());
    if (auto refined = refine_trims(act); !refined) return std::unexpected(refined.error());
    if (auto united = unite_followed(act); !united) return std::unexpected(united.error());
  } else if (step->coarseness > coarse && act.state.permission == RefinePermission::automatic) {
    const auto tool = find_tool(act, stroke.tool);
    if (!tool) return std::unexpected(tool.error());
    if (auto refined = refine_under(act, Tool(**tool), true); !refined) return refined;
    if (auto united = unite_followed(act); !united) return std::unexpected(united.error());
  }
  std::array<Points*, 2> fields = {&stroke.history, &stroke.last};
  std::array<std::vector<Points>, 2> finer;
  Eigen::Index first = 0;
  const std::vector<int> selection = act.state.selection();
  const auto shape = [&](std::size_t k) {
    return act.state.surfaces[static_cast<std::size_t>(selection[k])].current;
  };
  bool any = false;
  for (std::size_t k = 0; k < selection.size(); ++k)
    any = any || shape(k) != stroke.before[k].current;
  if (!any) return false;
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(selection[k])];
    const Surface old = *stroke.before[k].current, &like = *s.current;
    stroke.before[k] = {s.rest, s.current};
    const auto from = SiteValues<2>::create(old, Sites::chebyshev),
               to = SiteValues<2>::create(like, Sites::chebyshev);
    if (!from) return std::unexpected(from.error());
    if (!to) return std::unexpected(to.error());
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (fields[f]->rows() == 0) continue;
      const Points part = fields[f]->middleRows(first, old.size());
      auto field = old.with_control_points(f == 0 ? from->coefficients(part) : part);
      if (field) field = onto_net(*field, like);
      if (!field) return std::unexpected(field.error());
      finer[f].push_back(f == 0 ? to->values(field->control_points()) : field->control_points());
    }
    first += old.size();
  }
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (fields[f]->rows() == 0) continue;
    Eigen::Index rows = 0;
    for (const Points& part : finer[f]) rows += part.rows();
    fields[f]->resize(rows, 3);
    rows = 0;
    for (const Points& part : finer[f]) {
      fields[f]->middleRows(rows, part.rows()) = part;
      rows += part.rows();
    }
  }
  return true;
}

}  // namespace

/// The rest shapes with what stays so far, and the shapes with the dent that the tool is in where
/// it is down.
Expected<void> Stroke::show_remembered(bool down) {
  const OpenStroke& stroke = *act_.state.stroke;
  const StrokeModel& model = *act_.cache.stroke;
  const Points stays =
      stroke.share * unmasked(act_.state, staying(stroke.history, stroke.plasticity));
  Points shown = stays;
  if (down && stroke.last.rows() > 0)
    remember(shown, stroke.share * unmasked(act_.state, model.at_abscissae(stroke.last)));
  const bool same = shown == stays;
  // The largest of many displacements is none that coupled surfaces allow on both sides; then the
  // nearest one stays.
  const auto allowed = [&](const Points& values) {
    return model.allowed(model.control_points(values));
  };
  const Points resting = allowed(stays);
  const Points showing = same ? resting : allowed(shown);
  Eigen::Index first = 0;
  const std::vector<int> selection = act_.state.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    SceneSurface& s = act_.state.surfaces[static_cast<std::size_t>(selection[k])];
    const OpenStroke::Before& before = stroke.before[k];
    const auto n = static_cast<Eigen::Index>(before.current->size());
    const auto with = [&](const std::shared_ptr<const Surface>& shape,
                          const Points& all) -> Expected<std::shared_ptr<const Surface>> {
      const Points d = all.middleRows(first, n);
      if ((d.array() == 0).all()) return shape;
      auto moved = shape->with_control_points(shape->control_points() + d);
      if (!moved) return std::unexpected(moved.error());
      return std::make_shared<const Surface>(std::move(*moved));
    };
    auto current = with(before.current, showing);
    if (!current) return std::unexpected(current.error());
    auto rest = same && before.rest == before.current ? current : with(before.rest, resting);
    if (!rest) return std::unexpected(rest.error());
    s.current = std::move(*current);
    s.rest = std::move(*rest);
    s.velocity.resize(0, 3);
    first += n;
  }
  return {};
}

/// Edges that follow are closed, and as smooth as asked: what is remembered is kept, and only its
/// image in the constraints is made again.
Expected<void> Stroke::show(bool down) {
  Attempts tried(act_.state, act_.state.stroke->before);
  while (true) {
    if (auto made = prepare_stroke_model(act_); !made) return made;
    if (auto shown = show_remembered(down); !shown) return shown;
    const auto closed = tried.together(act_.state);
    if (!closed) return std::unexpected(closed.error());
    if (*closed) return {};
  }
}

Expected<void> Stroke::keep_share(double share) {
  act_.state.stroke->share *= share;
  return show(true);
}

/// Puts the tool there, and presses it into the shapes from before the stroke, on nets that are
/// fine enough. \param tools with their images: where they were, and then are
Expected<ActiveStep> Stroke::press_at(const Point& place, std::vector<Tool>& tools) {
  if (auto put = put_tool(act_, place); !put) return std::unexpected(put.error());
  auto present = tools_and_images(act_.state);
  if (!present) return std::unexpected(present.error());
  const std::vector<Travel> travels = travels_of(tools, *present);
  tools = std::move(*present);
  if (auto refined = refine_stroke(act_, nullptr); !refined)
    return std::unexpected(refined.error());
  auto step = press(act_, tools, travels);
  for (int k = 0; k < max_refinements && step; ++k) {
    const auto refined = refine_stroke(act_, &*step);
    if (!refined) return std::unexpected(refined.error());
    if (!*refined) break;
    step = press(act_, tools, travels);
  }
  return step;
}

Expected<void> Stroke::press_along(const std::vector<Point>& places) {
  if (places.empty()) return {};
  SessionState& state = act_.state;
  const auto start = std::chrono::steady_clock::now();
  ActiveStep last;
  int pressed = 0, iterations = 0;
  std::string note;
  bool converged = true;
  const std::vector<int> selection = state.selection();
  for (std::size_t k = 0; k < selection.size();
       ++k) {  // nets are refined for the shapes from before the stroke
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(selection[k])];
    s.rest = state.stroke->before[k].rest;
    s.current = state.stroke->before[k].current;
  }
  auto tools = tools_and_images(state);
  if (!tools) return std::unexpected(tools.error());
  act_.law.keep_what_stroke_left(state);
  for (const Point& place : places) {
    auto step = press_at(place, *tools);
    if (!step) return std::unexpected(step.error());
    OpenStroke& stroke = *state.stroke;
    stroke.last = step->control_points;
    const Points asked = act_.cache.stroke->at_abscissae(stroke.last);
    remember(stroke.history, asked);
    const double moved = std::sqrt(asked.rowwise().squaredNorm().maxCoeff());
    act_.law.ask_of_stroke(stroke, *act_.cache.stroke, moved, *tools);
    iterations += step->iterations;
    converged = converged && step->converged;
    if (note.empty()) note = note_of(*step);
    last = std::move(*step);
    if (auto told = tell_progress(act_, ++pressed, static_cast<int>(places.size())); !told)
      return told;
  }
  note_loose(state, act_.law);
  if (last.gap > 0 && (state.stroke->history.array() == 0).all()) {
    return std::unexpected(all_held(state, last.gap_tool));
  }
  if (auto shown = show(true); !shown) return shown;
  const auto shallower = keep_unfolded(state, "stroke", state.stroke->share, [&](double share) {
    state.stroke->share = share;
    return show(true);
  });
  if (!shallower) return std::unexpected(shallower.error());
  if (!shallower->empty()) note = *shallower;
  note_model(act_, act_.cache.stroke->scene.seams, act_.cache.stroke->scene.notes);
  last.iterations = iterations;
  last.converged = converged;
  record(state, last,
         std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
         std::move(note));
  return {};
}

Expected<void> Stroke::lead(const std::vector<Point>& path) {
  OpenStroke& stroke = *act_.state.stroke;
  double length = 0;
  Point at = stroke.path.begun || path.empty() ? stroke.path.end : path.front();
  for (const Point& point : path) {
    length += (point - at).norm();
    at = point;
  }
  if (!std::isfinite(length)) return input_error("the path is too long", "path", "shorten it");
  if (length > max_places * stroke.path.spacing) {
    return input_error(
        fmt::format("a path of {:.3g} is too long for this tool, which is placed every {:.3g}",
                    length, stroke.path.spacing),
        "path", "give it in parts, or use a larger tool");
  }
  std::vector<Point> places;
  for (const Point& point : path) stroke.path.go_to(point, places);
  return press_along(places);
}

// The path is finished first: its last places come only when it is known to end.
Expected<void> Stroke::lift() {
  if (!is_open()) return {};
  std::vector<Point> places;
  act_.state.stroke->path.finish(places);
  if (auto pressed = press_along(places); !pressed) return pressed;
  if (auto shown = show(false); !shown) return shown;
  if (auto put = put_tool(act_, act_.state.stroke->home); !put) return put;
  act_.state.stroke.reset();
  return {};
}

}  // namespace knead
