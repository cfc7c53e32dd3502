#include "brep/trim_loops.hpp"

#include <cmath>
#include <numbers>

#include "exchange/face_builder.hpp"

namespace knead {
namespace {

using testing::FaceBuilder;
using testing::on_square;
using testing::square;

double area_of(const TrimFace& face) {
  double area = 0;
  for (const TrimLoop& loop : face) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const auto &a = loop[k], &b = loop[(k + 1) % loop.size()];
      area += (a.x() * b.y() - a.y() * b.x()) / 2;
    }
  }
  return area;
}

TEST(TrimLoops, AnUntrimmedSurfaceIsWhole) {
  const auto trims = trim_loops(testing::parse_or_die(testing::step_text(square)).model());
  ASSERT_TRUE(trims);
  ASSERT_EQ(trims->surfaces.size(), 1U);
  EXPECT_TRUE(trims->surfaces[0].whole);
}

TEST(TrimLoops, ACircleOnTheUnitSquareIsThatCircleInItsParameters) {
  FaceBuilder b;
  b.face(10, {b.bound({b.circle(0.4, 0, 0.5, 0.5)}), b.bound({-b.circle(0.1, 0, 0.6, 0.5)})});
  const auto trims = trim_loops(on_square(b).model());
  ASSERT_TRUE(trims);
  ASSERT_TRUE(trims->skipped.empty());
  ASSERT_FALSE(trims->surfaces[0].whole);
  ASSERT_EQ(trims->surfaces[0].faces.size(), 1U);
  const auto& face = trims->surfaces[0].faces[0];
  ASSERT_EQ(face.size(), 2U);
  for (const auto& p : face[0]) EXPECT_NEAR((p - Eigen::Vector2d(0.5, 0.5)).norm(), 0.4, 1e-12);
  for (const auto& p : face[1]) EXPECT_NEAR((p - Eigen::Vector2d(0.6, 0.5)).norm(), 0.1, 1e-12);
  EXPECT_NEAR(area_of(face), 0.15 * std::numbers::pi, 1e-3);
}

TEST(TrimLoops, SeveralFacesOnOneSurfaceAreAllThere) {
  FaceBuilder b;
  b.face(10, {b.bound({b.circle(0.1, 0, 0.3, 0.5)})});
  b.face(10, {b.bound({b.circle(0.1, 0, 0.7, 0.5)})});
  const auto trims = trim_loops(on_square(b).model());
  ASSERT_TRUE(trims);
  EXPECT_EQ(trims->surfaces[0].faces.size(), 2U);
}

TEST(TrimLoops, AFaceThatCannotBeFollowedLeavesItsSurfaceWhole) {
  FaceBuilder b;
  const int astray = b.face(10, {b.bound({b.circle(0.1, 5, 0.3, 0.5)})});
  const auto trims = trim_loops(on_square(b).model());
  ASSERT_TRUE(trims);
  EXPECT_TRUE(trims->surfaces[0].whole);
  ASSERT_EQ(trims->skipped.size(), 1U);
  EXPECT_EQ(trims->skipped[0].id, "#" + std::to_string(astray));
}

// The rational quadratic unit cylinder over z = 0 … 1, #10: u round it, one turn.
std::string cylinder() {
  FaceBuilder b;
  const std::array<std::array<double, 2>, 8> xy = {
      {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
  std::vector<std::string> rows;
  for (const auto& [x, y] : xy)
    rows.push_back(FaceBuilder::list_of({b.point(x, y, 0), b.point(x, y, 1)}));
  std::string net, weights;
  for (std::size_t k = 0; k <= 8; ++k) {
    net += (k == 0 ? "(" : ",(") + rows[k % 8] + ")";
    weights += (k == 0 ? "(" : ",(") +
               std::string(k % 2 == 0 ? "1.,1." : "0.70710678118654757,0.70710678118654757") + ")";
  }
  return b.text() + "#10=(BOUNDED_SURFACE()B_SPLINE_SURFACE(2,1,(" + net +
         "),.UNSPECIFIED.,.T.,.F.,.F.)B_SPLINE_SURFACE_WITH_KNOTS((3,2,2,2,3),(2,2),(0.,1.,2.,3.,4."
         "),(0.,1.),."
         "UNSPECIFIED.)"
         "GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE((" +
         weights + "))REPRESENTATION_ITEM('')SURFACE());\n";
}

// Two records of the same name must not meet: those of the builder are named anew.
std::string renamed(std::string text) {
  for (std::size_t k = text.find('#'); k != std::string::npos; k = text.find('#', k + 1)) {
    if (text.compare(k, 4, "#10,") != 0) text.insert(k + 1, "9");
  }
  return text;
}

TEST(TrimLoops, ABandRoundACylinderIsARectangleCutOpen) {
  FaceBuilder b;
  b.face(10, {b.bound({b.circle(1, 0.25)}), b.bound({-b.circle(1, 0.75)})});
  const auto trims =
      trim_loops(testing::parse_or_die(testing::step_text(cylinder() + renamed(b.text()))).model());
  ASSERT_TRUE(trims);
  for (const auto& [id, reason] : trims->skipped) ADD_FAILURE() << reason.message();
  ASSERT_FALSE(trims->surfaces[0].whole);
  double area = 0;
  for (const auto& face : trims->surfaces[0].faces) {
    for (const auto& p : face[0])
      EXPECT_TRUE(std::abs(p.y() - 0.25) < 1e-9 || std::abs(p.y() - 0.75) < 1e-9);
    area = area_of(face);
  }
  EXPECT_NEAR(area, 0.5, 1e-9);
}

TEST(TrimLoops, AWindowOverTheSeamComesOnBothSides) {
  FaceBuilder b;
  // From -45° to 45°, z from 0.25 to 0.75.
  const double c = std::sqrt(0.5);
  const auto circle = [&b](double z) {
    return "CIRCLE('',#" + std::to_string(b.frame(0, 0, z)) + ",1.)";
  };
  const int p = b.vertex(c, -c, 0.25), q = b.vertex(c, c, 0.25), r = b.vertex(c, c, 0.75),
            s = b.vertex(c, -c, 0.75);
  const int below = b.edge(p, q, circle(0.25)), above = b.edge(s, r, circle(0.75));
  const int right = b.line(q, r, {c, c, 0}, {0, 0, 1}), left = b.line(p, s, {c, -c, 0}, {0, 0, 1});
  b.face(10, {b.bound({below, right, -above, -left})});
  const auto trims =
      trim_loops(testing::parse_or_die(testing::step_text(cylinder() + renamed(b.text()))).model());
  ASSERT_TRUE(trims);
  ASSERT_EQ(trims->surfaces[0].faces.size(), 2U);
  for (const auto& face : trims->surfaces[0].faces) EXPECT_NEAR(area_of(face), 0.25 * 0.5, 1e-9);
  const auto middle = [](const TrimLoop& loop) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const auto& at : loop) sum += at / static_cast<double>(loop.size());
    return sum;
  };
  const double first = middle(trims->surfaces[0].faces[0][0]).x(),
               second = middle(trims->surfaces[0].faces[1][0]).x();
  EXPECT_NEAR(std::abs(first - second), 1, 1e-9);
}

}  // namespace
}  // namespace knead
