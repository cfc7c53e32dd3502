#include "lattice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../limits.hpp"
#include "knead/sculpt/lattice.hpp"

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
}

template <>
Expected<void> Executor::execute(const LatticeCommand& c) {
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  if (auto few = check_steps(c.steps, "steps"); !few) return few;
  // The lattice moves control points, so it must contain all of them.
  BoundingBox box;
  bool first = true;
  for (int index : state.selection()) {
    const Points& points = state.surfaces[static_cast<std::size_t>(index)].current->control_points();
    const Point lower = points.colwise().minCoeff().transpose(), upper = points.colwise().maxCoeff().transpose();
    box.lower = first ? lower : Point(box.lower.cwiseMin(lower));
    box.upper = first ? upper : Point(box.upper.cwiseMax(upper));
    first = false;
  }
  const auto lattice = Lattice::create(box, c.margin, c.degree, c.net);
  if (!lattice) return std::unexpected(lattice.error());
  auto held = lattice->faces(c.hold, 1);
  if (!held) return std::unexpected(held.error());
  const auto tools = tools_and_images(state);
  if (!tools) return std::unexpected(tools.error());
  ActiveSettings<3> settings;
  settings.lambda = c.lambda;
  if (!c.hold.empty()) settings.held = std::move(*held);
  for (const Tool& tool : *tools) {
    const double size = tool.collides() ? tool.shape.size() : std::min(tool.shape.size(), tool.range);
    if (std::isfinite(size) && (settings.detail == 0 || size < settings.detail)) settings.detail = size;
  }
  const auto model = ActiveSpline<3>::create(lattice->rest(), settings);
  if (!model) return std::unexpected(model.error());
  ActiveState active{lattice->rest().control_points()};
  for (int k = 0; k < c.steps; ++k) {
    auto step = model->step(active, *tools);
    if (!step) return std::unexpected(step.error());
    active.control_points = std::move(step->control_points);
    if (auto on = carries_on(k + 1, c.steps); !on) return std::unexpected(on.error());
  }
  for (int index : state.selection()) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(index)];
    const auto points = lattice->deformed(s.current->control_points(), active.control_points);
    if (!points) return std::unexpected(points.error());
    auto moved = s.current->with_control_points(*points);
    if (!moved) return std::unexpected(moved.error());
    s.current = s.rest = std::make_shared<const Surface>(std::move(*moved));  // the block carries the energy, not they
    s.velocity.resize(0, 3);
  }
  return {};
}

}  // namespace knead
