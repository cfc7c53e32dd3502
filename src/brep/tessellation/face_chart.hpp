#pragma once

#include <memory>
#include <span>
#include <vector>

#include "brep/face_loops.hpp"
#include "brep/surfaces/face_surface.hpp"
#include "parameter_region.hpp"

namespace knead::brep {

/// The plane in which a face is cut open: whole steps where the surface is curved; where it is
/// straight the face is one step long.
class Chart {
 public:
  Chart(std::shared_ptr<const ChartedSurface> surface, std::span<const Foot> feet);

  [[nodiscard]] const ChartedSurface& surface() const { return *surface_; }
  [[nodiscard]] Eigen::Vector2d to(const Eigen::Vector2d& uv) const {
    return surface_->chart(uv).cwiseProduct(scale_);
  }
  [[nodiscard]] Eigen::Vector2d from(const Eigen::Vector2d& c) const {
    return surface_->from_chart(c.cwiseQuotient(scale_));
  }
  [[nodiscard]] ParameterSpace space() const;

 private:
  std::shared_ptr<const ChartedSurface> surface_;
  Eigen::Vector2d scale_ = Eigen::Vector2d::Ones();
};

/// A face, cut open.
struct ChartedFace {
  std::vector<Loop> loops;  ///< on the left as seen from the tip of the surface's normal
  Chart chart;
  std::vector<RegionPart> parts;  ///< in chart coordinates
};

/// Errors (input): an edge that cannot be read, edges off the surface, bounds that bound nothing.
/// \param surface the one that the face lies on, with its steps set
[[nodiscard]] Expected<ChartedFace> charted_face(const Model& model, const Face& face,
                                                 EdgeSampler& edges,
                                                 std::shared_ptr<const ChartedSurface> surface);

}  // namespace knead::brep
