// Nets at the edge of what there is: one span, degrees 1 and 5, repeated knots, weights over six
// orders of magnitude, patches without area.

#include <gtest/gtest.h>

#include "morph/fit_models.hpp"

namespace knead::morph::testing {
namespace {

using knead::testing::clamped_knots;

Surface on(KnotVector u, KnotVector v) { return wave(std::move(u), std::move(v), -1, 1); }

TEST(SurfaceFit, FollowsOnNetsOfEveryKind) {
  const std::vector<std::pair<std::string, Surface>> nets = {
      {"one span, bilinear", on(clamped_knots(1, {0, 1}), clamped_knots(1, {0, 1}))},
      {"one span, bicubic", on(clamped_knots(3, {0, 1}), clamped_knots(3, {-7, 12}))},
      {"degrees 1 and 5", on(clamped_knots(1, {0, 0.1, 1}), clamped_knots(5, {0, 2, 3}))},
      {"repeated knots", on(clamped_knots(3, {0, 0.4, 0.7, 1}, {4, 3, 2, 4}),
                            clamped_knots(2, {0, 0.5, 1}, {3, 2, 3}))},
      {"spans of very different lengths",
       on(clamped_knots(3, {0, 1e-4, 0.5, 1}), clamped_knots(3, {0, 0.999, 1}))},
      {"not clamped",
       on(*KnotVector::create(3, {-3, -2, -1, 0, 1, 2, 3, 4, 5, 6}), clamped_knots(3, {0, 1}))}};
  for (const auto& [name, surface] : nets) {
    SCOPED_TRACE(name);
    const Model model = model_of({surface});
    for (const Map& map : {bend(0.05), twist(0.05), bulge(0.05)}) {
      const FitResult result = fit(model, data_on(model, map, 40));
      EXPECT_LT(errors_of(model, result, map).largest, 4e-5 * model.size);
      EXPECT_TRUE(result.above.empty());
    }
  }
}

/// The largest |D| on the visible part, of the fit or of the map.
TEST(SurfaceFit, KeepsDisplacementsBoundedWhateverTheWeights) {
  const auto knots = *KnotVector::clamped_uniform(3, 6);
  const Model model = model_of({knead::testing::relief(knots, knots, 3, 0.1, 1e3)});
  const Map map = bulge(0.05);
  const FitResult result = fit(model, data_on(model, map));
  EXPECT_LT(errors_of(model, result, map).rms, 5e-3 * model.size);
  for (int i = 0; i <= 100; ++i) {
    for (int j = 0; j <= 100; ++j) {
      const Point d = at(result.surfaces[0], i / 100.0, j / 100.0) -
                      at(*model.surfaces[0].surface, i / 100.0, j / 100.0);
      EXPECT_LT(d.norm(), 1.5 * 0.05);
    }
  }
}

/// A sheet whose creases, of degree 1, are none: all of its control points are in a plane.
TEST(SurfaceFit, GivesAFlatPolygonNoCreases) {
  const Model model =
      model_of({on(clamped_knots(1, {0, 0.25, 0.5, 1}), clamped_knots(1, {0, 0.5, 1}))});
  const Map map = bend(0.1);
  const FitResult result = fit(model, data_on(model, map, 40));
  EXPECT_LT(errors_of(model, result, map).largest, 3e-5 * model.size);
  EXPECT_LT(result.largest_angle, 0.02);
  const Surface& moved = result.surfaces[0];
  for (const double u : {0.25, 0.5}) {
    Parameters<2> places(1, 2);
    places << u, 0.3;
    const auto left = unit_normals(moved, places, Side::left),
               right = unit_normals(moved, places, Side::right);
    ASSERT_TRUE(left && right);
    EXPECT_LT(angle_between_planes(left->row(0), right->row(0)) * 180 / std::numbers::pi, 0.03);
  }
}

/// A sheet with its neighbour collapsed to the line of their edge, and one collapsed to a point.
TEST(SurfaceFit, TakesPatchesWithoutAreaAlong) {
  const auto knots = *KnotVector::clamped_uniform(3, 6);
  const Surface sheet = wave(knots, knots, -1, 0);
  Points line = sheet.control_points(), point = sheet.control_points();
  for (Eigen::Index k = 0; k < line.rows(); ++k) {
    line.row(k) << 0, sheet.control_points()(k, 1), 0;
    point.row(k) << 0, -0.5, 0;
  }
  FitEdge to_point{.course = nullptr, .surfaces = {0, 2}, .name = "corner"};
  for (int k = 0; k < 2; ++k)
    to_point.samples.push_back({double(k), Point(0, -0.5, 0), {{1, 0}, {0.5, 0.5}}, {}, 1});
  const Model model =
      model_of({sheet, *sheet.with_control_points(line), *sheet.with_control_points(point)},
               {edge_between(0, 1, false), to_point});
  const Map map = bend(0.05);
  std::vector<Datum> data = data_on(model, map);
  std::erase_if(data, [](const Datum& datum) { return datum.surface != 0; });
  const FitResult result = fit(model, data);
  ASSERT_EQ(result.surfaces.size(), 3U);
  EXPECT_LT(at_edge(result.surfaces[0], result.surfaces[1]).parting, 2e-6 * model.size);
  EXPECT_LT((at(result.surfaces[2], 0.2, 0.9) - at(result.surfaces[0], 1, 0)).norm(),
            2e-6 * model.size);
}

TEST(SurfaceFit, MovesASurfaceWithoutDataWithItsNeighbours) {
  const auto knots = *KnotVector::clamped_uniform(3, 6);
  const Model model = model_of({wave(knots, knots, -1, 0), wave(knots, knots, 0, 0.5)},
                               {edge_between(0, 1, true, 1, 0.5)});
  std::vector<Datum> data = data_on(model, bend(0.05));
  std::erase_if(data, [](const Datum& datum) { return datum.surface != 0; });
  const FitResult result = fit(model, data);
  const AtEdge edge = at_edge(result.surfaces[0], result.surfaces[1]);
  EXPECT_LT(edge.parting, 1.5e-6 * model.size);
  EXPECT_LT(edge.degrees, 0.03);
  for (int k = 0; k <= 20; ++k) {
    const Point d =
        at(result.surfaces[1], k / 20.0, 0.4) - at(*model.surfaces[1].surface, k / 20.0, 0.4);
    EXPECT_LT(d.norm(), 1.5 * 0.05);
  }
}

/// A sheet of which a corner starts without speed, and another side stands still over a span.
TEST(SurfaceFit, LeavesSidesThatStandStillStill) {
  const KnotVector u = *KnotVector::clamped_uniform(3, 7), v = *KnotVector::clamped_uniform(3, 6);
  const Surface flat = wave(u, v, -1, 1);
  Points points = flat.control_points();
  points.row(1 * 6 + 0) = points.row(0 * 6 + 0);  // S_u = 0 at (0, 0)
  for (int i = 2; i <= 4; ++i)
    points.row(i * 6 + 5) = points.row(1 * 6 + 5);  // v = 1, u 0.25 to 0.5
  const Model model = model_of({*flat.with_control_points(points)});
  const Map map = bulge(0.05);
  const FitResult result = fit(model, data_on(model, map, 40));
  EXPECT_LT(errors_of(model, result, map).largest, 1e-4 * model.size);
  const Surface& moved = result.surfaces[0];
  ASSERT_GT(moved.net()[0], 7) << "and finer nets";
  for (int k = 0; k <= 20; ++k)
    EXPECT_LT((at(moved, 0.25 + k / 80.0, 1) - at(moved, 0.25, 1)).norm(), 1e-15);
  EXPECT_EQ((moved.control_points().row(0) - moved.control_points().row(moved.net()[1])).norm(), 0);
}

/// Two sheets in one, with a crease across that runs out: where there is none there stays none.
TEST(SurfaceFit, KeepsALineOfKnotsSmoothWhereItIs) {
  const KnotVector u = clamped_knots(3, {0, 0.5, 1}, {4, 3, 4}),
                   v = *KnotVector::clamped_uniform(3, 9);
  const Surface flat = wave(u, v, -1, 1);
  Points points = flat.control_points();
  for (int i = 4; i < 7; ++i) {
    for (int j = 5; j < 9; ++j)  // up behind the line, the more the farther along it
      points(i * 9 + j, 2) += 0.1 * (i - 3) * (j - 4);
  }
  const Model model = model_of({*flat.with_control_points(points)});
  const FitResult result = fit(model, data_on(model, bulge(0.1), 40));
  const Surface& moved = result.surfaces[0];
  for (int k = 0; k <= 16; ++k) {
    Parameters<2> place(1, 2);
    place << 0.5, k / 64.0;
    const auto left = unit_normals(moved, place, Side::left),
               right = unit_normals(moved, place, Side::right);
    ASSERT_TRUE(left && right);
    EXPECT_LT(angle_between_planes(left->row(0), right->row(0)) * 180 / std::numbers::pi, 0.02)
        << place(0, 1);
  }
}

}  // namespace
}  // namespace knead::morph::testing
