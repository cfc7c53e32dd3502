// Faces and surfaces that meet without a common edge stay together.

#include <gtest/gtest.h>

#include "brep/check/bare_faces.hpp"
#include "brep/check/meeting_courses.hpp"
#include "exchange/face_builder.hpp"
#include "knead/brep/edge_measures.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/morph.hpp"
#include "morph/fit_models.hpp"

namespace knead::morph::testing {
namespace {

using brep::MeetingCourse;

/// Surfaces without faces, "#1", "#2", …, joined where they meet.
Model joined(std::vector<Surface> surfaces) {
  brep::Model bare;
  for (const Surface& surface : surfaces)
    bare.surfaces.push_back({"#" + std::to_string(bare.surfaces.size() + 1), "", "mm", surface});
  bare.index_surfaces();
  Model model = model_of(std::move(surfaces));
  for (MeetingCourse& met : brep::meeting_courses(bare)) {
    FitEdge edge{.course = nullptr,
                 .surfaces = {},
                 .samples = std::move(met.samples),
                 .name = std::move(met.id)};
    for (const brep::Index surface : met.surfaces)
      edge.surfaces.push_back(static_cast<int>(surface));
    model.edges.push_back(std::move(edge));
  }
  return model;
}

KnotVector cubic(int count) { return *KnotVector::clamped_uniform(3, count); }

/// A sheet with its second half of y taken away, or the first.
Surface half(const Surface& sheet, bool lower) {
  Points points = sheet.control_points();
  points.col(1) = 0.5 * points.col(1).array() + (lower ? -0.25 : 0.25);
  return *sheet.with_control_points(points);
}

TEST(Meetings, OfThreeSheetsInATStayTogether) {
  const Surface right = wave(cubic(6), cubic(7), 0, 1);
  const Model model =
      joined({wave(cubic(6), cubic(6), -1, 0), half(right, true), half(right, false)});
  ASSERT_EQ(model.edges.size(), 3U);
  for (const FitEdge& edge : model.edges) {
    for (const auto& sample : edge.samples) {
      ASSERT_EQ(sample.feet.size(), 2U);
      EXPECT_EQ(sample.across.size(), 2U) << "all of it is one smooth sheet";
      for (std::size_t k = 0; k < 2; ++k) {
        const Surface& s = *model.surfaces[static_cast<std::size_t>(edge.surfaces[k])].surface;
        EXPECT_LT((at(s, sample.feet[k].x(), sample.feet[k].y()) - sample.point).norm(), 1e-9);
      }
    }
  }
  const Map map = bulge(0.05);
  const FitResult result = fit(model, data_on(model, map));
  EXPECT_LT(errors_of(model, result, map).largest, 3e-5 * model.size);
  for (int k = 0; k < 97; ++k) {
    const double t = (k + 0.37) / 97, own = t < 0.5 ? 2 * t : 2 * t - 1;
    const Surface& other = result.surfaces[t < 0.5 ? 1 : 2];
    EXPECT_LT((at(result.surfaces[0], 1, t) - at(other, 0, own)).norm(), 1.2e-6 * model.size);
  }
}

// Of the other side the parameter is the root of the length: feet on even chords are off by far
// more than sheets may part.
TEST(Meetings, AreFollowedToACusp) {
  Surface cusp = wave(knead::testing::clamped_knots(3, {0, 1}),
                      knead::testing::clamped_knots(2, {0, 1}), 0, 1);
  Points points = cusp.control_points();
  for (Eigen::Index k = 0; k < points.rows(); ++k) points(k, 1) = k % 3 == 2 ? 0.5 : -0.5;
  const Model model = joined({wave(cubic(6), cubic(6), -1, 0), *cusp.with_control_points(points)});
  ASSERT_EQ(model.edges.size(), 1U);
  const auto& samples = model.edges[0].samples;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    std::array<Point, 2> middle;
    for (std::size_t side = 0; side < 2; ++side) {
      const Eigen::Vector2d foot = (samples[k - 1].feet[side] + samples[k].feet[side]) / 2;
      middle[side] = at(*model.surfaces[side].surface, foot.x(), foot.y());
    }
    EXPECT_LT((middle[0] - middle[1]).norm(), 3e-6 * model.size);
  }
}

TEST(Meetings, LeavePatchesWithoutAreaToSeams) {
  const Surface sheet = wave(cubic(6), cubic(6), -1, 0);
  Points line = sheet.control_points();
  line.col(0).setZero();
  const Model model = joined({sheet, *sheet.with_control_points(line)});
  EXPECT_TRUE(model.edges.empty());
}

/// A sheet and what is left of its neighbour, of which both sides are one: it stays a curve.
TEST(SurfaceFit, KeepsPatchesWithoutAreaCurves) {
  const Surface sheet = wave(cubic(6), cubic(6), -1, 0);
  Points line = sheet.control_points();
  line.col(0).setZero();
  for (const double share : {0.0, 1.0}) {  // far from the origin nothing but rounding is equal
    Points far = line;
    far.col(2).array() += share * 1e3;
    const Surface curve = *sheet.with_control_points(far);
    const Model model = model_of({sheet, curve}, {edge_between(0, 1, false)});
    const Map map = bend(0.05);
    std::vector<Datum> data = data_on(model, map);
    std::erase_if(data, [](const Datum& datum) { return datum.surface != 0; });
    const FitResult result = fit(model, data);
    ASSERT_EQ(result.surfaces.size(), 2U);
    EXPECT_FALSE(brep::has_area(result.surfaces[1]));
    EXPECT_TRUE(brep::collapsed_directions(result.surfaces[1])[0]);
  }
}

// Beside a cusp the derivative by length has no bound, and one such row would drown all others.
TEST(SurfaceFit, LeavesOutDirectionsAcrossThatAreOutOfProportion) {
  FitEdge edge = edge_between(0, 1, true);
  edge.samples.front().across[0] *= 1e12;
  const Model model =
      model_of({wave(cubic(6), cubic(6), -1, 0), wave(cubic(6), cubic(6), 0, 1)}, {edge});
  const Map map = bulge(0.05);
  const FitResult result = fit(model, data_on(model, map));
  EXPECT_LT(errors_of(model, result, map).largest, 3e-5 * model.size);
  EXPECT_LT(at_edge(result.surfaces[0], result.surfaces[1]).degrees, 0.03);
}

/// A face over a rectangle with edges and vertices of its own, on a surface that goes on.
void add_face(knead::testing::FaceBuilder& builder, std::string& faces,
              const std::array<double, 4>& box) {
  const auto [x0, x1, y0, y1] = box;
  std::string corners;
  for (const double x : {x0 - 0.1, x1 + 0.1}) {
    corners += corners.empty() ? "(" : ",(";
    for (const double y : {y0 - 0.1, y1 + 0.1})
      corners += (corners.back() == '(' ? "#" : ",#") + std::to_string(builder.point(x, y, 0));
    corners += ")";
  }
  const int surface = builder.entity("B_SPLINE_SURFACE_WITH_KNOTS('',1,1,(" + corners +
                                     "),.UNSPECIFIED.,.F.,.F.,.F.,(2,2),(2,2),(0.,1.),(0.,1.),"
                                     ".UNSPECIFIED.)");
  const std::array<std::array<double, 3>, 4> corner = {
      {{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}}};
  std::array<int, 4> vertices{};
  for (std::size_t k = 0; k < 4; ++k)
    vertices[k] = builder.vertex(corner[k][0], corner[k][1], corner[k][2]);
  const std::array<std::array<double, 3>, 4> ways = {
      {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}};
  std::vector<int> edges;
  for (std::size_t k = 0; k < 4; ++k)
    edges.push_back(builder.line(vertices[k], vertices[(k + 1) % 4], corner[k], ways[k]));
  const int bound = builder.bound(edges);
  faces += (faces.empty() ? "#" : ",#") + std::to_string(builder.face(surface, {bound}));
}

TEST(Meetings, OfFacesWithoutACommonEdgeStayTogetherInAFile) {
  knead::testing::FaceBuilder builder;
  std::string faces;
  add_face(builder, faces, {-1, 0, 0, 1});
  add_face(builder, faces, {0, 1, 0, 0.4});
  add_face(builder, faces, {0, 1, 0.4, 1});
  builder.entity("OPEN_SHELL('',(" + faces + "))");
  const auto source = open_source(knead::testing::step_text(builder.text()), "sheets.step");
  ASSERT_TRUE(source) << source.error().message();
  const auto opened = brep::measure_edges(*(*source)->model());
  ASSERT_TRUE(opened);
  const auto moved = morph_file(*source, {.space = "0.03*sin(3*y); 0; 0.1*sin(3*x)*cos(2*y)"}, {});
  ASSERT_TRUE(moved) << moved.error().message();
  EXPECT_LT(moved->report.after.largest, 1e-5 * opened->size);
  const auto reopened = open_source(moved->bytes, "moved.step");
  ASSERT_TRUE(reopened) << reopened.error().message();
  const auto measures = brep::measure_edges(*(*reopened)->model());
  ASSERT_TRUE(measures);
  int met = 0;
  for (const auto& edge : measures->edges) {
    if (edge.id.find('+') == std::string::npos) continue;
    ++met;
    ASSERT_TRUE(edge.gap && edge.angle) << edge.reason;
    EXPECT_LE(edge.gap->value, opened->gap_tolerance) << edge.id;
    EXPECT_LT(edge.angle->value, 0.03) << edge.id << " is smooth as opened";
  }
  EXPECT_EQ(met, 3);
}

}  // namespace
}  // namespace knead::morph::testing
