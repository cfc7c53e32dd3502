// Surfaces that are bounded by curves alone: faces of the model, with edges that neighbours share.

#include <gtest/gtest.h>

#include <cmath>

#include "brep/shared_edge.hpp"
#include "brep/tessellation/model_mesh.hpp"
#include "exchange/mesh_measures.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/source.hpp"
#include "support/bounded_sheets.hpp"

namespace knead {
namespace {

using testing::all_boundings;
using testing::bounded_sheets;
using testing::BoundedSheets;
using testing::Bounding;

/// The edges that both faces have.
std::vector<std::string> shared_edges(const brep::Model& model) {
  std::vector<std::string> result;
  const auto west = brep::edges_around(model.faces[0]), east = brep::edges_around(model.faces[1]);
  for (const brep::Index edge : west) {
    if (std::ranges::find(east, edge) != east.end()) result.push_back(model.edges[edge].id);
  }
  return result;
}

class BoundedSurfaces : public ::testing::TestWithParam<std::tuple<Bounding, std::string>> {
 protected:
  void SetUp() override {
    const auto& [bounding, unit] = GetParam();
    sheets_ = bounded_sheets(bounding, unit, unit == "m" ? 5 : 5000);
    source_ = testing::open_or_die(sheets_.text, "sheets.step");
  }
  BoundedSheets sheets_;
  std::shared_ptr<const Source> source_;
};

TEST_P(BoundedSurfaces, AreFacesWithASharedEdge) {
  const brep::Model& model = *source_->model();
  ASSERT_EQ(model.faces.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(model.faces[k].id, sheets_.faces[k]);
    ASSERT_NE(model.spline_under(model.faces[k]), nullptr);
    EXPECT_EQ(model.spline_under(model.faces[k])->id, sheets_.surfaces[k]);
    EXPECT_TRUE(model.surfaces[k].trimmed);
    EXPECT_EQ(model.surfaces[k].faces, 1);
    for (const brep::Bound& bound : model.faces[k].bounds)
      EXPECT_FALSE(bound.wrong) << bound.wrong->message();
  }
  ASSERT_TRUE(model.assembly);
  ASSERT_EQ(model.assembly->parts.size(), 1U);
  EXPECT_EQ(model.assembly->parts[0].name, "sheets");
  EXPECT_EQ(model.assembly->parts[0].faces.size(), 2U);
  const auto shared = shared_edges(model);
  ASSERT_EQ(shared.size(), 1U);
  const auto edge = SharedEdge::create(model, shared[0]);
  ASSERT_TRUE(edge) << edge.error().message();
  EXPECT_LE(edge->gap(), 1e-8 * sheets_.scale);
  EXPECT_EQ(edge->surfaces().size(), 2U);
  EXPECT_TRUE(source_->left_out().empty()) << source_->left_out()[0].many;
}

/// Of the roof over a rectangle, by the midpoint rule.
double roof_area(double from, double to) {
  constexpr int n = 400;
  const double dx = (to - from) / n, dy = 2.0 / n;
  double area = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double x = from + (i + 0.5) * dx, y = (j + 0.5) * dy;
      area +=
          std::sqrt(1 + std::pow(0.1 * (4 - 2 * x), 2) + std::pow(0.15 * (2 - 2 * y), 2)) * dx * dy;
    }
  }
  return area;
}

TEST_P(BoundedSurfaces, AreMeshedAsTheyAreBounded) {
  const auto mesh = model_faces(*source_->model(), 1e-4 * sheets_.scale);
  ASSERT_TRUE(mesh) << mesh.error().message();
  EXPECT_TRUE(mesh->skipped.empty()) << mesh->skipped[0].reason.message();
  ASSERT_EQ(mesh->faces.size(), 2U);
  if (std::get<0>(GetParam()) == Bounding::holes) {
    for (const FaceMesh& face : mesh->faces)
      EXPECT_LT(testing::area_of(face), 4 * sheets_.scale * sheets_.scale);
  } else {
    const double scale = sheets_.scale * sheets_.scale;
    EXPECT_NEAR(testing::area_of(mesh->faces[0]), scale * roof_area(0, 2), 1e-3 * scale);
    EXPECT_NEAR(testing::area_of(mesh->faces[1]), scale * roof_area(2, 4), 1e-3 * scale);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, BoundedSurfaces,
                         ::testing::Combine(::testing::ValuesIn(all_boundings),
                                            ::testing::Values("m", "mm")),
                         [](const auto& instance) {
                           return name_of(std::get<0>(instance.param)) + "_" +
                                  std::get<1>(instance.param);
                         });

}  // namespace
}  // namespace knead
