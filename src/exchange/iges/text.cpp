#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "exchange/length_units.hpp"
#include "exchange/natural_faces.hpp"
#include "exchange/part21/part21_text.hpp"
#include "writer.hpp"

namespace knead::iges {
namespace {

using Values = std::vector<std::string>;
constexpr std::string_view line_break = "\n";
constexpr std::size_t label_columns = 8;
constexpr double resolution = 1e-7;  // of the surfaces that meet, as in STEP

std::string ascii(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7F) result += c;
    if (byte >= 0xC0) result += '?';  // the first byte of a character
  }
  return result;
}

std::string hollerith_of(std::string_view text) {
  const std::string plain = ascii(text);
  return plain.empty() ? std::string() : fmt::format("{}H{}", plain.size(), plain);
}

/// Entities one after the other.
class Sections {
 public:
  explicit Sections(const Global& global) : global_(global) {}

  /// The directory number. `colour`: that of an entity 314, or 0. `dependent`: part of another entity.
  int add(int type, int form, Values values, const std::string& name = {}, int colour = 0, bool dependent = false) {
    const std::string label = ascii(name).substr(0, label_columns);
    if (ascii(name).size() > label_columns) {
      const int property = add(406, 15, {"1", hollerith_of(name)}, {}, 0, true);
      values.insert(values.end(), {"0", "1", std::to_string(property)});
    }
    values.insert(values.begin(), std::to_string(type));
    const int number = File::number(entities_++);
    const std::vector<std::string> lines = wrapped(values, global_, "");
    directory_ += fmt::format("{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}D{:>7}{}", type, records_ + 1, 0, 0, 0, 0,
                              0, 0, dependent ? "00010000" : "00000000", number, line_break);
    directory_ += fmt::format("{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}D{:>7}{}", type, 0, -colour, lines.size(),
                              form, "", "", label, 0, number + 1, line_break);
    for (const std::string& line : lines) {
      parameters_ += fmt::format("{:<64}{:>8}P{:>7}{}", line, number, ++records_, line_break);
    }
    return number;
  }

  [[nodiscard]] std::string text(std::string_view title, const std::string& head) const {
    std::string result = fmt::format("{:<72}S{:>7}{}", ascii(title).substr(0, letter_column), 1, line_break);
    int globals = 0;
    for (std::size_t at = 0; at < head.size(); at += letter_column) {
      result += fmt::format("{:<72}G{:>7}{}", head.substr(at, letter_column), ++globals, line_break);
    }
    return result + directory_ + parameters_ +
           fmt::format("S{:>7}G{:>7}D{:>7}P{:>7}{:<40}T{:>7}{}", 1, globals, 2 * entities_, records_, "", 1,
                       line_break);
  }

 private:
  const Global& global_;
  std::string directory_, parameters_;
  std::size_t entities_ = 0;
  int records_ = 0;
};

void append(Values& to, std::span<const double> numbers) {
  for (const double x : numbers) to.push_back(format_real(x));
}

/// Vertices, edges, loops, faces and shells over surfaces with these directory numbers.
Expected<void> add_shells(std::span<const NamedSurface> surfaces, const std::vector<int>& numbers,
                          const std::vector<int>& colours, Sections& to) {
  std::vector<const Surface*> shapes;
  for (const NamedSurface& s : surfaces) shapes.push_back(&s.surface);
  const auto made = detail::natural_faces(shapes);
  if (!made) return std::unexpected(made.error());
  Values vertices = {std::to_string(made->vertices.size())}, edges = {std::to_string(made->edges.size())};
  for (const Point& p : made->vertices) append(vertices, std::span(p.data(), 3));
  const std::string corners = std::to_string(to.add(502, 1, std::move(vertices), {}, 0, true));
  for (const detail::NaturalEdge& e : made->edges) {
    edges.push_back(std::to_string(to.add(126, 0, curve_values(e.curve), {}, 0, true)));
    edges.insert(edges.end(), {corners, std::to_string(e.from + 1), corners, std::to_string(e.to + 1)});
  }
  const std::string list = std::to_string(to.add(504, 1, std::move(edges), {}, 0, true));
  std::vector<Values> shells(made->closed.size());
  for (std::size_t k = 0; k < made->faces.size(); ++k) {
    const detail::NaturalFace& face = made->faces[k];
    Values loop = {std::to_string(face.loop.size())};
    for (const auto& use : face.loop) {
      loop.insert(loop.end(), {"0", list, std::to_string(use.edge + 1), use.forward ? "1" : "0", "0"});
    }
    const int bound = to.add(508, 1, std::move(loop), {}, 0, true);
    const int number = to.add(510, 1, {std::to_string(numbers[k]), "1", "1", std::to_string(bound)}, surfaces[k].name,
                              colours[k], true);
    Values& shell = shells[static_cast<std::size_t>(face.shell)];
    shell.insert(shell.end(), {std::to_string(number), face.flipped ? "0" : "1"});
  }
  for (std::size_t k = 0; k < shells.size(); ++k) {
    shells[k].insert(shells[k].begin(), std::to_string(shells[k].size() / 2));
    to.add(514, made->closed[k] ? 1 : 2, std::move(shells[k]));
  }
  return {};
}

std::string global_section(const SaveOptions& options, const KnownLengthUnit& unit, double largest) {
  const std::string title = hollerith_of(options.title);
  return fmt::format(
      "1H,,1H;,{0},{0},5HKnead,5HKnead,32,38,6,308,15,{0},1.,{1},{2},1,0.1,15H20000101.000000,{3},{4},,,11,0,"
      "15H20000101.000000;",
      title, unit.iges_flag, hollerith_of(unit.iges_name), format_shortest_real(resolution), format_real(largest));
}

template <class Spline>
Expected<void> whole(const Spline& spline, const std::string& what) {
  for (const KnotVector& knots : spline.knots()) {
    if (knots.max_interior_multiplicity() > knots.degree()) {
      return input_error("IGES knows none that is torn along a knot", what,
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
      v.push_back(s.rational() ? format_real(s.weights()[static_cast<std::size_t>(i * n + j)]) : "1.");
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < m; ++i) append(v, std::span(s.control_points().row(i * n + j).data(), 3));
  }
  for (int d = 0; d < 2; ++d) append(v, std::array{s.knots(d).domain().lower, s.knots(d).domain().upper});
  return v;
}

Expected<std::string> text_of(std::span<const NamedSurface> surfaces, const SaveOptions& options) {
  const std::string name = options.unit.empty() ? "mm" : options.unit;
  const KnownLengthUnit* unit = length_unit_named(name);
  if (unit == nullptr || unit->iges_flag == 0) {
    return input_error("the unit " + name + " is not known to IGES", {},
                       "use " + list_of_units([](const KnownLengthUnit& u) { return u.iges_flag != 0; }));
  }
  if (surfaces.empty() && options.curves.empty()) return input_error("there is no surface to write");
  double largest = 0;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    if (auto can = whole(surfaces[k].surface, fmt::format("surface {}", k)); !can) return std::unexpected(can.error());
    largest = std::max(largest, surfaces[k].surface.control_points().cwiseAbs().maxCoeff());
  }
  for (std::size_t k = 0; k < options.curves.size(); ++k) {
    if (auto can = whole(options.curves[k].curve, fmt::format("curve {}", k)); !can)
      return std::unexpected(can.error());
    largest = std::max(largest, options.curves[k].curve.control_points().cwiseAbs().maxCoeff());
  }
  const Global global;
  Sections sections(global);
  std::map<std::array<double, 3>, int> made;
  std::vector<int> numbers, colours;
  for (const NamedSurface& s : surfaces) {
    int colour = 0;
    if (s.colour) {
      const auto [found, fresh] = made.try_emplace(*s.colour, 0);
      Values percent;
      for (const double part : *s.colour) percent.push_back(format_real(100 * part));
      if (fresh) found->second = sections.add(314, 0, std::move(percent));
      colour = found->second;
    }
    colours.push_back(colour);
    numbers.push_back(sections.add(128, 0, surface_values(s.surface), s.name, colour, options.faces));
  }
  if (options.faces && !surfaces.empty()) {
    if (auto done = add_shells(surfaces, numbers, colours, sections); !done) return std::unexpected(done.error());
  }
  for (const NamedCurve& c : options.curves) sections.add(126, 0, curve_values(c.curve), c.name);
  return sections.text(options.title, global_section(options, *unit, largest));
}

}  // namespace knead::iges
