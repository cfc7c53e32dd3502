#include "brep/tessellation/model_mesh.hpp"

#include "knead/exchange/save_model.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>

#include "exchange/face_builder.hpp"
#include "exchange/mesh_measures.hpp"
#include "knead/brep/model.hpp"
#include "knead/spline/closest_point.hpp"
#include "support/long_run.hpp"
#include "support/own_files.hpp"

namespace knead {
namespace {

using testing::FaceBuilder;
using testing::volume_of;
constexpr double pi = std::numbers::pi;

FaceMeshes model_of(const step::File& file, double tolerance) {
  auto model = model_faces(file.model(), tolerance);
  if (!model) {
    ADD_FAILURE() << model.error().message();
    return {};
  }
  for (const auto& [id, reason] : model->skipped) ADD_FAILURE() << id << ": " << reason.message();
  return *std::move(model);
}

/// A closed can: a cylinder with two lids that share its circles. Returns its CLOSED_SHELL.
int add_can(FaceBuilder& b, double radius, double height) {
  const int below = b.circle(radius, 0), above = b.circle(radius, height);
  const auto on = [&](const std::string& entity, double z, const std::string& measure) {
    return b.entity(entity + "('',#" + std::to_string(b.frame(0, 0, z)) + measure + ")");
  };
  const std::vector<int> faces = {
      b.face(on("CYLINDRICAL_SURFACE", 0, "," + FaceBuilder::real(radius)),
             {b.bound({below}), b.bound({-above})}),
      b.face(on("PLANE", 0, ""), {b.bound({-below})}, false),
      b.face(on("PLANE", height, ""), {b.bound({above})})};
  return b.entity("CLOSED_SHELL('',(" + FaceBuilder::list_of(faces) + "))");
}

step::File can(double radius, double height) {
  FaceBuilder b;
  add_can(b, radius, height);
  return b.file();
}

TEST(ModelMesh, AClosedShellGivesAClosedMesh) {
  for (const double tolerance : {0.5, 0.05, 0.0005}) {
    const FaceMeshes model = model_of(can(10, 30), tolerance);
    ASSERT_EQ(model.faces.size(), 3U);
    EXPECT_EQ(open_sides(model.faces), 0U);
    const double exact = 3000 * pi, surface = 800 * pi;
    EXPECT_NEAR(volume_of(model.faces), exact, tolerance * surface);
    EXPECT_LT(volume_of(model.faces), exact);
  }
}

TEST(ModelMesh, ShellsOfHollowsAreInsideOutWhereTheyAreSaidToBe) {
  const auto volume = [](char orientation, bool also_solid = false) {
    FaceBuilder b;
    const int outer = add_can(b, 10, 30), hollow = add_can(b, 5, 20);
    const int oriented = b.entity("ORIENTED_CLOSED_SHELL('',*,#" + std::to_string(hollow) + ",." +
                                  std::string(1, orientation) + ".)");
    b.entity("BREP_WITH_VOIDS('',#" + std::to_string(outer) + ",(#" + std::to_string(oriented) +
             "))");
    if (also_solid) b.entity("MANIFOLD_SOLID_BREP('',#" + std::to_string(hollow) + ")");
    const FaceMeshes model = model_of(b.file(), 0.01);
    for (const FaceMesh& mesh : model.faces) {
      for (const auto& t : mesh.triangles) {
        const Point &p = mesh.points[t[0]], &q = mesh.points[t[1]], &r = mesh.points[t[2]];
        EXPECT_GT((q - p).cross(r - p).dot(mesh.normals[t[0]]), 0) << mesh.id;
      }
    }
    EXPECT_EQ(open_sides(model.faces), 0U);
    return volume_of(model.faces);
  };
  const double outer = 3000 * pi, hollow = 500 * pi,
               within = 0.01 * 1050 * pi;  // the tolerance times the area
  EXPECT_NEAR(volume('F'), outer - hollow, within);
  EXPECT_NEAR(volume('T'), outer + hollow, within);
  EXPECT_NEAR(volume('F', true), outer + hollow, within);  // what fills it: one mesh of both
}

/// Volume of the only face, meshed at the default tolerance.
double default_volume(const FaceBuilder& b) { return volume_of(model_of(b.file(), 0).faces); }

TEST(ModelMesh, WholeSpheresAndToriAreMeshedAtTheDefaultTolerance) {
  FaceBuilder torus;
  torus.face(torus.entity("TOROIDAL_SURFACE('',#" + std::to_string(torus.frame()) + ",10.,3.)"),
             {torus.vertex_bound(13, 0, 0)});
  EXPECT_NEAR(default_volume(torus), 2 * pi * pi * 90, 0.01 * 2 * pi * pi * 90);
  for (const double radius : {1e-3, 1.0, 1e4}) {
    FaceBuilder sphere;
    sphere.face(sphere.entity("SPHERICAL_SURFACE('',#" + std::to_string(sphere.frame()) + "," +
                              FaceBuilder::real(radius) + ")"),
                {sphere.vertex_bound(0, 0, radius)});
    const double exact = 4 * pi / 3 * radius * radius * radius;
    EXPECT_NEAR(default_volume(sphere), exact, 0.01 * exact) << radius;
  }
}

TEST(ModelMesh, ASmallHoleMakesNoFinerMesh) {
  FaceBuilder b;
  const double narrow = 0.001;
  b.face(b.entity("SPHERICAL_SURFACE('',#" + std::to_string(b.frame()) + ",1.)"),
         {b.bound({-b.circle(narrow, std::sqrt(1 - narrow * narrow))})});
  const FaceMeshes model = model_of(b.file(), 0);
  EXPECT_LT(model.faces[0].triangles.size(), 20000U);
}

TEST(ModelMesh, AnEdgeMayHaveFunctionsThatAreZeroEverywhere) {
  // A cubic with the knot 0 six times: its first two functions have no support, and their control
  // points no effect.
  FaceBuilder b;
  const int from = b.vertex(0, 0, 0), to = b.vertex(3, 0, 0), far = b.point(50, 60, 70);
  std::string points = FaceBuilder::list_of(
      {far, far, b.point(0, 0, 0), b.point(1, 1, 0), b.point(2, 1, 0), b.point(3, 0, 0)});
  const int arch = b.edge(from, to,
                          "B_SPLINE_CURVE_WITH_KNOTS('',3,(" + points +
                              "),.UNSPECIFIED.,.F.,.F.,(4,2,4),(0.,0.,1.),.UNSPECIFIED.)");
  b.face(b.entity("PLANE('',#" + std::to_string(b.frame()) + ")"),
         {b.bound({-arch, b.line(from, to, {0, 0, 0}, {1, 0, 0})})});
  const FaceMeshes model = model_of(b.file(), 1e-4);
  ASSERT_EQ(model.faces.size(), 1U);
  EXPECT_NEAR(testing::area_of(model.faces[0]), 1.5, 1e-3);  // x = 3 t, y = 3 t (1 − t)
}

/// Half a ring, 5 high: between the radii `inner` and 10, the inner arc in two edges.
step::File half_ring(double inner) {
  FaceBuilder b;
  struct Corner {
    double x, y, radius;  ///< of the arc to the next one; 0: a line; below 0: clockwise
  };
  const double angle = 2.2;
  const std::array<Corner, 5> corners = {
      {{10, 0, 10},
       {-10, 0, 0},
       {-inner, 0, -inner},
       {inner * std::cos(angle), inner * std::sin(angle), -inner},
       {inner, 0, 0}}};
  constexpr std::size_t n = corners.size();
  std::array<int, n> post;
  std::array<std::array<int, n>, 2> vertex, side;
  for (std::size_t k = 0; k < n; ++k) {
    const auto [x, y, radius] = corners[k];
    for (const std::size_t end : {0U, 1U}) vertex[end][k] = b.vertex(x, y, 5.0 * end);
    post[k] = b.line(vertex[0][k], vertex[1][k], {x, y, 0}, {0, 0, 1});
  }
  std::array<std::vector<int>, 2> rim;
  for (const std::size_t end : {0U, 1U}) {
    for (std::size_t k = 0; k < n; ++k) {
      const auto [x, y, radius] = corners[k];
      const int from = vertex[end][k], to = vertex[end][(k + 1) % n];
      const auto circle = "CIRCLE('',#" + std::to_string(b.frame(0, 0, 5.0 * end)) + ",";
      side[end][k] = radius == 0  ? b.line(from, to, {x, y, 5.0 * end}, {1, 0, 0})
                     : radius > 0 ? b.edge(from, to, circle + FaceBuilder::real(radius) + ")")
                                  : -b.edge(to, from, circle + FaceBuilder::real(-radius) + ")");
      rim[end].push_back(side[end][k]);
    }
    if (end == 0) {
      std::ranges::reverse(rim[end]);
      for (int& edge : rim[end]) edge = -edge;
    }
    b.face(b.entity("PLANE('',#" + std::to_string(b.frame(0, 0, 5.0 * end)) + ")"),
           {b.bound(rim[end])}, end == 1);
  }
  const int front = b.entity("AXIS2_PLACEMENT_3D('',#" + std::to_string(b.point(0, 0, 0)) + ",#" +
                             std::to_string(b.direction(0, -1, 0)) + ",#" +
                             std::to_string(b.direction(1, 0, 0)) + ")");
  for (std::size_t k = 0; k < n; ++k) {
    const double radius = corners[k].radius;
    const int on = b.entity(radius == 0 ? "PLANE('',#" + std::to_string(front) + ")"
                                        : "CYLINDRICAL_SURFACE('',#" + std::to_string(b.frame()) +
                                              "," + FaceBuilder::real(std::abs(radius)) + ")");
    b.face(on, {b.bound({side[0][k], post[(k + 1) % n], -side[1][k], -post[k]})}, radius >= 0);
  }
  return b.file();
}

TEST(ModelMesh, FacesNarrowerThanTheirChordsAreHighAreMeshedAndTheirNeighboursMeetThem) {
  for (const double width : {2.0, 0.3, 0.02, 0.004}) {
    const FaceMeshes model = model_of(half_ring(10 - width), 0.3);
    EXPECT_EQ(model.faces.size(), 7U) << width;
    EXPECT_EQ(open_sides(model.faces), 0U) << width;
    const double exact = 5 * pi / 2 * width * (20 - width), area = 10 * pi * 10;
    EXPECT_NEAR(volume_of(model.faces), exact, 0.3 * area) << width;
    EXPECT_GT(volume_of(model.faces), 0) << width;
  }
}

TEST(ModelMesh, AnEdgeMayBeAPoint) {
  // Rounding moves the points of its curve to and fro.
  FaceBuilder b;
  const double x = -445.0328, y = 701.2329, z = 143.7008;
  const auto line = [&](int from, int to, double dx, double dy, double wx, double wy) {
    return b.line(from, to, {x + dx, y + dy, z}, {wx, wy, 0});
  };
  const int first = b.vertex(x, y, z), second = b.vertex(x, y, z), right = b.vertex(x + 3, y, z),
            above = b.vertex(x, y + 2, z);
  const std::vector<int> points(6, b.point(x, y, z));
  const int none =
      b.edge(first, second,
             "B_SPLINE_CURVE_WITH_KNOTS('',5,(" + FaceBuilder::list_of(points) +
                 "),.UNSPECIFIED.,.F.,.F.,(6,6),(1213.81,1213.813),.PIECEWISE_BEZIER_KNOTS.)");
  b.face(b.entity("PLANE('',#" + std::to_string(b.frame(0, 0, z)) + ")"),
         {b.bound({none, line(second, right, 0, 0, 1, 0), line(right, above, 3, 0, -3, 2),
                   line(above, first, 0, 2, 0, -1)})});
  const FaceMeshes model = model_of(b.file(), 1e-3);
  ASSERT_EQ(model.faces.size(), 1U);
  EXPECT_NEAR(testing::area_of(model.faces[0]), 3, 1e-9);
  EXPECT_EQ(open_sides(model.faces), 3U);
}

TEST(ModelMesh, ASurfaceMayBeNarrowerThanItsEdgesAreSearchedTo) {
  // An arch 10 long and 5e-5 wide. Its sides are parallel to ∂u, and ∂v is zero there.
  FaceBuilder b;
  const double wide = 5e-5;
  const std::array<std::array<double, 2>, 3> arch = {{{0, 0}, {5, 2}, {10, 0}}};
  const auto side = [&](double y) {
    std::vector<int> points;
    for (const auto& [x, z] : arch) points.push_back(b.point(x, y, z));
    return points;
  };
  std::string net;
  for (const auto& [x, z] : arch) {
    std::vector<int> row;
    for (int k = 0; k < 6; ++k) row.push_back(b.point(x, k < 3 ? 0 : wide, z));
    net += (net.empty() ? "(" : ",(") + FaceBuilder::list_of(row) + ")";
  }
  std::array<int, 4> vertex = {b.vertex(0, 0, 0), b.vertex(10, 0, 0), b.vertex(10, wide, 0),
                               b.vertex(0, wide, 0)};
  const auto curved = [&](int from, int to, double y) {
    return b.edge(from, to,
                  "B_SPLINE_CURVE_WITH_KNOTS('',2,(" + FaceBuilder::list_of(side(y)) +
                      "),.UNSPECIFIED.,.F.,.F.,(3,3),(0.,1.),.UNSPECIFIED.)");
  };
  const int front = curved(vertex[0], vertex[1], 0), back = curved(vertex[3], vertex[2], wide);
  const int right = b.line(vertex[1], vertex[2], {10, 0, 0}, {0, 1, 0});
  const int left = b.line(vertex[0], vertex[3], {0, 0, 0}, {0, 1, 0});
  b.face(b.entity("B_SPLINE_SURFACE_WITH_KNOTS('',2,5,(" + net +
                  "),.UNSPECIFIED.,.F.,.F.,.F.,(3,3),(6,6),(0.,1.),(0.,1.),.UNSPECIFIED.)"),
         {b.bound({front, right, -back, -left})});
  const FaceMeshes model = model_of(b.file(), 0.01);
  ASSERT_EQ(model.faces.size(), 1U);
  EXPECT_LT(model.faces[0].triangles.size(), 1000U);
  // ∫ √(100 + (4 − 8 t)²) dt from 0 to 1.
  const double length = std::sqrt(29) + 12.5 * std::asinh(0.4);
  EXPECT_NEAR(testing::area_of(model.faces[0]), wide * length, 0.01 * wide * length);
}

TEST(ModelMesh, AnOpenShellIsOpenAlongItsEdge) {
  FaceBuilder b;
  b.face(b.entity("PLANE('',#" + std::to_string(b.frame()) + ")"), {b.bound({b.circle(10, 0)})});
  const FaceMeshes model = model_of(b.file(), 0.01);
  EXPECT_EQ(open_sides(model.faces), model.faces[0].points.size());
}

TEST(ModelMesh, SpheresAndToriAreClosedWithoutEdges) {
  for (const std::string shape : {"SPHERICAL_SURFACE", "TOROIDAL_SURFACE"}) {
    FaceBuilder b;
    const bool sphere = shape.starts_with("SPH");
    b.face(b.entity(shape + "('',#" + std::to_string(b.frame()) + (sphere ? ",3.)" : ",9.,3.)")),
           {b.vertex_bound(sphere ? 0 : 12, 0, sphere ? 3 : 0)});
    const FaceMeshes model = model_of(b.file(), 0.01);
    EXPECT_EQ(open_sides(model.faces), 0U) << shape;
    const double volume = sphere ? 36 * pi : 162 * pi * pi;
    EXPECT_NEAR(volume_of(model.faces), volume, 0.01 * (sphere ? 36 * pi : 108 * pi * pi)) << shape;
  }
}

/// The largest distance of a mesh from the surface that it lies on, at 12 points of each triangle,
/// or of every so many of the larger meshes.
double off(const FaceMesh& mesh, const Surface& surface) {
  const auto search = ClosestPointSearch<2>::create(surface);
  double result = 0;
  const std::size_t enough = testing::long_run() ? 1000 : 250;
  for (std::size_t n = 0; n < mesh.triangles.size(); n += 1 + mesh.triangles.size() / enough) {
    const auto& t = mesh.triangles[n];
    const Point &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    for (int i = 0; i <= 4; ++i) {
      for (int k = 0; k <= 4 - i; ++k) {
        if (i == 4 || k == 4) continue;
        result =
            std::max(result, search->nearest(Point(i * a + k * b + (4 - i - k) * c) / 4).distance);
      }
    }
  }
  return result;
}

class ModelMeshFile : public testing::FileTest {};

TEST_P(ModelMeshFile, TrianglesAreWithinTheToleranceOfTheirSurface) {
  const auto file = step::File::read(path_);
  ASSERT_TRUE(file);
  if (file->surfaces().empty()) GTEST_SKIP() << "there is no B-spline surface";
  for (const double share : {1e-3, 1e-4}) {
    Eigen::AlignedBox3d box;
    for (const auto& s : file->surfaces()) {
      for (const auto& row : s.surface.control_points().rowwise())
        box.extend(Point(row.transpose()));
    }
    const double tolerance = share * box.diagonal().norm();
    const FaceMeshes model = model_of(*file, tolerance);
    const auto assembly = file->model().assembly;
    ASSERT_TRUE(assembly);
    int measured = 0;
    std::map<std::string, std::size_t>
        place;  // the meshes of a face are in the order of the places of its part
    for (FaceMesh mesh : model.faces) {
      const auto* entity = file->model().find_surface(mesh.surface);
      if (entity == nullptr || ++measured > (testing::long_run() ? 12 : 4)) continue;
      const Eigen::Affine3d back =
          assembly->part_of(mesh.surface)->places[place[mesh.id]++].to_model.inverse();
      for (Point& p : mesh.points) p = back * p;
      EXPECT_LE(off(mesh, entity->surface), tolerance) << mesh.id << " of " << model.faces.size();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Files, ModelMeshFile, ::testing::ValuesIn(testing::step_files()),
                         testing::file_test_name);

TEST(ModelMesh, SaysWhatIsWrong) {
  const auto file = can(10, 30);
  for (const double tolerance : {-1.0, 1e-9, std::nan("")}) {
    const auto model = model_faces(file.model(), tolerance);
    ASSERT_FALSE(model) << tolerance;
    EXPECT_EQ(model.error().kind, ErrorKind::usage);
    EXPECT_EQ(model.error().where, "tolerance");
  }
  const auto empty = model_faces(
      testing::parse_or_die(testing::step_text("#1=CARTESIAN_POINT('',(0.,0.,0.));\n")).model());
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().kind, ErrorKind::input);
  // A tolerance that follows from the model is not one that somebody gave.
  for (const double size : {1e200, 0.0}) {
    brep::Model far;
    brep::TessellatedItem& item = far.tessellated.items.emplace_back();
    item.mesh.id = "#1";
    if (size > 0) item.mesh.points = {Point(0, 0, 0), Point(size, 0, 0), Point(0, size, 0)};
    far.assembly = brep::single_part(far);
    const auto made = model_faces(far);
    EXPECT_EQ(made.has_value(), size == 0) << "an item without points has no extent";
    EXPECT_EQ(made ? ErrorKind::numerical : made.error().kind, ErrorKind::numerical);
  }
  const auto text = save_model(**open_source(file.bytes(), file.name()), *find_format("step"));
  ASSERT_FALSE(text);
  EXPECT_NE(text.error().message().find(".stl"), std::string::npos) << text.error().message();
}

}  // namespace
}  // namespace knead
