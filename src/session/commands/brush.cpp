#include "brush.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../shape_fields.hpp"
#include "knead/base/error_code.hpp"
#include "session/acts/selection.hpp"
#include "session/gestures/brushing.hpp"

namespace knead {
namespace {

constexpr double default_height = 0.25;  // of the radius
constexpr double default_pinch = 0.5;
constexpr double default_flat_core = 0.5, default_stamp_core = 0.75;
constexpr double largest_core = 0.95;
constexpr int most_copies = 64;
constexpr std::size_t most_samples = 512 * 512;  // of a pattern

Point in_space(const Vector3& v) { return {v[0], v[1], v[2]}; }

/// A point with a direction of length 1.
Expected<BrushPlace> line_of(const PointAndDirection& given, const char* field) {
  const BrushPlace line{in_space(given[0]), in_space(given[1])};
  const double length = line.normal.norm();
  if (!(line.at.allFinite() && std::isfinite(length) && length > 0)) {
    return input_error("a direction has no length, or a number is not finite", field,
                       "give [[x, y, z], [dx, dy, dz]]");
  }
  return BrushPlace{line.at, line.normal / length};
}

/// Copies by mirror planes, those that are kept among them, and around an axis.
Expected<std::vector<BrushImage>> images_of(const BrushCommand& c, const SceneSurface& surface) {
  std::vector<BrushImage> mirrors;
  if (c.mirror) {
    const auto plane = line_of(*c.mirror, "mirror");
    if (!plane) return std::unexpected(plane.error());
    mirrors.push_back(BrushImage::mirror(plane->at, plane->normal));
  }
  for (const KeptConstraint& kept : surface.constraints) {
    const auto* symmetry = std::get_if<MirrorSymmetry>(&kept.constraint);
    if (symmetry == nullptr) continue;
    const auto plane = plane_of(*symmetry, *surface.reference);
    if (!plane) return std::unexpected(plane.error());
    const BrushImage image = BrushImage::mirror(plane->point, plane->normal.normalized());
    const bool known = std::ranges::any_of(mirrors, [&](const BrushImage& m) {
      return (m.linear - image.linear).norm() < 1e-9 &&
             (m.offset - image.offset).norm() < 1e-9 * m.offset.norm();
    });
    if (!known) mirrors.push_back(image);
  }
  std::vector<BrushImage> images = {{}};
  const auto add = [&images](const BrushImage& by, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) images.push_back(by.after(images[k]));
  };
  if (c.radial > 1) {
    if (!c.axis)
      return input_error("the axis is missing", "axis", "give [[x, y, z], [dx, dy, dz]]");
    const auto axis = line_of(*c.axis, "axis");
    if (!axis) return std::unexpected(axis.error());
    for (int k = 1; k < c.radial; ++k) {
      add(BrushImage::turn(axis->at, axis->normal, 2 * std::numbers::pi * k / c.radial), 1);
    }
  }
  // Each mirror doubles what is there, turns and earlier mirrors included: the group that they
  // generate, if planes are perpendicular to each other and contain the axis.
  for (const BrushImage& mirror : mirrors) add(mirror, images.size());
  images.erase(images.begin());
  return images;
}

Expected<void> check(double x, const Range& range, const char* field) {
  if (!std::isfinite(x)) return input_error("the number is too large", field, "use a smaller one");
  if (range.holds(x)) return {};
  return input_error(fmt::format("{} is not possible", x), field,
                     "use a number " + in_words(range));
}

/// The rows of a pattern, or the shape of a tool as a pattern within the core.
Expected<StampPattern> pattern_of(const Act& act, const BrushCommand& c, double core) {
  if (c.pattern.empty() == !c.shape) {
    return input_error("a stamp is either a pattern or a shape", "pattern",
                       R"(give "pattern": [[h, …], …], or "shape": "torus")");
  }
  if (c.shape) {
    // A hand that turns it asks again and again.
    const std::optional<BrushRun>& known = act.cache.brush;
    if (known && known->shape == *c.shape && known->open.brush.core == core)
      return known->open.brush.pattern;
    ShapeFields measures;
    measures.radius = 1;
    const auto shape = make_shape(*c.shape, measures, 1, 1, act);
    if (!shape) return std::unexpected(shape.error());
    return stamp_of(*shape, core);
  }
  StampPattern pattern{static_cast<int>(c.pattern.front().size()), {}};
  for (std::size_t k = 0; k < c.pattern.size(); ++k) {
    const std::vector<double>& row = c.pattern[k];
    if (row.size() != c.pattern.front().size()) {
      return input_error(fmt::format("row {} has {} heights and the first one {}", k + 1,
                                     row.size(), pattern.columns),
                         "pattern", "give rows of the same length");
    }
    if (!std::ranges::all_of(row, [](double h) { return std::isfinite(h); })) {
      return input_error(fmt::format("a height of row {} is not finite", k + 1), "pattern",
                         "use finite numbers");
    }
    pattern.heights.insert(pattern.heights.end(), row.begin(), row.end());
  }
  if (pattern.columns < 2 || c.pattern.size() < 2 || pattern.heights.size() > most_samples) {
    return input_error(
        fmt::format("a pattern of {} × {} is not possible", c.pattern.size(), pattern.columns),
        "pattern", "give at least 2 rows of 2 heights, and at most 262,144 heights");
  }
  return pattern;
}

/// The brush in file units.
Expected<Brush> brush_of(const BrushCommand& c, double diagonal) {
  const double unit = c.relative ? diagonal : 1;
  Brush b;
  b.kind = c.kind;
  b.radius = c.radius ? *c.radius * unit : 0.1 * diagonal;
  b.height = c.height ? *c.height * unit : default_height * b.radius;
  b.strength = c.strength.value_or(c.kind == BrushKind::pinch ? default_pinch : 1);
  const bool flat =
      c.kind == BrushKind::flatten || c.kind == BrushKind::mask || c.kind == BrushKind::unmask;
  b.core = c.core.value_or(flat                         ? default_flat_core
                           : c.kind == BrushKind::stamp ? default_stamp_core
                                                        : 0);
  b.by = unit * in_space(c.by.value_or(Vector3{}));
  b.angle = c.angle.value_or(0) * std::numbers::pi / 180;
  b.factor = c.factor.value_or(1);
  b.pressure = c.presses;
  for (const auto& [x, range, field] :
       {std::tuple{b.radius, above(0), "radius"}, std::tuple{b.height, Range{}, "height"},
        std::tuple{b.strength, between(0, 1), "strength"},
        std::tuple{b.core, between(0, largest_core), "core"}, std::tuple{b.by.sum(), Range{}, "by"},
        std::tuple{b.angle, Range{}, "angle"}, std::tuple{b.factor, above(0), "factor"},
        std::tuple{c.steady, at_least(0), "steady"},
        std::tuple{static_cast<double>(c.radial), between(1, most_copies), "radial"}}) {
    if (auto fits = check(x, range, field); !fits) return std::unexpected(fits.error());
  }
  return b;
}

/// What a pen says of the points of the path has to be possible.
Expected<void> check_pen(const BrushCommand& c) {
  const auto given = [&c](std::size_t count, const char* field,
                          const char* what) -> Expected<void> {
    if (count == 0 || count == c.path.size()) return {};
    return input_error(
        fmt::format("there are {} {} for {} points of the path", count, what, c.path.size()), field,
        "give one for each, or leave them out");
  };
  if (auto fits = given(c.pressure.size(), "pressure", "pressures"); !fits) return fits;
  if (auto fits = given(c.tilt.size(), "tilt", "tilts"); !fits) return fits;
  const bool unpressed =
      c.kind == BrushKind::grab || c.kind == BrushKind::twist || c.kind == BrushKind::scale;
  if (unpressed && !c.pressure.empty()) {
    return input_error("grab, twist and scale have no pressure", "pressure", "leave it out");
  }
  for (std::size_t k = 0; k < c.tilt.size(); ++k) {
    if (in_space(c.tilt[k]).allFinite()) continue;
    return input_error("a number is not finite", fmt::format("tilt[{}]", k),
                       "give [x, y, z], the direction of the pen");
  }
  return {};
}

/// The points of the path with their surfaces.
Expected<std::vector<BrushPoint>> path_of(Act& act, const BrushCommand& c) {
  if (c.surface && !c.surfaces.empty()) {
    return input_error("the path is on one surface or on those of its points", "surfaces",
                       "give `surface` or `surfaces`");
  }
  if (!c.surfaces.empty() && c.surfaces.size() != c.path.size()) {
    return input_error(fmt::format("there are {} surfaces for {} points of the path",
                                   c.surfaces.size(), c.path.size()),
                       "surfaces", "give one for each");
  }
  auto surface = selected_surface(act, c.surface);
  std::vector<BrushPoint> path;
  for (std::size_t k = 0; k < c.path.size() && surface; ++k) {
    if (!c.surfaces.empty()) surface = selected_surface(act, c.surfaces[k], "surfaces");
    if (!surface) break;
    path.push_back({*surface, c.path[k], {}});
    if (!c.pressure.empty() && c.presses != PressureUse::none)
      path.back().pen.pressure = c.pressure[k];
    if (!c.tilt.empty()) path.back().pen.axis = in_space(c.tilt[k]).normalized();
  }
  if (!surface) return std::unexpected(surface.error());
  return path;
}

}  // namespace

std::span<const Choice> choices(BrushKind) {
  static constexpr Choice list[] = {
      {"push", BrushKind::push, "into the surface"},
      {"pull", BrushKind::pull, "out of it"},
      {"inflate", BrushKind::inflate, "along the normal of each point"},
      {"flatten", BrushKind::flatten, "towards the plane fitted under it"},
      {"smooth", BrushKind::smooth, "towards the fair shape"},
      {"pinch", BrushKind::pinch, "towards the path, within the surface"},
      {"crease", BrushKind::crease, "a sharp valley along the path"},
      {"ridge", BrushKind::ridge, "a sharp crest along it"},
      {"grab", BrushKind::grab, "drags the first place of the path"},
      {"twist", BrushKind::twist, "turns about the normal there"},
      {"scale", BrushKind::scale, "larger or smaller about it"},
      {"mask", BrushKind::mask, "paints what brushes and strokes leave alone"},
      {"unmask", BrushKind::unmask, "frees it again"},
      {"stamp", BrushKind::stamp, "a pattern or shape as a height"}};
  return list;
}

std::span<const Choice> choices(PressureUse) {
  static constexpr Choice list[] = {{"depth", PressureUse::depth, "how far points go"},
                                    {"size", PressureUse::size, "the radius"},
                                    {"both", PressureUse::both, "depth and radius"},
                                    {"none", PressureUse::none, "nothing"}};
  return list;
}

void describe(BrushCommand& c, Fields& fields) {
  fields.name("brush", "lead a brush over the surface");
  fields.add("kind", c.kind, {.help = "what it does", .presence = Presence::required});
  fields.add(
      "path", c.path,
      {.help =
           "`[[s, t], …]`, points of the surface; empty to go on with an open stroke where it is",
       .unit = Unit::fraction});
  fields.add("surface", c.surface,
             {.help = "id of the surface of the path", .fallback = "the first selected one"});
  fields.add(
      "surfaces", c.surfaces,
      {.help = "ids of the surface of each point of a path that leads over several selected ones"});
  fields.add(
      "pressure", c.pressure,
      {.help =
           "of a pen at each point of the path, linear in between; not of grab, twist and scale",
       .unit = Unit::fraction,
       .range = between(0, 1),
       .fallback = "`1`"});
  fields.add("presses", c.presses, {.help = "what `pressure` scales"});
  fields.add(
      "tilt", c.tilt,
      {.help =
           "`[[x, y, z], …]`: the direction of the pen at each point of the path, in which push, "
           "pull, crease, "
           "ridge, flatten, pinch and stamp act, up to 60° from the normal; `[0, 0, 0]` along it",
       .fallback = "the normal"});
  fields.add("radius", c.radius,
             {.help = "beyond which nothing moves, measured in space",
              .unit = Unit::length,
              .range = above(0),
              .fallback = "a tenth of the diagonal"});
  fields.add(
      "height", c.height,
      {.help = "of push, pull, inflate, crease, ridge and stamp, at full weight; either sign",
       .unit = Unit::length,
       .fallback = "a quarter of the radius"});
  fields.add("strength", c.strength,
             {.help = "of flatten, smooth and pinch: the share of the way that points go at full "
                      "weight; of mask and unmask: how much",
              .unit = Unit::fraction,
              .range = between(0, 1),
              .fallback = "`1`; of pinch `0.5`"});
  fields.add("core", c.core,
             {.help = "share of the radius with full weight; from there it falls off smoothly",
              .unit = Unit::fraction,
              .range = between(0, largest_core),
              .fallback = "`0`; of flatten, mask and unmask `0.5`, of stamp `0.75`"});
  fields.add("by", c.by,
             {.help = "of grab: `[dx, dy, dz]`", .unit = Unit::length, .fallback = "`[0, 0, 0]`"});
  fields.add("angle", c.angle,
             {.help = "of twist and stamp: counterclockwise about the normal",
              .unit = Unit::angle,
              .fallback = "`0`"});
  fields.add("factor", c.factor, {.help = "of scale", .range = above(0), .fallback = "`1`"});
  fields.add(
      "pattern", c.pattern,
      {.help =
           "of stamp: rows of heights over a square whose corners are on the radius, `1` for the "
           "whole "
           "`height`; the first row is the upper one, and columns go along the first parameter"});
  fields.add("shape", c.shape,
             {.help = "of stamp, in place of `pattern`: the shape of a tool as it is seen along "
                      "its axis, as wide as the `core`",
              .choices = shape_choices()});
  fields.add("steady", c.steady,
             {.help = "the brush is pulled along the path by a rope of this many radii, which "
                      "smooths out a trembling hand",
              .range = at_least(0)});
  fields.add("mirror", c.mirror,
             {.help = "`[[x, y, z], [nx, ny, nz]]`: point and normal of a plane in which the "
                      "stroke is repeated"});
  fields.add("axis", c.axis,
             {.help = "`[[x, y, z], [dx, dy, dz]]`: point and direction of the axis of `radial`"});
  fields.add(
      "radial", c.radial,
      {.help = "strokes around the axis, this one among them", .range = between(1, most_copies)});
  fields.add("open", c.open,
             {.help = "the next `brush` with the same settings goes on with this stroke; any other "
                      "command ends it"});
  fields.add("relative", c.relative,
             {.help = "`radius`, `height` and `by` are fractions of the diagonal"});
  describe_allowance(c.allow, fields);
}

Expected<void> execute(const BrushCommand& c, Act& act) {
  auto first = selected(act);
  if (!first) return std::unexpected(first.error());
  const auto length = diagonal(act);
  if (!length) return std::unexpected(length.error());
  auto brush = brush_of(c, *length);
  if (!brush) return std::unexpected(brush.error());
  if (c.kind == BrushKind::stamp) {
    auto pattern = pattern_of(act, c, brush->core);
    if (!pattern) return std::unexpected(pattern.error());
    brush->pattern = std::move(*pattern);
  }
  auto images = images_of(c, **first);
  if (!images) return std::unexpected(images.error());
  if (auto possible = check_pen(c); !possible) return possible;
  const auto path = path_of(act, c);
  if (!path) return std::unexpected(path.error());
  const double rope = c.steady * brush->radius;
  const auto goes_on = [&](const OpenBrush& open) {
    Brush like = *brush;  // a hand changes these as it goes
    like.by = open.brush.by;
    like.angle = open.brush.angle;
    like.factor = open.brush.factor;
    return open.brush == like && open.images == *images && open.rope == rope;
  };
  if (act.state.brush && !goes_on(*act.state.brush)) act.state.brush.reset();
  if (c.path.empty() && !act.state.brush) {
    return input_error("the path has no places", "path", "give one or more: [[s, t], ...]");
  }
  const std::size_t known = act.state.brush ? act.state.brush->path.size() : 0;
  if (acts_about_one_place(c.kind) && known + c.path.size() > 1) {
    return input_error("this kind of brush acts about one place", "path", "give one: [[s, t]]");
  }
  if (act.state.brush) act.state.brush->brush = *brush;
  const bool open = c.open.value_or(false);
  if (auto status = make(BrushStroke(act), {*brush, *images, rope}, *path, open); !status)
    return status;
  act.cache.brush->shape = c.shape.value_or("");
  if (act.cache.brush->stuck &&
      !open) {  // not of a stroke that may still come to where something is free
    return numerical_error(
        "nothing is free to move under the brush", "brush",
        R"(brush elsewhere, or release what is held or masked: {"do":"release"})",
        {ErrorCode::nothing_free_at_brush});
  }
  return {};
}

}  // namespace knead
