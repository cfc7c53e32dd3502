// Points, normals and curvatures of faces on elementary and swept surfaces, against their closed
// forms.

#include "brep/face_point.hpp"

#include <cmath>
#include <numbers>

#include "exchange/face_builder.hpp"

namespace knead {
namespace {

using testing::FaceBuilder;

/// A face on a surface about the z axis, between a circle of radius 2 at z = 0 and what else bounds
/// it.
struct Case {
  const char* name;
  const char* record;                          ///< %f: a placement at the origin
  std::vector<std::array<double, 2>> circles;  ///< radius, z
  Point near;
  Point point;
  Point normal;
  std::array<double, 2> curvature;
  /// Of the point and the normal: feet on swept curves are found by iteration.
  double rounding = 1e-14;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

const double h = std::sqrt(0.5);

class PointOnFace : public ::testing::TestWithParam<Case> {
 protected:
  static FacePoint found(const Case& c, bool same_sense) {
    FaceBuilder b;
    std::string record = c.record;
    const auto put = [&](const std::string& sign, const std::string& text) {
      if (const auto at = record.find(sign); at != std::string::npos)
        record.replace(at, sign.size(), text);
    };
    put("%f", FaceBuilder::ref(b.frame()));
    put("%axis", FaceBuilder::ref(b.entity("AXIS1_PLACEMENT('',#100,$)")));
    put("%circle", FaceBuilder::ref(b.entity("CIRCLE('',#101,2.)")));
    put("%way",
        FaceBuilder::ref(b.entity("VECTOR('',#" + std::to_string(b.direction(0, 0, 1)) + ",1.)")));
    // A circle of radius 1 about (3, 0, 0) in the plane y = 0: turned about z, a torus.
    const int side = b.entity("AXIS2_PLACEMENT_3D('',#" + std::to_string(b.point(3, 0, 0)) + ",#" +
                              std::to_string(b.direction(0, -1, 0)) + ",#" +
                              std::to_string(b.direction(1, 0, 0)) + ")");
    put("%ring", FaceBuilder::ref(b.entity("CIRCLE('',#" + std::to_string(side) + ",1.)")));
    std::vector<int> bounds;
    for (std::size_t k = 0; k < c.circles.size(); ++k) {
      const int circle = b.circle(c.circles[k][0], c.circles[k][1]);
      bounds.push_back(b.bound({k == 0 ? circle : -circle}));
    }
    const int face = b.face(b.entity(record), bounds, same_sense);
    const auto result = point_on_face(b.file().model(), FaceBuilder::ref(face), c.near);
    EXPECT_TRUE(result) << result.error().message();
    return result ? *result : FacePoint{};
  }
};

TEST_P(PointOnFace, IsThatOfTheSurface) {
  const Case& c = GetParam();
  const FacePoint p = found(c, true);
  EXPECT_LE((p.point - c.point).norm(), c.rounding * (1 + c.point.norm())) << p.point.transpose();
  EXPECT_LE((p.normal - c.normal).norm(), c.rounding) << p.normal.transpose();
  ASSERT_TRUE(p.curvature);
  EXPECT_NEAR((*p.curvature)[0], c.curvature[0], 1e-13);
  EXPECT_NEAR((*p.curvature)[1], c.curvature[1], 1e-13);
}

TEST_P(PointOnFace, IsSeenFromTheOtherSideWhereTheFaceIsTurned) {
  const Case& c = GetParam();
  const FacePoint p = found(c, false);
  EXPECT_LE((p.normal + c.normal).norm(), c.rounding);
  ASSERT_TRUE(p.curvature);
  EXPECT_NEAR((*p.curvature)[0], -c.curvature[1], 1e-13);
  EXPECT_NEAR((*p.curvature)[1], -c.curvature[0], 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Forms, PointOnFace,
                         ::testing::Values(Case{"plane",
                                                "PLANE('',%f)",
                                                {{2, 0}},
                                                {0.5, 0.25, 1e-3},
                                                {0.5, 0.25, 0},
                                                {0, 0, 1},
                                                {0, 0}},
                                           Case{"cylinder",
                                                "CYLINDRICAL_SURFACE('',%f,2.)",
                                                {{2, 0}, {2, 5}},
                                                {0, 1.99, 3},
                                                {0, 2, 3},
                                                {0, 1, 0},
                                                {0, -0.5}},
                                           // Half angle 45°: radius 2 + z. The normal curvature of
                                           // a circle of radius r is that of it times cos 45°.
                                           Case{"cone",
                                                "CONICAL_SURFACE('',%f,2.,0.78539816339744831)",
                                                {{2, 0}, {4, 2}},
                                                {3, 0, 1},
                                                {3, 0, 1},
                                                {h, 0, -h},
                                                {0, -h / 3}},
                                           Case{"sphere",
                                                "SPHERICAL_SURFACE('',%f,2.)",
                                                {{2, 0}},
                                                {1.4 * h, 0, 1.4 * h},
                                                {2 * h, 0, 2 * h},
                                                {h, 0, h},
                                                {-0.5, -0.5}},
                                           Case{"torus",
                                                "TOROIDAL_SURFACE('',%f,3.,1.)",
                                                {{4, 0}, {2, 0}},
                                                {3, 0, 0.9},
                                                {3, 0, 1},
                                                {0, 0, 1},
                                                {0, -1}},
                                           Case{"inside of a torus",
                                                "TOROIDAL_SURFACE('',%f,3.,1.)",
                                                {{4, 0}, {2, 0}},
                                                {0, 2.05, 0},
                                                {0, 2, 0},
                                                {0, -1, 0},
                                                {0.5, -1}},
                                           Case{"extruded circle",
                                                "SURFACE_OF_LINEAR_EXTRUSION('',%circle,%way)",
                                                {{2, 0}, {2, 5}},
                                                {0, 1.99, 3},
                                                {0, 2, 3},
                                                {0, 1, 0},
                                                {0, -0.5}},
                                           Case{"turned circle",
                                                "SURFACE_OF_REVOLUTION('',%ring,%axis)",
                                                {{4, 0}, {2, 0}},
                                                {0, 2.05, 0},
                                                {0, 2, 0},
                                                {0, -1, 0},
                                                {0.5, -1},
                                                1e-11}),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           for (char& c : name) c = c == ' ' ? '_' : c;
                           return name;
                         });

TEST(PointOnFaceErrors, NameWhatIsMissing) {
  FaceBuilder b;
  const int face =
      b.face(b.entity("PLANE('',#" + std::to_string(b.frame()) + ")"), {b.bound({b.circle(2, 0)})});
  EXPECT_EQ(point_on_face(b.file().model(), "#7", Point::Zero()).error().where, "#7");
  EXPECT_TRUE(point_on_face(b.file().model(), FaceBuilder::ref(face), Point::Zero()));
  FaceBuilder on;
  const int known = on.face(10, {on.polygon_bound({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}})});
  EXPECT_FALSE(
      point_on_face(testing::on_square(on).model(), FaceBuilder::ref(known), Point::Zero()));
}

TEST(PointOnFaceErrors, APoleHasAPointAndNoNormal) {
  FaceBuilder b;
  const int sphere = b.entity("SPHERICAL_SURFACE('',#" + std::to_string(b.frame()) + ",2.)");
  const int face = b.face(sphere, {b.bound({b.circle(2, 0)})});
  const auto p = point_on_face(b.file().model(), FaceBuilder::ref(face), {0, 0, 3});
  ASSERT_TRUE(p);
  EXPECT_LE((p->point - Point(0, 0, 2)).norm(), 1e-15);
  EXPECT_TRUE(p->normal.isZero());
  EXPECT_FALSE(p->curvature);
}

}  // namespace
}  // namespace knead
