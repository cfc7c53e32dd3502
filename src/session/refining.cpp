#include <fmt/format.h>

#include <algorithm>

#include "executor.hpp"
#include "knead/base/error_code.hpp"
#include "knead/scene/followed.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "limits.hpp"

namespace knead {

std::string net_note(const SceneSurface& s) {
  const auto [m, n] = s.current->net();
  return fmt::format("{}: the net is now {} x {}, degree {} x {}", s.id, m, n, s.current->knots(0).degree(),
                     s.current->knots(1).degree());
}

namespace {

constexpr int least_limit = 40'000, grown = 4;  // of control points, and times those of the file, where nobody asked
constexpr double near_seam = 2;                 // sizes of the tool from its centre within which seams have to bend

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

/// How far a point is from samples of an edge.
double distance_from(const Surface& surface, SurfaceEdge edge, const Point& place) {
  constexpr int samples = 65;
  const auto across = static_cast<std::size_t>(edge_across(edge));
  std::array<std::vector<double>, 2> at;
  const Interval fixed = surface.knots()[across].domain(), along = surface.knots()[1 - across].domain();
  at[across] = {edge_at_end(edge) ? fixed.upper : fixed.lower};
  for (int k = 0; k < samples; ++k) {
    at[1 - across].push_back(std::min(along.lower + along.length() * k / (samples - 1), along.upper));
  }
  const auto points = evaluate_grid<2>(surface, {std::span<const double>(at[0]), std::span<const double>(at[1])}, 0);
  if (!points) return std::numeric_limits<double>::infinity();
  return (points->points().rowwise() - place.transpose()).rowwise().norm().minCoeff();
}

}  // namespace

Expected<void> Executor::change_net(SceneSurface& s, const SurfaceChange& change) {
  const SurfaceChange limited = [&](const Surface& shape) -> Expected<Surface> {
    auto changed = change(shape);
    if (!changed) return changed;
    if (auto fits = check_net_size(changed->net()); !fits) return std::unexpected(fits.error());
    if (auto fits = check_document_size(state, changed->size() - shape.size()); !fits) {
      return std::unexpected(fits.error());
    }
    return changed;
  };
  if (auto done = knead::change_net(s, limited); !done) return done;
  state.notes.push_back(net_note(s));
  return {};
}

Expected<bool> Executor::refine_under(const Tool& tool, bool limited) {
  bool any = false;
  for (int index : state.selection()) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(index)];
    const auto reach = reach_of(*s.current, tool);
    if (!reach) continue;
    any = true;
    const auto in_file = std::ranges::find(document.surfaces(), s.id, &DocumentSurface::id);
    const int limit =
        in_file == document.surfaces().end() ? least_limit : std::max(least_limit, grown * in_file->surface->size());
    auto done = change_net(s, [&](const Surface& shape) -> Expected<Surface> {
      auto finer = refine_region<2>(shape, *reach);
      if (!limited || !finer || finer->size() <= limit) return finer;
      const auto [m, n] = finer->net();
      return numerical_error(
          fmt::format("the tool {} needs a net of {} x {} on {}, more than the {} control points to which a command "
                      "refines by itself",
                      tool.name, m, n, s.id, limit),
          tool.name,
          R"(take a larger tool, refine where it matters, {"do":"refine","region":[[0.4,0.6],[0.4,0.6]]}, or go on with a coarse net: {"do":"refine","permission":"never"})",
          {ErrorCode::net_too_large, {{"tool", tool.name}, {"surface", s.id}}});
    });
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
  return refine_as(seam_refinements(patches, whole));
}

Expected<void> Executor::refine_as(const std::vector<SeamRefinement>& refinements) {
  const std::vector<int> selection = state.selection();
  for (const SeamRefinement& r : refinements) {
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

Expected<void> Executor::unite_restricted(std::span<const SeamReport> reports, const Point& place, double reach) {
  if (state.permission == RefinePermission::never) return {};
  std::vector<const SceneSurface*> surfaces;
  std::vector<const Surface*> patches;
  for (int index : state.selection()) {
    surfaces.push_back(&state.surfaces[static_cast<std::size_t>(index)]);
    patches.push_back(surfaces.back()->reference.get());
  }
  std::vector<Seam> near;
  for (const SeamReport& report : reports) {
    const auto a = static_cast<std::size_t>(report.seam.a.patch), b = static_cast<std::size_t>(report.seam.b.patch);
    if (!report.restricted || report.seam.kind != SeamKind::whole) continue;
    if (!surfaces[a]->pins.empty() || !surfaces[b]->pins.empty()) continue;
    if (distance_from(*surfaces[a]->current, report.seam.a.edge, place) <= reach) near.push_back(report.seam);
  }
  return refine_as(seam_refinements(patches, near));
}

/// Lets seams bend under the tool.
Expected<void> Executor::unite_under_stroke() {
  if (state.together.empty() || state.permission == RefinePermission::never) return {};
  if (auto made = prepare_stroke_model(); !made) return made;
  const auto tool = find_tool(state.stroke->tool);
  if (!tool) return std::unexpected(tool.error());
  const PlacedShape& shape = (*tool)->shape;
  return unite_restricted(stroke_cache->scene.seams, shape.placement().position, near_seam * shape.size());
}

}  // namespace knead
