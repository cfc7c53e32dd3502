#pragma once

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "exchange/face_builder.hpp"
#include "knead/spline/revolution.hpp"
#include "knead/spline/spline_refinement.hpp"

/// STEP files as other systems write them: small ones, of every kind that foreign files show.
namespace knead::testing {

/// Writes whole files: splines, units and products beside the faces.
class StepBuilder : public FaceBuilder {
 public:
  /// The context of representations in "mm", "m" or "inch".
  int context(const std::string& unit) {
    int length = entity(unit == "m" ? "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))"
                                    : "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
    if (unit == "inch") {
      const int exponents = entity("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)");
      const int measure =
          entity(fmt::format("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(2.54E1),#{})", length));
      length = entity(fmt::format("(CONVERSION_BASED_UNIT('INCH',#{})LENGTH_UNIT()NAMED_UNIT(#{}))",
                                  measure, exponents));
    }
    const int angle = entity("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
    const int solid = entity("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
    const int near = entity(fmt::format(
        "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-6),#{},'distance_accuracy_value','')",
        length));
    return entity(
        fmt::format("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{}))"
                    "GLOBAL_UNIT_ASSIGNED_CONTEXT((#{},#{},#{}))REPRESENTATION_CONTEXT('','3D'))",
                    near, length, angle, solid));
  }

  struct Product {
    int definition = 0, representation = 0, frame = 0;
  };
  /// A product whose shape is a representation of this type; `items` are there beside its frame.
  Product product(const std::string& name, const std::string& type, const std::vector<int>& items,
                  int context) {
    const int application = entity("APPLICATION_CONTEXT('mechanical design')");
    const int owner = entity(fmt::format("PRODUCT_CONTEXT('',#{},'mechanical')", application));
    const int made = entity(fmt::format("PRODUCT('{0}','{0}','',(#{1}))", name, owner));
    const int version = entity(fmt::format("PRODUCT_DEFINITION_FORMATION('1','',#{})", made));
    const int stage = entity(
        fmt::format("PRODUCT_DEFINITION_CONTEXT('part definition',#{},'design')", application));
    Product result;
    result.definition =
        entity(fmt::format("PRODUCT_DEFINITION('design','',#{},#{})", version, stage));
    result.frame = frame();
    std::string list = ref(result.frame);
    for (const int item : items) list += "," + ref(item);
    result.representation = entity(fmt::format("{}('{}',({}),#{})", type, name, list, context));
    const int shape = entity(fmt::format("PRODUCT_DEFINITION_SHAPE('','',#{})", result.definition));
    entity(fmt::format("SHAPE_DEFINITION_REPRESENTATION(#{},#{})", shape, result.representation));
    return result;
  }
  /// Puts a product into another, whose representation has the frame as an item.
  void place(const Product& part, const Product& whole, int frame, const std::string& name) {
    const int use = entity(fmt::format("NEXT_ASSEMBLY_USAGE_OCCURRENCE('{0}','{0}','',#{1},#{2},$)",
                                       name, whole.definition, part.definition));
    const int shape = entity(fmt::format("PRODUCT_DEFINITION_SHAPE('','',#{})", use));
    const int move =
        entity(fmt::format("ITEM_DEFINED_TRANSFORMATION('','',#{},#{})", part.frame, frame));
    const int relation =
        entity(fmt::format("(REPRESENTATION_RELATIONSHIP('','',#{},#{})"
                           "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{})"
                           "SHAPE_REPRESENTATION_RELATIONSHIP())",
                           part.representation, whole.representation, move));
    entity(fmt::format("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{},#{})", relation, shape));
  }
  int placement(std::array<double, 3> at, std::array<double, 3> axis, std::array<double, 3> along) {
    return entity(fmt::format("AXIS2_PLACEMENT_3D('',#{},#{},#{})", point(at[0], at[1], at[2]),
                              direction(axis[0], axis[1], axis[2]),
                              direction(along[0], along[1], along[2])));
  }
  int plane(std::array<double, 3> at, std::array<double, 3> normal, std::array<double, 3> along) {
    return entity(fmt::format("PLANE('',#{})", placement(at, normal, along)));
  }

  int surface(const Surface& s, const std::string& name) {
    const auto [m, n] = s.net();
    std::string net, weights;
    for (int i = 0; i < m; ++i) {
      std::vector<int> row;
      std::string row_weights;
      for (int j = 0; j < n; ++j) {
        const auto p = s.control_points().row(i * n + j);
        row.push_back(point(p[0], p[1], p[2]));
        if (s.rational())
          row_weights +=
              (j == 0 ? "" : ",") + real(s.weights()[static_cast<std::size_t>(i * n + j)]);
      }
      net += (i == 0 ? "(" : ",(") + list_of(row) + ")";
      weights += (i == 0 ? "(" : ",(") + row_weights + ")";
    }
    const auto [mu, ku] = distinct(s.knots(0));
    const auto [mv, kv] = distinct(s.knots(1));
    const std::string degrees = fmt::format("{},{},({}),.UNSPECIFIED.,.F.,.F.,.F.",
                                            s.knots(0).degree(), s.knots(1).degree(), net);
    const std::string knots = fmt::format("({}),({}),({}),({}),.UNSPECIFIED.", mu, mv, ku, kv);
    if (!s.rational())
      return entity(fmt::format("B_SPLINE_SURFACE_WITH_KNOTS('{}',{},{})", name, degrees, knots));
    return entity(
        fmt::format("(BOUNDED_SURFACE()B_SPLINE_SURFACE({})B_SPLINE_SURFACE_WITH_KNOTS({})"
                    "GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(({}))"
                    "REPRESENTATION_ITEM('{}')SURFACE())",
                    degrees, knots, weights, name));
  }
  /// The edge along a Bézier curve.
  int bezier_edge(int from, int to, const std::vector<std::array<double, 3>>& points) {
    std::vector<int> ids;
    for (const auto& p : points) ids.push_back(point(p[0], p[1], p[2]));
    const std::size_t order = points.size();
    return edge(
        from, to,
        fmt::format(
            "B_SPLINE_CURVE_WITH_KNOTS('',{0},({1}),.UNSPECIFIED.,.F.,.F.,({2},{2}),(0.,1.),"
            ".UNSPECIFIED.)",
            order - 1, list_of(ids), order));
  }
  int straight_edge(int from, int to, std::array<double, 3> a, std::array<double, 3> b) {
    return line(from, to, a, {b[0] - a[0], b[1] - a[1], b[2] - a[2]});
  }

  /// The file of these records in the opposite order, one that some systems write, with a comment
  /// before each hundredth.
  [[nodiscard]] std::string backward(const std::string& schema) const {
    const std::string all = text();
    std::string data;
    int count = 0;
    for (std::size_t end = all.size(); end > 0;) {
      const std::size_t last = end >= 2 ? all.rfind('\n', end - 2) : std::string::npos;
      const std::size_t begin = last == std::string::npos ? 0 : last + 1;
      if (++count % 100 == 0) data += "/* a note between records; #1 = no record */\n";
      data += all.substr(begin, end - begin);
      end = begin;
    }
    return file_of(schema, data);
  }
  [[nodiscard]] std::string forward(const std::string& schema) const {
    return file_of(schema, text());
  }

 private:
  static std::string file_of(const std::string& schema, const std::string& data) {
    return "ISO-10303-21;\r\nHEADER;\r\n/* of another system "
           "*/\r\nFILE_DESCRIPTION((''),'2;1');\r\n"
           "FILE_NAME('Geh\\X2\\00E4\\X0\\use','2024-01-01T00:00:00',('O''Hara'),(''),'','','');"
           "\r\nFILE_SCHEMA(('" +
           schema + "'));\r\nENDSEC;\r\nDATA;\r\n" + data + "ENDSEC;\r\nEND-ISO-10303-21;\r\n";
  }
  /// Multiplicities and distinct knots.
  static std::array<std::string, 2> distinct(const KnotVector& knots) {
    std::array<std::string, 2> result;
    const auto all = knots.knots();
    for (std::size_t k = 0; k < all.size();) {
      std::size_t next = k;
      while (next < all.size() && all[next] == all[k]) ++next;
      result[0] += (k == 0 ? "" : ",") + std::to_string(next - k);
      result[1] += (k == 0 ? "" : ",") + real(all[k]);
      k = next;
    }
    return result;
  }
};

}  // namespace knead::testing
