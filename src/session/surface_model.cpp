#include "surface_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knead/sculpt/constraints.hpp"
#include "knead/session/held_points.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {
namespace {

constexpr double pole_tolerance = 1e-9;  // of the surface's size
constexpr double pole_flatness = 1e-6;

double detail_of(const std::vector<Tool>& tools) {
  double detail = 0;
  for (const Tool& t : tools) {
    double size = t.shape.size();
    if (!t.collides()) size = std::min(size, t.range);
    if (std::isfinite(size) && (detail == 0 || size < detail)) detail = size;
  }
  return detail;
}

/// Appends what one request asks for.
struct Asked {
  const SurfaceState& surface;
  const Surface& where;
  ConstraintList& list;

  Expected<void> operator()(const EdgeCommand& c) const {
    if (c.hold == EdgeHold::free) return {};
    const int order = c.hold == EdgeHold::position ? 0 : c.hold == EdgeHold::clamped ? 1 : 2;
    return holding([&]() -> Expected<void> {
      for (SurfaceEdge edge : edges_of(c.which)) {
        if (auto done = hold_edge(*surface.rest, edge, order, list); !done) return done;
      }
      return {};
    });
  }

  Expected<void> operator()(const PinCommand& c) const {
    if (!c.at) return {};
    const auto u = parameters_at(*surface.rest, *c.at);
    if (!u) return std::unexpected(u.error());
    if (c.to) return pin_point(*surface.rest, (*u)[0], (*u)[1], Point((*c.to)[0], (*c.to)[1], (*c.to)[2]), list);
    return holding([&] { return pin_point(*surface.rest, (*u)[0], (*u)[1], std::nullopt, list); });
  }

  Expected<void> operator()(const FreezeCommand& c) const {
    const auto region = region_at(*surface.rest, c.region);
    if (!region) return std::unexpected(region.error());
    const auto frozen = freeze_region(*surface.rest, (*region)[0], (*region)[1], list);
    if (!frozen) return std::unexpected(frozen.error());
    return {};
  }

  Expected<void> operator()(const KeepCommand& c) const {
    return holding([&]() -> Expected<void> {
      for (int direction = 0; direction < 2; ++direction) {
        const std::optional<double>& line = direction == 0 ? c.u : c.v;
        if (!line) continue;
        Fractions at = {0, 0};
        at[static_cast<std::size_t>(direction)] = *line;
        const auto u = parameters_at(*surface.rest, at, direction == 0 ? "u" : "v");
        if (!u) return std::unexpected(u.error());
        auto done = hold_isoline(*surface.rest, direction, (*u)[static_cast<std::size_t>(direction)], 0, list);
        if (!done) return done;
      }
      if (c.curve.empty()) return {};
      Parameters<2> polyline(static_cast<Eigen::Index>(c.curve.size()), 2);
      for (std::size_t k = 0; k < c.curve.size(); ++k) {
        const auto u = parameters_at(*surface.rest, c.curve[k], "curve");
        if (!u) return std::unexpected(u.error());
        polyline.row(static_cast<Eigen::Index>(k)) << (*u)[0], (*u)[1];
      }
      const auto kept = keep_curve(*surface.rest, polyline, c.tolerance, list);
      if (!kept) return std::unexpected(kept.error());
      return {};
    });
  }

  Expected<void> operator()(const SymmetryCommand& c) const { return symmetry_constraints(surface, c, list); }

 private:
  /// What `f` appends is held where it was when that was asked for, not where it is at rest.
  template <class F>
  Expected<void> holding(const F& f) const {
    const std::size_t first = list.constraints.size();
    if (auto done = f(); !done) return done;
    keep_present(list, where.control_points() - surface.rest->control_points(), first);
    return {};
  }
};

/// Rows and control points that are held by their numbers.
void hold_numbered(const SurfaceState& s, ConstraintList& list) {
  const auto [m, n] = s.reference->net();
  const int rows = s.hold_rows;
  for (int i = 0; i < m && rows > 0; ++i) {
    for (int j = 0; j < n; ++j) {
      if (i < rows || i >= m - rows || j < rows || j >= n - rows) list.hold(i * n + j, "hold");
    }
  }
  for (const auto& [i, j] : s.pins) list.hold(i * n + j, fmt::format("pin ({}, {})", i, j));
}

/// All constraints on one surface; terms count its own control points.
Expected<ConstraintList> constraints_of(const SurfaceState& s, std::vector<std::string>& notes) {
  ConstraintList list(s.reference->size());
  hold_numbered(s, list);
  for (const auto& [request, where] : s.constraints) {
    if (auto done = std::visit(Asked{s, *where, list}, request); !done) return std::unexpected(done.error());
  }
  if (s.mode == RestMode::none) return list;  // the energy acts on the shape itself: there is no rest to stay smooth to
  if (s.smooth_knot_lines) {
    const auto lines = keep_smooth(*s.reference, {}, list);
    if (!lines) return std::unexpected(lines.error());
    for (const SmoothLine& line : *lines) {
      if (line.state == SmoothLine::State::crease) {
        notes.push_back(
            fmt::format("{}: the crease at {} = {:.6g} may bend", s.id, line.direction == 0 ? "u" : "v", line.knot));
      }
    }
  }
  if (s.smooth_poles) {
    const double size = bounding_box(*s.reference).diagonal();
    const auto poles = keep_poles(*s.reference, pole_tolerance * size, pole_flatness, list);
    if (!poles) return std::unexpected(poles.error());
  }
  return list;
}

}  // namespace

Expected<std::vector<std::uint8_t>> held_points(const SurfaceState& surface) {
  ConstraintList list(surface.reference->size());
  hold_numbered(surface, list);
  for (const auto& [request, where] : surface.constraints) {
    if (std::holds_alternative<SymmetryCommand>(request)) continue;
    if (auto done = std::visit(Asked{surface, *where, list}, request); !done) return std::unexpected(done.error());
  }
  std::vector<std::uint8_t> held(list.held.size(), 0);
  for (const LinearConstraint& c : list.constraints) {
    for (const auto& [row, coefficient] : c.terms) {
      if (coefficient != 0) held[static_cast<std::size_t>(row)] = 2;
    }
  }
  for (std::size_t k = 0; k < held.size(); ++k) {
    if (list.held[k]) held[k] = 1;
  }
  return held;
}

std::vector<int> SessionState::selection() const {
  std::vector<int> result;
  if (selected) result.push_back(*selected);
  result.insert(result.end(), together.begin(), together.end());
  return result;
}

Expected<FoundSeams> seams_between(const SessionState& state, std::span<const Surface* const> patches) {
  const double tolerance = state.seams.tolerance.value_or(suggested_seam_tolerance(patches));
  if (tolerance == 0) return FoundSeams{};  // surfaces that are one point
  return find_seams(patches, tolerance);
}

ModelInput model_input(const SessionState& state, const EvolveCommand& evolve) {
  ModelInput input;
  bool places = false;
  for (int k : state.selection()) places = places || !state.surfaces[static_cast<std::size_t>(k)].constraints.empty();
  for (int k : state.selection()) {
    const SurfaceState& s = state.surfaces[static_cast<std::size_t>(k)];
    input.references.push_back(s.reference);
    if (places) input.rests.push_back(s.rest);
    input.modes.push_back(s.mode);
    input.materials.push_back(s.material);
    input.hold_rows.push_back(s.hold_rows);
    input.pins.push_back(s.pins);
    input.constraints.push_back(s.constraints);
    input.smooth.push_back({s.smooth_knot_lines, s.smooth_poles});
  }
  input.seams = state.seams;
  input.scaling = state.scaling;
  input.evolve = evolve;
  input.detail = detail_of(state.tools);
  return input;
}

Expected<SurfaceModel> make_model(const SessionState& state, ModelInput input) {
  ActiveSettings<2> settings;
  std::vector<std::string> notes;
  std::vector<Surface> patches;
  std::vector<const Surface*> pointers;
  std::vector<int> rows = {0};
  bool varying = false;
  for (int k : state.selection()) {
    const SurfaceState& s = state.surfaces[static_cast<std::size_t>(k)];
    if (s.mode != input.modes.front()) {
      return input_error("surfaces that are selected together have different rest modes", "rest",
                         "give `rest` once with all of them selected");
    }
    auto list = constraints_of(s, notes);
    if (!list) return std::unexpected(list.error());
    settings.held.insert(settings.held.end(), list->held.begin(), list->held.end());
    for (LinearConstraint& c : list->constraints) {
      for (auto& term : c.terms) term.first += rows.back();
      if (state.together.size() > 0) c.name = s.id + ": " + c.name;
      settings.constraints.push_back(std::move(c));
    }
    for (const Coefficient<2>& c : s.material.alpha) varying = varying || !std::holds_alternative<double>(c);
    for (const Coefficient<2>& c : s.material.beta) varying = varying || !std::holds_alternative<double>(c);
    varying = varying || !std::holds_alternative<double>(s.material.mass) ||
              !std::holds_alternative<double>(s.material.damping);
    varying = varying || !(s.material == input.materials.front());
    patches.push_back(*s.reference);
    pointers.push_back(s.reference.get());
    rows.push_back(rows.back() + s.reference->size());
  }
  if (std::ranges::none_of(settings.held, [](bool f) { return f; })) settings.held.clear();

  std::vector<SeamReport> reports;
  if (state.seams.couple) {
    const auto found = seams_between(state, pointers);
    if (!found) return std::unexpected(found.error());
    auto coupled = couple_seams(pointers, rows, found->seams);
    if (!coupled) return std::unexpected(coupled.error());
    settings.constraints.insert(settings.constraints.end(), coupled->constraints.begin(), coupled->constraints.end());
    reports = std::move(coupled->reports);
    const std::vector<int> selection = state.selection();
    for (SeamReport& report : reports) {
      for (PatchEdge* edge : {&report.seam.a, &report.seam.b})
        edge->patch = selection[static_cast<std::size_t>(edge->patch)];
    }
  }

  const MaterialFieldOf<2>& material = input.materials.front();
  if (varying) {
    settings.fields = input.materials;
  } else {
    for (std::size_t k = 0; k < 3; ++k) {
      settings.material.alpha[k] = std::get<double>(material.alpha[k]);
      settings.material.beta[k] = std::get<double>(material.beta[k]);
    }
    settings.mass = std::get<double>(material.mass);
    settings.damping = std::get<double>(material.damping);
  }
  settings.rest = input.modes.front();
  settings.evolution = input.evolve.mode;
  settings.weight = input.evolve.weight;
  settings.lambda = input.evolve.lambda;
  settings.time_step = input.evolve.time_step;
  settings.route = input.evolve.route;
  settings.raw = input.scaling == ScalingMode::raw;
  settings.detail = input.detail;
  auto model = ActiveSurface::create(std::move(patches), settings);
  if (!model) return std::unexpected(model.error());
  return SurfaceModel{std::move(input), std::move(*model), std::move(reports), std::move(notes)};
}

}  // namespace knead
