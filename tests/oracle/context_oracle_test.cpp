// Faces as triangles, and the bounds of B-spline faces, held against the areas that Open CASCADE
// finds.

#include <Eigen/Geometry>
#include <cmath>

#include "brep/tessellation/context_faces.hpp"
#include "brep/trim_loops.hpp"
#include "exchange/mesh_measures.hpp"
#include "knead/spline/evaluate.hpp"
#include "oracle/occt_shapes.hpp"
#include "oracle/step_oracle.hpp"

namespace knead::oracle {
namespace {

using testing::area_of;

// Where triangles lie on the wrong side of their own normals: folded.
double folded_area(const FaceMesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Point twice = (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]);
    if (twice.dot(mesh.normals[a] + mesh.normals[b] + mesh.normals[c]) < 0)
      area += twice.norm() / 2;
  }
  return area;
}

void expect_areas(const FaceMeshes& context, const std::map<std::string, double>& areas,
                  double chord) {
  for (const auto& [id, reason] : context.skipped)
    ADD_FAILURE() << id << " is skipped: " << reason.message();
  EXPECT_EQ(context.faces.size(), areas.size());
  for (const auto& mesh : context.faces) {
    const auto found = areas.find(mesh.id);
    if (found == areas.end()) {
      ADD_FAILURE() << mesh.id << " is no face there";
      continue;
    }
    // Chords of a circle are shorter by chord/3 than their arcs, and a surface may be curved both
    // ways. On a plane the polygon in a circle of radius r lacks 2/3 chord π r² of what is on its
    // left, or has it too much: a narrow ring more than its area says.
    Eigen::AlignedBox3d box;
    for (const Point& p : mesh.points) box.extend(p);
    const double size = std::max(2 * found->second, box.diagonal().squaredNorm());
    EXPECT_NEAR(area_of(mesh), found->second, chord * size) << mesh.id;
    EXPECT_LE(folded_area(mesh), 1e-3 * chord * found->second) << mesh.id;
  }
}

class ContextShape : public ::testing::TestWithParam<std::string> {};

TEST_P(ContextShape, HasTheAreasThatOpenCascadeFinds) {
  const auto path = fs::temp_directory_path() /
                    ("knead-context-" + std::to_string(getpid()) + "-" + GetParam() + ".step");
  ASSERT_TRUE(occt_write_shape(GetParam(), path));
  const auto file = step::File::read(path);
  ASSERT_TRUE(file) << file.error().message();
  const auto areas = occt_face_areas(path, "mm");
  ASSERT_FALSE(areas.empty());
  for (const double chord : {1e-2, 1e-3}) {
    const auto context = context_faces(file->model(), chord);
    ASSERT_TRUE(context);
    expect_areas(*context, areas, chord);
  }
  fs::remove(path);
}

INSTANTIATE_TEST_SUITE_P(Shapes, ContextShape, ::testing::ValuesIn(occt_shape_names()),
                         [](const auto& instance) { return instance.param; });

// The share of a surface's area that its trims show, by midpoints of a fine grid.
double shown_share(const Surface& surface, const SurfaceTrim& trim) {
  constexpr int count = 250;
  std::array<std::vector<double>, 2> parameters;
  for (int d = 0; d < 2; ++d) {
    const Interval domain = surface.knots(d).domain();
    for (int k = 0; k < count; ++k)
      parameters[std::size_t(d)].push_back(domain.lower + domain.length() * (k + 0.5) / count);
  }
  const auto grid =
      evaluate_grid<2>(surface, {std::span<const double>(parameters[0]), parameters[1]}, 1);
  if (!grid) return 0;
  double whole = 0, shown = 0;
  for (int k = 0; k < count; ++k) {
    for (int l = 0; l < count; ++l) {
      const Eigen::Vector2d p((k + 0.5) / count, (l + 0.5) / count);
      const Point u = grid->at({1, 0}).row(k * count + l), v = grid->at({0, 1}).row(k * count + l);
      const double area = u.cross(v).norm();
      whole += area;
      const auto inside = [&p](const TrimFace& face) {
        bool odd = false;
        for (const TrimLoop& loop : face) {
          for (std::size_t i = 0; i < loop.size(); ++i) {
            const auto &a = loop[i], &b = loop[(i + 1) % loop.size()];
            if ((a.y() > p.y()) != (b.y() > p.y()) &&
                p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) {
              odd = !odd;
            }
          }
        }
        return odd;
      };
      if (trim.whole || std::any_of(trim.faces.begin(), trim.faces.end(), inside)) shown += area;
    }
  }
  return shown / whole;
}

class ContextOracle : public StepOracle {};

TEST_P(ContextOracle, EveryFaceHasTheAreaThatOpenCascadeFinds) {
  const auto areas = occt_face_areas(path_, file_->model().length_unit());
  const auto context = context_faces(file_->model());
  ASSERT_TRUE(context);
  expect_areas(*context, areas, 1e-3);
}

TEST_P(ContextOracle, TrimsShowTheShareOfTheSurfaceThatOpenCascadeFinds) {
  const auto trims = trim_loops(file_->model());
  ASSERT_TRUE(trims);
  for (const auto& [id, reason] : trims->skipped)
    ADD_FAILURE() << id << " is skipped: " << reason.message();
  for (std::size_t k = 0; k < file_->surfaces().size(); ++k) {
    const auto& surface = file_->surfaces()[k];
    const auto found = before_->results.find(surface.id);
    if (found == before_->results.end() || found->second.area_ratios.empty()) continue;
    double ratio = 0;
    for (const double r : found->second.area_ratios) ratio += r;
    // The grid of the comparison is the larger part of it.
    EXPECT_NEAR(shown_share(surface.surface, trims->surfaces[k]), ratio, 4e-3) << surface.id;
  }
}

INSTANTIATE_TEST_SUITE_P(Files, ContextOracle, ::testing::ValuesIn(testing::step_files()),
                         testing::file_test_name);

}  // namespace
}  // namespace knead::oracle
