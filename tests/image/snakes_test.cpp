// Snakes that are run a few iterations at a time.
#include <gtest/gtest.h>

#include <cmath>

#include "knead/image/snake.hpp"
#include "snake_fixtures.hpp"

namespace knead {
namespace {

using testing::circle;

TEST(Snakes, AdvanceInSlicesAsInOneRunToTheLastBit) {
  Image square{64, 64, std::vector<double>(4096, 0)};
  for (int y = 15; y < 50; ++y) {
    for (int x = 15; x < 50; ++x) square.at(x, y) = 1;
  }
  const auto image = ImagePotential::create(square, {.smoothing = 1, .edge = 0, .region = 1});
  ASSERT_TRUE(image);
  const SnakeSettings settings{.control_points = 8,
                               .units = 130,
                               .alpha = 0.002,
                               .beta = 0.02,
                               .gamma = 0.1,
                               .motion = 1e-2,
                               .refine = 0.3};
  const std::vector<Curve> starts = {*curve_through(circle(32, 32, 20), settings)};
  const auto whole = run_snakes(*image, starts, {settings});
  ASSERT_TRUE(whole) << whole.error().message();
  auto snakes = Snakes::create(*image, starts, {settings});
  ASSERT_TRUE(snakes) << snakes.error().message();
  EXPECT_EQ(snakes->count(), 1);
  while (!snakes->ended()) {
    const auto made = snakes->advance(3);
    ASSERT_TRUE(made && *made > 0 && *made <= 3);
  }
  const auto sliced = snakes->result(0);
  ASSERT_TRUE(sliced);
  EXPECT_GT(sliced->curve.size(), starts[0].size());
  EXPECT_EQ(sliced->curve.control_points(), whole->front().curve.control_points());
  EXPECT_EQ(sliced->iterations, whole->front().iterations);
  EXPECT_EQ(*snakes->advance(10), 0);
}

TEST(Snakes, CopiesGoOnByThemselvesToTheSamePlaces) {
  const auto image =
      ImagePotential::create(testing::blurred_disc(64, 32, 30, 15, 1), {.smoothing = 0, .edge = 1});
  ASSERT_TRUE(image);
  const SnakeSettings settings{
      .control_points = 12, .alpha = 0.002, .beta = 0.02, .gamma = 0.1, .motion = 1e-2};
  auto first = Snakes::create(*image, {*curve_through(circle(33, 32, 18), settings)}, {settings});
  ASSERT_TRUE(first && first->advance(20));
  Snakes second = *first;
  const Points kept = second.result(0)->curve.control_points();
  ASSERT_TRUE(first->advance(50));
  const Points end = first->result(0)->curve.control_points();
  EXPECT_EQ(second.result(0)->curve.control_points(), kept);
  EXPECT_NE(kept, end);
  ASSERT_TRUE(second.advance(50));
  EXPECT_EQ(second.result(0)->curve.control_points(), end);
  EXPECT_EQ(second.result(0)->last_motion, first->result(0)->last_motion);
  *first = second;
  EXPECT_EQ(first->result(0)->iterations, second.result(0)->iterations);
}

TEST(Snakes, ArePulledBySpringsWhileTheyRun) {
  const Image black{100, 100, std::vector<double>(10000, 0)};
  const auto image = ImagePotential::create(black);
  ASSERT_TRUE(image);
  SnakeSettings settings{.closed = false,
                         .control_points = 20,
                         .alpha = 1,
                         .beta = 0.1,
                         .gamma = 0.01,
                         .motion = 1e-6};
  const std::vector<std::array<double, 2>> line = {{10, 50}, {90, 50}};
  auto snakes = Snakes::create(*image, {*curve_through(line, settings)}, {settings});
  ASSERT_TRUE(snakes) << snakes.error().message();
  ASSERT_TRUE(snakes->advance(1000));
  EXPECT_TRUE(snakes->ended());
  settings.springs = {{0.5, {50, 20}, 1e3}};
  ASSERT_TRUE(snakes->change(0, settings));
  EXPECT_FALSE(snakes->ended());
  while (!snakes->ended()) ASSERT_TRUE(snakes->advance(100));
  const auto pulled = polyline(*snakes->result(0));
  EXPECT_NEAR(pulled[pulled.size() / 2][1], 20, 0.1);
  settings.springs.clear();
  ASSERT_TRUE(snakes->change(0, settings));
  while (!snakes->ended()) ASSERT_TRUE(snakes->advance(100));
  for (const auto& p : polyline(*snakes->result(0))) EXPECT_NEAR(p[1], 50, 0.1);
  EXPECT_EQ(snakes->change(1, settings).error().where, "snakes");
  settings.gamma = 0;
  EXPECT_EQ(snakes->change(0, settings).error().where, "snakes[0]: gamma");
  EXPECT_EQ(snakes->result(-1).error().where, "snakes");
}

TEST(Snakes, KeepTheTensionOfTheirStartWhenTheyChange) {
  const Image black{200, 100, std::vector<double>(20000, 0)};
  const auto image = ImagePotential::create(black);
  ASSERT_TRUE(image);
  SnakeSettings settings{.closed = false,
                         .control_points = 20,
                         .alpha = 1,
                         .beta = 0.1,
                         .gamma = 0.01,
                         .hold_ends = false,
                         .end_tension = 1,
                         .max_iterations = 5000,
                         .motion = 1e-6};
  const std::vector<std::array<double, 2>> line = {{50, 50}, {150, 50}};
  auto snakes = Snakes::create(*image, {*curve_through(line, settings)}, {settings});
  ASSERT_TRUE(snakes) << snakes.error().message();
  settings.springs = {{0, {60, 50}, 10}, {1, {140, 50}, 10}};  // shorter while they draw
  ASSERT_TRUE(snakes->change(0, settings));
  ASSERT_TRUE(snakes->advance(5000));
  EXPECT_LT(polyline(*snakes->result(0)).back()[0] - polyline(*snakes->result(0)).front()[0], 82);
  settings.springs.clear();
  ASSERT_TRUE(snakes->change(0, settings));
  ASSERT_TRUE(snakes->advance(5000));
  EXPECT_NEAR(polyline(*snakes->result(0)).back()[0] - polyline(*snakes->result(0)).front()[0], 100,
              0.1);
}

}  // namespace
}  // namespace knead
