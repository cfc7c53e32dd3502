#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knead/image/surface_snake.hpp"
#include "knead/session/snake_script.hpp"

namespace knead {

std::span<const Choice> choices(SurfaceForm);

/// An active surface of a script: its start and what is its own.
struct VolumeSnakeStart {
  SurfaceForm shape = SurfaceForm::sphere;
  std::array<double, 3> centre = {0, 0, 0}, axis = {0, 0, 1};
  std::vector<double> radii = {};  ///< one or three of a sphere; two of a torus, the ring's and the tube's
  std::optional<std::array<int, 2>> control_points = {};
  std::vector<SurfaceSpring> springs = {};
};

/// A run of `knead snake` in a volume. Places and radii are those of the volume's space; lengths of settings are
/// counted in the shortest step between its voxels.
struct VolumeSnakeScript {
  int version = 2;
  ImagePotentialSettings image = {.smoothing = 1, .edge = 0, .region = 1};
  /// The values that count as 0 and as 1; without it the least and the largest.
  std::optional<std::array<double, 2>> grey = {};
  std::string mask = {};  ///< file of the mask that `distance` counts from
  SurfaceSnakeSettings settings = {};
  std::vector<VolumeSnakeStart> snakes = {};
};

void describe(SurfaceSpring& s, Fields& fields);
void describe(SurfaceVolcano& v, Fields& fields);
void describe(SurfaceSnakeSettings& s, Fields& fields);
void describe(VolumeSnakeStart& s, Fields& fields);
void describe(VolumeSnakeScript& s, Fields& fields);

/// Errors (input): as of `parse_snake_script`.
[[nodiscard]] Expected<VolumeSnakeScript> parse_volume_snake_script(std::string_view json);

/// Without a script: an ellipsoid in nearly all of the volume, drawn together by the region term.
[[nodiscard]] VolumeSnakeScript default_volume_snake_script(const VolumeImage& volume);

/// Active surfaces of a script in a volume, in its space. Errors (input): those of the script's fields; a volume of
/// voxels, or a mask, that `VolumePotential` refuses.
[[nodiscard]] Expected<std::vector<SurfaceSnakeResult>> run_volume_snakes(const VolumeImage& volume,
                                                                          const VolumeSnakeScript& script,
                                                                          const std::optional<VolumeImage>& mask = {});

}  // namespace knead
