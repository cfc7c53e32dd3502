#include "refining.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "following.hpp"
#include "holding.hpp"
#include "knead/base/error_code.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "limits.hpp"
#include "scene/followed.hpp"
#include "selection.hpp"
#include "session/gestures/stroking.hpp"
#include "trimming.hpp"

namespace knead {

std::string net_note(const SceneSurface& s) {
  const auto [m, n] = s.current->net();
  return fmt::format("{}: the net is now {} x {}, degree {} x {}", s.id, m, n,
                     s.current->knots(0).degree(), s.current->knots(1).degree());
}

namespace {

constexpr int least_limit = 40'000,
              grown = 4;  // of control points, and times those of the file, where nobody asked

/// The rectangle of parameters of all spans whose control points come near the tool; none if there
/// are none.
/// By the box of each span's control points, which contains the span. The net is a grid: knots of a
/// rectangle go through all of the surface, so that only its two intervals matter.
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
      const Interval u{surface.knots(0)[a], surface.knots(0)[a + 1]},
          v{surface.knots(1)[b], surface.knots(1)[b + 1]};
      if (!result) {
        result = {u, v};
      } else {
        (*result)[0] = {std::min((*result)[0].lower, u.lower),
                        std::max((*result)[0].upper, u.upper)};
        (*result)[1] = {std::min((*result)[1].lower, v.lower),
                        std::max((*result)[1].upper, v.upper)};
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
  const Interval fixed = surface.knots()[across].domain(),
                 along = surface.knots()[1 - across].domain();
  at[across] = {edge_at_end(edge) ? fixed.upper : fixed.lower};
  for (int k = 0; k < samples; ++k) {
    at[1 - across].push_back(
        std::min(along.lower + along.length() * k / (samples - 1), along.upper));
  }
  const auto points = evaluate_grid<2>(
      surface, {std::span<const double>(at[0]), std::span<const double>(at[1])}, 0);
  if (!points) return std::numeric_limits<double>::infinity();
  return (points->points().rowwise() - place.transpose()).rowwise().norm().minCoeff();
}

}  // namespace

Expected<void> change_basis(Act& act, SceneSurface& surface, const SurfaceChange& change) {
  if (act.state.limit) {
    return input_error(
        "a limit is measured on the weights and knots that the surface was opened with", "limit",
        R"(end it first: {"do":"limit"})", {ErrorCode::limit_keeps_basis});
  }
  // `opened` is unchanged: deviations are measured from it.
  if (auto status = knead::change_basis(surface, change); !status) return status;
  surface.velocity.resize(0, 3);  // it is a spline on the old basis
  return surface.constraints.empty() ? Expected<void>() : check_constraints(act);
}

Expected<void> change_net(Act& act, SceneSurface& s, const SurfaceChange& change) {
  const SurfaceChange limited = [&](const Surface& shape) -> Expected<Surface> {
    auto changed = change(shape);
    if (!changed) return changed;
    if (auto fits = check_net_size(changed->net()); !fits) return std::unexpected(fits.error());
    if (auto fits = check_document_size(act.state, changed->size() - shape.size()); !fits) {
      return std::unexpected(fits.error());
    }
    return changed;
  };
  if (auto status = knead::change_net(s, limited); !status) return status;
  act.state.notes.push_back(net_note(s));
  return {};
}

// Each call halves the spans, and quadruples the control points under the tool at most. A limit
// counts only where nobody asked to refine: a small tool would otherwise fill the memory.
Expected<bool> refine_under(Act& act, const Tool& tool, bool limited) {
  bool any = false;
  for (SceneSurface& s : selected_surfaces(act.state)) {
    const auto reach = reach_of(*s.current, tool);
    if (!reach) continue;
    any = true;
    const auto in_file = std::ranges::find(act.document.surfaces(), s.id, &DocumentSurface::id);
    const int limit = in_file == act.document.surfaces().end()
                          ? least_limit
                          : std::max(least_limit, grown * in_file->surface->size());
    auto status = change_net(act, s, [&](const Surface& shape) -> Expected<Surface> {
      auto finer = refine_region<2>(shape, *reach);
      if (!limited || !finer || finer->size() <= limit) return finer;
      const auto [m, n] = finer->net();
      return numerical_error(
          fmt::format("the tool {} needs a net of {} x {} on {}, more than the {} control points "
                      "to which a command refines by itself",
                      tool.name, m, n, s.id, limit),
          tool.name,
          R"(take a larger tool, refine where it matters, )"
          R"({"do":"refine","region":[[0.4,0.6],[0.4,0.6]]}, )"
          R"(or go on with a coarse net: {"do":"refine","permission":"never"})",
          {ErrorCode::net_too_large, {{"tool", tool.name}, {"surface", s.id}}});
    });
    if (!status) return std::unexpected(status.error());
  }
  return any;
}

namespace {

Expected<void> refine_as(Act& act, const std::vector<SeamRefinement>& refinements) {
  const std::vector<int> selection = act.state.selection();
  for (const SeamRefinement& r : refinements) {
    SceneSurface& s =
        act.state.surfaces[static_cast<std::size_t>(selection[static_cast<std::size_t>(r.patch)])];
    auto status = change_net(act, s, [&](const Surface& shape) -> Expected<Surface> {
      Expected<Surface> result = shape;
      if (r.elevate > 0) result = elevate_degree<2>(shape, r.direction, r.elevate);
      if (!result || r.insert.empty()) return result;
      std::array<std::vector<double>, 2> knots;
      knots[static_cast<std::size_t>(r.direction)] = r.insert;
      return insert_knots<2>(*result, knots);
    });
    if (!status) return status;
  }
  return {};
}

}  // namespace

Expected<void> refine_seams(Act& act, bool followed) {
  if (!act.state.seams.couple) return {};
  std::vector<const Surface*> patches;
  const std::vector<int> selection = act.state.selection();
  for (int index : selection)
    patches.push_back(act.state.surfaces[static_cast<std::size_t>(index)].reference.get());
  const auto found = seams_between(act.state.seams, patches);
  if (!found) return std::unexpected(found.error());
  std::vector<Seam> whole;
  const auto edges = followed_inputs(act.state);
  std::ranges::copy_if(found->seams, std::back_inserter(whole), [&](const Seam& s) {
    return s.kind == SeamKind::whole && (!followed || followed_at(edges, s) != nullptr);
  });
  return refine_as(act, seam_refinements(patches, whole));
}

Expected<void> unite_restricted(Act& act, std::span<const SeamReport> reports, const Point& place,
                                double reach) {
  if (act.state.permission == RefinePermission::never) return {};
  std::vector<const SceneSurface*> surfaces;
  std::vector<const Surface*> patches;
  for (int index : act.state.selection()) {
    surfaces.push_back(&act.state.surfaces[static_cast<std::size_t>(index)]);
    patches.push_back(surfaces.back()->reference.get());
  }
  std::vector<Seam> near;
  for (const SeamReport& report : reports) {
    const auto a = static_cast<std::size_t>(report.seam.a.patch),
               b = static_cast<std::size_t>(report.seam.b.patch);
    if (!report.restricted || report.seam.kind != SeamKind::whole) continue;
    if (!surfaces[a]->pins.empty() || !surfaces[b]->pins.empty()) continue;
    if (distance_from(*surfaces[a]->current, report.seam.a.edge, place) <= reach)
      near.push_back(report.seam);
  }
  return refine_as(act, seam_refinements(patches, near));
}

namespace {

const Surface* document_surface(const Act& act, const SceneSurface& surface) {
  for (const DocumentSurface& s : act.document.surfaces()) {
    if (s.id == surface.id) return s.surface.get();
  }
  return surface.opened.get();
}

Expected<void> refine_round(Act& act, SceneSurface& s, const TrimContact& contact, double size) {
  if (act.state.permission == RefinePermission::never || !s.pins.empty()) return {};
  const auto refinement =
      trim_refinement(*s.reference, contact.at, contact.distance, std::isfinite(size) ? size : 0,
                      trim_refinement_cap(*document_surface(act, s)));
  if (!refinement) return std::unexpected(refinement.error());
  if (refinement->capped) {
    act.state.notes.push_back(
        fmt::format("{}: the net between tool and held edges stays coarser than it should be, as "
                    "it is limited to {} control points; refine it where it matters with "
                    "{{\"do\":\"refine\"}}",
                    s.id, trim_refinement_cap(*document_surface(act, s))));
  }
  if (refinement->empty()) return {};
  return change_net(act, s, [&](const Surface& shape) { return refinement->apply(shape); });
}

// An edge that follows moves on all of its surfaces: a net that is fine on one side and coarse on
// the other has too few displacements in common along it. Other sides are refined about the nearest
// point of the edge, if that is nearer than what is held.
Expected<void> refine_followed(Act& act, const SceneSurface& touched, const TrimContact& contact,
                               double size) {
  const auto place = evaluate_point<2>(*touched.opened, contact.at);
  if (!place) return std::unexpected(place.error());
  for (const FollowedEdge& edge : act.state.followed) {
    if (!edge.course || !follows(touched, edge.id)) continue;
    const auto& samples = edge.course->samples();
    const auto near = std::ranges::min_element(
        samples, {}, [&](const SharedEdge::Sample& s) { return (s.point - *place).norm(); });
    if ((near->point - *place).norm() >= contact.distance) continue;
    for (std::size_t k = 0; k < near->feet.size(); ++k) {
      const auto index = find_surface(act, edge.course->surfaces()[k]);
      if (!index) return std::unexpected(index.error());
      SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(*index)];
      const bool itself = std::ranges::count(edge.course->surfaces(), s.id) > 1;
      if ((&s == &touched && !itself) || !s.visible) continue;
      std::vector<bool> held;
      for (const int order : trim_orders(s.constraints, *s.visible)) held.push_back(order >= 0);
      TrimContact there{parameters_at_foot(*s.current, near->feet[k]),
                        s.visible->distance(near->point, held)};
      there.distance = std::min(there.distance, contact.distance);
      if (!(there.distance > 0)) continue;
      if (auto status = refine_round(act, s, there, size); !status) return status;
    }
  }
  return {};
}

}  // namespace

Expected<void> refine_trims(Act& act) {
  if (auto known = know_trims(act); !known) return known;
  for (SceneSurface& s : selected_surfaces(act.state)) {
    if (!any_held(s)) continue;
    for (const Tool& tool : act.state.tools) {
      const auto contact = trim_contact(s, tool);
      if (!contact) return std::unexpected(contact.error());
      if (!*contact) continue;
      if (auto status = refine_round(act, s, **contact, tool.shape.size()); !status) return status;
      if (auto status = refine_followed(act, s, **contact, tool.shape.size()); !status)
        return status;
    }
  }
  return {};
}

Expected<void> refine_at_trims(Act& act, SceneSurface& surface, const Fractions& at, double size) {
  if (auto known = know_trims(act); !known) return known;
  if (!any_held(surface)) return {};
  TrimContact contact{parameters_of(*surface.current, {at[0], at[1]}), 0};
  const auto place = evaluate_point<2>(*surface.opened, contact.at);
  if (!place) return std::unexpected(place.error());
  std::vector<bool> held;
  for (const int order : trim_orders(surface.constraints, *surface.visible))
    held.push_back(order >= 0);
  contact.distance = surface.visible->distance(*place, held);
  if (auto status = refine_round(act, surface, contact, size); !status) return status;
  return refine_followed(act, surface, contact, size);
}

}  // namespace knead
