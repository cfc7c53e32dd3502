#include "draw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "knead/spline/evaluate.hpp"

namespace knead::examples {
namespace {

constexpr double width = 640;
constexpr Colour clay = {236, 168, 92}, glass_colour = {200, 205, 215};

const Point right = Point(0.8, 0.6, 0).normalized();
const Point back = Point(-0.6, 0.8, 0).normalized();
const Point up = (Point(0, 0, 0.85) + 0.53 * back).normalized();  // of the picture
const Point towards = right.cross(up);                            // the eye

struct Facet {
  std::array<Point, 4> corners;
  std::array<bool, 4> outlined;  // the side from corner k to the next
  bool glass;
  Colour colour;
};

/// Facets of a grid of points, row by row; lines are drawn where `line` says so.
template <class Line, class ColourOf>
void add_grid(const Points& points, int rows, int columns, bool glass, const Line& line,
              const ColourOf& colour, std::vector<Facet>& facets) {
  for (int i = 0; i + 1 < rows; ++i) {
    for (int j = 0; j + 1 < columns; ++j) {
      const auto at = [&](int a, int b) { return Point(points.row(a * columns + b)); };
      facets.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)},
                        {line(1, j), line(0, i + 1), line(1, j + 1), line(0, i)},
                        glass,
                        colour(i, j)});
    }
  }
}

Expected<void> add_surface(const Surface& surface, std::size_t number, const DrawStyle& style,
                           std::vector<Facet>& facets) {
  const int facets_per_span = style.facets_per_span;
  std::array<std::vector<double>, 2> parameters;
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& knots = surface.knots()[d];
    for (int span : knots.spans()) {
      for (int k = 0; k < facets_per_span; ++k) {
        parameters[d].push_back(knots[span] +
                                (knots[span + 1] - knots[span]) * k / facets_per_span);
      }
    }
    parameters[d].push_back(knots.domain().upper);
  }
  const auto grid =
      evaluate_grid<2>(surface, {std::span<const double>(parameters[0]), parameters[1]});
  if (!grid) return std::unexpected(grid.error());
  add_grid(
      grid->points(), static_cast<int>(parameters[0].size()),
      static_cast<int>(parameters[1].size()), false,
      [&](int, int k) { return k % facets_per_span == 0; },
      [&](std::size_t i, std::size_t j) {
        const auto middle = [&](std::size_t d, std::size_t k) {
          return (parameters[d][k] + parameters[d][k + 1]) / 2;
        };
        return style.colour ? style.colour(number, {middle(0, i), middle(1, j)}) : clay;
      },
      facets);
  return {};
}

void add_tool(const Tool& tool, std::vector<Facet>& facets) {
  constexpr int rows = 24, columns = 48;
  const Placement& place = tool.shape.placement();
  // A half profile (r, z) around the tool's own z axis.
  std::vector<std::array<double, 2>> profile;
  if (const auto* sphere = std::get_if<SphereShape>(&tool.shape.shape())) {
    for (int k = 0; k <= rows; ++k) {
      const double a = std::numbers::pi * k / rows;
      profile.push_back({sphere->radius * std::sin(a), -sphere->radius * std::cos(a)});
    }
  } else if (const auto* bowl = std::get_if<BowlShape>(&tool.shape.shape())) {
    for (int side = 0; side < 2; ++side) {
      const double r = bowl->radius - side * bowl->thickness;
      for (int k = 0; k <= rows / 2; ++k) {
        const double a = 0.5 * std::numbers::pi * (side == 0 ? k : rows / 2 - k) / (rows / 2);
        profile.push_back({r * std::sin(a), -r * std::cos(a)});
      }
    }
  } else if (const auto* torus = std::get_if<TorusShape>(&tool.shape.shape())) {
    for (int k = 0; k <= rows; ++k) {
      const double a = 2 * std::numbers::pi * k / rows;
      profile.push_back({torus->major + torus->minor * std::cos(a), torus->minor * std::sin(a)});
    }
  }
  if (profile.empty()) return;
  const int count = static_cast<int>(profile.size());
  Points points(count * (columns + 1), 3);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j <= columns; ++j) {
      const double a = 2 * std::numbers::pi * j / columns;
      const auto [r, z] = profile[static_cast<std::size_t>(i)];
      const Point point(place.scale[0] * r * std::cos(a), place.scale[1] * r * std::sin(a),
                        place.scale[2] * z);
      points.row(i * (columns + 1) + j) = place.position + place.rotation * point;
    }
  }
  add_grid(
      points, count, columns + 1, true, [](int d, int k) { return k % (d == 0 ? 3 : 4) == 0; },
      [](int, int) { return glass_colour; }, facets);
}

}  // namespace

Expected<std::string> draw(std::span<const Surface> surfaces, std::span<const Tool> tools,
                           const DrawStyle& style) {
  std::vector<Facet> facets;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    if (auto status = add_surface(surfaces[k], k, style, facets); !status)
      return std::unexpected(status.error());
  }
  for (const Tool& tool : tools) add_tool(tool, facets);
  const auto depth = [](const Facet& f) {
    return (f.corners[0] + f.corners[1] + f.corners[2] + f.corners[3]).dot(towards);
  };
  std::ranges::stable_sort(facets, {}, depth);
  double lower_x = 1e300, upper_x = -1e300, lower_y = 1e300, upper_y = -1e300;
  for (const Facet& f : facets) {
    for (const Point& p : f.corners) {
      lower_x = std::min(lower_x, right.dot(p)), upper_x = std::max(upper_x, right.dot(p));
      lower_y = std::min(lower_y, up.dot(p)), upper_y = std::max(upper_y, up.dot(p));
    }
  }
  const double scale = width / std::max({upper_x - lower_x, upper_y - lower_y, 1e-300});
  const auto x = [&](const Point& p) { return 10 + scale * (right.dot(p) - lower_x); };
  const auto y = [&](const Point& p) { return 10 + scale * (upper_y - up.dot(p)); };
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" "
      "stroke-linejoin=\"round\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      20 + scale * (upper_x - lower_x), 20 + scale * (upper_y - lower_y));
  const Point light = Point(-0.3, -0.5, 0.8).normalized();
  for (const Facet& f : facets) {
    const Point normal = (f.corners[2] - f.corners[0]).cross(f.corners[3] - f.corners[1]);
    const double shade =
        normal.norm() > 0 ? 0.45 + 0.55 * std::abs(normal.normalized().dot(light)) : 1;
    const auto [r, g, b] = f.colour;
    const std::string fill = fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(r * shade),
                                         static_cast<int>(g * shade), static_cast<int>(b * shade));
    std::string points;
    for (const Point& p : f.corners) points += fmt::format("{:.1f},{:.1f} ", x(p), y(p));
    svg += f.glass
               ? fmt::format("<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"0.3\"/>\n", points,
                             fill)
               : fmt::format(
                     "<polygon points=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"0.6\"/>\n",
                     points, fill, fill);
    for (std::size_t k = 0; k < 4; ++k) {
      if (!f.outlined[k]) continue;
      const Point &a = f.corners[k], &c = f.corners[(k + 1) % 4];
      svg += fmt::format(
          "<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#503010\" stroke-opacity=\"{}\" "
          "stroke-width=\"0.7\"/>\n",
          x(a), y(a), x(c), y(c), f.glass ? 0.15 : 0.6);
    }
  }
  return svg + "</svg>\n";
}

}  // namespace knead::examples
