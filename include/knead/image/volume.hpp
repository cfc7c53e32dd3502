#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// Where voxels stand in space: the centre of voxel (i, j, k) is at origin + directions · (i, j, k).
struct VolumeFrame {
  Point origin = Point::Zero();
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();  ///< columns: the steps from a voxel to the next

  /// Lengths of the steps.
  [[nodiscard]] Eigen::Vector3d spacing() const { return directions.colwise().norm(); }
  /// Whether the steps are perpendicular, to 1e-6 of their lengths.
  [[nodiscard]] bool orthogonal() const;
  friend bool operator==(const VolumeFrame&, const VolumeFrame&) = default;
};

/// A grey image in space: `values[(k * size[1] + j) * size[0] + i]` is voxel (i, j, k).
struct VolumeImage {
  std::array<int, 3> size = {0, 0, 0};
  std::vector<double> values = {};
  VolumeFrame frame = {};

  [[nodiscard]] double at(int i, int j, int k) const { return values[index(i, j, k)]; }
  [[nodiscard]] double& at(int i, int j, int k) { return values[index(i, j, k)]; }
  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    const auto nx = static_cast<std::size_t>(size[0]), ny = static_cast<std::size_t>(size[1]);
    return (static_cast<std::size_t>(k) * ny + static_cast<std::size_t>(j)) * nx + static_cast<std::size_t>(i);
  }
  friend bool operator==(const VolumeImage&, const VolumeImage&) = default;
};

/// Errors (input): no voxels, a wrong number of values, a value that is not finite, steps that are not finite or lie in
/// a plane.
[[nodiscard]] Expected<void> check_volume(const VolumeImage& volume);

/// The volume convolved with a Gaussian of that standard deviation in space, cut at 4 σ, with the voxels of the border
/// repeated beyond it; along steps that are not perpendicular it is stretched as they are. σ = 0 returns the volume.
/// Cost: O(voxels · σ / spacing).
[[nodiscard]] VolumeImage gaussian(const VolumeImage& volume, double sigma);

/// ∇I in space at the voxels, x, y and z: that of the cubic splines through the lines of voxels, mirrored at the
/// border, which is where it has no slope.
[[nodiscard]] std::array<VolumeImage, 3> gradient(const VolumeImage& volume);

/// |∇I| of `gradient`.
[[nodiscard]] VolumeImage gradient_magnitude(const VolumeImage& volume);

/// Distance of every voxel's centre to the nearest voxel whose value is 0.5 or more, in space; exact where the steps
/// are perpendicular (P. Felzenszwalb and D. Huttenlocher, *Distance transforms of sampled functions*, 2012). Infinite
/// if there is none. Cost: O(voxels).
[[nodiscard]] VolumeImage distance_to(const VolumeImage& mask);

/// The curvature of the surfaces of equal grey, the sum of the principal ones: (|∇I|² ΔI − ∇Iᵀ H ∇I) / |∇I|³ where the
/// gradient is above 1e-3 of its largest, else 0; H by `gradient` of the gradient.
[[nodiscard]] VolumeImage termination(const VolumeImage& volume);

/// The gradient vector flow of an edge map (`gradient_vector_flow` of images) in space: the Laplacian by differences
/// along the steps, lengths counted in the shortest of them. Where the steps are not perpendicular it spreads along
/// them. Cost: O(voxels · iterations).
[[nodiscard]] std::array<VolumeImage, 3> gradient_vector_flow(const VolumeImage& edges, double mu, int iterations);

/// The tricubic spline through the centres of the voxels, mirrored at those of the border: twice continuously
/// differentiable, exact at the voxels to rounding. Beyond the border it has the value and no slope there. Places are
/// in voxels, (i, j, k). Memory: one number per voxel.
class VolumeSpline {
 public:
  explicit VolumeSpline(const VolumeImage& volume);

  [[nodiscard]] double value(const Point& voxel) const;
  /// The derivatives along the steps; zero along one that leads beyond the border.
  [[nodiscard]] Eigen::Vector3d gradient(const Point& voxel) const;

 private:
  /// Value and derivatives.
  [[nodiscard]] Eigen::Vector4d sum(const Point& voxel, bool derivatives) const;

  std::array<int, 3> size_;
  std::vector<double> coefficients_;  ///< one more beyond each border
};

}  // namespace knead
