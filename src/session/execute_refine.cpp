#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "change_shapes.hpp"
#include "executor.hpp"
#include "knead/spline/extremum.hpp"
#include "knead/spline/knot_removal.hpp"
#include "knead/spline/spline_refinement.hpp"

namespace knead {
namespace {

std::string net_of(const SurfaceState& s) {
  const auto [m, n] = s.current->net();
  return fmt::format("{}: the net is now {} x {}, degree {} x {}", s.id, m, n, s.current->knots(0).degree(),
                     s.current->knots(1).degree());
}

/// The rectangle of parameters of all spans whose control points come near the tool; nothing where there are none.
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

template <class F>
Expected<void> Executor::reshape(SurfaceState& surface, const F& change) {
  if (!surface.pins.empty()) {
    return input_error("control points are pinned by their numbers, which change with the net", surface.id,
                       "release them first, or pin surface points (at) instead");
  }
  auto shapes = shapes_of(surface);
  if (same_basis(*surface.opened, *surface.current)) shapes.push_back(&surface.opened);
  if (auto done = change_shapes(shapes, change); !done) return done;
  if (surface.velocity.rows() > 0) {
    // The velocity is a spline on the old net; `opened` and it change alike, but it is no shape of its own.
    surface.velocity.resize(0, 3);
  }
  state.notes.push_back(net_of(surface));
  return {};
}

Expected<bool> Executor::refine_under(const Tool& tool) {
  bool any = false;
  for (int index : state.selection()) {
    SurfaceState& s = state.surfaces[static_cast<std::size_t>(index)];
    const auto reach = reach_of(*s.current, tool);
    if (!reach) continue;
    any = true;
    auto done = reshape(s, [&](const Surface& shape) { return refine_region<2>(shape, *reach); });
    if (!done) return std::unexpected(done.error());
  }
  return any;
}

Expected<void> Executor::refine_seams() {
  if (!state.seams.couple) return {};
  std::vector<const Surface*> patches;
  const std::vector<int> selection = state.selection();
  for (int index : selection) patches.push_back(state.surfaces[static_cast<std::size_t>(index)].reference.get());
  const auto found = seams_between(state, patches);
  if (!found) return std::unexpected(found.error());
  std::vector<Seam> whole;
  std::ranges::copy_if(found->seams, std::back_inserter(whole),
                       [](const Seam& s) { return s.kind == SeamKind::whole; });
  for (const SeamRefinement& r : seam_refinements(patches, whole)) {
    SurfaceState& s = state.surfaces[static_cast<std::size_t>(selection[static_cast<std::size_t>(r.patch)])];
    auto done = reshape(s, [&](const Surface& shape) -> Expected<Surface> {
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

Expected<void> Executor::operator()(const RefineCommand& c) {
  if (c.permission) state.permission = *c.permission;
  const bool knots = !c.knots_u.empty() || !c.knots_v.empty();
  const int ways =
      static_cast<int>(c.region.has_value()) + static_cast<int>(c.under.has_value()) + static_cast<int>(knots);
  if (ways == 0 && c.permission) return {};
  if (ways != 1) {
    return input_error("what to refine is not clear", "region", "give one of region, under, and knots_u with knots_v");
  }
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  if (c.under) {
    auto tool = find_tool(c.under);
    if (!tool) return std::unexpected(tool.error());
    const auto any = refine_under(**tool);
    if (!any) return std::unexpected(any.error());
    if (!*any)
      return input_error(fmt::format("the tool {} does not reach the surface", *c.under), "under", "move it nearer");
    return {};
  }
  for (int index : state.selection()) {
    SurfaceState& s = state.surfaces[static_cast<std::size_t>(index)];
    Expected<void> done;
    if (c.region) {
      const auto region = region_at(*s.current, *c.region);
      if (!region) return std::unexpected(region.error());
      done = reshape(s, [&](const Surface& shape) { return refine_region<2>(shape, *region); });
    } else {
      done = reshape(s, [&](const Surface& shape) { return insert_knots<2>(shape, {c.knots_u, c.knots_v}); });
    }
    if (!done) return done;
  }
  return {};
}

Expected<void> Executor::operator()(const ElevateCommand& c) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  if (c.by[0] < 0 || c.by[1] < 0) return input_error("a degree cannot be lowered", "by", "use numbers >= 0");
  for (int index : state.selection()) {
    auto done =
        reshape(state.surfaces[static_cast<std::size_t>(index)], [&](const Surface& shape) -> Expected<Surface> {
          Expected<Surface> result = shape;
          for (int d = 0; d < 2; ++d) {
            const int times = c.by[static_cast<std::size_t>(d)];
            if (result && times > 0) result = elevate_degree<2>(*result, d, times);
          }
          return result;
        });
    if (!done) return done;
  }
  return {};
}

Expected<void> Executor::operator()(const CoarsenCommand& c) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  for (int index : state.selection()) {
    SurfaceState& s = state.surfaces[static_cast<std::size_t>(index)];
    if (!s.pins.empty()) {
      return input_error("control points are pinned by their numbers, which change with the net", s.id,
                         "release them first, or pin surface points (at) instead");
    }
    double bound = 0;
    std::size_t removed = 0;
    for (int d = 0; d < 2; ++d) {
      // Each direction may spend half of the tolerance.
      std::vector<std::shared_ptr<const Surface>*> shapes = {&s.reference, &s.rest};
      if (same_basis(*s.opened, *s.current)) shapes.push_back(&s.opened);
      for (KeptConstraint& kept : s.constraints) shapes.push_back(&kept.where);
      std::vector<Points> others;
      for (const auto* shape : shapes) others.push_back((*shape)->control_points());
      auto result = remove_knots<2>(*s.current, d, 0.5 * c.tolerance, others);
      if (!result) return std::unexpected(result.error());
      if (result->removed.empty()) continue;
      removed += result->removed.size();
      bound += result->error_bound;
      const auto current = std::make_shared<const Surface>(std::move(result->spline));
      std::map<const Surface*, std::shared_ptr<const Surface>> made = {{s.current.get(), current}};
      for (std::size_t k = 0; k < shapes.size(); ++k) {
        auto& other = made[shapes[k]->get()];
        if (!other) {
          auto coarser = current->with_control_points(std::move(result->companions[k]));
          if (!coarser) return std::unexpected(coarser.error());
          other = std::make_shared<const Surface>(std::move(*coarser));
        }
      }
      for (auto* shape : shapes) *shape = made[shape->get()];
      s.current = current;
      s.velocity.resize(0, 3);
    }
    state.notes.push_back(
        fmt::format("{}: {} knots removed, the shape moved by less than {:.3g}", s.id, removed, bound));
    if (removed > 0) state.notes.push_back(net_of(s));
  }
  return {};
}

}  // namespace knead
