#include <fmt/format.h>

#include <algorithm>

#include "executor.hpp"
#include "knead/sculpt/constraints.hpp"

namespace knead {

Expected<void> Executor::ask(const ConstraintRequest& request) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  for (int k : state.selection()) {
    SurfaceState& s = state.surfaces[static_cast<std::size_t>(k)];
    s.constraints.push_back({request, s.current});
  }
  return check_constraints();
}

Expected<void> Executor::check_constraints() {
  // What cannot be made is refused now and not at the next step. A large lambda makes a model of whatever can step.
  EvolveCommand evolve;
  evolve.lambda = 1e6;
  auto model = make_model(state, model_input(state, evolve));
  if (!model) return std::unexpected(model.error());
  return {};
}

Expected<void> Executor::operator()(const HoldCommand& c) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  if (c.rows < 0) return input_error(fmt::format("{} rows cannot be held", c.rows), "rows", "use 0 or more");
  for (int k : state.selection()) state.surfaces[static_cast<std::size_t>(k)].hold_rows = c.rows;
  return {};
}

Expected<void> Executor::operator()(const PinCommand& c) {
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  if (c.to && !c.at) return input_error("there is no point to bring there", "to", "give at, the surface point");
  if (c.control_points.empty() && !c.at) {
    return input_error("nothing is pinned", "control_points", "give control_points, or at");
  }
  const auto [m, n] = (*surface)->rest->net();
  for (std::size_t k = 0; k < c.control_points.size(); ++k) {
    const auto [i, j] = c.control_points[k];
    if (i < 0 || i >= m || j < 0 || j >= n) {
      return input_error(fmt::format("there is no control point [{}, {}]", i, j), fmt::format("control_points[{}]", k),
                         fmt::format("the net is {} by {}, counted from 0", m, n));
    }
    (*surface)->pins.insert({i, j});
  }
  if (!c.at) return {};
  PinCommand point;
  point.at = c.at;
  point.to = c.to;
  // Points belong to one surface.
  const std::vector<int> others = std::exchange(state.together, {});
  auto done = ask(point);
  state.together = others;
  return done;
}

Expected<void> Executor::operator()(const EdgeCommand& c) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  std::vector<EdgeChoice> edges = {c.which};  // one by one, so that they can be freed so
  if (c.which == EdgeChoice::all) edges = {EdgeChoice::u0, EdgeChoice::u1, EdgeChoice::v0, EdgeChoice::v1};
  for (int k : state.selection()) {
    SurfaceState& s = state.surfaces[static_cast<std::size_t>(k)];
    std::erase_if(s.constraints, [&](const KeptConstraint& kept) {
      const auto* edge = std::get_if<EdgeCommand>(&kept.request);
      return edge != nullptr && std::ranges::find(edges, edge->which) != edges.end();
    });
    if (c.hold == EdgeHold::free) continue;
    for (EdgeChoice edge : edges) s.constraints.push_back({EdgeCommand{edge, c.hold}, s.current});
  }
  return c.hold == EdgeHold::free ? Expected<void>() : check_constraints();
}

Expected<void> Executor::operator()(const FreezeCommand& c) {
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  if (auto done = ask(c); !done) return done;
  const auto region = region_at(*(*surface)->rest, c.region);
  ConstraintList list((*surface)->rest->size());
  const auto frozen = freeze_region(*(*surface)->rest, (*region)[0], (*region)[1], list);
  if (!frozen) return std::unexpected(frozen.error());
  state.notes.push_back(fmt::format("{}: frozen from u = {:.6g} to {:.6g}, v = {:.6g} to {:.6g}", (*surface)->id,
                                    frozen->u.lower, frozen->u.upper, frozen->v.lower, frozen->v.upper));
  return {};
}

Expected<void> Executor::operator()(const KeepCommand& c) {
  if (static_cast<int>(c.u.has_value()) + static_cast<int>(c.v.has_value()) + static_cast<int>(!c.curve.empty()) != 1) {
    return input_error("one of u, v and curve is needed", "keep", "give exactly one of them");
  }
  return ask(c);
}

Expected<void> Executor::operator()(const SymmetryCommand& c) {
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  if (c.edge.has_value() == c.mirror.has_value()) {
    return input_error("one of edge and mirror is needed", "symmetry", "give exactly one of them");
  }
  if (c.edge && !(c.point && c.normal)) return input_error("the plane is missing", "normal", "give point and normal");
  if (c.mirror && *c.mirror != "u" && *c.mirror != "v") {
    return input_error(fmt::format("\"{}\" is not a direction", *c.mirror), "mirror", "use u or v");
  }
  if (c.mirror && state.permission == RefinePermission::automatic) {
    // Exactly the knots that make the net symmetric.
    const int direction = *c.mirror == "u" ? 0 : 1;
    const auto plane = mirror_plane(*(*surface)->reference, direction);
    if (!plane) return std::unexpected(plane.error());
    const auto report = mirror_report(*(*surface)->reference, direction, *plane, 1e-9);
    if (!report) return std::unexpected(report.error());
    if (!report->insert.empty()) {
      RefineCommand refine;
      (direction == 0 ? refine.knots_u : refine.knots_v) = report->insert;
      if (auto done = (*this)(refine); !done) return done;
    }
  }
  return ask(c);
}

Expected<void> Executor::operator()(const SmoothCommand& c) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  for (int k : state.selection()) {
    SurfaceState& s = state.surfaces[static_cast<std::size_t>(k)];
    s.smooth_knot_lines = c.knot_lines;
    s.smooth_poles = c.poles;
  }
  return {};
}

Expected<void> Executor::operator()(const SeamsCommand& c) {
  if (c.tolerance && !(*c.tolerance > 0)) {
    return input_error(fmt::format("{} is not a tolerance", *c.tolerance), "tolerance", "use a length > 0");
  }
  state.seams = c;
  return {};
}

Expected<void> Executor::operator()(const ReleaseCommand&) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  for (int k : state.selection()) {
    SurfaceState& s = state.surfaces[static_cast<std::size_t>(k)];
    s.hold_rows = 0;
    s.pins.clear();
    s.constraints.clear();
  }
  return {};
}

}  // namespace knead
