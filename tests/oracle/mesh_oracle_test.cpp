// The triangles of whole models, held against the areas and volumes that Open CASCADE finds.

#include <Eigen/Geometry>
#include <cmath>

#include "brep/tessellation/model_mesh.hpp"
#include "exchange/mesh_measures.hpp"
#include "knead/brep/model.hpp"
#include "oracle/occt_shapes.hpp"
#include "oracle/step_oracle.hpp"
#include "support/long_run.hpp"

namespace knead::oracle {
namespace {

using testing::area_of;
using testing::volume_of;

/// Every part where the assembly puts it, as often as it is used.
void expect_in_place(const FaceMeshes& model, const OcctWhole& other, double tolerance,
                     double area) {
  Eigen::AlignedBox3d box;
  for (const FaceMesh& mesh : model.faces) {
    for (const Point& p : mesh.points) box.extend(p);
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(box.min()[k], other.lower[static_cast<std::size_t>(k)], 2 * tolerance) << k;
    EXPECT_NEAR(box.max()[k], other.upper[static_cast<std::size_t>(k)], 2 * tolerance) << k;
  }
  EXPECT_NEAR(area, other.area, 0.01 * other.area);
  EXPECT_EQ(model.faces.size(), static_cast<std::size_t>(other.faces));
}

/// Closed where the file has only solids, with their volume, and every face with its area.
void expect_model(const step::File& file, const fs::path& path, double tolerance) {
  const auto model = model_faces(file.model(), tolerance);
  ASSERT_TRUE(model) << model.error().message();
  for (const auto& [id, reason] : model->skipped)
    ADD_FAILURE() << id << " is left out: " << reason.message();
  const auto assembly = file.model().assembly;
  ASSERT_TRUE(assembly) << assembly.error().message();
  std::map<std::string, double> areas = occt_face_areas(path, assembly->unit);
  areas.merge(occt_face_areas(path, assembly->unit, true));
  double whole = 0;
  for (const FaceMesh& mesh : model->faces) {
    const double area = area_of(mesh);
    whole += area;
    const auto found = areas.find(mesh.id);
    if (found == areas.end()) continue;
    // Chords shorten curves; and a strip as wide as the tolerance around the face.
    Eigen::AlignedBox3d box;
    for (const Point& p : mesh.points) box.extend(p);
    EXPECT_NEAR(area, found->second, 0.02 * found->second + 8 * tolerance * box.diagonal().norm())
        << mesh.id;
  }
  const OcctWhole other = occt_whole(path, assembly->unit, assembly->placed());
  if (assembly->placed()) expect_in_place(*model, other, tolerance, whole);
  const bool shells = file.bytes().find("SHELL_BASED_SURFACE_MODEL") != std::string::npos;
  if (other.solids == 0 || shells) return;
  EXPECT_EQ(open_sides(model->faces), 0U);
  EXPECT_NEAR(volume_of(model->faces), other.volume, tolerance * whole);
}

class MeshShape : public ::testing::TestWithParam<std::string> {};

TEST_P(MeshShape, IsClosedAndHasTheVolumeThatOpenCascadeFinds) {
  const auto path = fs::temp_directory_path() /
                    ("knead-mesh-" + std::to_string(getpid()) + "-" + GetParam() + ".step");
  ASSERT_TRUE(occt_write_shape(GetParam(), path));
  const auto file = step::File::read(path);
  ASSERT_TRUE(file) << file.error().message();
  for (const double tolerance : {0.2, 0.01}) expect_model(*file, path, tolerance);
  fs::remove(path);
}

INSTANTIATE_TEST_SUITE_P(Shapes, MeshShape, ::testing::ValuesIn(occt_shape_names()),
                         [](const auto& instance) { return instance.param; });

class MeshOracle : public StepOracle {};

TEST_P(MeshOracle, IsClosedAndHasTheVolumeThatOpenCascadeFinds) {
  if (GetParam() == "linkrods.step" && !testing::long_run())
    GTEST_SKIP() << "with KNEAD_LONG=1";  // its nets are large
  Eigen::AlignedBox3d box;
  for (const auto& s : file_->surfaces()) {
    for (const auto& row : s.surface.control_points().rowwise()) box.extend(Point(row.transpose()));
  }
  const double tolerance = box.diagonal().norm() / 2000;
  expect_model(*file_, path_, tolerance);
}

INSTANTIATE_TEST_SUITE_P(Files, MeshOracle, ::testing::ValuesIn(testing::step_files()),
                         testing::file_test_name);

}  // namespace
}  // namespace knead::oracle
