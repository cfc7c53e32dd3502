#include "face_region.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace knead::brep {

using Eigen::Vector2d;

namespace {

double extent_of(std::span<const Loop> loops) {
  Eigen::AlignedBox3d box;
  for (const Loop& loop : loops) {
    for (const Point& p : loop) box.extend(p);
  }
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

}  // namespace

// A wrong digit in one coordinate makes a surface so large that all tolerances in proportion to it
// exceed the face; what follows would be accepted anywhere.
Expected<void> check_extent(const Model& model, const Face& face, std::span<const Loop> loops,
                            double size) {
  const double extent = extent_of(loops);
  if (extent == 0 || extent >= least_extent * size) return {};
  return model.error(
      face,
      fmt::format("its edges, {:.3g} in extent, vanish on its surface, {:.3g} in size", extent,
                  size),
      "look for a wrong coordinate or weight of the surface");
}

Expected<std::vector<RegionPart>> region_of(const Model& model, const Face& face,
                                            EdgeSampler& edges, const SurfaceFoot& feet,
                                            double size) {
  auto loops = edges.loops(face);
  if (!loops) return std::unexpected(std::move(loops.error()));
  if (auto checked = check_extent(model, face, *loops, size); !checked)
    return std::unexpected(checked.error());
  const double extent = extent_of(*loops);
  std::vector<std::vector<LoopPoint>> in_chart;
  for (Loop& loop : *loops) {
    if (!face.same_sense) std::reverse(loop.begin(), loop.end());
    auto& points = in_chart.emplace_back();
    std::optional<Vector2d> hint;
    for (const Point& p : loop) {
      const auto found = feet.nearest(p, hint, on_surface * size);
      if (!(found.distance <= off_surface * extent + on_surface * size)) {
        return model.error(face, "its edges do not lie on its surface");
      }
      hint.reset();
      if (!found.foot.free[0] && !found.foot.free[1]) hint = found.foot.parameters;
      points.push_back({found.foot.parameters, found.foot.free});
    }
  }
  auto parts = parameter_region(feet.space(), in_chart);
  if (!parts) return model.error(face, parts.error().what);
  return parts;
}

// A region of a closed surface is unwrapped and may lie across the ends of the domain. It is
// repeated at every turn that meets [0, 1], so that a test of a point needs no periods.
void add_turns(const RegionPart& part, const ParameterSpace& space, std::vector<TrimFace>& faces) {
  Vector2d lower = part.outer.front().at, upper = lower;
  for (const auto& p : part.outer) {
    lower = lower.cwiseMin(p.at);
    upper = upper.cwiseMax(p.at);
  }
  std::array<int, 2> from = {0, 0}, to = {0, 0};
  constexpr double near = 1e-6;
  for (int d = 0; d < 2; ++d) {
    if (!(space.periods[std::size_t(d)] > 0)) continue;
    from[std::size_t(d)] = static_cast<int>(std::floor(-upper[d] + near)) + 1;
    to[std::size_t(d)] = static_cast<int>(std::ceil(1 - lower[d] - near)) - 1;
  }
  for (int i = from[0]; i <= to[0]; ++i) {
    for (int j = from[1]; j <= to[1]; ++j) {
      TrimFace& face = faces.emplace_back();
      const auto append = [&](const std::vector<RegionPoint>& polygon) {
        TrimLoop& loop = face.emplace_back();
        for (const auto& p : polygon) loop.push_back(p.at + Vector2d(i, j));
      };
      append(part.outer);
      for (const auto& hole : part.holes) append(hole);
    }
  }
}

}  // namespace knead::brep
