// Surfaces without faces stay together where they meet geometrically.

#include "morph/seam_edges.hpp"

#include <gtest/gtest.h>

#include "morph/fit_models.hpp"

namespace knead::morph::testing {
namespace {

std::vector<const Surface*> pointers(const Model& model) {
  std::vector<const Surface*> result;
  for (const FitSurface& s : model.surfaces) result.push_back(s.surface.get());
  return result;
}

Model joined_by_seams(std::vector<Surface> surfaces) {
  Model model = model_of(std::move(surfaces));
  const auto patches = pointers(model);
  const auto seams = find_seams(patches, 1e-6);
  EXPECT_TRUE(seams);
  auto edges = edges_of_seams(patches, seams->seams);
  EXPECT_TRUE(edges);
  model.edges = *std::move(edges);
  return model;
}

/// The same sheet with its v turned round.
Surface reversed(const Surface& s) {
  const auto [m, n] = s.net();
  Points points = s.control_points();
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) points.row(i * n + j) = s.control_points().row(i * n + n - 1 - j);
  }
  std::vector<double> knots;
  for (int k = 0; k < n + s.knots(1).degree() + 1; ++k)
    knots.push_back(1 - s.knots(1)[n + s.knots(1).degree() - k]);
  return make_surface(s.knots(0), *KnotVector::create(s.knots(1).degree(), knots), points);
}

TEST(EdgesOfSeams, ArePointsOfBothSidesWithCommonDirectionsAcross) {
  const auto cubic = *KnotVector::clamped_uniform(3, 6), fine = *KnotVector::clamped_uniform(3, 9);
  const Model model =
      joined_by_seams({wave(cubic, cubic, -1, 0), reversed(wave(cubic, fine, 0, 0.5))});
  ASSERT_EQ(model.edges.size(), 1U);
  const FitEdge& edge = model.edges[0];
  for (const auto& sample : edge.samples) {
    ASSERT_EQ(sample.feet.size(), 2U);
    ASSERT_EQ(sample.across.size(), 2U);
    EXPECT_LT(sample.angle, 1e-12);
    std::array<Point, 2> across;
    for (std::size_t k = 0; k < 2; ++k) {
      const Surface& s = *model.surfaces[static_cast<std::size_t>(edge.surfaces[k])].surface;
      EXPECT_LT((at(s, sample.feet[k].x(), sample.feet[k].y()) - sample.point).norm(), 1e-12);
      constexpr double step = 1e-3;  // sheets are flat and evenly parametrised
      const Eigen::Vector2d on = sample.feet[k], sign(on.x() > 0.5 ? -1 : 1, on.y() > 0.5 ? -1 : 1);
      const Point u = sign.x() / step * (at(s, on.x() + sign.x() * step, on.y()) - sample.point),
                  v = sign.y() / step * (at(s, on.x(), on.y() + sign.y() * step) - sample.point);
      across[k] = sample.across[k].x() * u + sample.across[k].y() * v;
    }
    EXPECT_NEAR(across[0].norm(), 1, 1e-9);
    EXPECT_LT((across[0] - across[1]).norm(), 1e-9);
  }
}

/// Two sheets beside one, with whose side each shares a half.
TEST(EdgesOfSeams, KeepTJunctionsTogether) {
  const auto cubic = *KnotVector::clamped_uniform(3, 6);
  Surface lower = wave(cubic, cubic, 0, 1), upper = lower;
  Points low = lower.control_points(), high = low;
  low.col(1) = 0.5 * low.col(1).array() - 0.25;
  high.col(1) = 0.5 * high.col(1).array() + 0.25;
  const Model model = joined_by_seams({wave(cubic, cubic, -1, 0), *lower.with_control_points(low),
                                       *upper.with_control_points(high)});
  ASSERT_EQ(model.edges.size(), 3U);
  const Map map = bulge(0.05);
  const FitResult result = fit(model, data_on(model, map));
  EXPECT_LT(errors_of(model, result, map).largest, 3e-5 * model.size);
  for (int k = 0; k < 97; ++k) {
    const double t = (k + 0.37) / 97;
    const std::size_t half = t < 0.5 ? 1 : 2;
    const double own = t < 0.5 ? 2 * t : 2 * t - 1;
    EXPECT_LT((at(result.surfaces[0], 1, t) - at(result.surfaces[half], 0, own)).norm(),
              2e-6 * model.size);
  }
}

TEST(EdgesOfSeams, LeaveOutThoseOfASurfaceWithItself) {
  EXPECT_TRUE(joined_by_seams({knead::testing::cylinder(1.5)}).edges.empty());
}

}  // namespace
}  // namespace knead::morph::testing
