#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "exchange/format_list.hpp"
#include "exchange/natural_faces.hpp"
#include "exchange/part21/part21_text.hpp"

namespace knead::iges {
namespace {

constexpr double resolution = 1e-7;  // of the surfaces that meet, as in STEP

template <class Spline>
Expected<void> whole(const Spline& spline, const std::string& what) {
  for (const KnotVector& knots : spline.knots()) {
    if (knots.max_interior_multiplicity() > knots.degree()) {
      return input_error(
          "IGES knows no curve or surface that is torn along a knot", what,
          fmt::format("keep knots inside the domain to a multiplicity of {}", knots.degree()));
    }
  }
  return {};
}

}  // namespace

std::vector<std::string> curve_values(const Curve& c) {
  const KnotVector& knots = c.knots(0);
  const Points& points = c.control_points();
  const bool closed = knots.clamped() && points.row(0) == points.row(points.rows() - 1);
  Values v = {std::to_string(c.size() - 1), std::to_string(knots.degree()), "0",
              closed ? "1" : "0",           c.rational() ? "0" : "1",       "0"};
  append(v, knots.knots());
  for (Eigen::Index k = 0; k < c.size(); ++k) {
    v.push_back(c.rational() ? format_real(c.weights()[static_cast<std::size_t>(k)]) : "1.");
  }
  for (Eigen::Index k = 0; k < c.size(); ++k) append(v, std::span(points.row(k).data(), 3));
  append(v, std::array{knots.domain().lower, knots.domain().upper, 0.0, 0.0, 0.0});
  return v;
}

std::vector<std::string> surface_values(const Surface& s) {
  const auto [m, n] = s.net();
  const auto closed = brep::closed_directions(s);
  Values v = {std::to_string(m - 1),
              std::to_string(n - 1),
              std::to_string(s.knots(0).degree()),
              std::to_string(s.knots(1).degree()),
              closed[0] ? "1" : "0",
              closed[1] ? "1" : "0",
              s.rational() ? "0" : "1",
              "0",
              "0"};
  for (int d = 0; d < 2; ++d) append(v, s.knots(d).knots());
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < m; ++i) {
      v.push_back(s.rational() ? format_real(s.weights()[static_cast<std::size_t>(i * n + j)])
                               : "1.");
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < m; ++i) append(v, std::span(s.control_points().row(i * n + j).data(), 3));
  }
  for (int d = 0; d < 2; ++d)
    append(v, std::array{s.knots(d).domain().lower, s.knots(d).domain().upper});
  return v;
}

Expected<std::vector<int>> add_shells(std::span<const NamedSurface> surfaces,
                                      const std::vector<int>& numbers, Sections& to) {
  std::vector<const Surface*> shapes;
  for (const NamedSurface& s : surfaces) shapes.push_back(&s.surface);
  const auto made = detail::natural_faces(shapes);
  if (!made) return std::unexpected(made.error());
  Values vertices = {std::to_string(made->vertices.size())},
         edges = {std::to_string(made->edges.size())};
  for (const Point& p : made->vertices) append(vertices, std::span(p.data(), 3));
  const std::string corners =
      std::to_string(to.add(502, std::move(vertices), {.form = 1, .dependent = true}));
  for (const detail::NaturalEdge& e : made->edges) {
    edges.push_back(std::to_string(to.add(126, curve_values(e.curve), {.dependent = true})));
    edges.insert(edges.end(),
                 {corners, std::to_string(e.from + 1), corners, std::to_string(e.to + 1)});
  }
  const std::string list =
      std::to_string(to.add(504, std::move(edges), {.form = 1, .dependent = true}));
  std::vector<Values> shells(made->closed.size());
  for (std::size_t k = 0; k < made->faces.size(); ++k) {
    const detail::NaturalFace& face = made->faces[k];
    Values loop = {std::to_string(face.loop.size())};
    for (const auto& use : face.loop) {
      loop.insert(loop.end(),
                  {"0", list, std::to_string(use.edge + 1), use.forward ? "1" : "0", "0"});
    }
    const int bound = to.add(508, std::move(loop), {.form = 1, .dependent = true});
    const int colour = surfaces[k].colour ? to.add_colour(*surfaces[k].colour) : 0;
    const int number =
        to.add(510, {std::to_string(numbers[k]), "1", "1", std::to_string(bound)},
               {.form = 1, .name = surfaces[k].name, .colour = colour, .dependent = true});
    Values& shell = shells[static_cast<std::size_t>(face.shell)];
    shell.insert(shell.end(), {std::to_string(number), face.flipped ? "0" : "1"});
  }
  std::vector<int> result;
  for (std::size_t k = 0; k < shells.size(); ++k) {
    shells[k].insert(shells[k].begin(), std::to_string(shells[k].size() / 2));
    result.push_back(to.add(514, std::move(shells[k]), {.form = made->closed[k] ? 1 : 2}));
  }
  return result;
}

Expected<std::string> text_of(std::span<const NamedSurface> surfaces, const SaveOptions& options) {
  const auto unit = unit_of_new_file(options.unit);
  if (!unit) return std::unexpected(unit.error());
  if (surfaces.empty() && options.curves.empty()) return detail::nothing_to_write();
  double largest = 0;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    if (auto can = whole(surfaces[k].surface, surfaces[k].called()); !can)
      return std::unexpected(can.error());
    largest = std::max(largest, surfaces[k].surface.control_points().cwiseAbs().maxCoeff());
  }
  for (std::size_t k = 0; k < options.curves.size(); ++k) {
    if (auto can = whole(options.curves[k].curve, options.curves[k].called()); !can)
      return std::unexpected(can.error());
    largest = std::max(largest, options.curves[k].curve.control_points().cwiseAbs().maxCoeff());
  }
  Sections sections;
  std::vector<int> numbers;
  for (const NamedSurface& s : surfaces) {
    const int colour = s.colour ? sections.add_colour(*s.colour) : 0;
    numbers.push_back(sections.add(128, surface_values(s.surface),
                                   {.name = s.name, .colour = colour, .dependent = options.faces}));
  }
  if (options.faces && !surfaces.empty()) {
    if (auto status = add_shells(surfaces, numbers, sections); !status)
      return std::unexpected(status.error());
  }
  for (const NamedCurve& c : options.curves)
    sections.add(126, curve_values(c.curve), {.name = c.name});
  return sections.text(options.title, global_section(options.title, **unit, largest, resolution));
}

}  // namespace knead::iges
