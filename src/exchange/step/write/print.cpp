#include "print.hpp"

#include <array>

#include "exchange/part21/part21_text.hpp"
#include "exchange/step/surfaces.hpp"
#include "knead/exchange/source.hpp"

namespace knead::step {

PrintedKnots print_knots(const KnotVector& knots,
                         const std::function<std::string(double)>& number) {
  PrintedKnots result;
  const auto x = knots.knots();
  for (std::size_t k = 0; k < x.size();) {
    std::size_t end = k + 1;
    while (end < x.size() && x[end] == x[k]) ++end;
    const char* separator = k == 0 ? "(" : ",";
    result.multiplicities += separator + std::to_string(end - k);
    result.values += separator + number(x[k]);
    k = end;
  }
  result.multiplicities += ")";
  result.values += ")";
  return result;
}

std::string print_net(int rows, int columns, const std::function<std::string(int)>& item,
                      std::string_view line_break) {
  std::string text = "(";
  for (int i = 0; i < rows; ++i) {
    if (i > 0) text.append(",").append(line_break);
    for (int j = 0; j < columns; ++j) text.append(j == 0 ? "(" : ",").append(item(i * columns + j));
    text += ")";
  }
  return text + ")";
}

std::string print_point(std::string_view name, const double* coordinates) {
  std::string text(name);
  text += "=CARTESIAN_POINT('',(";
  for (int k = 0; k < 3; ++k) text.append(k == 0 ? "" : ",").append(format_real(coordinates[k]));
  return text + "));";
}

// Shortest decimals that read back as the same double for knots and weights, 17 digits for points.
// Rational ones are complex records, their parts in alphabetical order (ISO 10303-21, external
// mapping).
std::string print_surface(const Surface& surface, std::string_view label,
                          const std::function<std::string(int)>& point,
                          std::string_view line_break) {
  const auto net = surface.net();
  std::array<PrintedKnots, 2> knots;
  for (std::size_t d = 0; d < 2; ++d)
    knots[d] = print_knots(surface.knots()[d], format_shortest_real);
  const auto closed = brep::closed_directions(surface);
  const std::string name(label);
  const auto degrees_and_points =
      std::to_string(surface.knots(0).degree()) + "," + std::to_string(surface.knots(1).degree()) +
      "," + print_net(net[0], net[1], point, line_break) + ",.UNSPECIFIED.," +
      (closed[0] ? ".T." : ".F.") + "," + (closed[1] ? ".T." : ".F.") + ",.U.";
  const auto listed = knots[0].multiplicities + "," + knots[1].multiplicities + "," +
                      knots[0].values + "," + knots[1].values + ",.UNSPECIFIED.";
  if (!surface.rational())
    return "B_SPLINE_SURFACE_WITH_KNOTS(" + name + "," + degrees_and_points + "," + listed + ")";
  const auto weights = print_net(
      net[0], net[1],
      [&](int k) { return format_shortest_real(surface.weights()[static_cast<std::size_t>(k)]); },
      line_break);
  return "(BOUNDED_SURFACE()B_SPLINE_SURFACE(" + degrees_and_points +
         ")B_SPLINE_SURFACE_WITH_KNOTS(" + listed +
         ")GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(" + weights +
         ")REPRESENTATION_ITEM(" + name + ")SURFACE())";
}

std::string print_curve(const Curve& curve, std::string_view label,
                        const std::function<std::string(int)>& point) {
  const auto row = [&](const std::function<std::string(int)>& item) {
    std::string text = "(";
    for (int k = 0; k < curve.size(); ++k) text.append(k == 0 ? "" : ",").append(item(k));
    return text + ")";
  };
  const PrintedKnots knots = print_knots(curve.knots(0), format_shortest_real);
  const std::string name(label);
  const Points& points = curve.control_points();
  const bool closed = curve.knots(0).clamped() && points.row(0) == points.row(points.rows() - 1);
  const auto degrees_and_points = std::to_string(curve.knots(0).degree()) + "," + row(point) +
                                  ",.UNSPECIFIED.," + (closed ? ".T." : ".F.") + ",.U.";
  const auto listed = knots.multiplicities + "," + knots.values + ",.UNSPECIFIED.";
  if (!curve.rational())
    return "B_SPLINE_CURVE_WITH_KNOTS(" + name + "," + degrees_and_points + "," + listed + ")";
  const auto weights = row(
      [&](int k) { return format_shortest_real(curve.weights()[static_cast<std::size_t>(k)]); });
  return "(BOUNDED_CURVE()B_SPLINE_CURVE(" + degrees_and_points + ")B_SPLINE_CURVE_WITH_KNOTS(" +
         listed + ")CURVE()GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_CURVE(" + weights +
         ")REPRESENTATION_ITEM(" + name + "))";
}

}  // namespace knead::step
