#include "step_sheet.hpp"

#include <cstdio>
#include <span>
#include <vector>

namespace knead::testing {
namespace {

std::string real(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.16E", value);
  return text;
}

template <class List, class F>
std::string listed(const List& list, F text) {
  std::string all;
  for (const auto& entry : list) all += (all.empty() ? "" : ",") + text(entry);
  return "(" + all + ")";
}

struct DistinctKnots {
  std::vector<double> values;
  std::vector<int> multiplicities;
};

DistinctKnots distinct(std::span<const double> knots) {
  DistinctKnots d;
  for (double knot : knots) {
    if (d.values.empty() || d.values.back() != knot) {
      d.values.push_back(knot);
      d.multiplicities.push_back(0);
    }
    ++d.multiplicities.back();
  }
  return d;
}

/// F(i, j) over the net, as the nested lists of the standard.
template <class F>
std::string net_of(const Surface& surface, F entry) {
  const auto [m, n] = surface.net();
  std::string rows;
  for (int i = 0; i < m; ++i) {
    std::string row;
    for (int j = 0; j < n; ++j) row += (j == 0 ? "" : ",") + entry(i * n + j);
    rows += (i == 0 ? "(" : ",(") + row + ")";
  }
  return "(" + rows + ")";
}

}  // namespace

std::string step_sheet(const Surface& surface, const std::string& unit_prefix) {
  constexpr int first_point = 100;
  const DistinctKnots u = distinct(surface.knots(0).knots()),
                      v = distinct(surface.knots(1).knots());
  const auto whole = [](int k) { return std::to_string(k); };
  const std::string degrees =
      whole(surface.knots(0).degree()) + "," + whole(surface.knots(1).degree());
  const std::string net =
      net_of(surface, [](int k) { return "#" + std::to_string(first_point + k); });
  const std::string shape = degrees + "," + net + ",.UNSPECIFIED.,.F.,.F.,.F.";
  const std::string knots = listed(u.multiplicities, whole) + "," +
                            listed(v.multiplicities, whole) + "," + listed(u.values, real) + "," +
                            listed(v.values, real) + ",.UNSPECIFIED.";
  std::string text =
      "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');"
      "\n"
      "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n#1=(LENGTH_UNIT()NAMED_UNIT(*)SI_"
      "UNIT(" +
      unit_prefix +
      ",.METRE.));\n"
      "#2=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#1))REPRESENTATION_"
      "CONTEXT('',''));\n"
      "#3=GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION('',(#4),#2);\n#4=GEOMETRIC_SET('',(#"
      "10));\n";
  if (surface.rational()) {
    const auto weights = surface.weights();
    text += "#10=(BOUNDED_SURFACE()B_SPLINE_SURFACE(" + shape + ")B_SPLINE_SURFACE_WITH_KNOTS(" +
            knots + ")GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(" +
            net_of(surface, [&](int k) { return real(weights[static_cast<std::size_t>(k)]); }) +
            ")REPRESENTATION_ITEM('sheet')SURFACE());\n";
  } else {
    text += "#10=B_SPLINE_SURFACE_WITH_KNOTS('sheet'," + shape + "," + knots + ");\n";
  }
  for (int k = 0; k < surface.size(); ++k) {
    const auto p = surface.control_points().row(k);
    text += "#" + std::to_string(first_point + k) + "=CARTESIAN_POINT('',(" + real(p[0]) + "," +
            real(p[1]) + "," + real(p[2]) + "));\n";
  }
  return text + "ENDSEC;\nEND-ISO-10303-21;\n";
}

}  // namespace knead::testing
