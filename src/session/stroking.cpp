#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "executor.hpp"
#include "knead/base/error_code.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "scene/anchors.hpp"

namespace knead {
namespace {

constexpr double places_per_size = 8;         // of a stroke, along its path
constexpr int max_places = 20000;             // of one command
constexpr double hard = 300;                  // stiffness of a tool, in λ: it gives way by about 1 % of its depth
constexpr std::size_t pure_terms[] = {0, 2};  // α11 and α22, β11 and β22

double mean(const Coefficient<2>& c) {
  if (const double* constant = std::get_if<double>(&c)) return *constant;
  const std::vector<double>& all = std::get<SplineField<2>>(c).coefficients();
  double sum = 0;
  for (double x : all) sum += x;
  return sum / static_cast<double>(all.size());
}

Expected<Coefficient<2>> raised(const Coefficient<2>& c, double by) {
  if (const double* constant = std::get_if<double>(&c)) return Coefficient<2>(*constant + by);
  const auto& field = std::get<SplineField<2>>(c);
  std::vector<double> all = field.coefficients();
  for (double& x : all) x += by;
  auto made = SplineField<2>::create(field.knots(), std::move(all));
  if (!made) return std::unexpected(made.error());
  return Coefficient<2>(std::move(*made));
}

/// The bed on which a dent in the selected surfaces is felt no further than `reach` (file units), but over one span at
/// least: on a shorter length the net could not show it.
Locality bed_of(const Scene& scene, const std::map<int, DomainScaling<2>>& scalings, double reach) {
  double unit = 0, beta = 0, alpha = 0;
  for (int k : scene.selection()) {
    const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(k)];
    const DomainScaling<2>& scaling = scalings.at(k);
    if (unit == 0) unit = scaling.length;
    for (int d = 0; d < 2; ++d) {
      const KnotVector& knots = s.reference->knots(d);
      const double side = scaling.length * scaling.factors[static_cast<std::size_t>(d)] * knots.domain().length();
      reach = std::max(reach, side / static_cast<double>(knots.spans().size()));
    }
    if (is_nonlinear(s.elasticity)) alpha = std::max(alpha, 1.0);  // its membrane; bending is felt less far
    for (std::size_t i : pure_terms) {
      if (is_nonlinear(s.elasticity)) break;
      beta = std::max(beta, mean(s.material.beta[i]));
      alpha = std::max(alpha, mean(s.material.alpha[i]));
    }
  }
  const double length = reach / unit;
  if (beta > 0) return locality_of(beta, length);
  return Locality{alpha > 0 ? alpha / (length * length) : 1, 0};  // a membrane: its dents have no rim
}

/// The square of how far a dent is felt on a bed, file units.
double felt_area(const Scene& scene, const DomainScaling<2>& scaling, const OpenStroke& stroke) {
  const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(*scene.selected)];
  if (is_nonlinear(s.elasticity)) return scaling.length * scaling.length / stroke.lambda;
  double area = 0;
  for (std::size_t i : pure_terms) {
    area = std::max(
        {area, std::sqrt(mean(s.material.beta[i]) / stroke.lambda), mean(s.material.alpha[i]) / stroke.lambda});
  }
  return area * scaling.length * scaling.length;
}

std::vector<Travel> travels_of(const std::vector<Tool>& was, const std::vector<Tool>& is) {
  std::vector<Travel> travels;
  for (std::size_t t = 0; t < std::min(was.size(), is.size()); ++t)
    travels.push_back({was[t].shape.placement().position, is[t].shape.placement().position});
  return travels;
}

Points stacked(const std::vector<OpenStroke::Before>& shapes,
               std::shared_ptr<const Surface> OpenStroke::Before::*which) {
  Eigen::Index rows = 0;
  for (const OpenStroke::Before& s : shapes) rows += (s.*which)->size();
  Points result(rows, 3);
  rows = 0;
  for (const OpenStroke::Before& s : shapes) {
    result.middleRows(rows, (s.*which)->size()) = (s.*which)->control_points();
    rows += (s.*which)->size();
  }
  return result;
}

}  // namespace

Expected<Surface> onto_net(Surface shape, const Surface& like) {
  std::array<std::vector<double>, 2> more;
  for (std::size_t d = 0; d < 2; ++d) {
    if (const int times = like.knots()[d].degree() - shape.knots()[d].degree(); times > 0) {
      auto elevated = elevate_degree<2>(shape, static_cast<int>(d), times);
      if (!elevated) return std::unexpected(elevated.error());
      shape = std::move(*elevated);
    }
    std::ranges::set_difference(like.knots()[d].knots(), shape.knots()[d].knots(), std::back_inserter(more[d]));
  }
  return insert_knots<2>(shape, more);
}

Expected<void> Executor::begin_stroke(const std::string& name, double share) {
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  const auto tool = find_tool(name);
  if (!tool) return std::unexpected(tool.error());
  if (state.scaling == ScalingMode::raw) {
    return input_error("strokes that leave their groove as they go need a model in normalised units", "plastic",
                       R"(give {"do":"scaling","mode":"normalised"}, or "plastic":"release")",
                       {ErrorCode::scaling_is_raw});
  }
  if (state.permission == RefinePermission::automatic) {
    if (auto refined = refine_seams(); !refined) return refined;
  }
  double size = (*tool)->shape.size();
  if (!std::isfinite(size)) {
    const auto length = diagonal();
    if (!length) return std::unexpected(length.error());
    size = 0.1 * *length;
  }
  const PlasticPolicy& policy = (*surface)->plastic;
  const double unit = policy.in_radii ? size : 1;
  OpenStroke stroke;
  stroke.tool = name;
  stroke.home = (*tool)->shape.placement().position;
  stroke.path.spacing = size / places_per_size;
  stroke.plasticity = {share * policy.share, policy.yield * unit};
  stroke.lambda = state.evolution.lambda > 0 ? state.evolution.lambda : 1;
  std::map<int, DomainScaling<2>> scalings;
  for (const int k : state.selection()) {
    const auto scaling = normalised_scaling<2>(*state.surfaces[static_cast<std::size_t>(k)].reference);
    if (!scaling) return std::unexpected(scaling.error());
    scalings.emplace(k, *scaling);
  }
  if (policy.locality > 0) {
    const Locality bed = bed_of(state, scalings, policy.locality * unit);
    stroke.lambda = bed.lambda;
    stroke.tension = bed.tension;
  }
  // The further a dent is felt, the more a tool has to bear.
  const double felt = felt_area(state, scalings.at(*state.selected), stroke);
  stroke.stiffness = hard * stroke.lambda * std::max(1.0, 16 * felt / (size * size));
  Eigen::Index rows = 0;
  for (int k : state.selection()) {
    const SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    stroke.before.push_back({s.rest, s.current});
    rows += s.current->size();
  }
  stroke.history = Points::Zero(rows, 3);
  state.stroke = std::move(stroke);
  return {};
}

Expected<void> Executor::prepare_stroke_model() {
  if (auto known = know_trims(); !known) return known;
  if (auto known = know_followed(); !known) return known;
  const OpenStroke& stroke = *state.stroke;
  EvolutionPolicy evolution;
  evolution.lambda = stroke.lambda;
  evolution.accuracy = state.evolution.accuracy;
  evolution.solver = state.evolution.solver;
  evolution.energy_tolerance = state.evolution.energy_tolerance;
  ModelInput input = model_input(state, evolution);
  for (std::size_t k = 0; k < input.shapes.size(); ++k) {
    SurfaceInput& s = input.shapes[k];
    if (s.rest) s.rest = stroke.before[k].rest;
    for (std::size_t i : pure_terms) {
      auto alpha = raised(s.material.alpha[i], stroke.tension);
      if (!alpha) return std::unexpected(alpha.error());
      s.material.alpha[i] = std::move(*alpha);
    }
  }
  return keep_stroke_model(std::move(input), stroke.before);
}

/// Moves the tool of the open stroke.
Expected<void> Executor::put_tool(const Point& place) {
  auto tool = find_tool(state.stroke->tool);
  if (!tool) return std::unexpected(tool.error());
  auto moved = (*tool)->shape.moved((*tool)->shape.placement().rotation, place);
  if (!moved) return std::unexpected(moved.error().within("path"));
  (*tool)->shape = std::move(*moved);
  return {};
}

void harden(Tool& tool, const OpenStroke& stroke) {
  if (tool.collides()) tool.stiffness = std::min(std::max(tool.stiffness, stroke.stiffness), max_tool_stiffness);
}

/// What these tools ask, which are there after these travels, of the shapes from before the stroke.
Expected<ActiveStep> Executor::press(std::vector<Tool> tools, std::span<const Travel> travels) {
  if (auto made = prepare_stroke_model(); !made) return std::unexpected(made.error());
  const OpenStroke& stroke = *state.stroke;
  for (Tool& tool : tools) harden(tool, stroke);
  if (shells()) return press_shell_on_bed(tools, stroke_guess(travels));
  const ActiveSurface& model = stroke_cache->scene.model;
  auto loads = active_loads(state, stroke_cache->scene);
  if (!loads) return std::unexpected(loads.error());
  ActiveState from{stacked(stroke.before, &OpenStroke::Before::current),
                   stacked(stroke.before, &OpenStroke::Before::rest)};
  auto anchored = anchors(state, model, from.control_points);
  if (!anchored) return std::unexpected(anchored.error());
  loads->points = std::move(*anchored);  // other forces are in balance with the shape as it was
  from.balanced = true;
  from.guess = stroke_guess(travels);
  auto step = model.step(from, tools, *loads);
  if (step) step->control_points -= from.control_points;  // the displacement
  if (step) step = within_depth(std::move(*step), from, tools, *loads);
  return step;
}

/// Finer nets where held edges of faces need them (before a step), or where the spans under the tool are too long for
/// it (after one) and may be refined; what the stroke remembers follows.
Expected<bool> Executor::refine_stroke(const ActiveStep* step) {
  OpenStroke& stroke = *state.stroke;
  if (step == nullptr) {
    if (auto united = unite_under_stroke(); !united) return std::unexpected(united.error());
    if (auto refined = refine_trims(); !refined) return std::unexpected(refined.error());
    if (auto united = unite_followed(); !united) return std::unexpected(united.error());
  } else if (step->coarseness > coarse && state.permission == RefinePermission::automatic) {
    const auto tool = find_tool(stroke.tool);
    if (!tool) return std::unexpected(tool.error());
    if (auto refined = refine_under(Tool(**tool), true); !refined) return refined;
    if (auto united = unite_followed(); !united) return std::unexpected(united.error());
  }
  std::array<Points*, 2> fields = {&stroke.history, &stroke.last};
  std::array<std::vector<Points>, 2> finer;
  Eigen::Index first = 0;
  const std::vector<int> selection = state.selection();
  const auto shape = [&](std::size_t k) { return state.surfaces[static_cast<std::size_t>(selection[k])].current; };
  bool any = false;
  for (std::size_t k = 0; k < selection.size(); ++k) any = any || shape(k) != stroke.before[k].current;
  if (!any) return false;
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const SceneSurface& s = state.surfaces[static_cast<std::size_t>(selection[k])];
    const Surface old = *stroke.before[k].current, &like = *s.current;
    stroke.before[k] = {s.rest, s.current};
    const auto from = SiteValues<2>::create(old, Sites::chebyshev), to = SiteValues<2>::create(like, Sites::chebyshev);
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

Expected<void> Executor::press_along(const std::vector<Point>& places) {
  if (places.empty()) return {};
  const auto start = std::chrono::steady_clock::now();
  ActiveStep last;
  int done = 0, iterations = 0;
  std::string note;
  bool converged = true;
  const std::vector<int> selection = state.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {  // nets are refined for the shapes from before the stroke
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(selection[k])];
    s.rest = state.stroke->before[k].rest;
    s.current = state.stroke->before[k].current;
  }
  auto was = tools_and_images(state);
  if (!was) return std::unexpected(was.error());
  keep_what_stroke_left();
  for (const Point& place : places) {
    if (auto put = put_tool(place); !put) return put;
    auto is = tools_and_images(state);
    if (!is) return std::unexpected(is.error());
    const std::vector<Travel> travels = travels_of(*was, *is);
    if (auto refined = refine_stroke(nullptr); !refined) return std::unexpected(refined.error());
    auto step = press(*is, travels);
    for (int k = 0; k < max_refinements && step; ++k) {
      const auto refined = refine_stroke(&*step);
      if (!refined) return std::unexpected(refined.error());
      if (!*refined) break;
      step = press(*is, travels);
    }
    if (!step) return std::unexpected(step.error());
    was = std::move(is);
    OpenStroke& stroke = *state.stroke;
    stroke.last = step->control_points;
    const Points asked = stroke_cache->at_abscissae(stroke.last);
    remember(stroke.history, asked);
    ask_of_stroke(std::sqrt(asked.rowwise().squaredNorm().maxCoeff()), *was);
    iterations += step->iterations;
    converged = converged && step->converged;
    if (note.empty()) note = note_of(*step);
    last = std::move(*step);
    if (auto on = carries_on(++done, static_cast<int>(places.size())); !on) return std::unexpected(on.error());
  }
  note_loose();
  if (last.gap > 0 && (state.stroke->history.array() == 0).all()) return std::unexpected(all_held(last.gap_tool));
  if (auto shown = show_stroke(true); !shown) return shown;
  const auto shallower = keep_stroke_unfolded();
  if (!shallower) return std::unexpected(shallower.error());
  if (!shallower->empty()) note = *shallower;
  note_model(stroke_cache->scene.seams, stroke_cache->scene.notes);
  last.iterations = iterations;
  last.converged = converged;
  record(last, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), std::move(note));
  return {};
}

/// The rest shapes with what stays so far, and the shapes with the dent that the tool is in where it is down.
Expected<void> Executor::show_remembered(bool down) {
  const OpenStroke& stroke = *state.stroke;
  const StrokeModel& model = *stroke_cache;
  const Points stays = stroke.share * unmasked(staying(stroke.history, stroke.plasticity));
  Points shown = stays;
  if (down && stroke.last.rows() > 0) remember(shown, stroke.share * unmasked(model.at_abscissae(stroke.last)));
  const bool same = shown == stays;
  // The largest of many displacements is none that coupled surfaces allow on both sides; then the nearest one stays.
  const auto allowed = [&](const Points& values) { return model.allowed(model.control_points(values)); };
  const Points resting = allowed(stays);
  const Points showing = same ? resting : allowed(shown);
  Eigen::Index first = 0;
  const std::vector<int> selection = state.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(selection[k])];
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

Expected<void> Executor::stroke_to(const std::vector<Point>& points) {
  OpenStroke& stroke = *state.stroke;
  double length = 0;
  Point at = stroke.path.begun || points.empty() ? stroke.path.end : points.front();
  for (const Point& point : points) {
    if (!point.allFinite()) return input_error("a coordinate is not a finite number", "path");
    length += (point - at).norm();
    at = point;
  }
  if (length > max_places * stroke.path.spacing) {
    return input_error(fmt::format("a path of {:.3g} is too long for this tool, which is placed every {:.3g}", length,
                                   stroke.path.spacing),
                       "path", "give it in parts, or use a larger tool");
  }
  std::vector<Point> places;
  for (const Point& point : points) stroke.path.go_to(point, places);
  return press_along(places);
}

Expected<void> Executor::lift() {
  if (!state.stroke) return {};
  std::vector<Point> places;
  state.stroke->path.finish(places);
  if (auto pressed = press_along(places); !pressed) return pressed;
  if (auto shown = show_stroke(false); !shown) return shown;
  if (auto put = put_tool(state.stroke->home); !put) return put;
  state.stroke.reset();
  return {};
}

}  // namespace knead
