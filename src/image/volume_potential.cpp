#include "knead/image/volume.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace knead {

struct VolumePotential::Fields {
  ImagePotentialSettings settings;
  std::array<int, 3> size;
  VolumeFrame frame;
  Eigen::Matrix3d to_voxels;  ///< of the directions
  std::optional<VolumeSpline> potential = {}, intensity = {}, to_the_left = {};
  std::vector<VolumeSpline> flow = {};
  double total = 0;
};

namespace {

/// Sums along the first direction by the trapezoidal rule, from the border. J with ∂J/∂i = I: by
/// the divergence theorem ∮ J n_i dA is the sum of intensity inside.
VolumeImage sums_along_rows(const VolumeImage& volume) {
  VolumeImage sums = volume;
  for (int z = 0; z < volume.size[2]; ++z) {
    for (int y = 0; y < volume.size[1]; ++y) {
      sums.at(0, y, z) = 0;
      for (int x = 1; x < volume.size[0]; ++x) {
        sums.at(x, y, z) = sums.at(x - 1, y, z) + (volume.at(x - 1, y, z) + volume.at(x, y, z)) / 2;
      }
    }
  }
  return sums;
}

/// Vectors of length one; zero where there is none.
void make_unit(std::array<VolumeImage, 3>& flow) {
  for (std::size_t k = 0; k < flow[0].values.size(); ++k) {
    const double length = std::hypot(flow[0].values[k], flow[1].values[k], flow[2].values[k]);
    for (VolumeImage& component : flow) component.values[k] /= length > 0 ? length : 1;
  }
}

Expected<VolumeImage> distance_from(const VolumeImage& volume,
                                    const std::optional<VolumeImage>& mask) {
  if (!mask)
    return input_error("there is no mask to be near", "mask", "give one, or leave out distance");
  if (auto checked = check_volume(*mask); !checked)
    return std::unexpected(checked.error().within("mask"));
  if (mask->size != volume.size) {
    const auto [ax, ay, az] = mask->size;
    const auto [bx, by, bz] = volume.size;
    return input_error(
        fmt::format("it has {} x {} x {} voxels, the volume {} x {} x {}", ax, ay, az, bx, by, bz),
        "mask", "give one of the same size");
  }
  if (!volume.frame.orthogonal()) {
    return input_error("the steps between voxels are not perpendicular", "distance",
                       "sample the volume on perpendicular ones, or leave out distance");
  }
  VolumeImage placed = *mask;
  placed.frame = volume.frame;
  VolumeImage distance = distance_to(placed);
  if (!std::isfinite(distance.values.front())) {
    return input_error("no voxel of it is set", "mask", "its voxels count from 0.5");
  }
  return distance;
}

}  // namespace

// Splines are made of what the settings use alone: each takes a number per voxel, and a volume of
// 2^27 voxels is a gigabyte each.
Expected<VolumePotential> VolumePotential::create(const VolumeImage& volume,
                                                  const ImagePotentialSettings& settings,
                                                  const std::optional<VolumeImage>& mask) {
  if (auto checked = check_volume(volume); !checked) return std::unexpected(checked.error());
  if (auto checked = check_potential_settings(settings); !checked)
    return std::unexpected(checked.error());
  const VolumeImage smooth = gaussian(volume, settings.smoothing);
  const bool flows = settings.flow != 0;
  VolumeImage q = smooth;
  for (double& x : q.values) x *= settings.line;
  const auto add = [&q](const VolumeImage& term, double weight) {
    for (std::size_t k = 0; k < q.values.size(); ++k) q.values[k] += weight * term.values[k];
  };
  VolumeImage edges;
  if (settings.edge != 0 || flows) edges = gradient_magnitude(smooth);
  if (settings.edge != 0) add(edges, settings.edge);
  if (settings.termination != 0) add(termination(smooth), settings.termination);
  if (settings.distance != 0) {
    const auto distance = distance_from(volume, mask);
    if (!distance) return std::unexpected(distance.error());
    add(*distance, -settings.distance);
  }
  Fields fields{settings, volume.size, volume.frame, volume.frame.directions.inverse()};
  if (settings.line != 0 || settings.edge != 0 || settings.termination != 0 ||
      settings.distance != 0) {
    fields.potential.emplace(q);
  }
  if (settings.region != 0) {
    fields.intensity.emplace(smooth);
    fields.to_the_left.emplace(sums_along_rows(smooth));
  }
  for (const double x : smooth.values) fields.total += x;
  if (flows) {
    auto flow = gradient_vector_flow(edges, settings.flow_smoothness, settings.flow_iterations);
    make_unit(flow);
    for (const VolumeImage& component : flow) fields.flow.emplace_back(component);
  }
  return VolumePotential(std::make_shared<const Fields>(std::move(fields)));
}

const ImagePotentialSettings& VolumePotential::settings() const { return fields_->settings; }
const std::array<int, 3>& VolumePotential::size() const { return fields_->size; }
const VolumeFrame& VolumePotential::frame() const { return fields_->frame; }
double VolumePotential::total_intensity() const { return fields_->total; }

Point VolumePotential::voxel(const Point& place) const {
  return fields_->to_voxels * (place - fields_->frame.origin);
}

double VolumePotential::value(const Point& place) const {
  return fields_->potential ? fields_->potential->value(voxel(place)) : 0;
}

// ∇ in space from the derivatives by voxels: D⁻ᵀ.
Eigen::Vector3d VolumePotential::force(const Point& place) const {
  if (!fields_->potential) return Eigen::Vector3d::Zero();
  return fields_->to_voxels.transpose() * fields_->potential->gradient(voxel(place));
}

Eigen::Vector3d VolumePotential::flow(const Point& place) const {
  Eigen::Vector3d f = Eigen::Vector3d::Zero();
  if (fields_->flow.empty()) return f;
  const Point at = voxel(place);
  for (std::size_t d = 0; d < 3; ++d)
    f[static_cast<Eigen::Index>(d)] = fields_->settings.flow * fields_->flow[d].value(at);
  return f;
}

double VolumePotential::intensity(const Point& place) const {
  return fields_->intensity ? fields_->intensity->value(voxel(place)) : 0;
}

double VolumePotential::intensity_to_the_left(const Point& voxel) const {
  return fields_->to_the_left ? fields_->to_the_left->value(voxel) : 0;
}

}  // namespace knead
