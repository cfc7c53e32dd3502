#include <numbers>

#include "brep/tessellation/model_mesh.hpp"
#include "exchange/mesh_measures.hpp"
#include "exchange/support.hpp"
#include "support/made_iges_solids.hpp"

namespace knead {
namespace {

using testing::area_of;
using testing::open_or_die;

FaceMeshes mesh_of(const std::string& bytes, double tolerance) {
  const auto source = open_or_die(bytes, "test.igs");
  auto model = model_faces(*source->model(), tolerance);
  if (!model) {
    ADD_FAILURE() << model.error().message();
    std::abort();
  }
  for (const auto& [id, reason] : model->skipped) ADD_FAILURE() << id << ": " << reason.message();
  return *std::move(model);
}

struct Solid {
  std::string (*text)();
  double volume;
};

TEST(IgesSolids, AreClosedAndNotInsideOutWhereverTheirSurfacesLook) {
  for (const auto& [text, volume] :
       {Solid{testing::iges_box_of_turned_faces, 6}, Solid{testing::iges_box_of_a_turned_shell, 6},
        Solid{testing::iges_hollow_box, 5.5}, Solid{testing::iges_hollow_boxes, 11}}) {
    const FaceMeshes model = mesh_of(text(), 0);
    EXPECT_EQ(open_sides(model.faces), 0U);
    EXPECT_NEAR(testing::volume_of(model.faces), volume, 1e-12);
  }
}

TEST(IgesSolids, AFaceWithoutAShellLooksWhereItsSurfaceDoes) {
  const FaceMeshes model = mesh_of(testing::shell(), 0);
  ASSERT_EQ(model.faces.size(), 1U);
  for (const Point& n : model.faces[0].normals) EXPECT_EQ(n, Point(0, 0, 1));
}

TEST(IgesSolids, ListsThatEndTooEarlyAreReadOrRefused) {
  const std::string text = testing::iges_box_of_turned_faces();
  for (const std::string from : {"186,", "514,6"}) {
    std::string cut = text;
    const std::size_t at = cut.find("\n" + from);
    ASSERT_NE(at, cut.npos);
    cut.replace(cut.find(';', at), 1, ",");  // the list goes on into nothing
    const auto source = open_source(cut, "test.igs");
    EXPECT_TRUE(source || !source.error().what.empty());
  }
}

TEST(IgesSolids, ARingWhoseCirclesAreClosedToRoundingIsAFace) {
  constexpr double pi = std::numbers::pi;
  // Frusta: π (r + R) times the slant height.
  const double in_mm = area_of(mesh_of(testing::iges_ring_in_mm(), 1e-4).faces.at(0));
  EXPECT_NEAR(in_mm, 5 * pi * std::numbers::sqrt2, 1e-2);
  const double in_inch = area_of(mesh_of(testing::iges_ring_in_inch_backwards(), 1e-4).faces.at(0));
  EXPECT_NEAR(in_inch, 11 * pi * 5, 1e-2);
}

TEST(IgesSolids, SurfacesOfRevolutionLookWhereTheParametersOfIgesSay) {
  constexpr double pi = std::numbers::pi;
  for (const auto text : {testing::iges_drum_in_mm, testing::iges_drum_in_inch}) {
    const FaceMeshes model = mesh_of(text(), 1e-4);
    EXPECT_EQ(open_sides(model.faces), 0U);
    EXPECT_NEAR(testing::volume_of(model.faces), 12 * pi, 1e-2);
  }
  for (const auto text : {testing::iges_dome_in_metres, testing::iges_dome_in_inch}) {
    const FaceMeshes model = mesh_of(text(), 1e-3);
    EXPECT_NEAR(area_of(model.faces.at(0)), 8 * pi, 2e-2);
    for (const Point& p : model.faces.at(0).points) EXPECT_GT(p.z(), -1e-8);
  }
}

}  // namespace
}  // namespace knead
