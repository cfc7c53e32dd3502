// Edges of faces that are parted in the file may be parted by more where the data stretch it.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>

#include "exchange/face_builder.hpp"
#include "exchange/morph/data_stretch.hpp"
#include "knead/brep/edge_measures.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/morph.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::morph::testing {
namespace {

using knead::testing::FaceBuilder;

/// A bilinear surface over a rectangle.
int rectangle(FaceBuilder& builder, double x0, double x1) {
  std::vector<std::string> points;
  for (const double x : {x0, x1}) {
    for (const double y : {0.0, 1.0})
      points.push_back("#" + std::to_string(builder.point(x, y, 0)));
  }
  return builder.entity("B_SPLINE_SURFACE_WITH_KNOTS('',1,1,((" + points[0] + "," + points[1] +
                        "),(" + points[2] + "," + points[3] +
                        ")),.UNSPECIFIED.,.F.,.F.,.F.,(2,2),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.)");
}

/// A face on all of it.
int rectangular_face(FaceBuilder& b, double x0, double x1) {
  const int surface = rectangle(b, x0, x1);
  const std::array<int, 4> v = {b.vertex(x0, 0, 0), b.vertex(x1, 0, 0), b.vertex(x1, 1, 0),
                                b.vertex(x0, 1, 0)};
  return b.face(surface, {b.bound({b.line(v[0], v[1], {x0, 0, 0}, {1, 0, 0}),
                                   b.line(v[1], v[2], {x1, 0, 0}, {0, 1, 0}),
                                   b.line(v[2], v[3], {x1, 1, 0}, {-1, 0, 0}),
                                   b.line(v[3], v[0], {x0, 1, 0}, {0, -1, 0})})});
}

/// Two sheets beside each other, `gap` apart at x = 0.
std::shared_ptr<const Source> parted_sheets(double gap) {
  FaceBuilder b;
  const int left = rectangular_face(b, -1, -gap / 2), right = rectangular_face(b, gap / 2, 1);
  b.entity("OPEN_SHELL('',(" + FaceBuilder::list_of({left, right}) + "))");
  auto source = open_source(knead::testing::step_text(b.text()), "sheets.step");
  EXPECT_TRUE(source) << source.error().message();
  return *std::move(source);
}

/// What is between the sheets.
brep::EdgeMeasures common_edge(const Source& source) {
  const auto measures = brep::measure_edges(*source.model());
  EXPECT_TRUE(measures);
  for (const brep::EdgeMeasures& edge : measures->edges) {
    if (edge.faces.size() == 2) return edge;
  }
  ADD_FAILURE() << "they do not meet";
  return {};
}

TEST(PartedEdges, OpenAsTheDataStretchThem) {
  const double gap = 1e-4;
  const auto source = parted_sheets(gap);
  ASSERT_NEAR(common_edge(*source).gap->value, gap, 1e-9);
  for (const char* const map : {"0.05*x; 0; 0", "0.05*sin(x); 0.02*sin(2*y); 0.1*sin(3*y)"}) {
    const auto moved = morph_file(source, {.space = map}, {});
    ASSERT_TRUE(moved) << moved.error().message();
    const auto reopened = open_source(moved->bytes, "moved.step");
    ASSERT_TRUE(reopened) << reopened.error().message();
    EXPECT_NEAR(common_edge(**reopened).gap->value, 1.05 * gap, 2e-6) << map;
  }
}

// Displacements of both sides differ by more than the tolerance: made equal, they would not be what
// the map says.
TEST(PartedEdges, AreFollowedOnBothSides) {
  const double gap = 1e-4;
  const auto source = parted_sheets(gap);
  const auto moved = morph_file(source, {.space = "0; 0.1*sin(3*x); 0.1*sin(3*x)"}, {});
  ASSERT_TRUE(moved) << moved.error().message();
  const auto reopened = open_source(moved->bytes, "moved.step");
  ASSERT_TRUE(reopened) << reopened.error().message();
  EXPECT_NEAR(common_edge(**reopened).gap->value, std::sqrt(1 + 2 * 0.09) * gap, 3e-7);
}

TEST(PartedEdges, StayClosedWhereTheyWere) {
  const double size = std::sqrt(5.0);  // 1e-6 of it is what closed edges may be parted by
  const auto source = parted_sheets(0.7e-6 * size);
  ASSERT_TRUE(morph_file(source, {.space = "0.05*x; 0; 0"}, {}));
  const auto moved = morph_file(source, {.space = "0.5*x; 0; 0"}, {});
  ASSERT_FALSE(moved);
  EXPECT_NE(moved.error().message().find("it would be parted by"), std::string::npos)
      << moved.error().message();
}

/// What the data of a map say at the middle of the edge of two sheets.
double stretch_by(const std::function<Point(const Point&, int)>& map) {
  const auto source = parted_sheets(1e-4);
  const auto model = detail::moving_model(source, {});
  EXPECT_TRUE(model);
  detail::MorphPoints points;
  for (int surface = 0; surface < 2; ++surface) {
    for (int k = 0; k < 41 * 41; ++k) {
      const double u = k % 41 / 40.0, v = k / 41 / 40.0;
      Parameters<2> place(1, 2);
      place << u, v;
      const auto at =
          evaluate<2>(*model->surfaces[static_cast<std::size_t>(surface)].surface, place, 0);
      points.found.data.push_back({surface, {u, v}, map(at->points().row(0).transpose(), surface)});
    }
  }
  const Point middle(0, 0.5, 0);
  const auto result = detail::data_stretch(*model, points, common_edge(*source).faces, {&middle, 1},
                                           std::sqrt(5.0));
  EXPECT_TRUE(result);
  return result.value_or(0);
}

TEST(DataStretch, IsTheLargestSingularValueOfAnAffineMap) {
  Eigen::Matrix3d shear = Eigen::Matrix3d::Zero();
  shear.topLeftCorner<2, 2>() << 0.04, 0.03, 0, -0.02;
  const Eigen::Matrix2d f = Eigen::Matrix2d::Identity() + shear.topLeftCorner<2, 2>();
  const double squares = f.squaredNorm(), area = f.determinant();
  const double expected = std::sqrt((squares + std::sqrt(squares * squares - 4 * area * area)) / 2);
  EXPECT_NEAR(stretch_by([&](const Point& x, int) { return Point(shear * x); }), expected, 1e-12);
}

TEST(DataStretch, IsOneOfRotationsAndWhereAllShrinks) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.2, Point(1, 2, 3).normalized()).matrix();
  EXPECT_NEAR(stretch_by([&](const Point& x, int) { return Point(turn * x - x); }), 1, 1e-12);
  EXPECT_EQ(stretch_by([](const Point& x, int) { return Point(-0.2 * x); }), 1);
}

TEST(DataStretch, IsNotWhatTearsFacesApart) {
  const auto torn = [](const Point&, int surface) { return Point(0.1 * surface, 0, 0); };
  EXPECT_NEAR(stretch_by(torn), 1, 1e-12);
}

// Heights are of second order in the extent: as an affine function of heights they have any slope.
TEST(DataStretch, IsNotHowSheetsBend) {
  const auto bent = [](const Point& x, int) { return Point(0, 0, 0.2 * x.x() * x.x()); };
  EXPECT_LT(stretch_by(bent), 1.001);
}

/// What a map of space says there.
double stretch_of(const char* formulas) {
  const auto source = parted_sheets(1e-4);
  const auto model = detail::moving_model(source, {});
  EXPECT_TRUE(model);
  const auto points = detail::points_of(*model, {.space = formulas}, {});
  EXPECT_TRUE(points) << points.error().message();
  const Point middle(0, 0.5, 0);
  const auto result = detail::data_stretch(*model, *points, common_edge(*source).faces,
                                           {&middle, 1}, std::sqrt(5.0));
  EXPECT_TRUE(result);
  return result.value_or(0);
}

TEST(DataStretch, OfAMapOfSpaceIsKnownAcrossTheSheetsToo) {
  EXPECT_NEAR(stretch_of("0; 0; 0.07*z"), 1.07, 1e-9);
  EXPECT_NEAR(stretch_of("0.05*sin(x); 0; 0.02*z"), 1.05, 1e-6);
  EXPECT_NEAR(stretch_of("0.1*x/sqrt(x*x+1e-30); 0; 0"), 1, 1e-6) << "it jumps at x = 0";
}

}  // namespace
}  // namespace knead::morph::testing
