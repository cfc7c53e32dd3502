#include "new.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "../new_body.hpp"
#include "exchange/length_units.hpp"
#include "knead/spline/revolution.hpp"
#include "session/acts/act.hpp"
#include "session/acts/limits.hpp"

namespace knead {
namespace {

/// A sheet in z = 0, or the control points as given.
Expected<Surface> net_of(const NewCommand& c) {
  const bool explicit_points = !c.points.empty();
  std::vector<double> size = c.size.value_or(std::vector<double>{1});
  size.resize(2, size.front());
  const std::array<int, 2> net = {in_direction(c.net, 0), in_direction(c.net, 1)};
  if (c.knots_u.empty() && c.knots_v.empty() &&
      std::ranges::all_of(net, [](int n) { return n > 0; })) {
    if (auto fits = check_net_size(net); !fits) return std::unexpected(fits.error());
  }
  std::vector<KnotVector> knots;
  for (std::size_t d = 0; d < 2; ++d) {
    auto made = knots_of(c, d, net[d], "net");
    if (!made) return std::unexpected(made.error());
    if (!explicit_points && !(std::isfinite(size[d]) && size[d] > 0)) {
      return input_error(fmt::format("{} is not a size", size[d]), "size", "use two numbers > 0");
    }
    knots.push_back(std::move(*made));
  }
  const int m = knots[0].count(), n = knots[1].count();
  if (auto fits = check_net_size({m, n}); !fits) return std::unexpected(fits.error());
  if (explicit_points && static_cast<double>(c.points.size()) != static_cast<double>(m) * n) {
    return input_error(fmt::format("{} points for a net of {} x {}", c.points.size(), m, n),
                       "points", fmt::format("give {}, along v first, or another net", m * n));
  }
  if (auto checked = check_weights(c.weights, m * n); !checked)
    return std::unexpected(checked.error());
  Points points(static_cast<Eigen::Index>(m) * n, 3);
  const Interval u = knots[0].domain(), v = knots[1].domain();
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      if (explicit_points) {
        const Vector3& p = c.points[static_cast<std::size_t>(i * n + j)];
        points.row(i * n + j) << p[0], p[1], p[2];
      } else {
        points.row(i * n + j) << size[0] * ((knots[0].greville(i) - u.lower) / u.length()),
            size[1] * ((knots[1].greville(j) - v.lower) / v.length()), 0;
      }
    }
  }
  return Surface::create({knots[0], knots[1]}, std::move(points), c.weights);
}

/// The profile of a surface of revolution: control points (r, 0, z).
Expected<Curve> profile_of(const NewCommand& c) {
  const double radius = c.radius.value_or(0.5);
  if (auto checked = positive(radius, "radius"); !checked) return std::unexpected(checked.error());
  if (c.shape == "sphere") return circle_quarters({0, 0}, radius, -1, 2);
  if (c.shape == "torus") {
    const double minor = c.minor.value_or(radius / 4);
    if (auto checked = positive(minor, "minor"); !checked) return std::unexpected(checked.error());
    if (minor >= radius) {
      return input_error(
          fmt::format("the tube radius {} is not less than the radius {}", minor, radius), "minor",
          "use a smaller one, or a larger radius");
    }
    return circle_quarters({radius, 0}, minor, 0, 4);
  }
  if (c.shape == "cylinder") {
    const double height = c.height.value_or(2 * radius);
    if (auto checked = positive(height, "height"); !checked)
      return std::unexpected(checked.error());
    const int rows = in_direction(c.net, 1);
    if (auto fits = check_net_size({9, std::max(rows, 0)}); !fits)
      return std::unexpected(fits.error());
    auto knots = knots_of(c, 1, rows, "net");
    if (!knots) return std::unexpected(knots.error());
    Points points(knots->count(), 3);
    const Interval v = knots->domain();
    for (int j = 0; j < knots->count(); ++j) {
      points.row(j) << radius, 0, height * ((knots->greville(j) - v.lower) / v.length());
    }
    return Curve::create({*std::move(knots)}, std::move(points));
  }
  const int count = static_cast<int>(c.profile.size());
  auto knots = knots_of(c, 1, count, "profile");
  if (!knots) return std::unexpected(knots.error());
  if (knots->count() != count) {
    return input_error(
        fmt::format("{} points of the profile for knots of {}", count, knots->count()), "profile",
        "give as many as the knots require: their number minus the degree minus one");
  }
  if (auto checked = check_weights(c.weights, count); !checked)
    return std::unexpected(checked.error());
  Points points(count, 3);
  for (int j = 0; j < count; ++j) {
    const auto& [r, z] = c.profile[static_cast<std::size_t>(j)];
    if (r < 0) {
      return input_error(fmt::format("the radius {} is negative", r), fmt::format("profile[{}]", j),
                         "use r >= 0");
    }
    points.row(j) << r, 0, z;
  }
  return Curve::create({*std::move(knots)}, std::move(points), c.weights);
}

Expected<Surface> turned(const NewCommand& c) {
  // Already determined by the circle.
  if (!c.knots_u.empty()) {
    return input_error("round shapes have their own knots in u", "knots_u",
                       "leave it out: u is a circle of degree 2");
  }
  const bool own_profile = c.shape == "sphere" || c.shape == "torus";
  if (own_profile && !c.knots_v.empty()) {
    return input_error(fmt::format("a {} has its own knots", c.shape), "knots_v",
                       "leave it out: v is a circle too");
  }
  if (c.shape != "revolution" && !c.weights.empty()) {
    return input_error(fmt::format("a {} has its own weights", c.shape), "weights",
                       "leave them out");
  }
  const auto profile = profile_of(c);
  if (!profile) return std::unexpected(profile.error());
  if (auto fits = check_net_size({9, profile->size()}); !fits) return std::unexpected(fits.error());
  return revolve(*profile);
}

Expected<Surface> shape_of(const NewCommand& c) {
  if (c.knots_w) return input_error("surfaces have two directions", "knots_w", "leave it out");
  if (auto counted = check_counts(c, 2); !counted) return std::unexpected(counted.error());
  if (c.shape == "plane") return net_of(c);
  if (!c.points.empty()) {
    return input_error(fmt::format("both points and the shape \"{}\" are given", c.shape), "points",
                       "leave one of them out");
  }
  return turned(c);
}

}  // namespace

static constexpr Choice made_shapes[] = {
    {"plane", "a flat sheet in z = 0 with a corner in the origin"},
    {"cylinder", "without its ends, the lower one in z = 0"},
    {"sphere", "about the origin, v from pole to pole"},
    {"torus", "about the origin"},
    {"revolution", "of a profile about z"},
    {"curve", "of a `form`"},
    {"volume", "of a `form`"}};

/// What has a measure.
static constexpr std::string_view with_size[] = {"plane", "curve", "volume"},
                                  with_form[] = {"curve", "volume"},
                                  with_radius[] = {"cylinder", "sphere", "torus", "curve",
                                                   "volume"},
                                  with_height[] = {"cylinder", "curve", "volume"},
                                  with_minor[] = {"torus"}, with_turns[] = {"curve"},
                                  with_profile[] = {"revolution"};
static constexpr OnlyWith of_shape(std::span<const std::string_view> values) {
  return {"shape", values};
}

static std::span<const Choice> unit_choices() {
  static const auto texts = [] {
    std::vector<std::string> sizes;
    for (const KnownLengthUnit& unit : known_length_units())
      sizes.push_back(fmt::format("{} mm", unit.millimetres));
    return sizes;
  }();
  static const auto list = [] {
    std::vector<Choice> units;
    for (const KnownLengthUnit& unit : known_length_units())
      units.emplace_back(unit.name, texts[units.size()]);
    return units;
  }();
  return list;
}

void describe(NewCommand& c, Fields& fields) {
  fields.name("new",
              "make a surface, a curve or a volume, in a document without a file, and select it");
  fields.add("shape", c.shape, {.help = "what is made", .choices = made_shapes});
  fields.add("form", c.form,
             {.help = "of a curve or a volume",
              .fallback = "`\"line\"`, `\"box\"`",
              .only = of_shape(with_form)});
  fields.add("size", c.size,
             {.help = "of a plane: width along x (u) and height along y (v); of a line along x; of "
                      "a box along x, y, z; one number for all",
              .unit = Unit::length,
              .range = above(0),
              .fallback = "`1`",
              .uniform = true,
              .only = of_shape(with_size)});
  fields.add(
      "radius", c.radius,
      {.help = "of cylinder, sphere, circle and helix; of a torus, to the middle of its tube",
       .unit = Unit::length,
       .range = above(0),
       .fallback = "`0.5`",
       .only = of_shape(with_radius)});
  fields.add("height", c.height,
             {.help = "of a cylinder or a helix",
              .unit = Unit::length,
              .range = above(0),
              .fallback = "twice the radius",
              .only = of_shape(with_height)});
  fields.add(
      "turns", c.turns,
      {.help = "of a helix", .range = above(0), .fallback = "`3`", .only = of_shape(with_turns)});
  fields.add("minor", c.minor,
             {.help = "tube radius of a torus, less than `radius`",
              .unit = Unit::length,
              .range = above(0),
              .fallback = "a quarter of the radius",
              .only = of_shape(with_minor)});
  fields.add("profile", c.profile,
             {.help = "of a revolution: `[[r, z], …]`, r ≥ 0, control points of a B-spline of "
                      "degree `degree[1]`",
              .only = of_shape(with_profile)});
  fields.add("degree", c.degree,
             {.help = "in u and v, of a volume also w; one number for all; only v for the surfaces "
                      "cylinder and revolution; what is round has degree 2 around",
              .uniform = true});
  fields.add("net", c.net,
             {.help = "control points in each direction, likewise; of the surface cylinder only in "
                      "v, of the volume at least 3 in u and v",
              .uniform = true});
  fields.add("knots_u", c.knots_u,
             {.help = "knot vector of u, which determines the net; not for round shapes",
              .fallback = "clamped, uniform on [0, 1]"});
  fields.add("knots_v", c.knots_v,
             {.help = "knot vector of v; not for sphere and torus",
              .fallback = "clamped, uniform on [0, 1]"});
  fields.add("knots_w", c.knots_w,
             {.help = "knot vector of w, of a volume", .fallback = "clamped, uniform on [0, 1]"});
  fields.add("points", c.points,
             {.help = "instead of a form: all control points `[x, y, z]`, point (i, j) at place i "
                      "n + j of a net m × n, the last direction fastest"});
  fields.add("weights", c.weights,
             {.help = "of a plane or points: one > 0 for each control point, in the same order; of "
                      "a revolution: one for each point of the profile",
              .fallback = "none"});
  fields.add("position", c.position,
             {.help = "where the origin of the shape goes", .unit = Unit::length});
  fields.add("unit", c.unit,
             {.help = "of lengths; a document has one",
              .fallback = "that of existing surfaces, otherwise `\"mm\"`",
              .choices = unit_choices()});
  fields.add("name", c.name, {.help = "its label in the file", .fallback = "its kind"});
}

Expected<void> execute(const NewCommand& c, Act& act) {
  if (!act.document.is_fresh()) {
    return input_error("surfaces can only be made in a document without a file", {},
                       "start with `knead sculpt --new`, without a FILE");
  }
  const bool first = act.state.surfaces.empty() && act.state.bodies.empty();
  const std::string present = first ? act.document.unit()
                              : act.state.surfaces.empty()
                                  ? common_of(act.state.bodies.front()).unit
                                  : act.state.surfaces.front().unit;
  const std::string unit = c.unit.value_or(present);
  if (unit != present && !first) {
    return input_error(fmt::format("the surfaces of this document are in {}", present), "unit",
                       "give lengths in that unit: a file has one");
  }
  const std::string id =
      fmt::format("#{}", act.state.surfaces.size() + act.state.bodies.size() + 1);
  act.state.together.clear();
  if (makes_body(c)) {
    std::vector<std::string> notes;
    auto body = new_body(c, notes);
    if (!body) return std::unexpected(body.error());
    act.state.notes.insert(act.state.notes.end(), notes.begin(), notes.end());
    if (auto fits = check_document_size(act.state, control_points_of(*body).rows()); !fits)
      return fits;
    const auto label = [&](auto& s) {
      s.id = id;
      s.name = c.name.value_or(!c.points.empty() ? c.shape : s.name);
      s.unit = unit;
    };
    std::visit(label, *body);
    act.state.bodies.push_back(*std::move(body));
    act.state.body = static_cast<int>(act.state.bodies.size()) - 1;
    act.state.selected.reset();
    return {};
  }
  auto made = shape_of(c);
  if (!made) return std::unexpected(made.error());
  if (auto fits = check_document_size(act.state, made->size()); !fits) return fits;
  auto at = placed(*std::move(made), c.position);
  if (!at) return std::unexpected(at.error().within("position"));
  const std::string name = c.name.value_or(!c.points.empty()    ? "surface"
                                           : c.shape == "plane" ? "sheet"
                                                                : c.shape);
  act.state.surfaces.push_back(
      untouched<2>(id, name, unit, std::make_shared<const Surface>(*std::move(at))));
  act.state.selected = static_cast<int>(act.state.surfaces.size()) - 1;
  act.state.body.reset();
  return {};
}

}  // namespace knead
