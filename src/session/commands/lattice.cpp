#include "lattice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "scene/lattice.hpp"
#include "scene/trims.hpp"
#include "session/acts/data_moving.hpp"
#include "session/acts/limits.hpp"
#include "session/acts/placing.hpp"
#include "session/acts/refining.hpp"
#include "session/acts/selection.hpp"
#include "session/acts/stepping.hpp"

namespace knead {

static constexpr Choice block_faces[] = {{"u0", "the first end along x"}, {"u1", "the last"},
                                         {"v0", "the first along y"},     {"v1", "the last"},
                                         {"w0", "the first along z"},     {"w1", "the last"}};

void describe(LatticeCommand& c, Fields& fields) {
  fields.name("lattice",
              "deform the surfaces with an elastic block of space that the tools act on");
  fields.add("net", c.net, {.help = "control points of the block along x, y, z"});
  fields.add("degree", c.degree, {.help = "along x, y, z"});
  fields.add(
      "margin", c.margin,
      {.help = "how far the block reaches beyond the control points, as a share of their diagonal",
       .unit = Unit::fraction});
  fields.add("steps", c.steps, {.help = "number of steps", .range = between(1, max_steps)});
  fields.add("lambda", c.lambda, {.help = "inverse step size", .range = at_least(0)});
  fields.add("hold", c.hold, {.help = "faces of the block that stay", .choices = block_faces});
  fields.add("which", c.which,
             {.help = "control points of the block that are moved by hand; that of indices i, j, k "
                      "along x, y, z is `(i · net[1] + j) · net[2] + k`"});
  fields.add("by", c.by,
             {.help = "how far these are moved; tools do not act then", .unit = Unit::length});
  fields.add("again", c.again,
             {.help = "go on with the block of the `lattice` before: its control points are moved "
                      "from where they were pulled, and deform the shapes that it was put round. "
                      "Net, degree, margin and selection are the same, and nothing else has "
                      "changed the surfaces since"});
  describe_allowance(c.allow, fields);
}

namespace {

/// The control points of the block after tools have acted on it.
Expected<Points> pressed(const Act& act, const LatticeCommand& c, const Lattice& lattice) {
  auto held = lattice.faces(c.hold, 1);
  if (!held) return std::unexpected(held.error());
  const auto tools = tools_and_images(act.state);
  if (!tools) return std::unexpected(tools.error());
  ActiveSettings<3> settings;
  settings.lambda = c.lambda;
  if (!c.hold.empty()) settings.held = std::move(*held);
  settings.detail = detail_of(*tools);
  const auto model = ActiveSpline<3>::create(lattice.rest(), settings);
  if (!model) return std::unexpected(model.error());
  ActiveState active{lattice.rest().control_points()};
  for (int k = 0; k < c.steps; ++k) {
    auto step = model->step(active, *tools);
    if (!step) return std::unexpected(step.error());
    active.control_points = std::move(step->control_points);
    if (auto told = tell_progress(act, k + 1, c.steps); !told) return std::unexpected(told.error());
  }
  return std::move(active.control_points);
}

/// Whether a surface stands in the model where its part is drawn, once.
bool stands_as_drawn(const Document& document, const std::string& surface) {
  const brep::Model* model = document.model();
  const brep::Part* part = model && model->assembly ? model->assembly->part_of(surface) : nullptr;
  return !part || part->places.empty() ||
         (part->places.size() == 1 && part->places.front().to_model.matrix().isIdentity(0));
}

/// Whether surfaces that are selected come together at an edge of their faces, and none of these
/// edges is held in place or may open: then their points have to be moved alike, not their nets.
/// Data are in the coordinates of the model, and the block in those of a part: where these differ,
/// nets are moved.
Expected<bool> joined_at_edges(Act& act) {
  std::map<std::string, int> sides;
  for (const int k : act.state.selection()) {
    const SceneSurface& s = std::as_const(act.state).surfaces[static_cast<std::size_t>(k)];
    if (!stands_as_drawn(act.document, s.id)) return false;
    const auto region = act.regions.of(s.id);
    if (!region) return std::unexpected(region.error());
    const auto orders = trim_orders(s.constraints, *region);
    for (std::size_t e = 0; e < orders.size(); ++e) {
      const std::string& id = region->edges[e].id;
      if (orders[e] >= 0 || may_open(s.constraints, id)) return false;
      // Sides of a surface without faces are called alike on all of them, and meet none.
      if (!region->edges[e].neighbours.empty()) ++sides[id];
    }
  }
  return std::ranges::any_of(sides, [](const auto& edge) { return edge.second > 1; });
}

/// Moves the points of the faces on the selected surfaces with the block, and their edges with
/// them. \param before the shapes that the block was put round, in order of selection
Expected<void> move_points(Act& act, const Lattice& lattice, const Points& after,
                           std::span<const std::shared_ptr<const Surface>> before) {
  MorphData data;
  auto displacement = lattice.displacement(after);
  if (!displacement) return std::unexpected(displacement.error());
  data.map = *std::move(displacement);
  MorphRequest request;
  const auto selection = act.state.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(selection[k])];
    request.settings.faces.push_back(s.id);
    auto shape = on_basis_of(*before[k], *s.current);
    if (!shape) return std::unexpected(shape.error());
    if (auto status = put_at_rest(s, std::make_shared<const Surface>(*std::move(shape))); !status)
      return status;
  }
  if (act.state.permission == RefinePermission::never) request.settings.refinement = 1;
  const auto report = move_after_data(act, std::move(data), std::move(request));
  if (!report) return std::unexpected(report.error());
  note_excess(act, *report, "lattice");
  return {};
}

/// Moves the control points of the selected surfaces with the block. \param before as above
Expected<void> move_nets(Act& act, const Lattice& lattice, const Points& after,
                         std::span<const std::shared_ptr<const Surface>> before) {
  const auto selection = act.state.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const auto points = lattice.deformed(before[k]->control_points(), after);
    if (!points) return std::unexpected(points.error());
    auto moved = before[k]->with_control_points(*points);
    if (!moved) return std::unexpected(moved.error());
    SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(selection[k])];
    // The block carries the energy, not they.
    if (auto status = put_at_rest(s, std::make_shared<const Surface>(std::move(*moved))); !status)
      return status;
  }
  return {};
}

}  // namespace

// Free-form deformation (Sederberg and Parry, SIGGRAPH 1986): control points of surfaces are moved
// as points of the block, which deforms a surface as its net, not as its points. Finer nets come
// closer to the latter. Points are moved where faces have common edges: on nets of their own these
// would part.
Expected<void> execute(const LatticeCommand& c, Act& act) {
  auto surface = selected(act);
  if (!surface) return std::unexpected(surface.error());
  const bool by_hand = !c.which.empty() || c.by.has_value();
  if (by_hand && !c.by)
    return input_error("nothing says how far they are moved", "by", "give [dx, dy, dz]");
  if (by_hand && !c.hold.empty())
    return input_error("faces hold against tools only", "hold", "leave it out, or which");
  if (c.again && !by_hand)
    return input_error("tools press a block of their own", "again", "leave it out, or add which");
  const PulledLattice* on =
      c.again ? lattice_to_pull_on(act.state, c.margin, c.degree, c.net) : nullptr;
  if (c.again && on == nullptr) {
    return input_error("the surfaces are not as a block of this kind has left them", "again",
                       "leave it out: a block is put round them as they are");
  }
  const auto joined = joined_at_edges(act);
  if (!joined) return std::unexpected(joined.error());
  // Two edges with the same knots are deformed alike.
  if (on == nullptr && !*joined && act.state.permission != RefinePermission::never) {
    if (auto united = refine_seams(act, false); !united) return united;
  }
  PulledLattice pulled{c.net, c.degree, c.margin, {}, act.state.selection(), {}, {}};
  for (std::size_t k = 0; k < pulled.surfaces.size(); ++k) {
    pulled.before.push_back(
        on ? on->before[k]
           : act.state.surfaces[static_cast<std::size_t>(pulled.surfaces[k])].current);
  }
  const auto lattice = lattice_around(pulled.before, c.margin, c.degree, c.net);
  if (!lattice) return std::unexpected(lattice.error());
  auto after =
      by_hand ? lattice->moved(on ? on->points : lattice->rest().control_points(), c.which, *c.by)
              : pressed(act, c, *lattice);
  if (!after) return std::unexpected(after.error());
  const auto moved = *joined ? move_points(act, *lattice, *after, pulled.before)
                             : move_nets(act, *lattice, *after, pulled.before);
  if (!moved) return moved;
  for (const int k : pulled.surfaces)
    pulled.after.push_back(act.state.surfaces[static_cast<std::size_t>(k)].current);
  pulled.points = std::move(*after);
  act.state.lattice.reset();
  if (by_hand) act.state.lattice = std::move(pulled);
  return {};
}

}  // namespace knead
