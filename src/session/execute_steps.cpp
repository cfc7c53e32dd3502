#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "executor.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {
namespace {

constexpr double coarse = 0.5;         // spans longer than this share of a tool follow it with a loss
constexpr double too_coarse = 1;       // longer than this, they cannot follow it
constexpr int max_refinements = 5;     // of the net under a tool, where refining is permitted
constexpr int footprint_samples = 13;  // of a drag, in either direction

/// Rounds of halving after which spans are no longer coarse.
int halvings(double coarseness) { return static_cast<int>(std::ceil(std::log2(coarseness / coarse))); }

/// The points of a footprint: all samples of the domain whose place is within `radius` of the centre, each with the
/// share of the force that it takes.
Expected<std::vector<PointForce>> footprint(const Surface& surface, const Fractions& at, double radius,
                                            double strength) {
  const auto centre_at = parameters_at(surface, at);
  if (!centre_at) return std::unexpected(centre_at.error());
  const auto centre = evaluate_point<2>(surface, *centre_at);
  if (!centre) return std::unexpected(centre.error());
  Parameters<2> here(1, 2);
  here << (*centre_at)[0], (*centre_at)[1];
  const auto jet = evaluate<2>(surface, here, 1);
  if (!jet) return std::unexpected(jet.error());
  // A rectangle of parameters that holds the disc in the tangent plane, half as much again.
  std::array<std::vector<double>, 2> parameters;
  for (std::size_t d = 0; d < 2; ++d) {
    const double speed = (d == 0 ? jet->at({1, 0}) : jet->at({0, 1})).row(0).norm();
    const Interval domain = surface.knots()[d].domain();
    const double reach = speed > 0 ? std::min(1.5 * radius / speed, domain.length()) : domain.length();
    const double lower = std::max(domain.lower, (*centre_at)[d] - reach);
    const double upper = std::min(domain.upper, (*centre_at)[d] + reach);
    for (int k = 0; k < footprint_samples; ++k) {
      parameters[d].push_back(std::min(lower + (upper - lower) * (k + 0.5) / footprint_samples, domain.upper));
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
      force.terms = basis_terms(surface, {u, v}, 0);
      force.to = *place;
      force.strength = s * s;
      total += force.strength;
      forces.push_back(std::move(force));
    }
  }
  if (forces.empty()) {  // smaller than the distance of the samples: the one point
    PointForce force;
    force.terms = basis_terms(surface, *centre_at, 0);
    force.to = *centre;
    forces.push_back(std::move(force));
    total = 1;
  }
  for (PointForce& force : forces) force.strength *= strength / total;
  return forces;
}

}  // namespace

Expected<void> Executor::run(int count, const EvolveCommand& evolve, const std::vector<PointForce>& more, int done,
                             int total) {
  auto selection = selected();
  if (!selection) return std::unexpected(selection.error());
  if (state.permission == RefinePermission::automatic) {
    if (auto refined = refine_seams(); !refined) return refined;
  }
  int refinements = 0;
  for (int k = 0; k < count; ++k) {
    ModelInput input = model_input(state, evolve);
    if (!cache || !(cache->input == input)) {
      cache.reset();
      auto made = make_model(state, std::move(input));
      if (!made) return std::unexpected(made.error());
      cache = std::move(*made);
    }
    const ActiveSurface& model = cache->model;
    const auto tools = all_tools();
    if (!tools) return std::unexpected(tools.error());
    auto loads = active_loads(state, model);
    if (!loads) return std::unexpected(loads.error());
    loads->points.insert(loads->points.end(), more.begin(), more.end());
    const ActiveState before = active_state(state);
    if (!state.energy_before) state.energy_before = model.energy(before);
    const auto start = std::chrono::steady_clock::now();
    auto step = model.step(before, *tools, *loads);
    if (!step) return std::unexpected(step.error());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    std::string note = step->note;
    if (step->coarseness > coarse) {
      if (state.permission == RefinePermission::automatic && refinements < max_refinements && more.empty()) {
        bool any = false;
        for (const Tool& tool : state.tools) {
          auto refined = refine_under(tool);
          if (!refined) return std::unexpected(refined.error());
          any = any || *refined;
        }
        if (any) {  // this step again, on the finer net
          ++refinements;
          --k;
          continue;
        }
      }
      if (note.empty() && step->coarseness > too_coarse) {
        note = fmt::format(
            "the net is too coarse to follow the tool: its spans are up to {:.2g} times the tool's size; "
            "halve them {} with {{\"do\":\"refine\",\"under\":\"…\"}}",
            step->coarseness,
            halvings(step->coarseness) == 1 ? "once" : fmt::format("{} times", halvings(step->coarseness)));
      }
    }
    Eigen::Index first = 0;
    const bool imprinting =
        step->gap > 0 && std::ranges::any_of(state.tools, [](const Tool& t) { return t.mode == ToolMode::imprint; });
    for (int index : state.selection()) {
      SurfaceState& s = state.surfaces[static_cast<std::size_t>(index)];
      const Eigen::Index n = s.current->size();
      auto moved = s.current->with_control_points(step->control_points.middleRows(first, n));
      if (!moved) return std::unexpected(moved.error());
      if (moved->control_points() != s.current->control_points()) {
        s.current = std::make_shared<const Surface>(std::move(*moved));
      }
      s.velocity = step->velocity.rows() > 0 ? Points(step->velocity.middleRows(first, n)) : Points(0, 3);
      if (imprinting) s.rest = s.current;
      first += n;
    }
    StepRecord record;
    record.surface = *state.selected;
    record.time = seconds;
    record.energy = step->energy;
    record.stretch = step->stretch;
    record.bend = step->bend;
    record.kinetic = step->kinetic;
    record.contact = step->contact;
    record.residual = step->residual;
    for (int index : state.selection()) {
      const SurfaceState& s = state.surfaces[static_cast<std::size_t>(index)];
      record.largest_displacement = std::max(record.largest_displacement, largest_distance(*s.current, *s.opened));
    }
    record.gap = step->gap;
    record.violation = step->violation;
    record.iterations = step->iterations;
    record.converged = step->converged;
    record.limited = step->limited;
    record.note = std::move(note);
    state.steps.push_back(std::move(record));
    if (progress) progress(done + k + 1, total > 0 ? total : count);
  }
  if (cache) {
    state.seam_reports = cache->seams;
    for (const std::string& note : cache->notes) {
      if (std::ranges::find(state.notes, note) == state.notes.end()) state.notes.push_back(note);
    }
  }
  return {};
}

Expected<void> Executor::yield(double plasticity) {
  if (plasticity == 0) return {};
  for (int index : state.selection()) {
    SurfaceState& s = state.surfaces[static_cast<std::size_t>(index)];
    if (plasticity == 1) {
      s.rest = s.current;
      continue;
    }
    auto rest = s.rest->with_control_points(s.rest->control_points() +
                                            plasticity * (s.current->control_points() - s.rest->control_points()));
    if (!rest) return std::unexpected(rest.error());
    s.rest = std::make_shared<const Surface>(std::move(*rest));
  }
  return {};
}

Expected<void> Executor::operator()(const EvolveCommand& c) {
  if (!(std::isfinite(c.lambda) && c.lambda >= 0)) {
    return input_error(fmt::format("{} is not a step parameter", c.lambda), "lambda", "use a finite number >= 0");
  }
  if (!(std::isfinite(c.time_step) && c.time_step > 0)) {
    return input_error(fmt::format("{} is not a time step", c.time_step), "time_step", "use a finite number > 0");
  }
  if (c.mode == Evolution::stationary) {
    if (auto done = run(1, c); !done) return done;
  }
  state.evolve = c;
  return {};
}

Expected<void> Executor::operator()(const StepCommand& c) {
  if (c.count < 0) return input_error(fmt::format("{} steps cannot be done", c.count), "count", "use 0 or more");
  EvolveCommand evolve = state.evolve;
  if (c.lambda) evolve.lambda = *c.lambda;
  if (c.weight) evolve.weight = *c.weight;
  return run(c.count, evolve);
}

Expected<void> Executor::operator()(const StrokeCommand& c) {
  auto tool = find_tool(c.tool);
  if (!tool) return std::unexpected(tool.error());
  if (c.path.empty()) return input_error("the path has no positions", "path", "give one or more: [[x, y, z], ...]");
  if (c.steps < 1) return input_error(fmt::format("{} steps are too few", c.steps), "steps", "use 1 or more");
  if (!(c.plasticity >= 0 && c.plasticity <= 1)) {
    return input_error(fmt::format("{} is not a plasticity", c.plasticity), "plasticity", "use a number from 0 to 1");
  }
  const auto length = diagonal();
  if (!length) return std::unexpected(length.error());
  const PlacedShape before = (*tool)->shape;
  const Placement& at = before.placement();
  const auto index = static_cast<std::size_t>(*tool - state.tools.data());
  const int total = c.steps * static_cast<int>(c.path.size());
  for (std::size_t k = 0; k < c.path.size(); ++k) {
    const Point given(c.path[k][0], c.path[k][1], c.path[k][2]);
    auto moved = before.moved(at.rotation, c.relative ? Point(at.position + *length * given) : given);
    if (!moved) return std::unexpected(moved.error().within(fmt::format("path[{}]", k)));
    state.tools[index].shape = std::move(*moved);
    if (auto done = run(c.steps, state.evolve, {}, static_cast<int>(k) * c.steps, total); !done) return done;
  }
  state.tools[index].shape = before;
  return yield(c.plasticity);
}

Expected<void> Executor::operator()(const DragCommand& c) {
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  if (c.steps < 1) return input_error(fmt::format("{} steps are too few", c.steps), "steps", "use 1 or more");
  if (!(c.plasticity >= 0 && c.plasticity <= 1)) {
    return input_error(fmt::format("{} is not a plasticity", c.plasticity), "plasticity", "use a number from 0 to 1");
  }
  if (!(c.strength >= 0 && c.strength <= max_tool_stiffness)) {
    return input_error(fmt::format("{} is not a strength", c.strength), "strength",
                       fmt::format("use a number from 0 to {}", max_tool_stiffness));
  }
  const auto length = diagonal();
  if (!length) return std::unexpected(length.error());
  const double unit = c.relative ? *length : 1, radius = c.radius ? *c.radius * unit : 0.1 * *length;
  if (!(std::isfinite(radius) && radius > 0)) {
    return input_error(fmt::format("{} is not a radius", radius), "radius", "use a number > 0");
  }
  const auto grip = footprint(*(*surface)->current, c.at, radius, c.strength);
  if (!grip) return std::unexpected(grip.error());
  for (int k = 0; k < c.steps; ++k) {
    std::vector<PointForce> forces = *grip;
    const double share = static_cast<double>(k + 1) / c.steps;
    for (PointForce& force : forces) force.to += share * unit * Point(c.by[0], c.by[1], c.by[2]);
    if (auto done = run(1, state.evolve, forces, k, c.steps); !done) return done;
  }
  return yield(c.plasticity);
}

}  // namespace knead
