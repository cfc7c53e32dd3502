// Faces with round edges or on swept surfaces, and edges judged by thresholds.
#include <cmath>
#include <numbers>

#include "exchange/edge_pair.hpp"

namespace knead {
namespace {

using brep::EdgeKind;
using brep::EdgeMeasures;
using testing::Pair;
using testing::StepBuilder;

constexpr double degree = std::numbers::pi / 180;
constexpr double right = 0.01;

/// A circle about the z axis at z = 0 between a face on its left and one on its right.
EdgeMeasures around(StepBuilder& b, double radius, int left, int right_side) {
  const int circle = b.circle(radius, 0);
  b.face(left, {b.bound({circle})});
  b.face(right_side, {b.bound({-circle})});
  const auto file = b.file();
  const auto measured = brep::measure_edges(file.model());
  EXPECT_TRUE(measured && measured->edges.size() == 1);
  return measured->edges.front();
}

int upright(StepBuilder& b, const std::string& kind, double z, const std::string& numbers) {
  return b.entity(kind + "('',#" + std::to_string(b.frame(0, 0, z)) + "," + numbers + ")");
}

TEST(EdgeMeasures, ATorusRoundADiscBendsAsItsTube) {
  for (const double minor : {0.5, 3.0}) {
    StepBuilder b;
    const int disc = b.plane({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
    const int tube = upright(b, "TOROIDAL_SURFACE", -minor,
                             StepBuilder::real(5) + "," + StepBuilder::real(minor));
    const auto m = around(b, 5, disc, tube);
    EXPECT_LE(m.angle->value, 1e-6);
    EXPECT_NEAR(m.curvature->value, 1 / minor, right / minor);
    EXPECT_NEAR(m.length, 10 * std::numbers::pi, 1e-6);
  }
}

TEST(EdgeMeasures, ASphereOnACylinderBendsAsItself) {
  StepBuilder b;
  const int sphere = upright(b, "SPHERICAL_SURFACE", 0, StepBuilder::real(4));
  const auto m = around(b, 4, sphere, upright(b, "CYLINDRICAL_SURFACE", 0, StepBuilder::real(4)));
  EXPECT_LE(m.angle->value, 1e-6);
  EXPECT_NEAR(m.curvature->value, 0.25, right * 0.25);
  EXPECT_EQ(m.kind, EdgeKind::g1);
}

TEST(EdgeMeasures, TheCourseOfACircleIsNearIt) {
  const double radius = 4;
  StepBuilder b;
  const int sphere = upright(b, "SPHERICAL_SURFACE", 0, StepBuilder::real(radius));
  const auto m = around(b, radius, sphere, b.plane({0, 0, 0}, {0, 0, -1}, {1, 0, 0}));
  ASSERT_GT(m.course.size(), 3U);
  EXPECT_EQ(m.course.front(), m.start);
  double length = 0;
  for (std::size_t k = 0; k + 1 < m.course.size(); ++k) {
    const auto &p = m.course[k], &q = m.course[k + 1];
    EXPECT_NEAR(std::hypot(p[0], p[1]), radius, 1e-12);
    EXPECT_GE(std::hypot(p[0] + q[0], p[1] + q[1]) / 2, (1 - 1.001e-3) * radius);
    length += std::hypot(p[0] - q[0], p[1] - q[1]);
  }
  EXPECT_NEAR(length, m.length, 1e-3 * m.length);
}

TEST(EdgeMeasures, AProfileThatTurnsIsATorus) {
  const double minor = 2;
  StepBuilder b;
  const int disc = b.plane({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  const int profile =
      b.entity("CIRCLE('',#" + std::to_string(b.placement({5, 0, -minor}, {0, -1, 0}, {1, 0, 0})) +
               "," + StepBuilder::real(minor) + ")");
  const int axis = b.entity("AXIS1_PLACEMENT('',#" + std::to_string(b.point(0, 0, 0)) + ",#" +
                            std::to_string(b.direction(0, 0, 1)) + ")");
  const auto m = around(b, 5, disc,
                        b.entity("SURFACE_OF_REVOLUTION('',#" + std::to_string(profile) + ",#" +
                                 std::to_string(axis) + ")"));
  EXPECT_LE(m.angle->value, 1e-6);
  EXPECT_LE(m.gap->value, 1e-9);
  EXPECT_NEAR(m.curvature->value, 1 / minor, right / minor);
}

TEST(EdgeMeasures, AnExtrudedCircleIsACylinder) {
  const double radius = 3;
  Pair pair;
  StepBuilder& b = pair.builder;
  const int profile =
      b.entity("CIRCLE('',#" + std::to_string(b.placement({0, 0, -radius}, {0, 1, 0}, {1, 0, 0})) +
               "," + StepBuilder::real(radius) + ")");
  const int way = b.entity("VECTOR('',#" + std::to_string(b.direction(0, 1, 0)) + ",1.)");
  const int extruded = b.entity("SURFACE_OF_LINEAR_EXTRUSION('',#" + std::to_string(profile) +
                                ",#" + std::to_string(way) + ")");
  const auto m = pair.between(pair.flat(), extruded);
  EXPECT_LE(m.angle->value, 1e-6);
  EXPECT_NEAR(m.curvature->value, 1 / radius, right / radius);
}

TEST(EdgeMeasures, AConeMissesAPlaneByItsSlope) {
  const double slope = 0.1, radius = 2;
  Pair pair;
  const int cone = pair.builder.entity(
      "CONICAL_SURFACE('',#" +
      std::to_string(pair.builder.placement({0, 0, -radius}, {0, 1, 0}, {0, 0, 1})) + "," +
      StepBuilder::real(radius) + "," + StepBuilder::real(std::atan(slope)) + ")");
  const auto m = pair.between(pair.flat(), cone);
  EXPECT_NEAR(m.angle->value, std::atan(slope) / degree, right * std::atan(slope) / degree);
  // At the end of the edge it is slope above the plane, perpendicular to its ruling.
  EXPECT_NEAR(m.gap->value, slope * std::cos(std::atan(slope)), right * slope);
}

TEST(EdgeFaults, AreThoseAboveTheThresholds) {
  Pair pair;
  const double s = std::sin(0.2 * degree), c = std::cos(0.2 * degree);
  const int flat = pair.flat();
  const auto all = pair.measures(flat, pair.builder.plane({0, 0, 0}, {-s, 0, c}, {c, 0, s}));
  EXPECT_TRUE(brep::faults_of(all, {}).empty());
  EXPECT_TRUE(brep::faults_of(all, {.gap = 1, .angle = 0.21}).empty());
  const auto faults = brep::faults_of(all, {.gap = 1, .angle = 0.1});
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].edge, pair.edge);
  EXPECT_EQ(faults[0].measure, "angle");
  EXPECT_NEAR(faults[0].value, 0.2, 1e-6);
}

TEST(EdgeFaults, OfAnEdgeMeantToBeSharpAreItsGapsAlone) {
  Pair pair;
  const int flat = pair.flat();
  const auto all = pair.measures(flat, pair.builder.plane({0, 0, 0.1}, {-1, 0, 1}, {1, 0, 1}));
  const auto faults = brep::faults_of(all, {.gap = 0.05, .angle = 0.1, .curvature = 1});
  ASSERT_FALSE(faults.empty());
  for (const auto& fault : faults) EXPECT_EQ(fault.measure, "gap");
}

TEST(EdgeFaults, AgainstAnEarlierVersionAreWhatIsWorse) {
  const auto tilted = [](double angle, int records_before) {
    Pair pair;
    for (int k = 0; k < records_before; ++k) pair.builder.point(9, 9, k);
    const double s = std::sin(angle * degree), c = std::cos(angle * degree);
    const int flat = pair.flat();
    return pair.measures(flat, pair.builder.plane({0, 0, 0}, {-s, 0, c}, {c, 0, s}));
  };
  // With the same ids, and with others, some of which stand for other edges.
  for (const int more : {0, 1, 7, 500}) {
    const auto before = tilted(1, 0);
    EXPECT_TRUE(brep::faults_against(tilted(1, more), before, {.gap = 1, .angle = 0.1}).empty());
    EXPECT_TRUE(brep::faults_against(tilted(1.09, more), before, {.angle = 0.1}).empty());
    const auto worse = brep::faults_against(tilted(1.2, more), before, {.angle = 0.1});
    ASSERT_EQ(worse.size(), 1U) << more;
    EXPECT_NEAR(worse[0].value, 1.2, 1e-6);
    EXPECT_NEAR(*worse[0].before, 1, 1e-6);
    // What was smooth is judged though it no longer is.
    EXPECT_EQ(brep::faults_against(tilted(30, more), before, {.angle = 0.1}).size(), 1U);
  }
}

TEST(EdgeFaults, AnEdgeThatHasComeOpenIsOne) {
  Pair pair;
  const int flat = pair.flat();
  const auto before = pair.measures(flat, pair.builder.plane({0, 0, 0}, {0, 0, 1}, {1, 0, 0}));
  auto now = before;
  for (auto& edge : now.edges) {
    if (edge.id == pair.edge) {
      edge.kind = brep::EdgeKind::open;
      edge.faces.pop_back();
    }
  }
  const auto faults = brep::faults_against(now, before, {.gap = 1});
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].edge, pair.edge);
  EXPECT_EQ(faults[0].measure, "faces");
  EXPECT_EQ(faults[0].before, 2);
  EXPECT_TRUE(brep::faults_against(before, now, {.gap = 1}).empty()) << "it was open before";
}

}  // namespace
}  // namespace knead
