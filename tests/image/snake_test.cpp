#include "knead/image/snake.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "knead/spline/evaluate.hpp"
#include "snake_fixtures.hpp"

namespace knead {
namespace {

using std::numbers::pi;
using testing::blurred_disc;
using testing::circle;

Expected<SnakeResult> run(const ImagePotential& image,
                          const std::vector<std::array<double, 2>>& start,
                          const SnakeSettings& settings) {
  auto curve = curve_through(start, settings);
  if (!curve) return std::unexpected(curve.error());
  auto results = run_snakes(image, {*curve}, {settings});
  if (!results) return std::unexpected(results.error());
  return results->front();
}

struct Radii {
  double mean = 0, least = 1e9, most = 0;
};

Radii radii(const SnakeResult& snake, double x, double y) {
  Radii r;
  const auto points = polyline(snake);
  for (const auto& p : points) {
    const double d = std::hypot(p[0] - x, p[1] - y);
    r.mean += d / static_cast<double>(points.size());
    r.least = std::min(r.least, d);
    r.most = std::max(r.most, d);
  }
  return r;
}

TEST(CurveThrough, IsNearItsPointsForEveryDegree) {
  for (const int p : {2, 3, 4, 5, 7}) {
    SnakeSettings settings{.degree = p, .control_points = 40};
    const auto curve = curve_through(circle(50, 60, 20, 2000), settings);
    ASSERT_TRUE(curve) << curve.error().message();
    EXPECT_EQ(curve->size(), 40 + p);
    const Radii r = radii({*curve}, 50, 60);
    EXPECT_NEAR(r.least, 20, p == 2 ? 2e-3 : 1e-3) << p;
    EXPECT_NEAR(r.most, 20, p == 2 ? 2e-3 : 1e-3) << p;
    settings.closed = false;
    const auto line =
        curve_through(std::vector<std::array<double, 2>>{{1, 2}, {3, 4}, {7, 8}}, settings);
    ASSERT_TRUE(line) << line.error().message();
    EXPECT_NEAR(line->control_points()(0, 0), 1, 1e-12);
    EXPECT_NEAR(line->control_points()(line->size() - 1, 1), 8, 1e-12);
  }
}

TEST(Snake, WithoutForcesACircleShrinksAsItsEnergySays) {
  // M c' = −(α G11 + β G22) c: a circle of radius R over the parameter length L shrinks at α
  // (2π/L)² + β (2π/L)⁴ per γ.
  const Image black{300, 300, std::vector<double>(90000, 0)};
  const auto image = ImagePotential::create(black);
  ASSERT_TRUE(image);
  const double length = 400,
               rate = 0.4 * std::pow(2 * pi / length, 2) + 10 * std::pow(2 * pi / length, 4),
               gamma = 0.01;
  const SnakeSettings settings{.control_points = 60,
                               .units = length,
                               .alpha = 0.4,
                               .beta = 10,
                               .gamma = gamma,
                               .redistribute = 0,
                               .max_move = 1e6,

                               .max_iterations = 20,
                               .motion = 0};
  const auto snake = run(*image, circle(150, 150, 100, 4000), settings);
  ASSERT_TRUE(snake) << snake.error().message();
  EXPECT_NEAR(radii(*snake, 150, 150).mean, 100 * std::pow(1 + rate / gamma, -20), 1e-3);
}

TEST(Snake, FindsTheEdgeOfABlurredDiscToATwentiethOfAPixel) {
  const double x = 63.3, y = 65.8, radius = 31.4;
  const auto image =
      ImagePotential::create(blurred_disc(128, x, y, radius, 2), {.smoothing = 0, .edge = 1});
  ASSERT_TRUE(image);
  for (const int degree : {2, 3, 4, 5, 7}) {
    const double start = degree % 2 == 0 ? 25 : 38;
    const SnakeSettings settings{.degree = degree,
                                 .control_points = 24,
                                 .alpha = 0.01,
                                 .beta = 1,
                                 .gamma = 0.1,
                                 .motion = 1e-2};
    const auto snake = run(*image, circle(x + 1, y - 1, start), settings);
    ASSERT_TRUE(snake) << snake.error().message();
    const Radii r = radii(*snake, x, y);
    EXPECT_TRUE(snake->converged);
    EXPECT_NEAR(r.mean, radius, 0.05) << degree;
    EXPECT_GT(r.least, radius - 0.1);
    EXPECT_LT(r.most, radius + 0.1);
    EXPECT_EQ(crossings(*snake), 0);
  }
}

TEST(Snake, FindsTheDiscByRegionsAndByPressureAndByFlow) {
  const double x = 60, y = 64, radius = 30;
  const Image disc = blurred_disc(128, x, y, radius, 1.5);
  const struct {
    const char* name;
    ImagePotentialSettings image;
    double start, balloon, within;
  } cases[] = {
      // the mean of the means, 0.485, is the grey value at 30.06
      {"region", {.smoothing = 0, .edge = 0, .region = 1}, 8, 0, 0.1},
      {"region from outside", {.smoothing = 0, .edge = 0, .region = 1}, 50, 0, 0.1},
      {"balloon", {.smoothing = 0, .edge = 1}, 10, 0.01, 0.4},
      {"flow", {.smoothing = 0, .edge = 0, .flow = 0.1, .flow_iterations = 2000}, 15, 0, 0.5}};
  for (const auto& [name, settings, start, balloon, within] : cases) {
    const auto image = ImagePotential::create(disc, settings);
    ASSERT_TRUE(image);
    const SnakeSettings how{.control_points = 20,
                            .units = 100,
                            .alpha = 0.02,
                            .beta = 0.5,
                            .gamma = 0.1,
                            .balloon = balloon,
                            .motion = 1e-3};
    const auto snake = run(*image, circle(x, y, start), how);
    ASSERT_TRUE(snake) << snake.error().message();
    EXPECT_NEAR(radii(*snake, x, y).mean, radius, within) << name;
  }
}

TEST(Snake, IsDrawnToTheBorderOfAMask) {
  Image mask{90, 80, std::vector<double>(7200, 0)};
  for (int y = 0; y < 80; ++y) mask.at(60, y) = 1;
  const auto image =
      ImagePotential::create(mask, {.smoothing = 0, .edge = 0, .distance = 0.1}, mask);
  ASSERT_TRUE(image);
  const SnakeSettings settings{.closed = false,
                               .control_points = 12,
                               .alpha = 0.001,
                               .beta = 0.01,
                               .gamma = 0.1,
                               .hold_ends = false};
  const std::vector<std::array<double, 2>> line = {{30, 5}, {30, 75}};
  const auto snake = run(*image, line, settings);
  ASSERT_TRUE(snake) << snake.error().message();
  for (const auto& p : polyline(*snake)) EXPECT_NEAR(p[0], 60, 1);
}

TEST(Snake, SpringsDrawAndVolcanoesPush) {
  const Image black{100, 100, std::vector<double>(10000, 0)};
  const auto image = ImagePotential::create(black);
  ASSERT_TRUE(image);
  SnakeSettings settings{.closed = false,
                         .control_points = 20,
                         .alpha = 0.01,
                         .beta = 0.1,
                         .gamma = 0.1,
                         .motion = 1e-6,
                         .springs = {{0.5, {50, 20}, 1e3}}};
  const std::vector<std::array<double, 2>> line = {{10, 50}, {90, 50}};
  auto snake = run(*image, line, settings);
  ASSERT_TRUE(snake) << snake.error().message();
  const auto middle = evaluate(snake->curve, Parameters<1>(Parameters<1>::Constant(1, 40.0)));
  EXPECT_NEAR(middle->points()(0, 1), 20, 0.1);
  EXPECT_NEAR(polyline(*snake).front()[1], 50, 1e-12);  // the ends are held
  settings.springs.clear();
  settings.volcanoes = {{{50, 48}, 0.5, 5}};
  snake = run(*image, line, settings);
  ASSERT_TRUE(snake) << snake.error().message();
  for (const auto& p : polyline(*snake)) EXPECT_GE(p[1], 50 - 1e-9);
  EXPECT_GT(polyline(*snake)[polyline(*snake).size() / 2][1], 52);
}

TEST(Snake, RefinesWhereItCannotFollow) {
  // A square with one corner cut: straight sides need few control points, corners many.
  Image image{128, 128, {}};
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x)
      image.values.push_back(x > 30 && x < 100 && y > 30 && y < 100 ? 1 : 0);
  }
  const auto potential = ImagePotential::create(image, {.smoothing = 1, .edge = 0, .region = 1});
  ASSERT_TRUE(potential);
  SnakeSettings settings{.control_points = 8,
                         .units = 260,
                         .alpha = 0.002,
                         .beta = 0.02,
                         .gamma = 0.05,
                         .redistribute = 0,
                         .max_iterations = 20000,
                         .motion = 1e-3};
  const auto coarse = run(*potential, circle(65, 65, 40), settings);
  settings.refine = 0.3;
  const auto fine = run(*potential, circle(65, 65, 40), settings);
  ASSERT_TRUE(coarse && fine);
  const auto wrong = [&](const SnakeResult& s) {
    const Image mask = mask_of(s, 128, 128);
    int count = 0;
    for (std::size_t k = 0; k < image.values.size(); ++k)
      count += mask.values[k] != image.values[k];
    return count;
  };
  EXPECT_GT(wrong(*coarse), 4 * wrong(*fine));
  EXPECT_GT(fine->curve.size(), coarse->curve.size());
  EXPECT_EQ(crossings(*fine), 0);
}

TEST(Snake, SeveralShareTheirOutside) {
  Image two = blurred_disc(160, 45, 80, 25, 1);
  const Image other = blurred_disc(160, 115, 80, 20, 1);
  for (std::size_t k = 0; k < two.values.size(); ++k) two.values[k] += other.values[k];
  const auto image = ImagePotential::create(two, {.smoothing = 0, .edge = 0, .region = 1});
  ASSERT_TRUE(image);
  const SnakeSettings settings{
      .control_points = 16, .units = 100, .alpha = 0.02, .beta = 0.5, .gamma = 0.1, .motion = 1e-3};
  std::vector<Curve> starts;
  for (const double x : {45.0, 115.0})
    starts.push_back(*curve_through(circle(x, 80, 10), settings));
  const auto snakes = run_snakes(*image, starts, {settings, settings});
  ASSERT_TRUE(snakes) << snakes.error().message();
  EXPECT_NEAR(radii((*snakes)[0], 45, 80).mean, 25, 0.1);
  EXPECT_NEAR(radii((*snakes)[1], 115, 80).mean, 20, 0.1);
}

TEST(Contour, KnowsWhereItCrossesItselfAndWhatIsInside) {
  std::vector<std::array<double, 2>> eight;
  for (int k = 0; k < 200; ++k) {
    const double t = 2 * pi * k / 200;
    eight.push_back({50 + 30 * std::sin(t), 50 + 20 * std::sin(2 * t)});
  }
  const SnakeSettings settings{.control_points = 40};
  EXPECT_EQ(crossings({*curve_through(eight, settings)}), 1);
  const SnakeResult disc{*curve_through(circle(50, 40, 20, 1000), settings)};
  EXPECT_EQ(crossings(disc), 0);
  const Image mask = mask_of(disc, 100, 90);
  double sum = 0;
  for (const double x : mask.values) sum += x;
  EXPECT_NEAR(sum, pi * 400, 12);
  EXPECT_EQ(mask.at(50, 40), 1);
  EXPECT_EQ(mask.at(50, 61), 0);
}

TEST(Snake, FreeEndsObeyTheNaturalConditionsOfTheEnergy) {
  // A line of length L without bend: γ x' = α x'' with x' = 0 at free ends has the solution
  // x(0, t) = L / 2 − Σ 4 L / (k π)² exp(−α (k π / L)² t / γ) over odd k, with implicit steps
  // instead of the exponential.
  const Image black{200, 100, std::vector<double>(20000, 0)};
  const auto image = ImagePotential::create(black);
  ASSERT_TRUE(image);
  const double length = 100, alpha = 2, gamma = 0.1;
  const int steps = 40;
  SnakeSettings settings{.closed = false,
                         .control_points = 60,
                         .alpha = alpha,
                         .beta = 0,
                         .gamma = gamma,
                         .hold_ends = false,
                         .max_move = 1e6,
                         .max_iterations = steps,
                         .motion = 0};
  const std::vector<std::array<double, 2>> line = {{50, 50}, {150, 50}};
  const auto snake = run(*image, line, settings);
  ASSERT_TRUE(snake) << snake.error().message();
  double end = length / 2;
  for (int k = 1; k < 2000; k += 2) {
    end -= 4 * length / std::pow(k * pi, 2) *
           std::pow(1 + alpha * std::pow(k * pi / length, 2) / gamma, -steps);
  }
  EXPECT_GT(end, 20);
  EXPECT_NEAR(polyline(*snake).front()[0] - 50, end, 1e-3);
  EXPECT_NEAR(150 - polyline(*snake).back()[0], end, 1e-3);
  // with the tension of the start at its ends it is at rest
  settings.end_tension = 1;
  settings.beta = 3;
  const auto kept = run(*image, line, settings);
  ASSERT_TRUE(kept) << kept.error().message();
  EXPECT_NEAR(polyline(*kept).front()[0], 50, 1e-8);
  EXPECT_NEAR(polyline(*kept).back()[0], 150, 1e-8);
}

TEST(Snake, PaleDiscsAreFoundBesideBrightOnesWithinABand) {
  // A disc of a tenth of its neighbour's contrast, two pixels away from it, from circles of half
  // the size.
  Image two = blurred_disc(128, 40, 64, 20, 1);
  const Image other = blurred_disc(128, 82, 64, 20, 1);
  for (std::size_t k = 0; k < two.values.size(); ++k)
    two.values[k] = 0.1 * two.values[k] + other.values[k];
  const auto image = ImagePotential::create(
      two, {.smoothing = 0, .edge = 0, .region = 1, .relative_region = true});
  ASSERT_TRUE(image);
  const SnakeSettings settings{.control_points = 12,
                               .units = 100,
                               .alpha = 0.02,
                               .beta = 1,
                               .gamma = 1,
                               .band = 10,
                               .motion = 1e-2};
  const std::vector<Curve> starts = {*curve_through(circle(40, 64, 10), settings),
                                     *curve_through(circle(82, 64, 10), settings)};
  const auto snakes = run_snakes(*image, starts, {settings, settings});
  ASSERT_TRUE(snakes) << snakes.error().message();
  EXPECT_NEAR(radii((*snakes)[0], 40, 64).mean, 20, 0.5);
  EXPECT_NEAR(radii((*snakes)[1], 82, 64).mean, 20, 0.5);
}

TEST(Snake, RefusesWhatMakesNoSense) {
  const auto image = ImagePotential::create(blurred_disc(32, 16, 16, 8, 1));
  ASSERT_TRUE(image);
  const auto start = circle(16, 16, 5);
  const auto refused = [&](const SnakeSettings& settings) {
    const auto snake = run(*image, start, settings);
    return snake ? std::string("accepted") : snake.error().where;
  };
  EXPECT_EQ(refused({.degree = 1}), "degree");
  EXPECT_EQ(refused({.degree = 3, .control_points = 3}), "control_points");
  EXPECT_EQ(refused({.gamma = 0}), "gamma");
  EXPECT_EQ(refused({.alpha = -1}), "alpha");
  EXPECT_EQ(refused({.max_iterations = 0}), "max_iterations");
  EXPECT_EQ(refused({.springs = {{2, {1, 1}, 1}}}), "springs");
  EXPECT_EQ(run(*image, {{1, 1}, {1, 1}, {1, 1}}, {}).error().where, "points");
  EXPECT_EQ(run(*image, {{1, 1}, {NAN, 1}, {1, 2}}, {}).error().where, "points[1]");
  EXPECT_EQ(run(*image, {{1, 1}}, {}).error().where, "points");
}

}  // namespace
}  // namespace knead
