#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knead/image/image.hpp"
#include "knead/image/snake.hpp"
#include "knead/image/surface_snake.hpp"

namespace knead {

struct Choice;
class Fields;

std::span<const Choice> choices(ImageChannel);

/// What a snake starts from, places in pixels.
enum class SnakeShape { ellipse, points };
std::span<const Choice> choices(SnakeShape);

/// A snake of a script: its start and what is its own.
struct SnakeStart {
  SnakeShape shape = SnakeShape::ellipse;
  std::array<double, 2> centre = {0, 0}, radii = {0, 0};
  double angle = 0;  ///< of the first radius against the rows, degrees, clockwise
  std::vector<std::array<double, 2>> points = {};
  bool closed = true, hold_ends = true;
  std::optional<int> control_points = {};
  std::vector<SnakeSpring> springs = {};
};

/// Snakes where blobs are found in the image.
struct BlobSearch {
  BlobSettings settings = {};
  double start = 0.5;  ///< radius of the circle that a snake starts from for one of its blob
};

/// A run of `knead snake`: the energies, what all snakes have in common, and where each starts.
struct SnakeScript {
  int version = 2;
  ImageChannel channel = ImageChannel::grey;
  ImagePotentialSettings image = {.smoothing = 1, .edge = 0, .region = 1};
  std::string mask = {};  ///< file of the mask that `distance` counts from
  SnakeSettings settings = {};
  std::optional<BlobSearch> blobs = {};
  std::vector<SnakeStart> snakes = {};
};

void describe(ImagePotentialSettings& s, Fields& fields);
template <int D>
void describe(SnakeSpringOf<D>& s, Fields& fields);
template <int D>
void describe(SnakeVolcanoOf<D>& v, Fields& fields);
template <int D>
void describe(SnakeSettingsOf<D>& s, Fields& fields);
void describe(SnakeStart& s, Fields& fields);
void describe(BlobSearch& b, Fields& fields);
void describe(SnakeScript& s, Fields& fields);

/// Errors (input): JSON that is none, with its place; a field that is unknown, of the wrong type or
/// out of range; a version other than 2; no snakes.
[[nodiscard]] Expected<SnakeScript> parse_snake_script(std::string_view json);

/// Its snakes, and then those of the blobs in the image, from circles moved into the image where
/// they are beyond. Errors (input): those of `find_blobs`; there are none.
[[nodiscard]] Expected<std::vector<SnakeStart>> starts_of(const SnakeScript& script,
                                                          const Image& image);

/// The settings of one of its snakes, and the points that it starts from. Errors (input): an
/// ellipse without positive radii, too few points.
[[nodiscard]] SnakeSettings settings_of(const SnakeScript& script, const SnakeStart& start);
[[nodiscard]] Expected<std::vector<std::array<double, 2>>> points_of(const SnakeStart& start);

/// Without a script: an ellipse as large as the image nearly, drawn together by the region term.
[[nodiscard]] SnakeScript default_snake_script(const Image& image);

/// The curve through the points of a start, on the net of its settings. Errors: those of
/// `points_of` and `curve_through`.
[[nodiscard]] Expected<Curve> curve_of(const SnakeStart& start, const SnakeSettings& settings);

/// Where the snakes of a script start, and the settings of each. Errors: those of `starts_of`, and
/// of `curve_of`, which name the snake.
struct SnakeBeginnings {
  std::vector<Curve> curves;
  std::vector<SnakeSettings> settings;
};
[[nodiscard]] Expected<SnakeBeginnings> beginnings_of(const SnakeScript& script,
                                                      const Image& image);

/// `run_snakes` of a script from its starts. Errors: those of `starts_of`, `points_of` and
/// `curve_through`, which name the snake, and of `run_snakes`.
[[nodiscard]] Expected<std::vector<SnakeResult>> run_image_snakes(const ImagePotential& potential,
                                                                  const SnakeScript& script,
                                                                  const Image& image);

/// Contours as files, places in pixels; numbers with all their digits.
///
/// JSON: the image's name and size, and per snake whether it is closed and came to rest, degree,
/// iterations, how often it crosses itself, the area inside of a closed one, knots and control
/// points. Cost: O(points²) for the crossings.
[[nodiscard]] std::string snakes_json(std::span<const SnakeResult> snakes, std::string_view name,
                                      int width, int height);

/// CSV: `snake,x,y`, 16 points per span.
[[nodiscard]] std::string snakes_csv(std::span<const SnakeResult> snakes);

/// SVG: lines through the same points, in pixels, so that it lies on the image.
[[nodiscard]] std::string snakes_svg(std::span<const SnakeResult> snakes, int width, int height);

/// 1 at pixels that are inside of any of the closed contours (`mask_of`), else 0.
[[nodiscard]] Image snakes_mask(std::span<const SnakeResult> snakes, int width, int height);

std::span<const Choice> choices(SurfaceForm);

/// An active surface of a script: its start and what is its own.
struct VolumeSnakeStart {
  SurfaceForm shape = SurfaceForm::sphere;
  std::array<double, 3> centre = {0, 0, 0}, axis = {0, 0, 1};
  /// One or three of a sphere; two of a torus, the ring's and the tube's.
  std::vector<double> radii = {};
  std::optional<std::array<int, 2>> control_points = {};
  std::vector<SurfaceSpring> springs = {};
};

/// A run of `knead snake` in a volume. Places and radii are those of the volume's space; lengths of
/// settings are counted in the shortest step between its voxels.
struct VolumeSnakeScript {
  int version = 2;
  ImagePotentialSettings image = {.smoothing = 1, .edge = 0, .region = 1};
  /// The values that count as 0 and as 1; without it the least and the largest.
  std::optional<std::array<double, 2>> grey = {};
  std::string mask = {};  ///< file of the mask that `distance` counts from
  SurfaceSnakeSettings settings = {};
  std::vector<VolumeSnakeStart> snakes = {};
};

void describe(VolumeSnakeStart& s, Fields& fields);
void describe(VolumeSnakeScript& s, Fields& fields);

/// Errors (input): as of `parse_snake_script`.
[[nodiscard]] Expected<VolumeSnakeScript> parse_volume_snake_script(std::string_view json);

/// Without a script: an ellipsoid in nearly all of the volume, drawn together by the region term.
[[nodiscard]] VolumeSnakeScript default_volume_snake_script(const VolumeImage& volume);

/// Active surfaces of a script in a volume, in its space. Errors (input): those of the script's
/// fields; a volume of voxels, or a mask, that `VolumePotential` refuses.
[[nodiscard]] Expected<std::vector<SurfaceSnakeResult>> run_volume_snakes(
    const VolumeImage& volume, const VolumeSnakeScript& script,
    const std::optional<VolumeImage>& mask = {});

/// JSON of surfaces in a volume: the volume's name and per snake form, degree, iterations, whether
/// it came to rest, how many pairs of its triangles cross, area and volume inside, knots, net and
/// control points.
[[nodiscard]] std::string volume_snakes_json(std::span<const SurfaceSnakeResult> snakes,
                                             std::string_view name);

/// 1 at voxels that are inside of any of the surfaces, else 0, on the grid of `volume`.
[[nodiscard]] VolumeImage volume_snakes_mask(std::span<const SurfaceSnakeResult> snakes,
                                             const VolumeImage& volume);

}  // namespace knead
