#include "knead/image/snake_script.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "describe/record_json.hpp"

namespace knead {
namespace {

Point point_of(const std::array<double, 3>& place) { return {place[0], place[1], place[2]}; }

/// Where a surface starts, in lengths of the step h.
Expected<SurfaceStart> start_of(const VolumeSnakeStart& from, double h) {
  SurfaceStart start{from.shape, point_of(from.centre) / h, {}, point_of(from.axis)};
  const std::size_t count = from.radii.size();
  const bool torus = from.shape == SurfaceForm::torus;
  if (torus ? count != 2 : count != 1 && count != 3) {
    return input_error(fmt::format("{} radii do not make it", count), "radii",
                       torus ? "give the ring's and the tube's" : "give one, or three");
  }
  for (std::size_t d = 0; d < 3; ++d) start.radii[d] = from.radii[std::min(d, count - 1)] / h;
  return start;
}

/// What counts as black and white.
Expected<std::array<double, 2>> grey_window(const VolumeImage& volume,
                                            const VolumeSnakeScript& script) {
  if (script.grey) {
    const auto [black, white] = *script.grey;
    if (std::isfinite(black) && std::isfinite(white) && black < white) return *script.grey;
    return input_error("black is not below white", "grey", "give the lower value first");
  }
  const auto [least, most] = std::ranges::minmax_element(volume.values);
  return std::array{*least, *least < *most ? *most : *least + 1};
}

/// The settings of one of its surfaces, with places in lengths of the step h.
SurfaceSnakeSettings settings_in_steps(const VolumeSnakeScript& script,
                                       const VolumeSnakeStart& start, double h) {
  SurfaceSnakeSettings settings = script.settings;
  settings.springs = start.springs;
  if (start.control_points) settings.control_points = *start.control_points;
  for (SurfaceSpring& spring : settings.springs) spring.to /= h;
  for (SurfaceVolcano& volcano : settings.volcanoes) {
    volcano.at /= h;
    volcano.radius /= h;
  }
  return settings;
}

}  // namespace

std::span<const Choice> choices(SurfaceForm) {
  static constexpr Choice list[] = {
      {"sphere", SurfaceForm::sphere, "or an ellipsoid where the radii differ"},
      {"torus", SurfaceForm::torus, "radii: the ring's and the tube's"}};
  return list;
}

void describe(VolumeSnakeStart& s, Fields& fields) {
  fields.name("snake", "where it starts");
  fields.add("shape", s.shape);
  fields.add("centre", s.centre, {.help = "in space", .presence = Presence::required});
  fields.add("axis", s.axis, {.help = "through the poles, or through the hole"});
  fields.add("radii", s.radii,
             {.help = "in space: one or three of a sphere, the last along the axis; of a torus the "
                      "ring's and the tube's",
              .range = above(0),
              .presence = Presence::required,
              .uniform = true});
  fields.add("control_points", s.control_points, {.fallback = "those of `settings`"});
  fields.add("springs", s.springs);
}

void describe(VolumeSnakeScript& s, Fields& fields) {
  fields.name("volume snake script", "a run of `knead snake` in a volume");
  fields.add("knead", s.version, {.help = "version of the script", .presence = Presence::required});
  fields.add("image", s.image);
  fields.add("grey", s.grey,
             {.help = "values that count as black and as white, 0 and 1",
              .fallback = "the least and the largest"});
  fields.add("mask", s.mask, {.help = "file of the mask that `distance` counts from"});
  fields.add("settings", s.settings);
  fields.add("snakes", s.snakes, {.presence = Presence::required});
}

Expected<VolumeSnakeScript> parse_volume_snake_script(std::string_view text) {
  const auto json = parse_json(text);
  if (!json) return std::unexpected(json.error());
  VolumeSnakeScript script;
  if (auto read = read_record(*json, type_of<VolumeSnakeScript>(), &script); !read) {
    return std::unexpected(read.error());
  }
  if (script.version != 2) {
    return input_error(fmt::format("version {} is not known", script.version), "knead", "use 2");
  }
  if (script.snakes.empty()) {
    return input_error("there is no snake", "snakes", R"(add {"radii":20,"centre":[50,50,50]})");
  }
  return script;
}

VolumeSnakeScript default_volume_snake_script(const VolumeImage& volume) {
  VolumeSnakeScript script;
  script.settings.control_points = {16, 12};
  script.settings.alpha = 0.05;
  script.settings.beta = 0.1;
  script.settings.motion = 0.03;
  script.settings.refine = 0.5;
  const Point middle =
      volume.frame.origin + volume.frame.directions * Point((volume.size[0] - 1) / 2.0,
                                                            (volume.size[1] - 1) / 2.0,
                                                            (volume.size[2] - 1) / 2.0);
  const Eigen::Vector3d spacing = volume.frame.spacing();
  VolumeSnakeStart start;
  double narrowest = spacing[0] * volume.size[0];
  for (Eigen::Index d = 0; d < 3; ++d) {
    start.centre[static_cast<std::size_t>(d)] = middle[d];
    narrowest = std::min(narrowest, spacing[d] * volume.size[static_cast<std::size_t>(d)]);
  }
  start.radii = {0.45 * narrowest};
  script.snakes.push_back(start);
  return script;
}

Expected<std::vector<SurfaceSnakeResult>> run_volume_snakes(
    const VolumeImage& volume, const VolumeSnakeScript& script,
    const std::optional<VolumeImage>& mask) {
  if (auto checked = check_volume(volume); !checked) return std::unexpected(checked.error());
  const double h = volume.frame.spacing().minCoeff();
  auto window = grey_window(volume, script);
  if (!window) return std::unexpected(window.error());
  VolumeImage scaled = volume;
  for (double& x : scaled.values) x = (x - (*window)[0]) / ((*window)[1] - (*window)[0]);
  scaled.frame.origin /= h;
  scaled.frame.directions /= h;
  const auto potential = VolumePotential::create(scaled, script.image, mask);
  if (!potential) return std::unexpected(potential.error());
  std::vector<ClosedSurface> starts;
  std::vector<SurfaceSnakeSettings> settings;
  for (std::size_t k = 0; k < script.snakes.size(); ++k) {
    const VolumeSnakeStart& from = script.snakes[k];
    settings.push_back(settings_in_steps(script, from, h));
    const auto start = start_of(from, h);
    auto surface = start ? closed_surface(*start, settings.back()) : std::unexpected(start.error());
    if (!surface) return std::unexpected(surface.error().within(fmt::format("snakes[{}]", k)));
    starts.push_back(std::move(*surface));
  }
  auto results = run_surface_snakes(*potential, std::move(starts), settings);
  if (!results) return std::unexpected(results.error());
  for (SurfaceSnakeResult& r : *results) {
    auto placed = r.snake.surface.with_control_points(h * r.snake.surface.control_points());
    if (!placed) return std::unexpected(placed.error());
    r.snake.surface = std::move(*placed);
  }
  return results;
}

}  // namespace knead
