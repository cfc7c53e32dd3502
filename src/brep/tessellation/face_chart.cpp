#include "face_chart.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>

#include "brep/face_region.hpp"

namespace knead::brep {

using Eigen::Vector2d;

// Coordinates in which the face is about as wide as it is in steps of its surface; straight
// directions, in which no step is needed, are scaled to the face's extent, so that they do not
// stretch the triangles that Delaunay's criterion prefers.
Chart::Chart(std::shared_ptr<const ChartedSurface> surface, std::span<const Foot> feet)
    : surface_(std::move(surface)) {
  const auto straight = surface_->straight();
  Vector2d lower = Vector2d::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  for (const Foot& foot : feet) {
    const Vector2d c = surface_->chart(foot.parameters);
    lower = lower.cwiseMin(c);
    upper = upper.cwiseMax(c);
  }
  if (feet.empty()) return;
  for (int d = 0; d < 2; ++d) {
    const double extent = surface_->plane() ? (upper - lower).maxCoeff() : upper[d] - lower[d];
    if (straight[std::size_t(d)] && extent > 0) scale_[d] = 1 / extent;
  }
}

ParameterSpace Chart::space() const {
  const ParameterSpace space = surface_->space();
  ParameterSpace result;
  const Vector2d base = surface_->foot(surface_->at({0, 0}), Vector2d(0, 0)).parameters;
  for (int d = 0; d < 2; ++d) {
    const auto k = static_cast<std::size_t>(d);
    Vector2d period = Vector2d::Zero();
    period[d] = space.periods[k];
    if (period[d] > 0) result.periods[k] = to(base + period)[d] - to(base)[d];
    for (std::size_t end = 0; end < 2; ++end) {
      if (space.poles[k][end])
        result.poles[k][end] = to(Vector2d::Constant(*space.poles[k][end]))[d];
    }
  }
  return result;
}

Expected<ChartedFace> charted_face(const Model& model, const Face& face, EdgeSampler& edges,
                                   std::shared_ptr<const ChartedSurface> surface) {
  auto loops = edges.loops(face);
  if (!loops) return std::unexpected(std::move(loops.error()));
  // Now on the left as seen from the tip of the surface's normal, not the face's.
  if (!face.same_sense) {
    for (Loop& loop : *loops) std::reverse(loop.begin(), loop.end());
  }
  Eigen::AlignedBox3d box;
  for (const Loop& loop : *loops) {
    for (const Point& p : loop) box.extend(p);
  }
  std::vector<Foot> feet;
  for (const Loop& loop : *loops) {
    const std::size_t first = feet.size();
    for (const Foot& foot : surface->feet(loop)) {
      const double off = (surface->at(foot.parameters) - loop[feet.size() - first]).norm();
      if (!(off <= off_surface * box.diagonal().norm())) {
        return model.error(face, "its edges do not lie on its surface");
      }
      feet.push_back(foot);
    }
  }
  Chart chart(surface, feet);
  std::vector<std::vector<LoopPoint>> in_chart;
  auto foot = feet.begin();
  for (const Loop& loop : *loops) {
    auto& points = in_chart.emplace_back();
    for (std::size_t k = 0; k < loop.size(); ++k, ++foot)
      points.push_back({chart.to(foot->parameters), foot->free});
  }
  auto parts = parameter_region(chart.space(), in_chart);
  if (!parts) {
    // A loop that goes up to a pole winds round it the way that its normal says.
    if (auto other = surface->other_sense())
      return charted_face(model, face, edges, std::move(other));
    return model.error(face, parts.error().what);
  }
  return ChartedFace{*std::move(loops), std::move(chart), *std::move(parts)};
}

}  // namespace knead::brep
