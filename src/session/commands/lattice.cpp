#include "lattice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../limits.hpp"
#include "knead/scene/lattice.hpp"

namespace knead {

void describe(LatticeCommand& c, Fields& fields) {
  fields.name("lattice", "deform the surfaces with an elastic block of space that the tools act on");
  fields.add("net", c.net, {.help = "control points of the block along x, y, z"});
  fields.add("degree", c.degree, {.help = "along x, y, z"});
  fields.add("margin", c.margin,
             {.help = "how far the block reaches beyond the control points, as a share of their diagonal",
              .unit = Unit::fraction});
  fields.add("steps", c.steps, {.help = "number of steps"});
  fields.add("lambda", c.lambda, {.help = "inverse step size"});
  fields.add(
      "hold", c.hold,
      {.help =
           "faces of the block that stay: `\"u0\"`, `\"u1\"` (ends along x), `\"v0\"`, `\"v1\"`, `\"w0\"`, `\"w1\"`"});
  fields.add("which", c.which,
             {.help = "control points of the block that are moved by hand; that of indices i, j, k along x, y, z is "
                      "`(i · net[1] + j) · net[2] + k`"});
  fields.add("by", c.by, {.help = "how far these are moved; tools do not act then", .unit = Unit::length});
}

namespace {

/// The control points of the block after tools have acted on it.
Expected<Points> pressed(Executor& executor, const LatticeCommand& c, const Lattice& lattice) {
  auto held = lattice.faces(c.hold, 1);
  if (!held) return std::unexpected(held.error());
  const auto tools = tools_and_images(executor.state);
  if (!tools) return std::unexpected(tools.error());
  ActiveSettings<3> settings;
  settings.lambda = c.lambda;
  if (!c.hold.empty()) settings.held = std::move(*held);
  for (const Tool& tool : *tools) {
    const double size = tool.collides() ? tool.shape.size() : std::min(tool.shape.size(), tool.range);
    if (std::isfinite(size) && (settings.detail == 0 || size < settings.detail)) settings.detail = size;
  }
  const auto model = ActiveSpline<3>::create(lattice.rest(), settings);
  if (!model) return std::unexpected(model.error());
  ActiveState active{lattice.rest().control_points()};
  for (int k = 0; k < c.steps; ++k) {
    auto step = model->step(active, *tools);
    if (!step) return std::unexpected(step.error());
    active.control_points = std::move(step->control_points);
    if (auto on = executor.carries_on(k + 1, c.steps); !on) return std::unexpected(on.error());
  }
  return std::move(active.control_points);
}

/// The same after the user's hand has moved some.
Expected<Points> moved_by_hand(const LatticeCommand& c, const Lattice& lattice) {
  const int count = lattice.rest().size();
  if (c.which.empty()) return input_error("no control points are named", "which", "give their numbers, counted from 0");
  if (!c.by) return input_error("nothing says how far they are moved", "by", "give [dx, dy, dz]");
  const Eigen::RowVector3d by(c.by->data());
  if (!by.allFinite()) return input_error("the move is not finite", "by", "give three numbers");
  std::vector<bool> moved(static_cast<std::size_t>(count), false);
  Points points = lattice.rest().control_points();
  for (std::size_t k = 0; k < c.which.size(); ++k) {
    const int number = c.which[k];
    if (number < 0 || number >= count) {
      return input_error(fmt::format("the block has no control point {}", number), fmt::format("which[{}]", k),
                         fmt::format("use numbers from 0 to {}", count - 1));
    }
    if (!moved[static_cast<std::size_t>(number)]) points.row(number) += by;
    moved[static_cast<std::size_t>(number)] = true;
  }
  return points;
}

}  // namespace

template <>
Expected<void> Executor::execute(const LatticeCommand& c) {
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  if (auto few = check_steps(c.steps, "steps"); !few) return few;
  const auto lattice = lattice_around_selection(state, c.margin, c.degree, c.net);
  if (!lattice) return std::unexpected(lattice.error());
  const bool by_hand = !c.which.empty() || c.by.has_value();
  if (by_hand && !c.hold.empty()) return input_error("faces hold against tools only", "hold", "leave it out, or which");
  const auto after = by_hand ? moved_by_hand(c, *lattice) : pressed(*this, c, *lattice);
  if (!after) return std::unexpected(after.error());
  for (int index : state.selection()) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(index)];
    const auto points = lattice->deformed(s.current->control_points(), *after);
    if (!points) return std::unexpected(points.error());
    auto moved = s.current->with_control_points(*points);
    if (!moved) return std::unexpected(moved.error());
    s.current = s.rest = std::make_shared<const Surface>(std::move(*moved));  // the block carries the energy, not they
    s.velocity.resize(0, 3);
  }
  return {};
}

}  // namespace knead
