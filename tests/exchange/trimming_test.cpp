#include <gtest/gtest.h>
#include <map>

#include <sstream>

#include "exchange/support.hpp"
#include "support/renumbered.hpp"
#include "support/thread_counts.hpp"

namespace knead {
namespace {

using testing::bilinear_patch;
using testing::parse_or_die;
using testing::step_text;
using testing::unit_square_points;

// A face on surface #10 bounded by the polygon through the given vertices (entities #50 … are
// vertex points).
class Face {
 public:
  int vertex(double x, double y, double z = 0) {
    text_ << "#" << id_ << "=CARTESIAN_POINT('',(" << real(x) << "," << real(y) << "," << real(z)
          << "));\n#" << id_ + 1 << "=VERTEX_POINT('',#" << id_ << ");\n";
    places_[id_ + 1] = Point(x, y, z);
    return (id_ += 2) - 1;
  }
  int line(int from, int to) {
    const Point way = places_.at(to) - places_.at(from);
    const int direction =
        entity("DIRECTION('',(" + real(way.x()) + "," + real(way.y()) + "," + real(way.z()) + "))");
    const int vector = entity("VECTOR('',#" + std::to_string(direction) + ",1.)");
    return edge(from, to,
                "LINE('',#" + std::to_string(from - 1) + ",#" + std::to_string(vector) + ")");
  }
  int edge(int from, int to, const std::string& curve, bool sense = true) {
    text_ << "#" << id_ << "=" << curve << ";\n#" << id_ + 1 << "=EDGE_CURVE('',#" << from << ",#"
          << to << ",#" << id_ << (sense ? ",.T." : ",.F.") << ");\n#" << id_ + 2
          << "=ORIENTED_EDGE('',*,*,#" << id_ + 1 << ",.T.);\n";
    return (id_ += 3) - 1;
  }
  int entity(const std::string& record) {
    text_ << "#" << id_ << "=" << record << ";\n";
    return id_++;
  }
  void bound(const std::vector<int>& edges) {
    std::string list;
    for (const int e : edges) list += (list.empty() ? "#" : ",#") + std::to_string(e);
    text_ << "#" << id_ << "=EDGE_LOOP('',(" << list << "));\n#" << id_ + 1 << "=FACE_BOUND('',#"
          << id_ << ",.T.);\n";
    bounds_ += (bounds_.empty() ? "#" : ",#") + std::to_string(id_ + 1);
    id_ += 2;
  }
  void polygon(const std::vector<std::array<double, 2>>& corners) {
    std::vector<int> vertices;
    std::vector<int> edges;
    for (const auto& c : corners) vertices.push_back(vertex(c[0], c[1]));
    for (std::size_t k = 0; k < vertices.size(); ++k)
      edges.push_back(line(vertices[k], vertices[(k + 1) % vertices.size()]));
    bound(edges);
  }
  std::string text() const {
    return text_.str() + "#9000=ADVANCED_FACE('',(" + bounds_ + "),#10,.T.);\n";
  }

 private:
  static std::string real(double x) {
    const auto text = std::to_string(x);
    return text;
  }
  std::ostringstream text_;
  std::string bounds_;
  std::map<int, Point> places_;  // of vertices
  int id_ = 50;
};

bool trimmed(const std::string& surface, const Face& face) {
  return parse_or_die(step_text(surface + face.text())).surfaces().at(0).trimmed;
}

const std::string square = unit_square_points() + bilinear_patch();

TEST(StepTrimming, TheWholePatchIsNotTrimmed) {
  Face face;
  face.polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  EXPECT_FALSE(trimmed(square, face));
  Face divided;  // more vertices on the boundary than corners
  divided.polygon({{0, 0}, {0.3, 0}, {0.9, 0}, {1, 0}, {1, 0.5}, {1, 1}, {0, 1}, {0, 0.25}});
  EXPECT_FALSE(trimmed(square, divided));
}

TEST(StepTrimming, AnOutlineInsideThePatchTrimsIt) {
  Face inset;
  inset.polygon({{0.1, 0.1}, {0.9, 0.1}, {0.9, 0.9}, {0.1, 0.9}});
  EXPECT_TRUE(trimmed(square, inset));
  Face corner_cut;
  corner_cut.polygon({{0, 0}, {1, 0}, {1, 0.9}, {0.9, 1}, {0, 1}});
  EXPECT_TRUE(trimmed(square, corner_cut));
  Face hole;
  hole.polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  hole.polygon({{0.4, 0.4}, {0.4, 0.6}, {0.6, 0.6}});
  EXPECT_TRUE(trimmed(square, hole));
}

TEST(StepTrimming, EdgesOnTheBoundaryThatLeavePartOfItOutTrimToo) {
  Face slit;
  const int a = slit.vertex(0, 0);
  const int b = slit.vertex(1, 0);
  slit.bound({slit.line(a, b)});
  EXPECT_TRUE(trimmed(square, slit));
}

TEST(StepTrimming, TheSecondFaceDecidesToo) {
  Face whole;
  whole.polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  auto text = whole.text();
  Face half;
  half.polygon({{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}});
  auto second = testing::renumbered(half.text(), 10000);
  second.replace(second.find("#10010,"), 7, "#10,");  // on the same surface
  EXPECT_TRUE(parse_or_die(step_text(square + text + second)).surfaces()[0].trimmed);
  EXPECT_FALSE(parse_or_die(step_text(square + text)).surfaces()[0].trimmed);
}

TEST(StepTrimming, CurvesOfAnyKindMayRunAlongTheBoundary) {
  Face face;
  const int a = face.vertex(0, 0);
  const int b = face.vertex(1, 0);
  const int c = face.vertex(1, 1);
  const int d = face.vertex(0, 1);
  const int m = face.entity("CARTESIAN_POINT('',(0.3,0.,0.))");
  const auto point = [](int vertex) { return "#" + std::to_string(vertex - 1); };
  const int spline =
      face.entity("B_SPLINE_CURVE_WITH_KNOTS('',2,(" + point(b) + ",#" + std::to_string(m) + "," +
                  point(a) + "),.UNSPECIFIED.,.F.,.F.,(3,3),(0.,1.),.UNSPECIFIED.)");
  const int pcurve = face.entity("NOTHING()");
  face.bound(
      {face.edge(a, b,
                 "SURFACE_CURVE('',#" + std::to_string(spline) + ",(#" + std::to_string(pcurve) +
                     "),.CURVE_3D.)",
                 false),
       face.edge(b, c, "POLYLINE('',(" + point(b) + "," + point(c) + "))"), face.line(c, d),
       face.edge(d, a,
                 "BEZIER_CURVE('',1,(" + point(d) + "," + point(a) + "),.UNSPECIFIED.,.F.,.F.)")});
  EXPECT_FALSE(trimmed(square, face));
}

TEST(StepTrimming, SeamsAndPolesNeedNoEdge) {
  const auto cylinder = [] {
    std::string text;
    const char* xy[] = {"1.,0.",  "1.,1.",   "0.,1.",  "-1.,1.",
                        "-1.,0.", "-1.,-1.", "0.,-1.", "1.,-1."};
    std::string rows;
    std::string weights;
    for (int k = 0; k < 8; ++k) {
      for (int z = 0; z < 2; ++z) {
        text += "#" + std::to_string(20 + 2 * k + z) + "=CARTESIAN_POINT('',(" + xy[k] + "," +
                std::to_string(z) + ".));\n";
      }
    }
    for (int k = 0; k <= 8; ++k) {
      const int id = 20 + 2 * (k % 8);
      rows += std::string(k == 0 ? "(" : ",(") + "#" + std::to_string(id) + ",#" +
              std::to_string(id + 1) + ")";
      weights += std::string(k == 0 ? "" : ",") +
                 (k % 2 == 0 ? "(1.,1.)" : "(0.70710678118654757,0.70710678118654757)");
    }
    return text + "#10=(BOUNDED_SURFACE()B_SPLINE_SURFACE(2,1,(" + rows +
           "),.UNSPECIFIED.,.T.,.F.,.F.)B_SPLINE_SURFACE_WITH_KNOTS((3,2,2,2,3),(2,2),(0.,1.,2.,3.,"
           "4.),(0.,1.),."
           "UNSPECIFIED.)"
           "GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE((" +
           weights + "))REPRESENTATION_ITEM('')SURFACE());\n";
  }();
  const auto circle = [](Face& face, double z) {
    const int v = face.vertex(1, 0, z);
    const int centre = face.entity("CARTESIAN_POINT('',(0.,0.," + std::to_string(z) + "))");
    const int frame = face.entity("AXIS2_PLACEMENT_3D('',#" + std::to_string(centre) + ",$,$)");
    face.bound({face.edge(v, v, "CIRCLE('',#" + std::to_string(frame) + ",1.)")});
  };
  Face whole;
  circle(whole, 0);
  circle(whole, 1);
  EXPECT_EQ(parse_or_die(step_text(cylinder + whole.text())).surfaces()[0].closed,
            (std::array<bool, 2>{true, false}));
  EXPECT_FALSE(trimmed(cylinder, whole));
  Face shortened;
  circle(shortened, 0);
  circle(shortened, 0.5);
  EXPECT_TRUE(trimmed(cylinder, shortened));
  Face half_open;
  circle(half_open, 0);
  EXPECT_TRUE(trimmed(cylinder, half_open));
}

TEST(StepTrimming, CutSurfacesWithoutFaces) {
  const auto with = [](const std::string& entity) {
    return parse_or_die(step_text(square + "#11=" + entity + ";\n")).surfaces()[0].trimmed;
  };
  EXPECT_TRUE(with("RECTANGULAR_TRIMMED_SURFACE('',#10,0.,0.5,0.,1.,.T.,.T.)"));
  EXPECT_FALSE(with("RECTANGULAR_TRIMMED_SURFACE('',#10,0.,1.,0.,1.,.T.,.T.)"));
  EXPECT_TRUE(with("CURVE_BOUNDED_SURFACE('',#10,(#1),.F.)"));
  EXPECT_FALSE(with("CURVE_BOUNDED_SURFACE('',#10,(),.T.)"));
  EXPECT_FALSE(parse_or_die(step_text(square)).surfaces()[0].trimmed);
}

/// What a file of many surfaces is found to hold, in one text.
std::string contents(const std::string& text) {
  const step::File file = parse_or_die(text);
  std::ostringstream all;
  for (const brep::SplineSurface& s : file.surfaces())
    all << s.id << ' ' << s.name << ' ' << s.unit << s.closed[0] << s.closed[1] << s.trimmed
        << s.faces << ' ' << s.surface.control_points().row(3) << '\n';
  for (const brep::UnreadableSurface& s : file.model().unreadable)
    all << s.id << ' ' << s.reason.message() << '\n';
  return all.str();
}

TEST(StepTrimming, ThreadsDoNotChangeWhatALargeFileHolds) {
  Face whole, inset;
  whole.polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  inset.polygon({{0.1, 0.1}, {0.9, 0.1}, {0.9, 0.9}, {0.1, 0.9}});
  const std::array<std::string, 4> kinds = {
      square + whole.text(), square + inset.text(), square,
      unit_square_points() + bilinear_patch("((#1,#2),(#3))")};
  std::string data;
  for (std::size_t k = 0; k < 200; ++k) {
    std::string copy = kinds[k % 4];
    copy.replace(copy.find("(1.,1.,0.)"), 10, "(1.,1.," + std::to_string(k % 3 * k) + ".)");
    data += testing::renumbered(copy, static_cast<long>(k) * 10000);
  }
  const std::string text = step_text(data);
  ASSERT_GT(text.size(), 60000U);  // worth several blocks
  const std::string by_one = testing::with_threads(1, [&] { return contents(text); });
  EXPECT_EQ(std::ranges::count(by_one, '\n'), 200);
  EXPECT_NE(by_one.find("#10 "), std::string::npos);
  EXPECT_NE(by_one.find("#1990010 "), std::string::npos);
  for (const int threads : testing::thread_counts)
    EXPECT_EQ(testing::with_threads(threads, [&] { return contents(text); }), by_one) << threads;
}

}  // namespace
}  // namespace knead
