#include "anchors.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "scene/model/dead_loads.hpp"
#include "trims.hpp"

namespace knead {
namespace {

// A sphere that is held by nothing but its (absent) edges would fly off under a tool: its energy
// has rigid translations in the null space and the matrix would be singular under forces. A spring
// at the centre of area, Σ a_i x_i / Σ a_i with a_i = ∫ N_i dA over the reference shape, holds the
// place and nothing else: it resists translation alone, adds one rank-one term, and leaves every
// shape free. Its stiffness is in proportion to that of the stiffest tool, so that tools dent the
// surface rather than push it away.
constexpr double usual_stiffness = 1e4;  // of tools

bool holds(const KeptConstraint& kept) {
  return !std::holds_alternative<TrimHolds>(kept.constraint) &&
         !std::holds_alternative<TrimEdgeHold>(kept.constraint) &&
         !std::holds_alternative<MirrorSymmetry>(kept.constraint) &&
         !std::holds_alternative<EdgeSymmetry>(kept.constraint);
}

bool holds_more_than_edges(const SceneSurface& s) {
  return s.hold_rows > 0 || !s.pins.empty() || std::ranges::any_of(s.constraints, holds) ||
         std::ranges::find(s.mask, 1.0) != s.mask.end();
}

}  // namespace

// Only of surfaces without any boundary: in each direction closed, or ending in poles at both
// sides.
bool holds_its_place(const SceneSurface& s) {
  if (!s.visible || !s.visible->edges.empty() || !holds_trims(s.constraints) ||
      holds_more_than_edges(s))
    return false;
  for (std::size_t d = 0; d < 2; ++d) {
    if (!s.visible->closed[d] && !(s.visible->poles[d][0] && s.visible->poles[d][1])) return false;
  }
  return true;
}

bool holds_anything(const SceneSurface& s) {
  if (holds_more_than_edges(s) || holds_its_place(s)) return true;
  if (!s.visible) return false;
  return std::ranges::any_of(trim_orders(s.constraints, *s.visible),
                             [](int order) { return order >= 0; });
}

namespace {

/// \param scalings of the selected surfaces
Expected<std::vector<PointForce>> anchors_of(const Scene& scene,
                                             std::span<const DomainScaling<2>> scalings,
                                             const Points& points) {
  double stiffest = usual_stiffness;
  for (const Tool& tool : scene.tools) stiffest = std::max(stiffest, tool.stiffness);
  std::vector<PointForce> result;
  int next = 0;
  for (std::size_t patch = 0; const int k : scene.selection()) {
    const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(k)];
    const int first = std::exchange(next, next + s.current->size());
    const DomainScaling<2>& scaling = scalings[patch++];
    if (!holds_its_place(s)) continue;
    const auto areas = area_forces(*s.reference, scaling, Point::UnitX());
    if (!areas) return std::unexpected(areas.error());
    PointForce& spring = result.emplace_back();
    spring.strength = anchor_stiffness * stiffest;
    const double area = areas->col(0).sum();
    for (Eigen::Index i = 0; i < areas->rows(); ++i) {
      const double share = (*areas)(i, 0) / area;
      spring.terms.emplace_back(first + static_cast<int>(i), share);
      spring.to += share * points.row(first + i).transpose();
    }
  }
  return result;
}

}  // namespace

Expected<std::vector<PointForce>> anchors(const Scene& scene, const ActiveSurface& model,
                                          const Points& points) {
  std::vector<DomainScaling<2>> scalings;
  for (int k = 0; k < static_cast<int>(scene.selection().size()); ++k)
    scalings.push_back(model.scaling(k));
  return anchors_of(scene, scalings, points);
}

Expected<std::vector<PointForce>> shell_anchors(const Scene& scene, const Points& points) {
  std::vector<DomainScaling<2>> scalings;
  for (const int k : scene.selection()) {
    const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(k)];
    if (!holds_its_place(s)) {
      scalings.emplace_back();
      continue;
    }
    auto scaling = normalised_scaling<2>(*s.reference);
    if (!scaling) return std::unexpected(scaling.error());
    scalings.push_back(std::move(*scaling));
  }
  return anchors_of(scene, scalings, points);
}

}  // namespace knead
