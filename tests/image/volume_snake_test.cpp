#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "image/volume_fixtures.hpp"
#include "knead/image/surface_snake.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

using std::numbers::pi;
using testing::blurred, testing::blurred_ball, testing::blurred_torus, testing::distances,
    testing::radii, testing::Radii;

Expected<SurfaceSnakeResult> run(const VolumePotential& image, const SurfaceStart& start,
                                 const SurfaceSnakeSettings& settings) {
  auto surface = closed_surface(start, settings);
  if (!surface) return std::unexpected(surface.error());
  auto results = run_surface_snakes(image, {*surface}, {settings});
  if (!results) return std::unexpected(results.error());
  return results->front();
}

VolumePotential black() {
  return *VolumePotential::create(VolumeImage{{8, 8, 8}, std::vector<double>(512, 0), {}},
                                  {.edge = 0});
}

TEST(SurfaceSnake, WithoutForcesASphereShrinksEvenlyAsItsEnergySays) {
  // On the round sphere of radius ρ its places have Δv = −2 v / ρ²: it shrinks at (2 α / ρ² + 4 β /
  // ρ⁴) / γ.
  const double rho = 20, alpha = 0.4, beta = 30, gamma = 0.05;
  const SurfaceSnakeSettings settings{.control_points = {32, 20},
                                      .units = 2 * pi * rho,
                                      .alpha = alpha,
                                      .beta = beta,
                                      .gamma = gamma,
                                      .max_move = 1e6,
                                      .max_iterations = 20,
                                      .motion = 0};
  const auto snake = run(black(), {.radii = {100, 100, 100}}, settings);
  ASSERT_TRUE(snake) << snake.error().message();
  const double rate = 2 * alpha / (rho * rho) + 4 * beta / std::pow(rho, 4),
               wanted = 100 * std::pow(1 + rate / gamma, -20);
  ASSERT_LT(wanted, 70);
  const Radii r = distances(snake->snake, Point::Zero());
  // The start is within 5e-5 of its radius, at the poles.
  EXPECT_NEAR(r.mean, wanted, 2e-3);
  EXPECT_NEAR(r.least, wanted, 1e-2);
  EXPECT_NEAR(r.most, wanted, 1e-2);
}

TEST(SurfaceSnake, WithoutForcesATorusShrinksAsItsEnergySays) {
  // On the flat torus each wave shrinks by itself: the ring's cos s, and the tube's sin t and cos s
  // cos t.
  const double ring = 40, tube = 15, alpha = 0.4, beta = 30, gamma = 0.05;
  const SurfaceSnakeSettings settings{.control_points = {40, 24},
                                      .alpha = alpha,
                                      .beta = beta,
                                      .gamma = gamma,
                                      .max_move = 1e6,
                                      .max_iterations = 20,
                                      .motion = 0};
  const auto snake = run(black(), {.form = SurfaceForm::torus, .radii = {ring, tube}}, settings);
  ASSERT_TRUE(snake) << snake.error().message();
  const auto after = [&](double square) {
    return std::pow(1 + (alpha * square + beta * square * square) / gamma, -20);
  };
  const double s = 1 / (ring * ring), t = 1 / (tube * tube);
  const double r = ring * after(s), across = tube * after(s + t), up = tube * after(t);
  const auto [lu, lv] = std::pair(2 * pi * ring, 2 * pi * tube);
  const auto place = [&](double u, double v) {
    return *evaluate_point(snake->snake.surface, {u * lu, v * lv});
  };
  EXPECT_NEAR(place(0, 0)[0], r + across, 2e-3);
  EXPECT_NEAR(place(0, 0.5)[0], r - across, 2e-3);
  EXPECT_NEAR(place(0.25, 0.25)[1], r, 2e-3);
  EXPECT_NEAR(place(0.25, 0.25)[2], up, 2e-3);
}

TEST(SurfaceSnake, FindsTheEdgeOfABlurredBallToATwentiethOfAVoxel) {
  const Point centre(23.3, 24.8, 24.1);
  const double radius = 15.4;
  const auto image =
      VolumePotential::create(blurred_ball(48, centre, radius, 2), {.smoothing = 0, .edge = 1});
  ASSERT_TRUE(image);
  for (const double start : {11.0, 20.0}) {
    const SurfaceSnakeSettings settings{
        .control_points = {16, 12}, .alpha = 1e-3, .beta = 0.01, .gamma = 0.02};
    const auto snake =
        run(*image, {.centre = centre + Point(0.7, -0.6, 0.4), .radii = {start, start, start}},
            settings);
    ASSERT_TRUE(snake) << snake.error().message();
    const Radii r = distances(snake->snake, centre);
    EXPECT_TRUE(snake->converged);
    EXPECT_NEAR(r.mean, radius, 0.05) << start;
    EXPECT_GT(r.least, radius - 0.1);
    EXPECT_LT(r.most, radius + 0.1);
    EXPECT_EQ(crossings(closed_mesh(snake->snake)), 0);
  }
}

TEST(SurfaceSnake, FindsBothRadiiOfABlurredTorus) {
  const Point centre(29.6, 30.3, 14.9);
  const double ring = 18.3, tube = 7.2;
  const auto image = VolumePotential::create(blurred_torus({60, 60, 30}, centre, ring, tube, 1.5),
                                             {.smoothing = 0, .edge = 1});
  ASSERT_TRUE(image);
  for (const auto& [a, b] : {std::pair{18.0, 5.5}, std::pair{19.0, 9.0}}) {
    const SurfaceSnakeSettings settings{
        .control_points = {24, 14}, .alpha = 2e-3, .beta = 0.005, .gamma = 0.02, .motion = 0.03};
    const auto snake =
        run(*image,
            {.form = SurfaceForm::torus, .centre = centre + Point(0.3, 0.2, -0.4), .radii = {a, b}},
            settings);
    ASSERT_TRUE(snake) << snake.error().message();
    EXPECT_TRUE(snake->converged);
    const SurfaceMeasure m = measure(snake->snake);
    // Of a torus: volume / area = tube / 2, area = 4 π² ring tube.
    const double found_tube = 2 * m.volume / m.area,
                 found_ring = m.area / (4 * pi * pi * found_tube);
    EXPECT_NEAR(found_tube, tube, 0.05);
    EXPECT_NEAR(found_ring, ring, 0.05);
    const Radii r = radii(snake->snake, [&](const Point& p) {
      const Point d = p - centre;
      return std::hypot(std::hypot(d[0], d[1]) - ring, d[2]);
    });
    EXPECT_NEAR(r.mean, tube, 0.05);
    EXPECT_GT(r.least, tube - 0.15);
    EXPECT_LT(r.most, tube + 0.15);
  }
}

/// How far outside of a blurred shape the grey is the mean of the means inside and outside: where
/// the region term rests.
double region_offset(const VolumeImage& image, double sigma,
                     const std::function<double(const Point&)>& distance) {
  double low = -3, high = 3;
  for (int i = 0; i < 30; ++i) {
    const double out = std::midpoint(low, high),
                 grey = std::erfc(out / (std::numbers::sqrt2 * sigma)) / 2;
    double sums[2] = {0, 0}, counts[2] = {0, 0};
    for (int z = 0; z < image.size[2]; ++z) {
      for (int y = 0; y < image.size[1]; ++y) {
        for (int x = 0; x < image.size[0]; ++x) {
          const int side =
              distance(image.frame.origin + image.frame.directions * Point(x, y, z)) < out ? 0 : 1;
          sums[side] += image.at(x, y, z);
          ++counts[side];
        }
      }
    }
    (grey > (sums[0] / counts[0] + sums[1] / counts[1]) / 2 ? low : high) = out;
  }
  return low;
}

/// Nearly the distance from an ellipsoid, exactly zero on it.
double from_ellipsoid(const Point& p, const Point& radii) {
  const double k = p.cwiseQuotient(radii).norm(),
               slope = p.cwiseQuotient(radii.cwiseProduct(radii)).norm();
  return slope > 0 ? k * (k - 1) / slope : -radii.minCoeff();
}

TEST(SurfaceSnake, FindsAnEllipsoidFromASphereByRegionsAndByFlow) {
  const Point centre(27.2, 22.7, 18.4), size(20, 15, 10);
  const auto distance = [&](const Point& p) { return from_ellipsoid(p - centre, size); };
  const VolumeImage egg = blurred({56, 46, 38}, {}, 1, distance);
  const struct {
    ImagePotentialSettings image;
    double start, wanted;
  } cases[] = {{{.smoothing = 0, .edge = 0, .region = 1}, 6, region_offset(egg, 1, distance)},
               {{.smoothing = 0, .edge = 0, .flow = 0.2, .flow_iterations = 100}, 12, 0}};
  for (const auto& [settings, start, wanted] : cases) {
    const auto image = VolumePotential::create(egg, settings);
    ASSERT_TRUE(image);
    const auto snake = run(*image, {.centre = centre, .radii = {start, start, start}},
                           {.control_points = {20, 14},
                            .units = 100,
                            .alpha = 0.01,
                            .beta = 0.02,
                            .gamma = 0.1,
                            .max_iterations = 300,
                            .motion = 0.03});
    ASSERT_TRUE(snake) << snake.error().message();
    const Radii r = radii(snake->snake, distance);
    // The unit vectors of the flow turn round within a voxel: there it goes to and fro.
    const bool flows = settings.flow != 0;
    EXPECT_EQ(snake->converged, !flows);
    EXPECT_NEAR(r.mean, wanted, flows ? 0.2 : 0.02);
    EXPECT_GT(r.least, wanted - (flows ? 0.7 : 0.05));
    EXPECT_LT(r.most, wanted + (flows ? 0.7 : 0.05));
    EXPECT_EQ(crossings(closed_mesh(snake->snake)), 0);
  }
}

TEST(SurfaceSnake, FindsTheBallWhateverTheSpacing) {
  // The same ball in space on voxels of 0.8 × 1.3 × 2 along turned axes.
  VolumeFrame frame;
  frame.origin = {100, -40, 10};
  frame.directions = Eigen::AngleAxisd(0.5, Point(3, 1, 2).normalized()).toRotationMatrix() *
                     Eigen::Vector3d(0.8, 1.3, 2).asDiagonal();
  const std::array<int, 3> size = {60, 38, 24};
  const Point centre = frame.origin + frame.directions * Point(29.3, 19.1, 11.6);
  const double radius = 14.2;
  const VolumeImage ball =
      blurred(size, frame, 2.5, [&](const Point& p) { return (p - centre).norm() - radius; });
  for (const bool region : {false, true}) {
    const auto image = VolumePotential::create(
        ball, {.smoothing = 0, .edge = region ? 0.0 : 1.0, .region = region ? 1.0 : 0.0});
    ASSERT_TRUE(image);
    const auto snake =
        run(*image, {.centre = centre + Point(1, 0.5, -0.5), .radii = {11, 11, 11}},
            {.control_points = {16, 12}, .units = 90, .alpha = 1e-3, .beta = 0.01, .gamma = 0.02});
    ASSERT_TRUE(snake) << snake.error().message();
    const Radii r = distances(snake->snake, centre);
    EXPECT_TRUE(snake->converged);
    const double wanted =
        radius + (region
                      ? region_offset(ball, 2.5,
                                      [&](const Point& p) { return (p - centre).norm() - radius; })
                      : 0);
    EXPECT_NEAR(r.mean, wanted, 0.05);
    EXPECT_GT(r.least, wanted - 0.1);
    EXPECT_LT(r.most, wanted + 0.1);
    EXPECT_EQ(wanted > radius + 0.3, region);  // the mean of the means is not the middle grey
  }
}

double dice(const VolumeImage& a, const VolumeImage& b) {
  double both = 0, sum = 0;
  for (std::size_t k = 0; k < a.values.size(); ++k) {
    both += a.values[k] * b.values[k];
    sum += a.values[k] + b.values[k];
  }
  return 2 * both / sum;
}

TEST(SurfaceSnake, FindsANoisyBallByRegions) {
  const Point centre(20, 19, 21);
  VolumeImage noisy = blurred_ball(40, centre, 12, 0.5), truth = noisy;
  for (double& x : truth.values) x = x >= 0.5 ? 1 : 0;
  std::mt19937_64 random(5);
  std::normal_distribution<double> error(0, 0.5);
  for (double& x : noisy.values) x = 0.4 * x + 0.2 + error(random);  // noise above the contrast
  for (const double band : {0.0, 5.0}) {
    const auto image = VolumePotential::create(noisy, {.smoothing = 0.7, .edge = 0, .region = 5});
    ASSERT_TRUE(image);
    const auto snake =
        run(*image,
            {.centre = {21, 20, 20},
             .radii = {band > 0 ? 10.0 : 6.0, band > 0 ? 10.0 : 6.0, band > 0 ? 10.0 : 6.0}},
            {.control_points = {14, 10},
             .units = 75,
             .alpha = 0.5,
             .beta = 3,
             .gamma = 0.1,
             .band = band,
             .motion = 0.1});
    ASSERT_TRUE(snake) << snake.error().message();
    const double found = dice(mask_of(closed_mesh(snake->snake), truth.size, truth.frame), truth);
    EXPECT_GE(found, 0.97);
    EXPECT_TRUE(snake->converged);
  }
}

TEST(SurfaceSnake, RelativeRegionsFindPaleBallsAsBrightOnes) {
  const Point centre(16, 16, 16);
  const VolumeImage bright = blurred_ball(32, centre, 10, 0.6);
  VolumeImage pale = bright;
  for (double& x : pale.values) x *= 0.125;
  const auto found = [&](const VolumeImage& volume) {
    const auto image = VolumePotential::create(
        volume, {.smoothing = 0, .edge = 0, .region = 1, .relative_region = true});
    EXPECT_TRUE(image);
    const auto snake =
        run(*image, {.centre = centre, .radii = {5, 5, 5}},
            {.control_points = {12, 9}, .units = 60, .alpha = 0.002, .beta = 0.01, .gamma = 0.1});
    EXPECT_TRUE(snake && snake->converged);
    return distances(snake->snake, centre).mean;
  };
  EXPECT_NEAR(found(bright), 10, 0.15);
  EXPECT_NEAR(found(pale), found(bright), 1e-9);
}

TEST(SurfaceSnake, PressureDrivesItToTheEdgeOutwardsAndInwards) {
  const Point centre(20, 20, 20);
  const auto image =
      VolumePotential::create(blurred_ball(40, centre, 12, 1.5), {.smoothing = 0, .edge = 1});
  ASSERT_TRUE(image);
  for (const double start : {5.0, 17.0}) {
    const auto snake = run(*image, {.centre = centre, .radii = {start, start, start}},
                           {.control_points = {14, 10},
                            .units = 75,
                            .alpha = 1e-3,
                            .beta = 0.01,
                            .gamma = 0.05,
                            .balloon = start < 12 ? 0.02 : -0.02});
    ASSERT_TRUE(snake) << snake.error().message();
    EXPECT_NEAR(distances(snake->snake, centre).mean, 12, 0.4);
  }
}

TEST(SurfaceSnake, IsDrawnToAMask) {
  VolumeImage mask{{30, 30, 30}, std::vector<double>(27000, 0), {}};
  for (int k = 0; k < 30; ++k) {
    for (int j = 0; j < 30; ++j) {
      for (int i = 0; i < 30; ++i) {
        if (std::abs(std::hypot(i - 15, j - 15, k - 15) - 10) < 0.7) mask.at(i, j, k) = 1;
      }
    }
  }
  const auto image =
      VolumePotential::create(mask, {.smoothing = 0, .edge = 0, .distance = 0.1}, mask);
  ASSERT_TRUE(image);
  const auto snake = run(*image, {.centre = {15, 15, 15}, .radii = {7, 7, 7}},
                         {.control_points = {14, 10}, .alpha = 1e-3, .beta = 0.01, .gamma = 0.1});
  ASSERT_TRUE(snake) << snake.error().message();
  EXPECT_NEAR(distances(snake->snake, {15, 15, 15}).mean, 10, 0.5);
}

TEST(SurfaceSnake, SpringsDrawAndVolcanoesPush) {
  SurfaceSnakeSettings settings{
      .control_points = {16, 12}, .alpha = 0, .beta = 0.2, .gamma = 0.1, .max_iterations = 200};
  settings.springs = {{{0.25, 0.5}, {0, 16, 0}, 1e4}};
  auto snake = run(black(), {.radii = {10, 10, 10}}, settings);
  ASSERT_TRUE(snake) << snake.error().message();
  const auto place = [&](double u, double v) {
    return *evaluate_point(snake->snake.surface,
                           {u * snake->snake.surface.knots()[0].domain().upper,
                            v * snake->snake.surface.knots()[1].domain().upper});
  };
  EXPECT_LT((place(0.25, 0.5) - Point(0, 16, 0)).norm(), 0.01);
  settings.springs.clear();
  settings.volcanoes = {{{0, 0, 9}, 1, 3}};
  settings.max_iterations = 15;
  snake = run(black(), {.radii = {10, 10, 10}}, settings);
  ASSERT_TRUE(snake) << snake.error().message();
  EXPECT_GT(place(0, 1)[2], 12);  // the pole over the volcano
  EXPECT_GT(place(0, 0)[2], -10 - (place(0, 1)[2] - 10) / 2);
}

TEST(SurfaceSnake, RefinesWhereItCannotFollow) {
  const Point centre(24, 24, 24);
  const auto wavy = [&](const Point& p) {
    const Point d = p - centre;
    return d.norm() - 13 -
           2 * std::cos(4 * std::atan2(d[1], d[0])) *
               std::pow(std::hypot(d[0], d[1]) / d.norm(), 4);
  };
  const VolumeImage star =
      blurred({48, 48, 48}, {}, 1, [&](const Point& p) { return p == centre ? -13 : wavy(p); });
  VolumeImage truth = star;
  for (double& x : truth.values) x = x >= 0.5 ? 1 : 0;
  const auto image = VolumePotential::create(star, {.smoothing = 0, .edge = 0, .region = 1});
  ASSERT_TRUE(image);
  SurfaceSnakeSettings settings{
      .control_points = {6, 6}, .units = 80, .alpha = 0.05, .beta = 0.1, .gamma = 0.1};
  const SurfaceStart start{.centre = centre, .radii = {10, 10, 10}};
  const auto coarse = run(*image, start, settings);
  settings.refine = 0.3;
  const auto fine = run(*image, start, settings);
  ASSERT_TRUE(coarse && fine);
  const double before = dice(mask_of(closed_mesh(coarse->snake), truth.size, truth.frame), truth),
               after = dice(mask_of(closed_mesh(fine->snake, 2), truth.size, truth.frame), truth);
  EXPECT_GT(after, 0.98);
  EXPECT_LT(before, after - 0.01);
  EXPECT_GT(fine->snake.surface.size(), coarse->snake.surface.size());
  EXPECT_EQ(crossings(closed_mesh(fine->snake, 2)), 0);
}

TEST(SurfaceSnake, SeveralShareTheirOutside) {
  VolumeImage two = blurred({60, 32, 32}, {}, 0.6,
                            [](const Point& p) { return (p - Point(17, 16, 16)).norm() - 10; });
  const VolumeImage other = blurred(
      {60, 32, 32}, {}, 0.6, [](const Point& p) { return (p - Point(43, 16, 16)).norm() - 8; });
  for (std::size_t k = 0; k < two.values.size(); ++k) two.values[k] += other.values[k];
  const auto image = VolumePotential::create(two, {.smoothing = 0, .edge = 0, .region = 1});
  ASSERT_TRUE(image);
  const SurfaceSnakeSettings settings{
      .control_points = {12, 9}, .units = 60, .alpha = 0.002, .beta = 0.01, .gamma = 0.1};
  std::vector<ClosedSurface> starts;
  for (const double x : {17.0, 43.0}) {
    starts.push_back(*closed_surface({.centre = {x, 16, 16}, .radii = {5, 5, 5}}, settings));
  }
  const auto snakes = run_surface_snakes(*image, starts, {settings, settings});
  ASSERT_TRUE(snakes) << snakes.error().message();
  EXPECT_NEAR(distances((*snakes)[0].snake, {17, 16, 16}).mean, 10, 0.15);
  EXPECT_NEAR(distances((*snakes)[1].snake, {43, 16, 16}).mean, 8, 0.15);
}

}  // namespace
}  // namespace knead
