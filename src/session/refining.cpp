#include <fmt/format.h>

#include <algorithm>

#include "executor.hpp"
#include "knead/scene/followed.hpp"
#include "knead/spline/spline_refinement.hpp"

namespace knead {

std::string net_note(const SceneSurface& s) {
  const auto [m, n] = s.current->net();
  return fmt::format("{}: the net is now {} x {}, degree {} x {}", s.id, m, n, s.current->knots(0).degree(),
                     s.current->knots(1).degree());
}

namespace {

/// The rectangle of parameters of all spans whose control points come near the tool; none if there are none.
std::optional<std::array<Interval, 2>> reach_of(const Surface& surface, const Tool& tool) {
  const ModelTool probe(tool, Point::Zero(), 1);
  const std::vector<int> us = surface.knots(0).spans(), vs = surface.knots(1).spans();
  const int p = surface.knots(0).degree(), q = surface.knots(1).degree(), n = surface.net()[1];
  std::optional<std::array<Interval, 2>> result;
  for (int a : us) {
    for (int b : vs) {
      Point lower = surface.control_points().row((a - p) * n + b - q), upper = lower;
      for (int i = a - p; i <= a; ++i) {
        for (int j = b - q; j <= b; ++j) {
          lower = lower.cwiseMin(surface.control_points().row(i * n + j).transpose());
          upper = upper.cwiseMax(surface.control_points().row(i * n + j).transpose());
        }
      }
      if (!probe.may_reach(lower, upper)) continue;
      const Interval u{surface.knots(0)[a], surface.knots(0)[a + 1]}, v{surface.knots(1)[b], surface.knots(1)[b + 1]};
      if (!result) {
        result = {u, v};
      } else {
        (*result)[0] = {std::min((*result)[0].lower, u.lower), std::max((*result)[0].upper, u.upper)};
        (*result)[1] = {std::min((*result)[1].lower, v.lower), std::max((*result)[1].upper, v.upper)};
      }
    }
  }
  return result;
}

}  // namespace

Expected<void> Executor::change_net(SceneSurface& s, const SurfaceChange& change) {
  if (auto done = knead::change_net(s, change); !done) return done;
  state.notes.push_back(net_note(s));
  return {};
}

Expected<bool> Executor::refine_under(const Tool& tool) {
  bool any = false;
  for (int index : state.selection()) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(index)];
    const auto reach = reach_of(*s.current, tool);
    if (!reach) continue;
    any = true;
    auto done = change_net(s, [&](const Surface& shape) { return refine_region<2>(shape, *reach); });
    if (!done) return std::unexpected(done.error());
  }
  return any;
}

Expected<void> Executor::refine_seams(bool followed) {
  if (!state.seams.couple) return {};
  std::vector<const Surface*> patches;
  const std::vector<int> selection = state.selection();
  for (int index : selection) patches.push_back(state.surfaces[static_cast<std::size_t>(index)].reference.get());
  const auto found = seams_between(state.seams, patches);
  if (!found) return std::unexpected(found.error());
  std::vector<Seam> whole;
  const auto edges = followed_inputs(state);
  std::ranges::copy_if(found->seams, std::back_inserter(whole), [&](const Seam& s) {
    return s.kind == SeamKind::whole && (!followed || followed_at(edges, s) != nullptr);
  });
  for (const SeamRefinement& r : seam_refinements(patches, whole)) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(selection[static_cast<std::size_t>(r.patch)])];
    auto done = change_net(s, [&](const Surface& shape) -> Expected<Surface> {
      Expected<Surface> result = shape;
      if (r.elevate > 0) result = elevate_degree<2>(shape, r.direction, r.elevate);
      if (!result || r.insert.empty()) return result;
      std::array<std::vector<double>, 2> knots;
      knots[static_cast<std::size_t>(r.direction)] = r.insert;
      return insert_knots<2>(*result, knots);
    });
    if (!done) return done;
  }
  return {};
}

}  // namespace knead
