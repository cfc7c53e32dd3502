#include <gtest/gtest.h>

#include "knead/image/surface_snake.hpp"

namespace knead {
namespace {

VolumePotential black() {
  return *VolumePotential::create(VolumeImage{{8, 8, 8}, std::vector<double>(512, 0), {}},
                                  {.edge = 0});
}

Expected<std::vector<SurfaceSnakeResult>> run_from(const SurfaceStart& start,
                                                   const SurfaceSnakeSettings& settings) {
  auto surface = closed_surface(start, settings);
  if (!surface) return std::unexpected(surface.error());
  return run_surface_snakes(black(), {*surface}, {settings});
}

TEST(SurfaceSnake, RefusesWhatMakesNoSense) {
  const auto refused = [](const SurfaceStart& start, const SurfaceSnakeSettings& settings) {
    const auto snake = run_from(start, settings);
    return snake ? std::string("accepted") : snake.error().where;
  };
  EXPECT_EQ(refused({}, {.degree = 1}), "degree");
  EXPECT_EQ(refused({}, {.control_points = {3, 12}}), "control_points");
  EXPECT_EQ(refused({}, {.control_points = {12, 5}}), "control_points");
  EXPECT_EQ(refused({}, {.gamma = 0}), "gamma");
  EXPECT_EQ(refused({}, {.alpha = -1}), "alpha");
  EXPECT_EQ(refused({}, {.springs = {{{2, 0}, {1, 1, 1}, 1}}}), "springs");
  EXPECT_EQ(refused({}, {.volcanoes = {{{1, 1, 1}, 1, 0}}}), "volcanoes");
  EXPECT_EQ(refused({.radii = {1, 0, 1}}, {}), "radii");
  EXPECT_EQ(refused({.form = SurfaceForm::torus, .radii = {3, 4}}, {}), "radii");
  EXPECT_EQ(refused({.axis = {0, 0, 0}}, {}), "axis");
  // A surface that is none of these.
  const auto ball = closed_surface({}, {});
  ASSERT_TRUE(ball);
  const auto wrong = run_surface_snakes(black(), {{ball->surface, SurfaceForm::torus}}, {{}});
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().where, "snakes[0]: v");
  Points c = ball->surface.control_points();
  c(0, 0) += 1;
  const auto torn =
      run_surface_snakes(black(), {{*ball->surface.with_control_points(c), ball->form}}, {{}});
  ASSERT_FALSE(torn);
  EXPECT_NE(torn.error().what.find("poles"), std::string::npos);
}

}  // namespace
}  // namespace knead
