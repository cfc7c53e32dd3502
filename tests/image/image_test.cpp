#include "knead/image/image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace knead {
namespace {

Image made(int width, int height, const auto& f) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.values.push_back(f(x, y));
  }
  return image;
}

Image noise(int width, int height) {
  std::mt19937_64 random(5);
  return made(width, height,
              [&](int, int) { return std::uniform_real_distribution<double>(0, 1)(random); });
}

TEST(ImageSpline, GoesThroughThePixelsOfEverySize) {
  for (const auto& [w, h] : {std::array{1, 1}, {1, 7}, {2, 2}, {3, 5}, {64, 9}, {300, 200}}) {
    const Image image = noise(w, h);
    const ImageSpline spline(image);
    double error = 0;
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x)
        error = std::max(error, std::abs(spline.value(x, y) - image.at(x, y)));
    }
    EXPECT_LT(error, 1e-14) << w << " x " << h;
    EXPECT_DOUBLE_EQ(spline.value(-3, -5), spline.value(0, 0));
    EXPECT_EQ(spline.gradient(-3, -5), (std::array<double, 2>{0, 0}));
  }
}

TEST(ImageSpline, HasTheSlopeOfItsValuesAndIsASplineField) {
  const Image image = noise(20, 14);
  const ImageSpline spline(image);
  const auto field = spline.field();
  ASSERT_TRUE(field) << field.error().message();
  for (const auto& [x, y] : {std::array{0.3, 0.7}, {7.01, 3.99}, {18.9, 12.5}, {10.0, 6.0}}) {
    const double h = 1e-6;
    const auto slope = spline.gradient(x, y);
    EXPECT_NEAR(slope[0], (spline.value(x + h, y) - spline.value(x - h, y)) / (2 * h), 1e-8);
    EXPECT_NEAR(slope[1], (spline.value(x, y + h) - spline.value(x, y - h)) / (2 * h), 1e-8);
    const double u[] = {x}, v[] = {y};
    EXPECT_NEAR(field->on_grid({u, v})->front(), spline.value(x, y), 1e-14);
  }
}

TEST(Gaussian, KeepsConstantsAndSumsAndSpreadsAsItsVarianceSays) {
  const Image one = made(21, 13, [](int, int) { return 0.7; });
  for (const double x : gaussian(one, 2.5).values) EXPECT_NEAR(x, 0.7, 1e-15);
  const Image dot = made(81, 81, [](int x, int y) { return x == 40 && y == 40 ? 1.0 : 0.0; });
  const Image spread = gaussian(dot, 3);
  double sum = 0, variance = 0;
  for (int y = 0; y < 81; ++y) {
    for (int x = 0; x < 81; ++x)
      sum += spread.at(x, y), variance += spread.at(x, y) * (x - 40) * (x - 40);
  }
  EXPECT_NEAR(sum, 1, 1e-14);
  EXPECT_NEAR(variance, 9, 0.02);  // cut at 4 σ
  EXPECT_EQ(gaussian(dot, 0), dot);
}

TEST(Sobel, FindsTheSlopeOfARamp) {
  const Image ramp = made(9, 8, [](int x, int y) { return 0.3 * x - 0.4 * y; });
  const Image slope = sobel(ramp);
  EXPECT_NEAR(slope.at(4, 4), 0.5 / std::sqrt(2), 1e-15);
}

TEST(DistanceTo, IsThatOfALoopOverAllPixels) {
  std::mt19937_64 random(9);
  const Image mask = made(23, 17, [&](int, int) { return random() % 40 == 0 ? 1.0 : 0.0; });
  const Image distance = distance_to(mask);
  for (int y = 0; y < 17; ++y) {
    for (int x = 0; x < 23; ++x) {
      double nearest = std::numeric_limits<double>::infinity();
      for (int j = 0; j < 17; ++j) {
        for (int i = 0; i < 23; ++i) {
          if (mask.at(i, j) == 1) nearest = std::min(nearest, std::hypot(i - x, j - y));
        }
      }
      EXPECT_NEAR(distance.at(x, y), nearest, 1e-12);
    }
  }
  const Image none = distance_to(made(3, 2, [](int, int) { return 0.0; }));
  for (const double d : none.values) EXPECT_TRUE(std::isinf(d));
}

TEST(Termination, IsTheCurvatureOfCircles) {
  // Lines of equal grey of r² are circles of curvature 1/r.
  const Image bowl =
      made(61, 61, [](int x, int y) { return (x - 30) * (x - 30) + (y - 30) * (y - 30); });
  const Image curvature = termination(bowl);
  EXPECT_NEAR(curvature.at(50, 30), 1 / 20.0, 1e-12);
  EXPECT_NEAR(curvature.at(42, 46), 1 / 20.0, 1e-12);
}

TEST(ImagePotential, DrawsToCornersByTheirCurvature) {
  Image square{60, 60, std::vector<double>(3600, 0)};
  for (int y = 20; y < 40; ++y) {
    for (int x = 20; x < 40; ++x) square.at(x, y) = 1;
  }
  const auto potential =
      ImagePotential::create(square, {.smoothing = 2, .edge = 0, .termination = -1});
  ASSERT_TRUE(potential);
  double most = 0, x = 0,
         y = 0;  // the weight is negative: lines of equal grey around what is bright curve that way
  for (int j = 15; j < 45; ++j) {
    for (int i = 15; i < 45; ++i) {
      if (potential->value(i, j) <= most) continue;
      most = potential->value(i, j);
      x = i;
      y = j;
    }
  }
  EXPECT_GT(most, 0.1);
  EXPECT_LT(std::abs(potential->value(19.5, 30)), 0.1 * most);      // the middle of a side
  EXPECT_LE(std::abs(std::abs(x - 29.5) - std::abs(y - 29.5)), 1);  // on a diagonal
}

TEST(GradientVectorFlow, PointsToAnEdgeFromFarAway) {
  const Image edge = made(101, 21, [](int x, int) { return std::exp(-(x - 20) * (x - 20) / 4.0); });
  const auto flow = gradient_vector_flow(edge, 0.2, 3000);
  EXPECT_LT(flow[0].at(60, 10),
            0);  // 40 pixels to the right of it, where the slope of the edge is 1e-173
  EXPECT_GT(flow[0].at(2, 10), 0);
  EXPECT_NEAR(flow[1].at(60, 10), 0, 1e-12);
}

TEST(ImagePotential, RefusesWhatItCannotUse) {
  const Image image = noise(8, 6);
  EXPECT_EQ(ImagePotential::create({0, 0, {}}).error().where, "image");
  EXPECT_EQ(ImagePotential::create({2, 2, {1, 2, 3}}).error().where, "image");
  EXPECT_EQ(ImagePotential::create({2, 1, {1, NAN}}).error().where, "pixel 1");
  EXPECT_EQ(ImagePotential::create(image, {.smoothing = -1}).error().where, "smoothing");
  EXPECT_EQ(ImagePotential::create(image, {.edge = INFINITY}).error().where, "edge");
  EXPECT_EQ(ImagePotential::create(image, {.distance = 1}).error().where, "mask");
  EXPECT_EQ(ImagePotential::create(image, {.distance = 1}, noise(3, 3)).error().where, "mask");
}

}  // namespace
}  // namespace knead
