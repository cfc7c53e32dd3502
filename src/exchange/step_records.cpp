#include "step_records.hpp"

#include <fmt/format.h>

#include "part21_text.hpp"
#include "step_print.hpp"

namespace knead::step {

std::string list_of(const std::vector<int>& records) {
  std::string text;
  for (const int k : records) text += (text.empty() ? "(#" : ",#") + std::to_string(k);
  return text + ")";
}

int StepRecords::point(const Point& p) {
  put(next_, "CARTESIAN_POINT('',(" + format_real(p.x()) + "," + format_real(p.y()) + "," + format_real(p.z()) + "))");
  return next_++;
}

int StepRecords::direction(const Point& d) {
  return add("DIRECTION('',(" + format_real(d.x()) + "," + format_real(d.y()) + "," + format_real(d.z()) + "))");
}

int StepRecords::vertex(const Point& p) { return add(fmt::format("VERTEX_POINT('',#{})", point(p))); }

int StepRecords::frame(const Point& origin, const Point& z, const Point& x) {
  const int at = point(origin), axis = direction(z), reference = direction(x);
  return add(fmt::format("AXIS2_PLACEMENT_3D('',#{},#{},#{})", at, axis, reference));
}

int StepRecords::line(const Point& origin, const Point& along) {
  const int from = point(origin), vector = add(fmt::format("VECTOR('',#{},1.)", direction(along)));
  return add(fmt::format("LINE('',#{},#{})", from, vector));
}

int StepRecords::curve(const Curve& curve) {
  std::vector<int> list;
  std::string weights;
  for (Eigen::Index k = 0; k < curve.size(); ++k) {
    list.push_back(point(curve.control_points().row(k).transpose()));
    if (!curve.rational()) continue;
    weights += (k == 0 ? "" : ",") + format_real(curve.weights()[static_cast<std::size_t>(k)]);
  }
  const auto knots = print_knots(curve.knots(0), format_shortest_real);
  const std::string own = fmt::format("{},{},.UNSPECIFIED.,.F.,.F.", curve.knots(0).degree(), list_of(list));
  const std::string listed = knots.multiplicities + "," + knots.values + ",.UNSPECIFIED.";
  return add(curve.rational() ? "(BOUNDED_CURVE()B_SPLINE_CURVE(" + own + ")B_SPLINE_CURVE_WITH_KNOTS(" + listed +
                                    ")CURVE()GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_CURVE((" + weights +
                                    "))REPRESENTATION_ITEM(''))"
                              : "B_SPLINE_CURVE_WITH_KNOTS(''," + own + "," + listed + ")");
}

void StepRecords::surface(int id, const Surface& surface, const std::string& label) {
  std::vector<int> points;
  for (Eigen::Index k = 0; k < surface.size(); ++k) {
    points.push_back(point(surface.control_points().row(k).transpose()));
  }
  put(id, print_surface(
              surface, encode_string(label),
              [&](int k) { return fmt::format("#{}", points[static_cast<std::size_t>(k)]); }, "\n"));
}

std::string StepRecords::exchange_structure() const {
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'Knead','','');\n"
         "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n" +
         text_ + "ENDSEC;\nEND-ISO-10303-21;\n";
}

}  // namespace knead::step
