#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/image/image.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// Where voxels stand in space: the centre of voxel (i, j, k) is at origin + directions · (i, j,
/// k).
struct VolumeFrame {
  Point origin = Point::Zero();
  /// Columns: the steps from a voxel to the next.
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();

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
    return (static_cast<std::size_t>(k) * ny + static_cast<std::size_t>(j)) * nx +
           static_cast<std::size_t>(i);
  }
  friend bool operator==(const VolumeImage&, const VolumeImage&) = default;
};

/// Errors (input): no voxels, a wrong number of values, a value that is not finite, steps that are
/// not finite or lie in a plane.
[[nodiscard]] Expected<void> check_volume(const VolumeImage& volume);

/// The volume convolved with a Gaussian of that standard deviation in space, cut at 4 σ, with the
/// voxels of the border repeated beyond it; along steps that are not perpendicular it is stretched
/// as they are. σ = 0 returns the volume. Cost: O(voxels · σ / spacing).
[[nodiscard]] VolumeImage gaussian(const VolumeImage& volume, double sigma);

/// ∇I in space at the voxels, x, y and z: that of the cubic splines through the lines of voxels,
/// mirrored at the border, which is where it has no slope.
[[nodiscard]] std::array<VolumeImage, 3> gradient(const VolumeImage& volume);

/// |∇I| of `gradient`.
[[nodiscard]] VolumeImage gradient_magnitude(const VolumeImage& volume);

/// Distance of every voxel's centre to the nearest voxel whose value is 0.5 or more, in space;
/// exact where the steps are perpendicular (P. Felzenszwalb and D. Huttenlocher, *Distance
/// transforms of sampled functions*, 2012). Infinite if there is none. Cost: O(voxels).
[[nodiscard]] VolumeImage distance_to(const VolumeImage& mask);

/// The curvature of the surfaces of equal grey, the sum of the principal ones: (|∇I|² ΔI − ∇Iᵀ H
/// ∇I) / |∇I|³ where the gradient is above 1e-3 of its largest, else 0; H by `gradient` of the
/// gradient.
[[nodiscard]] VolumeImage termination(const VolumeImage& volume);

/// The gradient vector flow of an edge map (`gradient_vector_flow` of images) in space: the
/// Laplacian by differences along the steps, lengths counted in the shortest of them. Where the
/// steps are not perpendicular it spreads along them. Cost: O(voxels · iterations).
[[nodiscard]] std::array<VolumeImage, 3> gradient_vector_flow(const VolumeImage& edges, double mu,
                                                              int iterations);

/// The tricubic spline through the centres of the voxels, mirrored at those of the border: twice
/// continuously differentiable, exact at the voxels to rounding. Beyond the border it has the value
/// and no slope there. Places are in voxels, (i, j, k). Memory: one number per voxel.
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

/// The external energy of active surfaces in a volume: that of `ImagePotential` with one dimension
/// more (the P of thesis Eq. 2.34 is −Q).
///
/// Q = line · I + edge · |∇I| + termination · κ − distance · d at voxels, between them the tricubic
/// spline through these, as a function of the place in space; the force is ∇Q. With `flow` the unit
/// vectors of the gradient vector flow act besides, on surfaces along their normals. All lengths,
/// the `smoothing` too, are those of space. Copies share the volumes.
class VolumePotential {
 public:
  /// `mask` is needed for `distance`: a volume of the same size, whose own frame is not looked at.
  /// Cost: O(voxels · (smoothing + flow iterations)) and a number per voxel for each of Q, the
  /// intensity with its sums (for `region`) and the flow's components. Errors (input): those of
  /// `check_volume` and of the settings; no mask, one of another size or without a voxel of 0.5 or
  /// more; distance between voxels whose steps are not perpendicular.
  [[nodiscard]] static Expected<VolumePotential> create(
      const VolumeImage& volume, const ImagePotentialSettings& settings = {},
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
  /// ∫ I di from the border to a place in voxels, along the first direction: by the divergence
  /// theorem its integral over a closed surface, times the first component of the normal in voxels,
  /// is the sum of the intensity inside. 0 where there is no `region`.
  [[nodiscard]] double intensity_to_the_left(const Point& voxel) const;
  /// Of the smoothed volume over its voxels.
  [[nodiscard]] double total_intensity() const;

 private:
  struct Fields;
  explicit VolumePotential(std::shared_ptr<const Fields> fields) : fields_(std::move(fields)) {}
  std::shared_ptr<const Fields> fields_;
};

/// The header of an NRRD file (teem.sourceforge.net/nrrd/format.html), versions NRRD0001 to
/// NRRD0005, of numbers in three dimensions without compression.
struct NrrdHeader {
  enum class Type { int8, uint8, int16, uint16, int32, uint32, int64, uint64, single, real };
  Type type = Type::uint8;
  std::array<int, 3> size = {0, 0, 0};
  bool big_endian = false;
  VolumeFrame frame = {};
  /// Of the axes of space, as in "left-posterior-superior"; empty if it has none.
  std::string space = {};
  std::string data_file = {};  ///< of a detached header; empty if the data follow
  std::size_t data_at = 0;     ///< where the data begin in the header's own file
  long skipped_lines = 0;      ///< of the data, then
  long skipped_bytes = 0;      ///< of the data; −1: all but the last ones that are needed

  /// Of all voxels.
  [[nodiscard]] std::size_t data_bytes() const;
};

/// Whether bytes begin as an NRRD file does.
[[nodiscard]] bool is_nrrd(std::string_view bytes);

/// Reads a header. Places of voxels: `space directions` with `space origin`; or `spacings`, with
/// `axis mins` where `centers` says what they are of; or steps of 1. Values are taken as they are:
/// `old min` and the like are ignored, as are comments, keys and units. `name` stands for the file
/// in errors. Errors (input), with the line: no NRRD file; a dimension other than 3, sizes that are
/// not positive or of more than 2^27 voxels together, a type that is no number; data that are
/// compressed, as text, or in several files; fields that cannot be read, are missing or come twice;
/// directions that are none.
[[nodiscard]] Expected<NrrdHeader> parse_nrrd_header(std::string_view bytes, std::string name = {});

/// The voxels from the data, which for an attached header are the bytes after it. Errors (input):
/// more or fewer data than the sizes ask for; values that are not finite; 64-bit integers that a
/// double cannot hold.
[[nodiscard]] Expected<VolumeImage> nrrd_volume(const NrrdHeader& header, std::string_view data);

/// A volume file, with its data from the file that a detached header names. That must be a regular
/// file in the folder of `path` or below: a header from elsewhere cannot have other files read.
/// Errors (input): those above and of `read_file`; a data file with an absolute path or "..", or
/// with links that lead out of the folder.
struct NrrdFile {
  NrrdHeader header;
  VolumeImage volume;
};
[[nodiscard]] Expected<NrrdFile> read_nrrd(const std::filesystem::path& path);
/// The same from the bytes that were read from `path`, which is not read again.
[[nodiscard]] Expected<NrrdFile> nrrd_file(std::string bytes, const std::filesystem::path& path);

/// The bytes of an attached NRRD file of 8-bit numbers, values rounded and clamped to 0 to 255, in
/// the same space.
[[nodiscard]] std::string nrrd_bytes(const VolumeImage& volume, std::string_view space = {});

}  // namespace knead
