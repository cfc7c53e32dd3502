#pragma once

#include "exchange/face_builder.hpp"

namespace knead::testing {

/// Two bilinear squares side by side, #10 over x from 0 to 1 and #20 from 1 to 2, that share an
/// edge and two vertices.
struct TwoSheets {
  FaceBuilder builder;
  std::string text;  ///< the exchange structure
  int edge = 0;      ///< from (1, 0, 0) to (1, 1, 0)
  int outer = 0;     ///< from (0, 0, 0) to (1, 0, 0), of #10 alone
  int start = 0, end = 0;
  std::array<int, 2> faces = {0, 0};

  [[nodiscard]] static std::string name(int id) { return "#" + std::to_string(id); }
};

/// \param surface_curve the edge has a SURFACE_CURVE, which something else uses too, on a line in
/// steps of 2 \param flat the second face lies on a PLANE
inline TwoSheets two_sheets(bool surface_curve = false, bool flat = false) {
  TwoSheets s;
  FaceBuilder& b = s.builder;
  const int a = b.vertex(0, 0, 0), c = b.vertex(2, 0, 0), d = b.vertex(2, 1, 0),
            f = b.vertex(0, 1, 0);
  s.start = b.entity("VERTEX_POINT('',#3)");  // the control points of both surfaces
  s.end = b.entity("VERTEX_POINT('',#4)");
  s.outer = b.line(a, s.start, {0, 0, 0}, {1, 0, 0});
  const int last = b.line(s.end, f, {1, 1, 0}, {-1, 0, 0}),
            first = b.line(f, a, {0, 1, 0}, {0, -1, 0});
  if (surface_curve) {
    const int vector = b.entity("VECTOR('',#" + std::to_string(b.direction(0, 1, 0)) + ",2.)");
    const int line = b.entity("LINE('',#3,#" + std::to_string(vector) + ")");
    const int on = b.entity("SURFACE_CURVE('',#" + std::to_string(line) + ",(#30),.CURVE_3D.)");
    b.entity("GEOMETRIC_CURVE_SET('',(#" + std::to_string(on) + "))");
    s.edge = b.entity("EDGE_CURVE('',#" + std::to_string(s.start) + ",#" + std::to_string(s.end) +
                      ",#" + std::to_string(on) + ",.T.)");
  } else {
    s.edge = b.line(s.start, s.end, {1, 0, 0}, {0, 1, 0});
  }
  const int south = b.line(s.start, c, {1, 0, 0}, {1, 0, 0}),
            east = b.line(c, d, {2, 0, 0}, {0, 1, 0}),
            north = b.line(d, s.end, {2, 1, 0}, {-1, 0, 0});
  s.faces[0] = b.face(10, {b.bound({s.outer, s.edge, last, first})});
  s.faces[1] = b.face(20, {b.bound({south, east, north, -s.edge})});
  b.entity("OPEN_SHELL('',(#" + std::to_string(s.faces[0]) + ",#" + std::to_string(s.faces[1]) +
           "))");
  std::string data = unit_square_points() + bilinear_patch();
  data += "#5=CARTESIAN_POINT('',(2.,0.,0.));\n#6=CARTESIAN_POINT('',(2.,1.,0.));\n";
  data += flat ? "#21=AXIS2_PLACEMENT_3D('',#3,$,$);\n#20=PLANE('',#21);\n"
               : "#20=B_SPLINE_SURFACE_WITH_KNOTS('right',1,1,((#3,#4),(#5,#6)),.UNSPECIFIED.,.F.,."
                 "F.,.F.,(2,2),(2,2),"
                 "(0.,1.),(0.,1.),.UNSPECIFIED.);\n";
  if (surface_curve)
    data +=
        "#30=PCURVE('',#10,#31);\n#31=DEFINITIONAL_REPRESENTATION('',(),#32);\n#32=REPRESENTATION_"
        "CONTEXT('','');\n";
  s.text = step_text(data + b.text());
  return s;
}

}  // namespace knead::testing
