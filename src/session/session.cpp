#include "knead/session/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {
namespace {

std::vector<bool> fixed_control_points(const SurfaceState& surface) {
  const auto [m, n] = surface.rest->net();
  std::vector<bool> fixed;
  const int rows = surface.hold_rows;
  if (rows == 0 && surface.pins.empty()) return fixed;
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) fixed.push_back(i < rows || i >= m - rows || j < rows || j >= n - rows);
  }
  for (const auto& [i, j] : surface.pins) {
    fixed[static_cast<std::size_t>(i) * static_cast<std::size_t>(n) + static_cast<std::size_t>(j)] = true;
  }
  return fixed;
}

double detail_of(const std::vector<Tool>& tools) {
  double detail = 0;
  for (const Tool& t : tools) {
    const double size = t.mode == ToolMode::proximity ? std::min(t.shape.radius, t.range) : t.shape.radius;
    if (detail == 0 || size < detail) detail = size;
  }
  return detail;
}

}  // namespace

/// Applies one command to a copy of the state.
struct Session::Executor {
  Session& session;
  SessionState& state;
  const Progress& progress;

  Expected<SurfaceState*> selected() {
    if (!state.selected) {
      const std::size_t count = session.document_.surfaces().size();
      if (count == 0) {
        return input_error("the file has no B-spline surface that could be sculpted", session.document_.name());
      }
      return input_error(fmt::format("none of the {} surfaces is selected", count), {},
                         fmt::format(R"(select one first: {{"do":"select","surface":"{}"}})",
                                     session.document_.surfaces().front().id));
    }
    return &state.surfaces[static_cast<std::size_t>(*state.selected)];
  }

  Expected<Tool*> find_tool(const std::optional<std::string>& name) {
    std::string known;
    for (Tool& t : state.tools) {
      if (name ? t.name == *name : state.tools.size() == 1) return &t;
      known += (known.empty() ? "" : ", ") + t.name;
    }
    if (known.empty()) return input_error("there is no tool", "tool", "make one first with the command tool");
    return input_error(name ? fmt::format("there is no tool \"{}\"", *name) : "which tool is not said", "tool",
                       "the tools are: " + known);
  }

  Expected<void> operator()(const SelectCommand& c) {
    auto index = session.document_.find_surface(c.surface);
    if (!index) return std::unexpected(index.error());
    state.selected = *index;
    return {};
  }

  Expected<void> operator()(const MaterialCommand& c) {
    auto surface = selected();
    if (!surface) return std::unexpected(surface.error());
    auto material = validated(c.material);
    if (!material) return std::unexpected(material.error());
    (*surface)->material = *material;
    return {};
  }

  Expected<void> operator()(const RestCommand& c) {
    auto surface = selected();
    if (!surface) return std::unexpected(surface.error());
    (*surface)->rest = (*surface)->current;
    (*surface)->mode = c.mode;
    return {};
  }

  Expected<void> operator()(const HoldCommand& c) {
    auto surface = selected();
    if (!surface) return std::unexpected(surface.error());
    if (c.rows < 0) return input_error(fmt::format("{} rows cannot be held", c.rows), "rows", "use 0 or more");
    (*surface)->hold_rows = c.rows;
    return {};
  }

  Expected<void> operator()(const PinCommand& c) {
    auto surface = selected();
    if (!surface) return std::unexpected(surface.error());
    const auto [m, n] = (*surface)->rest->net();
    for (std::size_t k = 0; k < c.control_points.size(); ++k) {
      const auto [i, j] = c.control_points[k];
      if (i < 0 || i >= m || j < 0 || j >= n) {
        return input_error(fmt::format("there is no control point [{}, {}]", i, j),
                           fmt::format("control_points[{}]", k),
                           fmt::format("the net is {} by {}, counted from 0", m, n));
      }
      (*surface)->pins.insert({i, j});
    }
    return {};
  }

  Expected<void> operator()(const ReleaseCommand&) {
    auto surface = selected();
    if (!surface) return std::unexpected(surface.error());
    (*surface)->hold_rows = 0;
    (*surface)->pins.clear();
    return {};
  }

  Expected<void> operator()(const ToolCommand& c) {
    auto surface = selected();
    if (!surface) return std::unexpected(surface.error());
    if (c.shape != "sphere") {
      return input_error(fmt::format("\"{}\" is not a shape", c.shape), "shape", "the shapes are: sphere");
    }
    if (c.position.has_value() == c.at.has_value()) {
      return input_error(c.at ? "both position and at are given" : "neither position nor at is given", "position",
                         "give one of them");
    }
    const double diagonal = diagonal_of(**surface), unit = c.relative ? diagonal : 1;
    const double stiffness = c.stiffness.value_or(c.mode == ToolMode::collision ? 1e4 : 100);
    Tool made{c.name, {}, c.mode, stiffness, 0};
    made.shape.radius = c.radius ? *c.radius * unit : 0.1 * diagonal;
    made.range = c.range ? *c.range * unit : 0.5 * made.shape.radius;
    if (c.position) {
      for (int k = 0; k < 3; ++k) made.shape.centre[k] = (*c.position)[static_cast<std::size_t>(k)] * unit;
    } else {
      auto point = point_at(*(*surface)->current, *c.at);
      if (!point) return std::unexpected(point.error());
      made.shape.centre = *point;
    }
    auto tool = validated(made);
    if (!tool) return std::unexpected(tool.error());
    const auto same = std::ranges::find(state.tools, c.name, [](const Tool& t) { return t.name; });
    if (same != state.tools.end()) {
      *same = made;
    } else {
      state.tools.push_back(made);
    }
    return {};
  }

  Expected<void> operator()(const RemoveCommand& c) {
    auto tool = find_tool(c.tool);
    if (!tool) return std::unexpected(tool.error());
    state.tools.erase(state.tools.begin() + (*tool - state.tools.data()));
    return {};
  }

  Expected<void> operator()(const MoveCommand& c) {
    auto tool = find_tool(c.tool);
    if (!tool) return std::unexpected(tool.error());
    double unit = 1;
    if (c.relative) {
      auto surface = selected();
      if (!surface) return std::unexpected(surface.error());
      unit = diagonal_of(**surface);
    }
    Tool moved = **tool;
    for (int k = 0; k < 3; ++k) moved.shape.centre[k] += c.by[static_cast<std::size_t>(k)] * unit;
    auto checked = validated(moved);
    if (!checked) return std::unexpected(checked.error());
    **tool = moved;
    return {};
  }

  Expected<void> operator()(const StepCommand& c) {
    auto selection = selected();
    if (!selection) return std::unexpected(selection.error());
    if (c.count < 0) return input_error(fmt::format("{} steps cannot be done", c.count), "count", "use 0 or more");
    SurfaceState& surface = **selection;
    const auto model = session.model_of(surface, state.tools, c.lambda, c.weight);
    if (!model) return std::unexpected(model.error());
    if (!state.energy_before) state.energy_before = model->energy(surface.current->control_points());
    for (int k = 0; k < c.count; ++k) {
      const auto start = std::chrono::steady_clock::now();
      auto step = model->step(surface.current->control_points(), state.tools);
      if (!step) return std::unexpected(step.error());
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      auto moved = surface.current->with_control_points(std::move(step->control_points));
      if (!moved) return std::unexpected(moved.error());
      surface.current = std::make_shared<const Surface>(std::move(*moved));
      state.steps.push_back({*state.selected, seconds, step->energy, step->residual,
                             session.displacement_of(*state.selected, *surface.current), step->iterations,
                             step->converged});
      if (progress) progress(k + 1, c.count);
    }
    return {};
  }

  Expected<void> operator()(const UndoCommand&) { return {}; }
  Expected<void> operator()(const RedoCommand&) { return {}; }

  static double diagonal_of(const SurfaceState& surface) { return bounding_box(*surface.rest).diagonal(); }

  static Expected<Point> point_at(const Surface& surface, const std::array<double, 2>& at) {
    std::array<double, 2> u;
    for (std::size_t d = 0; d < 2; ++d) {
      if (!(at[d] >= 0 && at[d] <= 1)) {
        return input_error(fmt::format("{} is not a fraction of the domain", at[d]), "at", "use numbers from 0 to 1");
      }
      const Interval domain = surface.knots()[d].domain();
      u[d] = std::min(domain.lower + at[d] * domain.length(), domain.upper);
    }
    return evaluate_point<2>(surface, u);
  }
};

Session::Session(Document document) : document_(std::move(document)) {
  auto state = std::make_shared<SessionState>();
  for (const DocumentSurface& s : document_.surfaces()) {
    state->surfaces.push_back({s.surface, s.surface, RestMode::shape, {}, 0, {}});
  }
  if (state->surfaces.size() == 1) state->selected = 0;
  states_.push_back(std::move(state));
}

Expected<void> Session::execute(const Command& command, const Progress& progress) {
  if (std::holds_alternative<UndoCommand>(command)) {
    if (!can_undo()) return input_error("there is nothing to undo");
    --position_;
    return {};
  }
  if (std::holds_alternative<RedoCommand>(command)) {
    if (!can_redo()) return input_error("there is nothing to redo");
    ++position_;
    return {};
  }
  auto next = std::make_shared<SessionState>(state());
  if (auto done = std::visit(Executor{*this, *next, progress}, command); !done) return done;
  states_.resize(position_ + 1);
  commands_.resize(position_, command);
  states_.push_back(std::move(next));
  commands_.push_back(command);
  ++position_;
  return {};
}

std::vector<Command> Session::journal() const {
  return {commands_.begin(), commands_.begin() + static_cast<std::ptrdiff_t>(position_)};
}

Expected<ActiveSurface> Session::model_of(const SurfaceState& surface, const std::vector<Tool>& tools, double lambda,
                                          StepWeight weight) {
  ActiveSettings<2> settings;
  settings.material = surface.material;
  settings.rest = surface.mode;
  settings.weight = weight;
  settings.lambda = lambda;
  settings.fixed = fixed_control_points(surface);
  settings.detail = detail_of(tools);
  if (cache_ && cache_->rest == surface.rest && cache_->model.settings() == settings) return cache_->model;
  auto model = ActiveSurface::create(*surface.rest, settings);
  if (!model) return std::unexpected(model.error());
  cache_ = CachedModel{surface.rest, *model};
  return *model;
}

Expected<double> Session::energy() {
  if (!state().selected) return 0;
  const SurfaceState& surface = state().surfaces[static_cast<std::size_t>(*state().selected)];
  if (surface.mode == RestMode::shape && surface.current == surface.rest) return 0;  // also where no model can be made
  // The energy does not depend on lambda; a large one makes a model of whatever can be stepped at all.
  constexpr double lambda = 1e6;
  const auto model = cache_ && cache_->rest == surface.rest && cache_->model.settings().material == surface.material &&
                             cache_->model.settings().rest == surface.mode
                         ? Expected<ActiveSurface>(cache_->model)
                         : model_of(surface, {}, lambda, StepWeight::mass);
  if (!model) return std::unexpected(model.error());
  return model->energy(surface.current->control_points());
}

double Session::displacement_of(int surface, const Surface& current) const {
  const Surface& opened = *document_.surfaces()[static_cast<std::size_t>(surface)].surface;
  const auto field = current.with_control_points(current.control_points() - opened.control_points());
  return field ? largest_norm(*field).value : std::nan("");
}

double Session::largest_displacement(int surface) const {
  return displacement_of(surface, *state().surfaces[static_cast<std::size_t>(surface)].current);
}

int Session::moved_control_points(int surface) const {
  const Points& opened = document_.surfaces()[static_cast<std::size_t>(surface)].surface->control_points();
  const Points& current = state().surfaces[static_cast<std::size_t>(surface)].current->control_points();
  int moved = 0;
  for (Eigen::Index i = 0; i < opened.rows(); ++i) {
    moved += std::memcmp(opened.data() + 3 * i, current.data() + 3 * i, 3 * sizeof(double)) != 0;
  }
  return moved;
}

Expected<std::string> Session::save() const {
  std::vector<std::shared_ptr<const Surface>> surfaces;
  for (const SurfaceState& s : state().surfaces) surfaces.push_back(s.current);
  return document_.save(surfaces);
}

}  // namespace knead
