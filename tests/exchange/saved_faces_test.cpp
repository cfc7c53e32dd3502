// New files of faces with their trims, read again.

#include <cmath>
#include <numbers>

#include "brep/tessellation/model_mesh.hpp"
#include "exchange/brep_square.hpp"
#include "exchange/face_builder.hpp"
#include "exchange/iges_builder.hpp"
#include "exchange/mesh_measures.hpp"
#include "knead/exchange/save_model.hpp"
#include "support/made_files.hpp"
#include "support/made_iges_solids.hpp"

namespace knead {
namespace {

using testing::FaceBuilder;
using testing::open_or_die;
constexpr double pi = std::numbers::pi;
constexpr double rounding = 1e-9;              // of areas and volumes of the same mesh
constexpr double mesh_tolerance = 1.0 / 2000;  // of the diagonal of the box

/// What a file shows.
struct Shown {
  std::size_t faces = 0, edges = 0, open = 0;
  double area = 0, volume = 0;
  Eigen::AlignedBox3d box = {};
};

Shown shown(const Source& source) {
  Shown result;
  const auto meshed = model_faces(*source.model(), 0);
  if (!meshed) {
    ADD_FAILURE() << meshed.error().message();
    return result;
  }
  for (const auto& [id, reason] : meshed->skipped) ADD_FAILURE() << id << ": " << reason.message();
  result.faces = meshed->faces.size();
  result.edges = source.model()->edges.size();
  result.open = open_sides(meshed->faces);
  result.volume = testing::volume_of(meshed->faces);
  for (const FaceMesh& mesh : meshed->faces) {
    result.area += testing::area_of(mesh);
    for (const Point& p : mesh.points) result.box.extend(p);
  }
  return result;
}

void expect_same(const Shown& a, const Shown& b, double within = rounding) {
  EXPECT_EQ(a.faces, b.faces);
  EXPECT_EQ(a.open, b.open);
  const double size = a.box.diagonal().norm();
  // Chords that turn by half a radian take a hundredth of an area.
  EXPECT_NEAR(a.area, b.area, (within < mesh_tolerance ? within : 0.01) * a.area);
  EXPECT_NEAR(a.volume, b.volume, within * a.area * size);
  EXPECT_LE((a.box.min() - b.box.min()).norm(), within * size);
  EXPECT_LE((a.box.max() - b.box.max()).norm(), within * size);
}

FacesFile saved(const Source& source, const char* format, bool convert = false,
                SaveOptions options = {}) {
  auto made = save_faces(source, *find_format(format), options, convert);
  if (!made) {
    ADD_FAILURE() << made.error().message();
    std::abort();
  }
  return *std::move(made);
}

std::shared_ptr<const Source> again(const FacesFile& file, const char* format) {
  auto source = open_or_die(file.bytes, std::string("again.") + format);
  for (const std::string& remark : source->remarks())
    EXPECT_EQ(remark.find("warning"), std::string::npos) << remark;
  return source;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t result = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++result;
  return result;
}

/// A box from 0 to (4, 3, 2) with a round hole along z in its middle, 0.5 wide; a solid.
std::string drilled_box() {
  FaceBuilder b;
  const double size[3] = {4, 3, 2};
  int corners[8], hole[2];
  for (int k = 0; k < 8; ++k) corners[k] = b.vertex(k & 1 ? 4 : 0, k & 2 ? 3 : 0, k & 4 ? 2 : 0);
  const auto edge = [&](int from, int to) {
    std::array<double, 3> at{}, way{};
    for (int c = 0; c < 3; ++c) {
      at[std::size_t(c)] = (from >> c & 1) * size[c];
      way[std::size_t(c)] = (to >> c & 1) - (from >> c & 1);
    }
    return b.line(corners[from], corners[to], at, way);
  };
  std::map<std::pair<int, int>, int> edges;
  const auto along = [&](int from, int to) {
    const auto key = std::minmax(from, to);
    if (!edges.contains(key)) edges[key] = edge(key.first, key.second);
    return from < to ? edges[key] : -edges[key];
  };
  for (int k = 0; k < 2; ++k) hole[k] = b.circle(0.5, 2 * k, 2, 1.5);
  const auto plane = [&](int corner, std::array<double, 3> normal, std::array<double, 3> x) {
    const int at = b.point((corner & 1) * 4, (corner >> 1 & 1) * 3, (corner >> 2 & 1) * 2);
    const int z = b.direction(normal[0], normal[1], normal[2]),
              along_x = b.direction(x[0], x[1], x[2]);
    return b.entity(
        "PLANE('',#" +
        std::to_string(b.entity("AXIS2_PLACEMENT_3D('',#" + std::to_string(at) + ",#" +
                                std::to_string(z) + ",#" + std::to_string(along_x) + ")")) +
        ")");
  };
  const auto loop = [&](std::array<int, 4> c) {
    return b.bound({along(c[0], c[1]), along(c[1], c[2]), along(c[2], c[3]), along(c[3], c[0])});
  };
  const std::vector<int> faces = {
      b.face(plane(0, {0, 0, 1}, {1, 0, 0}), {loop({0, 2, 3, 1}), b.bound({hole[0]})}, false),
      b.face(plane(4, {0, 0, 1}, {1, 0, 0}), {loop({4, 5, 7, 6}), b.bound({-hole[1]})}),
      b.face(plane(0, {0, -1, 0}, {1, 0, 0}), {loop({0, 1, 5, 4})}),
      b.face(plane(3, {0, 1, 0}, {1, 0, 0}), {loop({3, 2, 6, 7})}),
      b.face(plane(0, {-1, 0, 0}, {0, 1, 0}), {loop({2, 0, 4, 6})}),
      b.face(plane(1, {1, 0, 0}, {0, 1, 0}), {loop({1, 3, 7, 5})}),
      b.face(b.entity("CYLINDRICAL_SURFACE('',#" + std::to_string(b.frame(2, 1.5, 0)) + ",0.5)"),
             {b.bound({-hole[0]}), b.bound({hole[1]})}, false)};
  const int shell = b.entity("CLOSED_SHELL('',(" + FaceBuilder::list_of(faces) + "))");
  b.entity("MANIFOLD_SOLID_BREP('',#" + std::to_string(shell) + ")");
  return testing::step_text(b.text());
}

/// A face on a surface of revolution or a cone, sphere or torus: a closed shell of one surface, by
/// a point of it.
std::string whole_surface(const std::string& surface, std::array<double, 3> at) {
  FaceBuilder b;
  b.face(b.entity(surface + ",#" + std::to_string(b.frame()) + "," +
                  (surface[0] == 'S' ? "2.)" : "5.,2.)")),
         {b.vertex_bound(at[0], at[1], at[2])});
  return testing::step_text(b.text());
}

class SavedFaces : public ::testing::TestWithParam<const char*> {};

TEST_P(SavedFaces, ABoxWithAHoleStaysASolid) {
  for (const bool convert : {false, true}) {
    const auto source = open_or_die(drilled_box(), "box.step");
    const Shown before = shown(*source);
    ASSERT_EQ(before.open, 0U);
    ASSERT_NEAR(before.volume, 24 - pi / 2, 0.01);
    const FacesFile file = saved(*source, GetParam(), convert);
    EXPECT_EQ(file.faces, 7U);
    EXPECT_EQ(file.solids, 1U);
    EXPECT_TRUE(file.left_out.empty()) << sentence(file.left_out.front());
    const auto read = again(file, GetParam());
    EXPECT_EQ(read->model()->edges.size(), 14U);
    EXPECT_EQ(read->surfaces().size(), convert ? 7U : 0U);
    expect_same(before, shown(*read), convert ? mesh_tolerance : rounding);
  }
}

TEST_P(SavedFaces, MadeStepFilesKeepTheirFacesTheirUnitsAndTheirPlaces) {
  for (const auto& [name, text] : testing::made_step_files) {
    const auto source = open_or_die(text(), name);
    if (source->model()->faces.empty()) continue;
    SCOPED_TRACE(name);
    const FacesFile file = saved(*source, GetParam());
    for (const LeftOut& left : file.left_out)
      EXPECT_EQ(left.what().find("face"), std::string::npos) << sentence(left);
    const auto read = again(file, GetParam());
    EXPECT_EQ(read->model()->assembly->unit, source->model()->assembly->unit);
    expect_same(shown(*source), shown(*read));
  }
}

TEST_P(SavedFaces, MadeIgesFilesKeepTheirFaces) {
  const std::vector<testing::MadeFile> more = {{"hollow_box.igs", testing::iges_hollow_box},
                                               {"hollow_boxes.igs", testing::iges_hollow_boxes},
                                               {"turned.igs", testing::iges_box_of_turned_faces},
                                               {"drum.igs", testing::iges_drum_in_inch},
                                               {"ring.igs", testing::iges_ring_in_inch_backwards},
                                               {"dome.igs", testing::iges_dome_in_metres}};
  for (const auto* list : {&testing::made_iges_files, &more}) {
    for (const auto& [name, text] : *list) {
      const auto source = open_or_die(text(), name);
      if (source->model()->faces.empty()) continue;
      SCOPED_TRACE(name);
      const FacesFile file = saved(*source, GetParam());
      const auto read = again(file, GetParam());
      EXPECT_EQ(read->model()->length_unit(), source->model()->length_unit());
      const bool swept =
          std::ranges::any_of(source->model()->supports, [](const brep::Support& support) {
            return std::holds_alternative<brep::SweptSurface>(support.form);
          });
      // Swept surfaces are B-splines in IGES, and then have another mesh, to its tolerance.
      const bool other_mesh = swept && std::string_view(GetParam()) == "iges";
      expect_same(shown(*source), shown(*read), other_mesh ? mesh_tolerance : 1e-6);
    }
  }
}

TEST_P(SavedFaces, HollowsStayHollows) {
  const auto source = open_or_die(testing::iges_hollow_box(), "hollow.igs");
  const FacesFile file = saved(*source, GetParam());
  EXPECT_EQ(file.solids, 1U);
  const Shown before = shown(*source), after = shown(*again(file, GetParam()));
  EXPECT_GT(before.volume, 0);
  EXPECT_NEAR(after.volume, before.volume, 1e-9 * before.volume);
}

TEST_P(SavedFaces, SphereAndTorusStayWholeAndAreSolids) {
  for (const auto& [surface, at] :
       {std::pair<std::string, std::array<double, 3>>("SPHERICAL_SURFACE(''", {0, 0, 2}),
        {"TOROIDAL_SURFACE(''", {7, 0, 0}}}) {
    const auto source = open_or_die(whole_surface(surface, at), "whole.step");
    const FacesFile file = saved(*source, GetParam());
    EXPECT_EQ(file.solids, 1U) << surface;
    expect_same(shown(*source), shown(*again(file, GetParam())));
  }
}

TEST_P(SavedFaces, ASplineFaceWithNeighboursSharesItsEdgesWithThem) {
  const auto source = open_or_die(testing::iges_dome_in_metres(), "dome.igs");
  const FacesFile file = saved(*source, GetParam());
  const auto once = again(file, GetParam());
  const FacesFile second = saved(*once, GetParam());
  EXPECT_EQ(again(second, GetParam())->model()->edges.size(), once->model()->edges.size());
}

TEST_P(SavedFaces, WhatCannotBeReadIsNamedAndItsSurfaceWrittenWhole) {
  FaceBuilder b;
  const int a = b.vertex(0, 0, 0), c = b.vertex(1, 0, 0);
  const int odd = b.edge(a, c, "OFFSET_CURVE_3D('',$,1.,.F.,$)"),
            back = b.line(c, a, {1, 0, 0}, {-1, 0, 0});
  const int face = b.face(10, {b.bound({odd, back})});
  const auto source = open_or_die(testing::step_text(testing::square + b.text()), "odd.step");
  const FacesFile file = saved(*source, GetParam());
  EXPECT_EQ(file.faces, 0U);
  EXPECT_EQ(file.surfaces, 1U);
  const auto left =
      std::ranges::find(file.left_out, "face whose trims are left out", &LeftOut::one);
  ASSERT_NE(left, file.left_out.end());
  EXPECT_EQ(left->ids, std::vector{FaceBuilder::ref(face)});
  EXPECT_EQ(again(file, GetParam())->surfaces().size(), 1U);
}

TEST_P(SavedFaces, AnEdgeMayPassTheEndOfItsClosedCurve) {
  for (const bool whole : {true, false}) {
    FaceBuilder b;
    const int end = b.point(2, 0, 0);
    const std::string curve = "B_SPLINE_CURVE_WITH_KNOTS('',2,(" +
                              FaceBuilder::list_of({end, b.point(2, 2, 0), b.point(-2, 2, 0),
                                                    b.point(-2, -2, 0), b.point(2, -2, 0), end}) +
                              "),.UNSPECIFIED.,.T.,.F.,(3,1,1,1,3),(0.,1.,2.,3.,4.),.UNSPECIFIED.)";
    const int above = b.vertex(0, 2, 0), below = b.vertex(0, -2, 0);
    std::vector<int> loop = {b.edge(whole ? above : below, above, curve)};
    if (!whole) loop.push_back(b.line(above, below, {0, 2, 0}, {0, -1, 0}));
    b.face(b.entity("PLANE('',#" + std::to_string(b.frame()) + ")"), {b.bound(loop)});
    const auto source = open_or_die(testing::step_text(b.text()), "closed.step");
    const FacesFile file = saved(*source, GetParam());
    EXPECT_EQ(file.faces, 1U);
    const Shown before = shown(*source), after = shown(*again(file, GetParam()));
    EXPECT_NEAR(after.area, before.area, 0.01 * before.area) << whole;
    EXPECT_LE((before.box.min() - after.box.min()).norm(),
              mesh_tolerance * before.box.diagonal().norm())
        << whole;
    EXPECT_LE((before.box.max() - after.box.max()).norm(),
              mesh_tolerance * before.box.diagonal().norm())
        << whole;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, SavedFaces, ::testing::Values("step", "iges"));

TEST(SavedFacesOfStep, HaveSolidsVoidsAndAnglesInRadians) {
  const auto hollow = saved(*open_or_die(testing::iges_hollow_box(), "hollow.igs"), "step");
  EXPECT_EQ(count(hollow.bytes, "BREP_WITH_VOIDS"), 1U);
  EXPECT_EQ(count(hollow.bytes, "ORIENTED_CLOSED_SHELL"), 1U);
  EXPECT_EQ(count(hollow.bytes, "CLOSED_SHELL"), 3U);
  const auto box = saved(*open_or_die(drilled_box(), "box.step"), "step");
  EXPECT_EQ(count(box.bytes, "MANIFOLD_SOLID_BREP"), 1U);
  EXPECT_EQ(count(box.bytes, "=LINE("), 12U);
  EXPECT_EQ(count(box.bytes, "=CIRCLE("), 2U);
  EXPECT_EQ(count(box.bytes, "=PLANE("), 6U);
}

TEST(SavedFacesOfStep, ASecondTimeAreTheSameBytes) {
  for (const auto& [name, text] : testing::made_step_files) {
    const auto source = open_or_die(text(), name);
    if (source->model()->faces.empty()) continue;
    const FacesFile once = saved(*source, "step");
    const FacesFile twice = saved(*again(once, "step"), "step");
    const FacesFile thrice = saved(*again(twice, "step"), "step");
    EXPECT_EQ(twice.bytes, thrice.bytes) << name;
  }
}

}  // namespace
}  // namespace knead
