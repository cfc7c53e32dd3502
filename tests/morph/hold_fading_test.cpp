// Data that contradict what stays: edges do not part, and what is beyond the zone is followed.

#include <gtest/gtest.h>

#include "morph/fit_models.hpp"

namespace knead::morph::testing {
namespace {

constexpr double lift = 0.03;
constexpr double zone = 8 * lift;  // in which data fade out

/// Twelve spans for the zone, from nets of three.
const FitSettings enough{.refinement = 40};

/// Sheets side by side in a plane, from x = −1 to 0 and from 0 to 1, smooth together.
Model sheets() {
  const auto knots = *KnotVector::clamped_uniform(3, 6);
  return model_of({wave(knots, knots, -1, 0), wave(knots, knots, 0, 1)},
                  {edge_between(0, 1, true)});
}

std::vector<Datum> data_on_second(const Model& model, const Map& map) {
  std::vector<Datum> data = data_on(model, map, 40);
  std::erase_if(data, [](const Datum& datum) { return datum.surface != 1; });
  return data;
}

Point moved_by(const Model& model, const FitResult& result, double u, double v) {
  return at(result.surfaces[1], u, v) - at(*model.surfaces[1].surface, u, v);
}

/// Lifted all along the edge of what stays.
TEST(HoldFading, KeepsTheEdgeWhereAllDataContradictIt) {
  Model model = sheets();
  model.surfaces[0].fixed = true;
  const Map map = [](const Point&) { return Point(0, 0, lift); };
  const auto data = data_on_second(model, map);
  const FitResult result = fit(model, data, enough);
  const AtEdge edge = at_edge(result.surfaces[0], result.surfaces[1]);
  EXPECT_LT(edge.parting, 1e-6 * model.size);
  EXPECT_LT(edge.degrees, 0.03);
  int within = 0;
  for (const Datum& datum : data) within += datum.parameters[0] < zone ? 1 : 0;
  for (int j = 1; j < 40; ++j) {
    const double v = j / 40.0;
    double before = 0;
    for (int i = 1; i <= 40; ++i) {
      const Point d = moved_by(model, result, i / 40.0, v);
      EXPECT_LT(std::hypot(d.x(), d.y()), 3e-5 * model.size);
      EXPECT_GT(d.z(), before - 2 * 3e-5 * model.size) << "it rises";
      before = d.z();
      if (i / 40.0 > 1.5 * zone) {
        EXPECT_NEAR(d.z(), lift, 3e-5 * model.size);
      }
    }
  }
  ASSERT_EQ(result.above.size(), 1U);
  const FitExcess& excess = result.above[0];
  EXPECT_EQ(excess.measure, FitExcess::Measure::contradiction);
  EXPECT_EQ(excess.surface, 1);
  // Beside the ends of the edge the zone is up to half as wide, and at its border d is hardly less.
  EXPECT_GT(excess.count, 0.5 * within);
  EXPECT_LE(excess.count, within);
  EXPECT_NEAR(excess.found, lift, 0.01 * lift);
  EXPECT_LT(excess.place.x(), 0.02);
  EXPECT_LT(result.control_points, 1500) << "nets are not refined at a step";
}

/// An edge that is held without a surface beside it, by its own samples.
TEST(HoldFading, KeepsAnEdgeThatIsHeld) {
  Model model = sheets();
  FitEdge held{.course = nullptr, .surfaces = {1}, .name = "far", .held = true};
  for (int k = 0; k <= 64; ++k)
    held.samples.push_back({k / 64.0, Point(1, k / 64.0 - 0.5, 0), {{1, k / 64.0}}});
  model.edges.push_back(held);
  const Map map = [](const Point&) { return Point(0, lift, 0); };
  const FitResult result = fit(model, data_on(model, map, 40), enough);
  for (int k = 0; k <= 97; ++k) {
    EXPECT_LT(moved_by(model, result, 1, k / 97.0).norm(), 1e-6 * model.size);
    EXPECT_NEAR(moved_by(model, result, 0.5, k / 97.0).y(), lift, 3e-5 * model.size);
  }
  EXPECT_LT(at_edge(result.surfaces[0], result.surfaces[1]).parting, 1e-6 * model.size);
  ASSERT_EQ(result.above.size(), 1U);
  EXPECT_EQ(result.above[0].measure, FitExcess::Measure::contradiction);
}

/// A sheet that turns about the edge of what stays, by 11 degrees, is no contradiction.
TEST(HoldFading, LeavesWhatTurnsAboutAHold) {
  Model model = sheets();
  model.surfaces[0].fixed = true;
  model.edges = {edge_between(0, 1, false)};
  const Map map = [](const Point& x) { return Point(0, 0, 0.2 * x.x()); };
  const FitResult result = fit(model, data_on_second(model, map), enough);
  EXPECT_TRUE(result.above.empty());
  for (int k = 0; k <= 37; ++k) {
    const double u = k / 37.0;
    EXPECT_LT((moved_by(model, result, u, 0.3) - map(Point(u, 0, 0))).norm(), 3e-5 * model.size);
  }
}

/// Data that contradict the edge only on one half of it: the other half is followed up to the edge.
TEST(HoldFading, LeavesDataFarFromTheContradiction) {
  Model model = sheets();
  model.surfaces[0].fixed = true;
  const Map map = [](const Point& x) {
    const double rise = std::clamp(4 * (x.y() - 0.2), 0.0, 1.0), foot = x.x() * x.x();
    return Point(0, 0, lift * (foot + rise * rise * rise * (10 + rise * (6 * rise - 15))));
  };
  const FitResult result = fit(model, data_on_second(model, map), enough);
  EXPECT_LT(at_edge(result.surfaces[0], result.surfaces[1]).parting, 1e-6 * model.size);
  for (int k = 0; k <= 37; ++k) {
    const double u = k / 37.0;  // y = −0.4
    EXPECT_LT((moved_by(model, result, u, 0.1) - map(Point(u, -0.4, 0))).norm(), 5e-5 * model.size);
  }
}

}  // namespace
}  // namespace knead::morph::testing
