#pragma once

#include <expected>
#include <memory>
#include <span>
#include <vector>

#include "context_faces.hpp"
#include "face_chart.hpp"

namespace knead::brep {

/// A face, and the surface that it lies on.
struct FaceOnSurface {
  const Face* face;
  std::shared_ptr<const ChartedSurface> surface;
};

/// Makes triangles of the faces of a file (docs/context-faces.md). Edges are sampled once, so that
/// faces meet in the same points.
class FaceTessellator {
 public:
  /// `model` must outlive it.
  FaceTessellator(const Model& model, ChordLimit chord)
      : model_(model), chord_(chord), edges_(model, chord) {}

  /// Errors (input): the face has no surface of a known form, or its edges are of an unknown one.
  [[nodiscard]] Expected<FaceOnSurface> face_on_surface(const Face& face);
  /// Whether its edges and its surface can be read: the errors of `face_on_surface`, without the
  /// search for the feet of points, which takes the time of a spline surface.
  [[nodiscard]] Expected<void> legible(const Face& face);
  /// Divides the edges of a face where their chords are longer than a step on its surface. Errors
  /// as above.
  [[nodiscard]] Expected<void> divide_edges(const FaceOnSurface& on);
  /// Errors (input): its edges do not lie on its surface, bound nothing, or cross; it needs too
  /// many points.
  [[nodiscard]] Expected<FaceMesh> mesh(const FaceOnSurface& on);
  /// Of each face. The edges of those that fail are divided more finely where that helps, as round
  /// a crescent that is narrower than chords of its arcs are high; neighbours have the same points
  /// there.
  [[nodiscard]] std::vector<Expected<FaceMesh>> meshes(std::span<const FaceOnSurface> faces);

 private:
  struct Filling;
  [[nodiscard]] bool refine_edges(const FaceOnSurface& on, std::size_t& spent);
  [[nodiscard]] Expected<std::size_t> halve_edges(std::span<const Index> edges);
  [[nodiscard]] Expected<std::unique_ptr<ChartedSurface>> surface_of(
      const Face& face, const std::vector<Loop>& loops);
  [[nodiscard]] const char* add(const RegionPart& part, const std::vector<Loop>& loops,
                                const Chart& chart, int sense, FaceMesh& mesh) const;
  [[nodiscard]] std::expected<Filling, const char*> fill(
      const Chart& chart, std::span<const std::vector<Eigen::Vector2d>> outline,
      std::span<const Point> bounds) const;
  [[nodiscard]] std::vector<Eigen::Vector2d> off(
      const Chart& chart, std::span<const std::vector<Eigen::Vector2d>> outline,
      std::span<const Point> bounds, const Filling& filling) const;

  const Model& model_;
  ChordLimit chord_;
  EdgeSampler edges_;
};

}  // namespace knead::brep
