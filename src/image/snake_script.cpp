#include "knead/image/snake_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "describe/record_json.hpp"

namespace knead {

std::span<const Choice> choices(ImageChannel) {
  static constexpr Choice list[] = {
      {"grey", ImageChannel::grey, "0.2125 red + 0.7154 green + 0.0721 blue"},
      {"red", ImageChannel::red},
      {"green", ImageChannel::green},
      {"blue", ImageChannel::blue}};
  return list;
}

std::span<const Choice> choices(SnakeShape) {
  static constexpr Choice list[] = {
      {"ellipse", SnakeShape::ellipse, "closed, or a circle where the radii are equal"},
      {"points", SnakeShape::points, "near these, in their order"}};
  return list;
}

void describe(ImagePotentialSettings& s, Fields& fields) {
  fields.name(
      "image energy",
      "what of the image attracts; positive weights draw to what is bright, has edges, is near");
  fields.add("smoothing", s.smoothing,
             {.help = "σ of the Gaussian, pixels", .range = between(0, 100)});
  fields.add("line", s.line, {.help = "weight of the intensity"});
  fields.add("edge", s.edge, {.help = "weight of the gradient's magnitude"});
  fields.add("termination", s.termination,
             {.help = "weight of the curvature of lines of equal grey"});
  fields.add("flow", s.flow, {.help = "weight of the gradient vector flow"});
  fields.add("flow_smoothness", s.flow_smoothness, {.help = "its μ", .range = at_least(0)});
  fields.add("flow_iterations", s.flow_iterations, {.range = between(0, 100000)});
  fields.add("region", s.region,
             {.help = "weight of the grey values inside and outside being like their means"});
  fields.add("relative_region", s.relative_region,
             {.help = "the region term in units of the difference of the means, at most 1: the "
                      "same force for what is pale and what is bright"});
  fields.add("distance", s.distance, {.help = "weight of the nearness to the mask"});
}

template <int D>
void describe(SnakeSpringOf<D>& s, Fields& fields) {
  constexpr bool curve = D == 1;
  fields.name("spring", curve ? "draws a point of the snake" : "draws a point of the surface");
  fields.add("at", s.at,
             {.help = curve ? "of its parameter" : "of its parameters",
              .unit = Unit::fraction,
              .range = between(0, 1)});
  fields.add(
      "to", s.to,
      {.help = curve ? "where to, pixels" : "where to, in space", .presence = Presence::required});
  fields.add("strength", s.strength, {.help = "force per distance", .range = at_least(0)});
}
template void describe(SnakeSpringOf<1>&, Fields&);
template void describe(SnakeSpringOf<2>&, Fields&);

template <int D>
void describe(SnakeVolcanoOf<D>& v, Fields& fields) {
  constexpr bool curve = D == 1;
  fields.name("volcano", curve ? "pushes snakes away" : "pushes surfaces away");
  fields.add("at", v.at,
             {.help = curve ? "from where, pixels" : "from where, in space",
              .presence = Presence::required});
  fields.add("strength", v.strength,
             {.help = "force at the radius; it falls with the square of the distance"});
  fields.add("radius", v.radius,
             {.help = curve ? "within which it grows no more, pixels"
                            : "within which it grows no more, in space",
              .range = above(0)});
}
template void describe(SnakeVolcanoOf<1>&, Fields&);
template void describe(SnakeVolcanoOf<2>&, Fields&);

template <int D>
void describe(SnakeSettingsOf<D>& s, Fields& fields) {
  constexpr bool curve = D == 1;
  const auto of = [](std::string_view curves, std::string_view surfaces) {
    return curve ? curves : surfaces;
  };
  fields.name("settings", of("how snakes are made and move",
                             "how active surfaces are made and move; lengths in voxels, the "
                             "shortest step between two"));
  fields.add("degree", s.degree, {.range = between(2, 7)});
  fields.add("control_points", s.control_points,
             {.help = of("of each snake", "around, and from pole to pole or around the tube"),
              .range = between(3, curve ? 100000 : 1000)});
  fields.add("units", s.units,
             {.help = of("length of the parameter s that `alpha` and `beta` count in",
                         "the way around that `alpha` and `beta` count in, voxels"),
              .range = at_least(0),
              .fallback = of("the length of the start in pixels", "that of the start")});
  fields.add("alpha", s.alpha, {.help = "stretch", .range = at_least(0)});
  fields.add("beta", s.beta, {.help = "bend", .range = at_least(0)});
  fields.add("gamma", s.gamma,
             {.help = of("force per velocity, pixels per iteration",
                         "force per velocity, voxels per iteration"),
              .range = above(0)});
  fields.add("band", s.band,
             {.help = of("width of the outside that the region term compares with, pixels",
                         "width of the outside that the region term compares with, voxels"),
              .range = at_least(0),
              .fallback = of("all of the image", "all of the volume")});
  if constexpr (curve) {
    fields.add("local", s.local,
               {.help = "share of that outside that each place takes along its own normal alone, "
                        "its darkest grey value",
                .unit = Unit::fraction,
                .range = between(0, 1)});
  }
  fields.add("redistribute", s.redistribute,
             {.help = of("after so many iterations a closed snake driven along its normal that is "
                         "stretched unevenly is spread evenly; 0: never",
                         "after so many iterations a surface driven along its normal that is "
                         "stretched unevenly is spread evenly; 0: never"),
              .range = at_least(0)});
  fields.add("balloon", s.balloon,
             {.help = of("pressure outwards, of closed snakes", "pressure outwards")});
  if constexpr (curve) {
    fields.add("end_tension", s.end_tension,
               {.help = "share of the stretch at the start that pulls free ends outwards; 0: they "
                        "are drawn in, 1: the length is kept",
                .range = at_least(0)});
  }
  fields.add("max_move", s.max_move,
             {.help = of("pixels in an iteration", "voxels in an iteration"), .range = above(0)});
  fields.add("max_iterations", s.max_iterations, {.range = between(1, 1e7)});
  fields.add("motion", s.motion,
             {.help = of("a snake rests when its control points are within this of one of ten "
                         "earlier places, pixels",
                         "a surface rests when its control points are within this of one of ten "
                         "earlier places, voxels"),
              .range = at_least(0)});
  fields.add("refine", s.refine,
             {.help = of("halves spans where that changes the contour by more, pixels; 0: never",
                         "halves all spans where that moves the surface by more, voxels; 0: never"),
              .range = at_least(0)});
  fields.add("max_control_points", s.max_control_points,
             {.help = "up to which", .range = between(1, 100000)});
  fields.add("volcanoes", s.volcanoes);
}
template void describe(SnakeSettingsOf<1>&, Fields&);
template void describe(SnakeSettingsOf<2>&, Fields&);

void describe(SnakeStart& s, Fields& fields) {
  fields.name("snake", "where it starts");
  fields.add("shape", s.shape);
  fields.add(
      "centre", s.centre,
      {.help = "of an ellipse, pixels: x to the right, y down from the first pixel's centre"});
  fields.add("radii", s.radii,
             {.help = "of an ellipse, pixels", .range = at_least(0), .uniform = true});
  fields.add("angle", s.angle, {.help = "of its first radius, clockwise, degrees"});
  fields.add("points", s.points, {.help = "`[[x, y], …]`"});
  fields.add("closed", s.closed);
  fields.add("hold_ends", s.hold_ends, {.help = "of an open one"});
  fields.add("control_points", s.control_points, {.fallback = "those of `settings`"});
  fields.add("springs", s.springs);
}

void describe(BlobSearch& b, Fields& fields) {
  fields.name("blobs", "a closed snake for each blob that is found, from a circle in it");
  fields.add("radii", b.settings.radii, {.help = "least and largest, pixels", .range = above(0)});
  fields.add("contrast", b.settings.contrast,
             {.help = "least, white being 1", .range = at_least(0)});
  fields.add("dark", b.settings.dark, {.help = "darker than what is around them"});
  fields.add("start", b.start,
             {.help = "radius of the circle for one of the blob", .range = above(0)});
}

void describe(SnakeScript& s, Fields& fields) {
  fields.name("snake script", "a run of `knead snake`");
  fields.add("knead", s.version, {.help = "version of the script", .presence = Presence::required});
  fields.add("channel", s.channel, {.help = "what of a colour image counts"});
  fields.add("image", s.image);
  fields.add("mask", s.mask, {.help = "file of the mask that `distance` counts from"});
  fields.add("settings", s.settings);
  fields.add("blobs", s.blobs);
  fields.add("snakes", s.snakes, {.fallback = "those of `blobs`"});
}

Expected<SnakeScript> parse_snake_script(std::string_view text) {
  const auto json = parse_json(text);
  if (!json) return std::unexpected(json.error());
  SnakeScript script;
  if (auto read = read_record(*json, type_of<SnakeScript>(), &script); !read)
    return std::unexpected(read.error());
  if (script.version != 2) {
    return input_error(fmt::format("version {} is not known", script.version), "knead", "use 2");
  }
  if (script.snakes.empty() && !script.blobs)
    return input_error("there is no snake", "snakes", R"(add {"radii":20,"centre":[50,50]})");
  return script;
}

// Circles are moved into the image: a snake that begins beyond it has no forces there.
Expected<std::vector<SnakeStart>> starts_of(const SnakeScript& script, const Image& image) {
  std::vector<SnakeStart> starts = script.snakes;
  if (!script.blobs) return starts;
  const auto blobs = find_blobs(image, script.blobs->settings);
  if (!blobs) return std::unexpected(blobs.error().within("blobs"));
  for (const Blob& blob : *blobs) {
    const double radius =
        std::min({script.blobs->start * blob.radius, image.width / 2.0, image.height / 2.0});
    const double x = std::clamp(blob.x, radius, std::max(radius, image.width - 1 - radius));
    const double y = std::clamp(blob.y, radius, std::max(radius, image.height - 1 - radius));
    starts.push_back({.centre = {x, y}, .radii = {radius, radius}});
  }
  if (starts.empty())
    return input_error("none is found", "blobs", "lower the contrast, or other radii");
  return starts;
}

SnakeSettings settings_of(const SnakeScript& script, const SnakeStart& start) {
  SnakeSettings settings = script.settings;
  settings.closed = start.closed;
  settings.hold_ends = start.hold_ends;
  settings.springs = start.springs;
  if (start.control_points) settings.control_points = *start.control_points;
  return settings;
}

// 400 points: chords of an ellipse are off by 3e-5 of its radius, far below a pixel.
Expected<std::vector<std::array<double, 2>>> points_of(const SnakeStart& start) {
  if (start.shape == SnakeShape::points) return start.points;
  if (!(start.radii[0] > 0 && start.radii[1] > 0)) {
    return input_error("the ellipse has no size", "radii", "give one or two numbers above 0");
  }
  constexpr int count = 400;
  const double turned = start.angle * std::numbers::pi / 180, c = std::cos(turned),
               s = std::sin(turned);
  std::vector<std::array<double, 2>> points;
  for (int k = 0; k < count; ++k) {
    const double t = 2 * std::numbers::pi * k / count;
    const double a = start.radii[0] * std::cos(t), b = start.radii[1] * std::sin(t);
    points.push_back({start.centre[0] + a * c - b * s, start.centre[1] + a * s + b * c});
  }
  return points;
}

SnakeScript default_snake_script(const Image& image) {
  SnakeScript script;
  script.settings.units = 400;
  script.settings.alpha = 1;
  script.settings.beta = 300;
  script.settings.gamma = 0.1;
  script.settings.refine = 0.5;
  script.settings.motion = 0.02;
  SnakeStart start;
  start.centre = {(image.width - 1) / 2.0, (image.height - 1) / 2.0};
  start.radii = {0.45 * image.width, 0.45 * image.height};
  script.snakes.push_back(start);
  return script;
}

Expected<Curve> curve_of(const SnakeStart& start, const SnakeSettings& settings) {
  const auto points = points_of(start);
  return points ? curve_through(*points, settings) : std::unexpected(points.error());
}

Expected<SnakeBeginnings> beginnings_of(const SnakeScript& script, const Image& image) {
  const auto starts = starts_of(script, image);
  if (!starts) return std::unexpected(starts.error());
  SnakeBeginnings beginnings;
  for (std::size_t k = 0; k < starts->size(); ++k) {
    beginnings.settings.push_back(settings_of(script, (*starts)[k]));
    auto curve = curve_of((*starts)[k], beginnings.settings.back());
    if (!curve) return std::unexpected(curve.error().within(fmt::format("snakes[{}]", k)));
    beginnings.curves.push_back(std::move(*curve));
  }
  return beginnings;
}

Expected<std::vector<SnakeResult>> run_image_snakes(const ImagePotential& potential,
                                                    const SnakeScript& script, const Image& image) {
  const auto begin = beginnings_of(script, image);
  return begin ? run_snakes(potential, begin->curves, begin->settings)
               : std::unexpected(begin.error());
}

}  // namespace knead
