// Parts of .brep files stand where Open CASCADE puts them, whatever locations they have.

#include <gtest/gtest.h>
#include <unistd.h>

#include "brep/tessellation/model_mesh.hpp"
#include "exchange/mesh_measures.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/file_io.hpp"
#include "oracle/occt_places.hpp"

namespace knead::oracle {
namespace {

namespace fs = std::filesystem;

class Places : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { ASSERT_TRUE(occt_write_placed(GetParam(), path_)); }
  void TearDown() override { fs::remove(path_); }

  fs::path path_ =
      fs::temp_directory_path() / ("knead-places-" + std::to_string(getpid()) + ".brep");
};

Point centre_of(const FaceMesh& mesh) {
  Point sum = Point::Zero();
  double all = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Point &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c];
    const double area = (q - p).cross(r - p).norm() / 2;
    sum += area * (p + q + r) / 3;
    all += area;
  }
  return sum / all;
}

double distance_to(const Point& p, const FaceMeshes& model) {
  double least = std::numeric_limits<double>::infinity();
  for (const FaceMesh& mesh : model.faces) {
    for (const Point& q : mesh.points) least = std::min(least, (p - q).norm());
  }
  return least;
}

/// Faces and vertices; planes are exact to rounding, curved faces to the chords of their triangles.
void expect_places(const brep::Model& file, const OcctPlaces& other, double exactness) {
  const auto model = model_faces(file, 1e-3);
  ASSERT_TRUE(model) << model.error().message();
  EXPECT_TRUE(model->skipped.empty());
  ASSERT_EQ(model->faces.size(), other.centres.size());
  std::vector<FaceMesh> left = model->faces;  // where parts are used again, in another order
  for (std::size_t k = 0; k < other.centres.size(); ++k) {
    const auto off = [&](const FaceMesh& mesh) {
      return (centre_of(mesh) - other.centres[k]).norm();
    };
    const auto same = std::ranges::min_element(left, {}, off);
    EXPECT_LE(off(*same), exactness) << "face " << k;
    EXPECT_NEAR(testing::area_of(*same), other.areas[k], exactness * other.areas[k])
        << "face " << k;
    left.erase(same);
  }
  for (const Point& vertex : other.vertices)
    EXPECT_LE(distance_to(vertex, *model), 1e-9) << vertex.transpose();
}

TEST_P(Places, FacesAndVerticesAreWhereOpenCascadePutsThem) {
  const auto other = occt_places(path_);
  ASSERT_TRUE(other);
  const auto source = testing::open_or_die(*read_file(path_), path_.string());
  expect_places(*source->model(), *other,
                GetParam() == "spline" || GetParam() == "again" ? 1e-3 : 1e-9);
}

TEST_P(Places, AMovedSplineIsWrittenWhereItIs) {
  const auto source = testing::open_or_die(*read_file(path_), path_.string());
  if (source->surfaces().empty()) GTEST_SKIP() << "all of its faces are planes";
  const Surface& before = *source->surfaces()[0].surface;
  Points points = before.control_points();
  points.row(4) += Eigen::RowVector3d(0.3, 0.2, 0.4);  // in the middle: its edges stay
  const auto after = std::make_shared<const Surface>(*before.with_control_points(points));
  const auto bytes = source->save(std::vector{after});
  ASSERT_TRUE(bytes) << bytes.error().message();
  ASSERT_TRUE(write_file_atomically(path_, *bytes));
  const auto other = occt_places(path_);
  ASSERT_TRUE(other);
  const auto again = testing::open_or_die(*bytes, path_.string());
  EXPECT_LE((again->surfaces()[0].surface->control_points() - points).norm(),
            1e-12 * points.norm());
  expect_places(*again->model(), *other, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Places, ::testing::ValuesIn(occt_placed_names()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace knead::oracle
