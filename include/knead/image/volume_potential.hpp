#pragma once

#include <memory>
#include <optional>

#include "knead/image/image_potential.hpp"
#include "knead/image/volume.hpp"

namespace knead {

/// The external energy of active surfaces in a volume: that of `ImagePotential` with one dimension more (the P of
/// thesis Eq. 2.34 is −Q).
///
/// Q = line · I + edge · |∇I| + termination · κ − distance · d at voxels, between them the tricubic spline through
/// these, as a function of the place in space; the force is ∇Q. With `flow` the unit vectors of the gradient vector
/// flow act besides, on surfaces along their normals. All lengths, the `smoothing` too, are those of space. Copies
/// share the volumes.
class VolumePotential {
 public:
  /// `mask` is needed for `distance`: a volume of the same size, whose own frame is not looked at. Cost: O(voxels ·
  /// (smoothing + flow iterations)) and a number per voxel for each of Q, the intensity with its sums (for `region`)
  /// and the flow's components. Errors (input): those of `check_volume` and of the settings; no mask, one of another
  /// size or without a voxel of 0.5 or more; distance between voxels whose steps are not perpendicular.
  [[nodiscard]] static Expected<VolumePotential> create(const VolumeImage& volume,
                                                        const ImagePotentialSettings& settings = {},
                                                        const std::optional<VolumeImage>& mask = {});

  [[nodiscard]] const ImagePotentialSettings& settings() const;
  [[nodiscard]] const std::array<int, 3>& size() const;
  [[nodiscard]] const VolumeFrame& frame() const;
  /// The place in voxels, (i, j, k).
  [[nodiscard]] Point voxel(const Point& place) const;

  /// Q at a place.
  [[nodiscard]] double value(const Point& place) const;
  /// ∇Q.
  [[nodiscard]] Eigen::Vector3d force(const Point& place) const;
  /// The gradient vector flow times its weight.
  [[nodiscard]] Eigen::Vector3d flow(const Point& place) const;

  /// The smoothed intensity; 0 where there is no `region`.
  [[nodiscard]] double intensity(const Point& place) const;
  /// ∫ I di from the border to a place in voxels, along the first direction: by the divergence theorem its integral
  /// over a closed surface, times the first component of the normal in voxels, is the sum of the intensity inside. 0
  /// where there is no `region`.
  [[nodiscard]] double intensity_to_the_left(const Point& voxel) const;
  /// Of the smoothed volume over its voxels.
  [[nodiscard]] double total_intensity() const;

 private:
  struct Fields;
  explicit VolumePotential(std::shared_ptr<const Fields> fields) : fields_(std::move(fields)) {}
  std::shared_ptr<const Fields> fields_;
};

}  // namespace knead
