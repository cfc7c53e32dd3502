#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knead/image/blobs.hpp"
#include "knead/image/snake.hpp"

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
void describe(SnakeSpring& s, Fields& fields);
void describe(SnakeVolcano& v, Fields& fields);
void describe(SnakeSettings& s, Fields& fields);
void describe(SnakeStart& s, Fields& fields);
void describe(BlobSearch& b, Fields& fields);
void describe(SnakeScript& s, Fields& fields);

/// Errors (input): JSON that is none, with its place; a field that is unknown, of the wrong type or out of range; a
/// version other than 2; no snakes.
[[nodiscard]] Expected<SnakeScript> parse_snake_script(std::string_view json);

/// Without a script: an ellipse as large as the image nearly, drawn together by the region term.
[[nodiscard]] SnakeScript default_snake_script(const Image& image);

/// Its snakes, and then those of the blobs in the image, from circles moved into the image where they are beyond.
/// Errors (input): those of `find_blobs`; there are none.
[[nodiscard]] Expected<std::vector<SnakeStart>> starts_of(const SnakeScript& script, const Image& image);

/// The settings of one of its snakes, and the points that it starts from. Errors (input): an ellipse without positive
/// radii, too few points.
[[nodiscard]] SnakeSettings settings_of(const SnakeScript& script, const SnakeStart& start);
[[nodiscard]] Expected<std::vector<std::array<double, 2>>> points_of(const SnakeStart& start);

/// `run_snakes` of a script from its starts. Errors: those of `starts_of`, `points_of` and `curve_through`, which name
/// the snake, and of `run_snakes`.
[[nodiscard]] Expected<std::vector<SnakeResult>> run_image_snakes(const ImagePotential& potential,
                                                                  const SnakeScript& script, const Image& image);

}  // namespace knead
