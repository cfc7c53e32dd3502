#include "brep/tessellation/context_faces.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "brep/tessellation/model_mesh.hpp"
#include "exchange/face_builder.hpp"
#include "exchange/mesh_measures.hpp"
#include "support/own_files.hpp"

namespace knead {
namespace {

using testing::area_of;
using testing::FaceBuilder;
constexpr double pi = std::numbers::pi;
constexpr double chord = 1e-4;

// All of a file's faces could be made triangles, and each triangle looks where its normals look.
std::vector<FaceMesh> meshes(const FaceBuilder& builder, double tolerance = chord) {
  auto context = context_faces(builder.file().model(), tolerance);
  if (!context) {
    ADD_FAILURE() << context.error().message();
    return {};
  }
  for (const auto& [id, reason] : context->skipped) ADD_FAILURE() << id << ": " << reason.message();
  for (const auto& mesh : context->faces) {
    EXPECT_EQ(mesh.points.size(), mesh.normals.size());
    for (const auto& n : mesh.normals) EXPECT_NEAR(n.norm(), 1, 1e-12);
    for (const auto& [a, b, c] : mesh.triangles) {
      const Point twice = (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]);
      EXPECT_GE(twice.dot(mesh.normals[a] + mesh.normals[b] + mesh.normals[c]), -1e-9);
    }
  }
  return std::move(context->faces);
}

// The area of the only face. The polygon in a circle lacks 4/3 chord of its disc, and surfaces that
// are curved both ways a third of it each way, of triangles that reach over up to 1.5 steps.
void expect_area(const FaceBuilder& builder, double area) {
  const auto found = meshes(builder);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(area_of(found[0]), area, 4 * chord * area);
}

std::string on_frame(FaceBuilder& b, const std::string& entity, const std::string& measures) {
  return entity + "('',#" + std::to_string(b.frame()) + measures + ")";
}

TEST(ContextFaces, APlaneWithHolesHasTheAreaThatTheyLeave) {
  FaceBuilder b;
  std::vector<int> bounds = {b.bound({b.circle(10, 0)})};
  for (const double x : {-5.0, 0.0, 5.0}) bounds.push_back(b.bound({-b.circle(1, 0, x, 0.5)}));
  b.face(b.entity(on_frame(b, "PLANE", "")), bounds);
  expect_area(b, 97 * pi);
}

/// What a face on a plane with one wrong number is refused for; empty if it is not.
std::string refusal_with(const std::string& right, const std::string& wrong) {
  FaceBuilder b;
  b.face(b.entity(on_frame(b, "PLANE", "")), {b.bound({b.circle(10, 0)})});
  std::string text = b.text();
  text.replace(text.find(right), right.size(), wrong);
  const auto model = model_faces(testing::parse_or_die(testing::step_text(text)).model());
  if (!model) return model.error().message();
  return model->skipped.empty() ? "" : model->skipped[0].reason.message();
}

TEST(ContextFaces, LengthsWhoseProductsOverflowAreRefused) {
  const std::string ten = FaceBuilder::real(10);
  for (const char* large : {"1.E51", "1.E150", "1.E200", "1.E300"}) {
    EXPECT_NE(
        refusal_with("(" + ten, "(" + std::string(large)).find("which is too large; correct it"),
        std::string::npos);
    EXPECT_NE(refusal_with("," + ten, "," + std::string(large)).find("lengths cannot be read"),
              std::string::npos);
  }
}

TEST(ContextFaces, LengthsOfDirectionsMeanNothing) {
  for (const char* length : {"1.E-310", "1.E-200", "1.E-6", "1.E6", "1.E200", "1.E300"}) {
    FaceBuilder b;
    const int direction = b.entity("DIRECTION('',(0.,0.," + std::string(length) + "))");
    const int frame = b.entity("AXIS2_PLACEMENT_3D('',#" + std::to_string(b.point(0, 0, 0)) + ",#" +
                               std::to_string(direction) + ",$)");
    b.face(b.entity("PLANE('',#" + std::to_string(frame) + ")"), {b.bound({b.circle(10, 0)})});
    expect_area(b, 100 * pi);
  }
}

TEST(ContextFaces, AFaceThatVanishesOnItsSurfaceIsRefused) {
  for (const char* far : {"1.E15", "1.E20", "1.E49"}) {
    FaceBuilder b;
    b.face(10, {b.bound({b.circle(0.25, 0, 0.5, 0.5)})});
    std::string data = testing::square;
    data.replace(data.find("(1.,1.,0.)"), 10, "(" + std::string(far) + ",1.,0.)");
    const auto model =
        model_faces(testing::parse_or_die(testing::step_text(data + b.text())).model());
    ASSERT_TRUE(model) << model.error().message();
    ASSERT_EQ(model->skipped.size(), 1U);
    EXPECT_NE(model->skipped[0].reason.message().find("vanish on its surface"), std::string::npos);
  }
}

TEST(ContextFaces, DirectionsOfLoopsOnAPlaneNeedNotBeRight) {
  FaceBuilder b;
  b.face(b.entity(on_frame(b, "PLANE", "")),
         {b.bound({-b.circle(10, 0)}), b.bound({b.circle(1, 0, 3, 0)})}, false);
  expect_area(b, 99 * pi);
}

TEST(ContextFaces, ACylinderMayHaveASeamOrNone) {
  FaceBuilder two_circles;
  two_circles.face(two_circles.entity(on_frame(two_circles, "CYLINDRICAL_SURFACE", ",2.")),
                   {two_circles.bound({two_circles.circle(2, 0)}),
                    two_circles.bound({-two_circles.circle(2, 5)})});
  expect_area(two_circles, 20 * pi);

  FaceBuilder b;
  const int lower = b.vertex(2, 0, 0), upper = b.vertex(2, 0, 5);
  const int below = b.edge(lower, lower, "CIRCLE('',#" + std::to_string(b.frame()) + ",2.)");
  const int above = b.edge(upper, upper, "CIRCLE('',#" + std::to_string(b.frame(0, 0, 5)) + ",2.)");
  const int seam = b.line(lower, upper, {2, 0, 0}, {0, 0, 1});
  b.face(b.entity(on_frame(b, "CYLINDRICAL_SURFACE", ",2.")),
         {b.bound({below, seam, -above, -seam})});
  expect_area(b, 20 * pi);
}

TEST(ContextFaces, NormalsLookWhereTheFaceDoes) {
  for (const bool same_sense : {true, false}) {
    FaceBuilder b;
    const int below = b.bound({b.circle(2, 0)}, same_sense),
              above = b.bound({-b.circle(2, 5)}, same_sense);
    b.face(b.entity(on_frame(b, "CYLINDRICAL_SURFACE", ",2.")), {below, above}, same_sense);
    const auto found = meshes(b);
    ASSERT_EQ(found.size(), 1U);
    for (std::size_t k = 0; k < found[0].points.size(); ++k) {
      const double outwards =
          found[0].points[k].head<2>().normalized().dot(found[0].normals[k].head<2>());
      EXPECT_NEAR(outwards, same_sense ? 1 : -1, 1e-9);
    }
  }
}

TEST(ContextFaces, AConeReachesItsApexInDegreesOrRadians) {
  for (const bool degrees : {false, true}) {
    FaceBuilder b;
    if (degrees) {
      const int radian = b.entity("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
      const int measure =
          b.entity("PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.017453292519943295),#" +
                   std::to_string(radian) + ")");
      b.entity("(CONVERSION_BASED_UNIT('DEGREE',#" + std::to_string(measure) +
               ")NAMED_UNIT($)PLANE_ANGLE_UNIT())");
    }
    const double angle = std::atan(0.5);
    // Radius 1 at z = 0, apex at z = -2; the face from z = 2, radius 2, downwards.
    b.face(b.entity(on_frame(b, "CONICAL_SURFACE",
                             ",1.," + FaceBuilder::real(degrees ? angle * 180 / pi : angle))),
           {b.bound({-b.circle(2, 2)}), b.vertex_bound(0, 0, -2)});
    expect_area(b, pi * 2 * std::sqrt(20.0));
  }
}

TEST(ContextFaces, WholeSpheresAndToriNeedNoEdge) {
  FaceBuilder sphere;
  sphere.face(sphere.entity(on_frame(sphere, "SPHERICAL_SURFACE", ",3.")),
              {sphere.vertex_bound(0, 0, 3)});
  expect_area(sphere, 36 * pi);
  FaceBuilder torus;
  torus.face(torus.entity(on_frame(torus, "TOROIDAL_SURFACE", ",5.,2.")),
             {torus.vertex_bound(7, 0, 0)});
  expect_area(torus, 40 * pi * pi);
}

TEST(ContextFaces, ASphereIsCutByTheSideThatTheLoopHasOnItsLeft) {
  // A small circle round x = 3 cos 30°; on its left, seen from outside, lies the cap or the rest.
  for (const bool cap : {true, false}) {
    FaceBuilder b;
    const double x = 3 * std::cos(pi / 6);
    const int v = b.vertex(x, 1.5, 0);
    const int frame = b.entity("AXIS2_PLACEMENT_3D('',#" + std::to_string(b.point(x, 0, 0)) + ",#" +
                               std::to_string(b.direction(1, 0, 0)) + ",#" +
                               std::to_string(b.direction(0, 1, 0)) + ")");
    const int circle = b.edge(v, v, "CIRCLE('',#" + std::to_string(frame) + ",1.5)");
    b.face(b.entity(on_frame(b, "SPHERICAL_SURFACE", ",3.")), {b.bound({cap ? circle : -circle})});
    const double height = 3 - x;
    expect_area(b, cap ? 2 * pi * 3 * height : 2 * pi * 3 * (6 - height));
  }
}

TEST(ContextFaces, ToriThatCrossTheirAxisHaveTwoParts) {
  const double phi = std::acos(-1.0 / 2);
  for (const bool outer : {true, false}) {
    FaceBuilder b;
    b.face(
        b.entity(on_frame(b, "DEGENERATE_TOROIDAL_SURFACE", outer ? ",1.,2.,.T." : ",1.,2.,.F.")),
        {b.vertex_bound(0, 0, 0)});
    // ∫ 2π |R + r cos v| r dv
    expect_area(
        b, 2 * pi * 2 * (outer ? 2 * phi + 4 * std::sin(phi) : 4 * std::sin(phi) - 2 * (pi - phi)));
  }
}

/// A closed shell of a lateral face and the discs below and above it; without a second radius the
/// disc below.
double volume_with_discs(FaceBuilder& b, double below, double radius, double above = 0,
                         double second = 0) {
  const auto plane = [&b](double z) {
    return b.entity("PLANE('',#" + std::to_string(b.frame(0, 0, z)) + ")");
  };
  b.face(plane(below), {b.bound({-b.circle(radius, below)})}, false);
  if (second > 0) b.face(plane(above), {b.bound({b.circle(second, above)})});
  return testing::volume_of(meshes(b));
}

TEST(ContextFaces, BothNappesOfAConeAreSheets) {
  // r = 5 + v on a frame at z = 15: the frustum from z = 0, r = 10, to z = 5, r = 5 lies beyond the
  // apex at z = 10. The near nappe is z = 15 to 20, r = 5 to 10.
  const double volume = pi * 5 / 3 * (100 + 50 + 25);
  for (const double tangent : {1.0, -1.0}) {  // the same cone from either side
    for (const bool upper : {false, true}) {
      FaceBuilder b;
      const int cone =
          b.entity("CONICAL_SURFACE('',#" + std::to_string(b.frame(0, 0, tangent > 0 ? 15 : 5)) +
                   ",5.," + FaceBuilder::real(std::atan(tangent)) + ")");
      const double below = upper ? 15 : 0, above = upper ? 20 : 5, radius = upper ? 5 : 10,
                   second = upper ? 10 : 5;
      b.face(cone, {b.bound({b.circle(radius, below)}), b.bound({-b.circle(second, above)})});
      EXPECT_NEAR(std::abs(volume_with_discs(b, below, radius, above, second)), volume,
                  0.01 * volume)
          << tangent << " " << upper;
    }
  }
}

TEST(ContextFaces, ALensOfTheInnerPartOfATorusHasItsVolume) {
  // R = 3, r = 10: the tip of the lemon above z = 8 is turned by the arc from (3, 0, 8) to (0, 0,
  // √91).
  const double tip = std::sqrt(91.0);
  for (const char* form : {"DEGENERATE_TOROIDAL_SURFACE", "TOROIDAL_SURFACE"}) {
    for (const bool away : {true, false}) {  // the normal that the file means
      FaceBuilder b;
      const bool flagged = form[0] == 'D';
      const int torus = b.entity(on_frame(b, form, flagged ? ",3.,10.,.F." : ",3.,10."));
      const int rim = b.vertex(3, 0, 8), apex = b.vertex(0, 0, tip);
      const int circle =
          b.edge(rim, rim, "CIRCLE('',#" + std::to_string(b.frame(0, 0, 8)) + ",3.)");
      const int at = b.point(-3, 0, 0), z = b.direction(0, -1, 0), x = b.direction(1, 0, 0);
      const int frame = b.entity("AXIS2_PLACEMENT_3D('',#" + std::to_string(at) + ",#" +
                                 std::to_string(z) + ",#" + std::to_string(x) + ")");
      const int arc = b.edge(rim, apex, "CIRCLE('',#" + std::to_string(frame) + ",10.)");
      const auto bound = away ? b.bound({circle, arc, -arc}) : b.bound({arc, -arc, -circle});
      b.face(torus, {bound}, true);
      const double z0 = 8;
      // V = π ∫ (√(100 − z²) − 3)² dz, of which the antiderivative is 109 z − z³/3 − 3 (z √(100 −
      // z²) + 100 asin(z/10))
      const auto integral = [](double h) {
        return 109 * h - h * h * h / 3 - 3 * (h * std::sqrt(100 - h * h) + 100 * std::asin(h / 10));
      };
      const double volume = pi * (integral(tip) - integral(z0));
      EXPECT_NEAR(volume, 17.598, 1e-3);
      EXPECT_NEAR(std::abs(volume_with_discs(b, 8, 3)), volume, 0.01 * volume) << form << away;
    }
  }
}

TEST(ContextFaces, ASkewLineRevolvesToAHyperboloid) {
  FaceBuilder b;
  const int at = b.point(2, 0, 0);
  const int vector = b.entity("VECTOR('',#" + std::to_string(b.direction(0, 1, 1)) + ",1.)");
  const int line = b.entity("LINE('',#" + std::to_string(at) + ",#" + std::to_string(vector) + ")");
  const int axis = b.entity("AXIS1_PLACEMENT('',#" + std::to_string(b.point(0, 0, 0)) + ",#" +
                            std::to_string(b.direction(0, 0, 1)) + ")");
  const double radius = std::sqrt(4.0 + 9.0);
  b.face(b.entity("SURFACE_OF_REVOLUTION('',#" + std::to_string(line) + ",#" +
                  std::to_string(axis) + ")"),
         {b.bound({b.circle(radius, -3)}), b.bound({-b.circle(radius, 3)})});
  // ρ² = 4 + z²: 2π ∫ ρ √(1 + ρ'²) dz with ρ √(1 + ρ'²) = √(4 + 2 z²)
  double area = 0;
  constexpr int count = 10000;
  for (int k = 0; k < count; ++k) {
    const double z = -3 + 6 * (k + 0.5) / count;
    area += 2 * pi * std::sqrt(4 + 2 * z * z) * 6 / count;
  }
  expect_area(b, area);
}

TEST(ContextFaces, AParabolaIsExtruded) {
  FaceBuilder b;
  // x = t², y = 2t with focal length 1, from t = -1 to 1, then along z.
  const auto parabola = [&b](double z) {
    return "PARABOLA('',#" + std::to_string(b.frame(0, 0, z)) + ",1.)";
  };
  const int p = b.vertex(1, -2, 0), q = b.vertex(1, 2, 0), r = b.vertex(1, 2, 4),
            s = b.vertex(1, -2, 4);
  const int below = b.edge(p, q, parabola(0)), above = b.edge(s, r, parabola(4));
  const int right = b.line(q, r, {1, 2, 0}, {0, 0, 1}), left = b.line(p, s, {1, -2, 0}, {0, 0, 1});
  const int swept = b.entity(parabola(0));
  const int vector = b.entity("VECTOR('',#" + std::to_string(b.direction(0, 0, 1)) + ",2.)");
  b.face(b.entity("SURFACE_OF_LINEAR_EXTRUSION('',#" + std::to_string(swept) + ",#" +
                  std::to_string(vector) + ")"),
         {b.bound({below, right, -above, -left})});
  // ∫ 2 √(1 + t²) dt = [t √(1 + t²) + asinh t]
  expect_area(b, 4 * 2 * (std::sqrt(2.0) + std::asinh(1.0)));
}

TEST(ContextFaces, PolygonsNeedNoSurface) {
  FaceBuilder b;
  const int outline = b.polygon_bound({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {2, 1, 0}, {0, 3, 0}});
  b.entity("FACE('',(#" + std::to_string(outline) + "))");
  expect_area(b, 8);
}

TEST(ContextFaces, FacesThatMeetAtAnEdgeHaveTheSamePointsThere) {
  FaceBuilder b;
  const int below = b.circle(2, 0), above = b.circle(2, 5);
  b.face(b.entity(on_frame(b, "CYLINDRICAL_SURFACE", ",2.")),
         {b.bound({below}), b.bound({-above})});
  b.face(b.entity(on_frame(b, "PLANE", "")), {b.bound({-below})}, false);
  const auto found = meshes(b, 1e-2);
  ASSERT_EQ(found.size(), 2U);
  std::size_t shared = 0;
  for (const Point& p : found[1].points) {
    shared +=
        static_cast<std::size_t>(std::count(found[0].points.begin(), found[0].points.end(), p) > 0);
  }
  EXPECT_EQ(shared, found[1].points.size());
}

TEST(ContextFaces, WhatCannotBeDrawnIsNamedAndTheRestIsDrawn) {
  FaceBuilder b;
  const int plane = b.entity(on_frame(b, "PLANE", ""));
  const int offset = b.entity("OFFSET_SURFACE('',#" + std::to_string(plane) + ",1.,.F.)");
  const int skipped = b.face(offset, {b.bound({b.circle(1, 1)})});
  const int crossed =
      b.face(b.entity(on_frame(b, "CYLINDRICAL_SURFACE", ",2.")), {b.bound({b.circle(2, 0)})});
  const int astray = b.face(plane, {b.bound({b.circle(1, 7)})});
  b.face(plane, {b.bound({b.circle(1, 0)})});
  const auto context = context_faces(b.file().model());
  ASSERT_TRUE(context);
  EXPECT_EQ(context->faces.size(), 1U);
  ASSERT_EQ(context->skipped.size(), 3U);
  EXPECT_EQ(context->skipped[0].id, "#" + std::to_string(skipped));
  EXPECT_NE(context->skipped[0].reason.message().find("OFFSET_SURFACE"), std::string::npos);
  EXPECT_EQ(context->skipped[1].id, "#" + std::to_string(crossed));
  EXPECT_NE(context->skipped[1].reason.message().find("goes round"), std::string::npos);
  EXPECT_EQ(context->skipped[2].id, "#" + std::to_string(astray));
  EXPECT_NE(context->skipped[2].reason.message().find("do not lie on its surface"),
            std::string::npos);
}

TEST(ContextFaces, FacesOnSurfacesThatCanBeSculptedAreNoContext) {
  FaceBuilder b;
  b.face(10, {b.bound({b.circle(0.25, 0, 0.5, 0.5)})});
  const auto file = testing::parse_or_die(
      testing::step_text(testing::unit_square_points() + testing::bilinear_patch() + b.text()));
  const auto context = context_faces(file.model());
  ASSERT_TRUE(context);
  EXPECT_TRUE(context->faces.empty());
  EXPECT_TRUE(context->skipped.empty());
}

TEST(ContextFaces, TheToleranceHasARange) {
  FaceBuilder b;
  b.face(b.entity(on_frame(b, "PLANE", "")), {b.bound({b.circle(1, 0)})});
  for (const double bad : {0.0, -1.0, 0.5, std::nan("")}) {
    const auto context = context_faces(b.file().model(), bad);
    ASSERT_FALSE(context);
    EXPECT_EQ(context.error().kind, ErrorKind::usage);
  }
}

class ContextCorpus : public testing::FileTest {};

TEST_P(ContextCorpus, NoFaceOfARealFileIsSkipped) {
  const auto file = step::File::read(path_);
  ASSERT_TRUE(file) << file.error().message();
  const auto context = context_faces(file->model());
  ASSERT_TRUE(context);
  for (const auto& [id, reason] : context->skipped) ADD_FAILURE() << id << ": " << reason.message();
  for (const auto& mesh : context->faces) {
    EXPECT_FALSE(mesh.triangles.empty()) << mesh.id;
    for (const Point& p : mesh.points) EXPECT_TRUE(p.allFinite()) << mesh.id;
  }
}

INSTANTIATE_TEST_SUITE_P(Files, ContextCorpus, ::testing::ValuesIn(testing::step_files()),
                         testing::file_test_name);

}  // namespace
}  // namespace knead
