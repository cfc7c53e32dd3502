#include "picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knead/base/printable.hpp"
#include "knead/energy/domain_scaling.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"

namespace knead::cli {
namespace {

/// Dark blue over teal to yellow: evenly increasing lightness (after the viridis map of matplotlib,
/// five stops).
std::string colour(double t) {
  static constexpr std::array<std::array<double, 3>, 5> stops = {
      {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};
  const double x = std::clamp(t, 0.0, 1.0) * (stops.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(x), stops.size() - 2);
  std::array<int, 3> c;
  for (std::size_t i = 0; i < 3; ++i) {
    c[i] = static_cast<int>(
        std::lround(stops[k][i] + (x - static_cast<double>(k)) * (stops[k + 1][i] - stops[k][i])));
  }
  return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
}

std::vector<double> cell_centres(const Interval& domain, int count) {
  std::vector<double> centres;
  for (int k = 0; k < count; ++k)
    centres.push_back(domain.lower + domain.length() * (k + 0.5) / count);
  return centres;
}

}  // namespace

Expected<std::string> displacement_picture(const Surface& before, const Surface& after,
                                           const std::string& title, const std::string& unit) {
  const auto scaling = normalised_scaling<2>(before);
  if (!scaling) return std::unexpected(scaling.error());
  const Interval du = before.knots(0).domain(), dv = before.knots(1).domain();
  const double side_u = scaling->factors[0] * du.length(),
               side_v = scaling->factors[1] * dv.length();
  const double scale = 480 / std::max(side_u, side_v);
  const double width = std::max(40.0, side_u * scale), height = std::max(40.0, side_v * scale);
  constexpr double cell = 8, left = 20, top = 44, legend = 110;
  const int columns = std::max(8, static_cast<int>(width / cell)),
            rows = std::max(8, static_cast<int>(height / cell));

  const std::vector<double> u = cell_centres(du, columns), v = cell_centres(dv, rows);
  const std::array<std::span<const double>, 2> cells = {u, v};
  const auto from = evaluate_grid<2>(before, cells), to = evaluate_grid<2>(after, cells);
  if (!from) return std::unexpected(from.error());
  if (!to) return std::unexpected(to.error());
  const Eigen::VectorXd ways = (to->points() - from->points()).rowwise().norm();
  const double largest = largest_distance(after, before);

  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" "
      "font-family=\"sans-serif\" "
      "font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
      "<text x=\"{}\" y=\"24\" font-size=\"14\">{}</text>\n<g shape-rendering=\"crispEdges\">\n",
      std::max(left + width + legend, 360.0), top + height + 40, left, xml_text(title));
  const double w = width / columns, h = height / rows;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns;) {
      const auto shade = [&](int column) {
        return colour(largest > 0 ? ways[static_cast<Eigen::Index>(column) * rows + j] / largest
                                  : 0);
      };
      const std::string fill = shade(i);
      int end = i + 1;  // neighbours of one colour become one rectangle
      while (end < columns && shade(end) == fill) ++end;
      svg += fmt::format(
          "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>\n",
          left + i * w, top + height - (j + 1) * h, (end - i) * w, h, fill);
      i = end;
    }
  }
  svg += "</g>\n<g stroke=\"white\" stroke-opacity=\"0.35\" stroke-width=\"0.6\">\n";
  for (int d = 0; d < 2; ++d) {
    const KnotVector& knots = before.knots(d);
    for (int s : knots.spans()) {
      if (s == knots.spans().front()) continue;
      const double t = (knots[s] - knots.domain().lower) / knots.domain().length();
      svg +=
          d == 0
              ? fmt::format("<line x1=\"{0:.2f}\" y1=\"{1:.2f}\" x2=\"{0:.2f}\" y2=\"{2:.2f}\"/>\n",
                            left + t * width, top, top + height)
              : fmt::format("<line x1=\"{0:.2f}\" y1=\"{2:.2f}\" x2=\"{1:.2f}\" y2=\"{2:.2f}\"/>\n",
                            left, left + width, top + (1 - t) * height);
    }
  }
  svg += "</g>\n";
  const double bar = left + width + 16;
  constexpr int steps = 32;
  for (int k = 0; k < steps; ++k) {
    svg += fmt::format(
        "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"14\" height=\"{:.2f}\" fill=\"{}\"/>\n", bar,
        top + height * (steps - 1 - k) / steps, height / steps + 0.5, colour((k + 0.5) / steps));
  }
  svg += fmt::format(
      "<text x=\"{0:.2f}\" y=\"{1:.2f}\">{2:.4g} {3}</text>\n<text x=\"{0:.2f}\" "
      "y=\"{4:.2f}\">0</text>\n",
      bar + 20, top + 10, largest, xml_text(unit), top + height);
  svg += fmt::format(
      "<text x=\"{:.2f}\" y=\"{:.2f}\">u \u2192</text>\n<text x=\"{:.2f}\" y=\"{:.2f}\" "
      "transform=\"rotate(-90 {:.2f} {:.2f})\">v \u2192</text>\n</svg>\n",
      left, top + height + 18, 14.0, top + height, 14.0, top + height);
  return svg;
}

}  // namespace knead::cli
