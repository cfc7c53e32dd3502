#include "knead/image/volume.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "image/volume_fixtures.hpp"

namespace knead {
namespace {

using testing::blurred;

VolumeImage noise(std::array<int, 3> size, const VolumeFrame& frame = {}) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> grey(0, 1);
  VolumeImage volume{size, {}, frame};
  volume.values.resize(static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
                       static_cast<std::size_t>(size[2]));
  for (double& x : volume.values) x = grey(random);
  return volume;
}

/// Steps of 0.5, 1 and 2 along turned axes, and with `sheared` not perpendicular.
VolumeFrame oblique(bool sheared = false) {
  VolumeFrame frame;
  frame.origin = {3, -2, 7};
  frame.directions = Eigen::AngleAxisd(0.7, Point(1, 2, 3).normalized()).toRotationMatrix() *
                     Eigen::Vector3d(0.5, 1, 2).asDiagonal();
  if (sheared) frame.directions.col(2) += 0.3 * frame.directions.col(1);
  return frame;
}

TEST(Volume, SplineGoesThroughTheVoxelsAndItsGradientIsItsDerivative) {
  const VolumeImage volume = noise({9, 7, 5});
  const VolumeSpline spline(volume);
  for (int k = 0; k < 5; ++k) {
    for (int j = 0; j < 7; ++j) {
      for (int i = 0; i < 9; ++i)
        EXPECT_NEAR(spline.value({i * 1.0, j * 1.0, k * 1.0}), volume.at(i, j, k), 1e-14);
    }
  }
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> part(0.01, 0.99);
  for (int trial = 0; trial < 100; ++trial) {
    const Point at(8 * part(random), 6 * part(random), 4 * part(random));
    const Eigen::Vector3d g = spline.gradient(at);
    for (int d = 0; d < 3; ++d) {
      Point step = Point::Zero();
      step[d] = 1e-5;
      // The second-order difference is off by h²/6 of the third derivative, which is below 1e3
      // here.
      EXPECT_NEAR(g[d], (spline.value(at + step) - spline.value(at - step)) / 2e-5, 1e-7);
    }
  }
}

TEST(Volume, SplineIsSmoothAcrossVoxelsAndEndsLevelAtTheBorder) {
  const VolumeSpline spline(noise({6, 6, 6}));
  const double tiny = 1e-12;
  for (double x = 1; x < 5; ++x) {
    const Point before(x - tiny, 2.3, 3.6), after(x + tiny, 2.3, 3.6);
    EXPECT_NEAR((spline.gradient(before) - spline.gradient(after)).norm(), 0, 1e-9);
  }
  EXPECT_EQ(spline.value({-4, 2, 2}), spline.value({0, 2, 2}));
  EXPECT_EQ(spline.gradient({-4, 2.5, 2})[0], 0);
  EXPECT_NE(spline.gradient({-4, 2.5, 2})[1], 0);
  EXPECT_NEAR(VolumeSpline(VolumeImage{{1, 1, 1}, {5}, {}}).value({0, 0, 0}), 5, 1e-14);
}

TEST(Volume, GaussianIsThatOfSpaceWhateverTheSpacing) {
  // A blurred edge is blurred more: variances add up, along a direction that lies across all axes.
  const VolumeFrame frame = oblique();
  const Eigen::Vector3d across = Point(2, 1, -1).normalized();
  const auto edge = [&](const Point& p) {
    return (p - frame.origin - frame.directions * Point(30, 15, 8)).dot(across);
  };
  const VolumeImage once = gaussian(blurred({60, 30, 16}, frame, 2.5, edge), 1.5),
                    wanted = blurred({60, 30, 16}, frame, std::hypot(2.5, 1.5), edge);
  // The Gaussian is cut at 4 σ, and the coarse step of 2 samples one of σ 1.5: e^(−2 π² 0.75²) of
  // it is missed.
  for (int i = 20; i < 40; ++i) EXPECT_NEAR(once.at(i, 15, 8), wanted.at(i, 15, 8), 1e-3);
}

TEST(Volume, GradientIsThatOfSpaceWhateverTheSteps) {
  for (const bool sheared : {false, true}) {
    const VolumeFrame frame = oblique(sheared);
    VolumeImage ramp{{20, 20, 20}, {}, frame};
    const Eigen::Vector3d slope(0.3, -0.2, 0.5);
    for (int k = 0; k < 20; ++k) {
      for (int j = 0; j < 20; ++j) {
        for (int i = 0; i < 20; ++i)
          ramp.values.push_back(slope.dot(frame.directions * Point(i, j, k)));
      }
    }
    const auto g = gradient(ramp);
    for (int d = 0; d < 3; ++d)
      EXPECT_NEAR(g[static_cast<std::size_t>(d)].at(10, 10, 10), slope[d], 1e-4);
    EXPECT_NEAR(gradient_magnitude(ramp).at(10, 10, 10), slope.norm(), 1e-4);
    EXPECT_EQ(frame.orthogonal(), !sheared);
  }
}

TEST(Volume, CurvatureOfSurfacesOfEqualGreyIsThatOfTheSphere) {
  const VolumeImage ball = testing::blurred_ball(40, {20, 20, 20}, 12, 3);
  // Two principal curvatures 1/r each; grey falls outwards, which gives the sign.
  EXPECT_NEAR(termination(ball).at(32, 20, 20), -2.0 / 12, 2e-3);
}

TEST(Volume, DistanceIsExactForAnySpacing) {
  const VolumeFrame frame = oblique();
  VolumeImage mask{{12, 9, 7}, std::vector<double>(12 * 9 * 7, 0), frame};
  const std::vector<std::array<int, 3>> set = {{1, 2, 3}, {10, 8, 0}, {6, 0, 6}};
  for (const auto& [i, j, k] : set) mask.at(i, j, k) = 1;
  const VolumeImage distance = distance_to(mask);
  for (int k = 0; k < 7; ++k) {
    for (int j = 0; j < 9; ++j) {
      for (int i = 0; i < 12; ++i) {
        double nearest = 1e9;
        for (const auto& [a, b, c] : set) {
          nearest = std::min(nearest, (frame.directions * Point(i - a, j - b, k - c)).norm());
        }
        EXPECT_NEAR(distance.at(i, j, k), nearest, 1e-12);
      }
    }
  }
}

TEST(Volume, FlowReachesFarFromEdges) {
  const VolumeImage edges = gradient_magnitude(testing::blurred_ball(40, {20, 20, 20}, 12, 1));
  const auto plain = gradient(edges), flow = gradient_vector_flow(edges, 0.2, 300);
  const auto outwards = [](const std::array<VolumeImage, 3>& v, int i) {
    return v[0].at(i, 20, 20);
  };
  // Five voxels from the edge hardly a gradient is left.
  EXPECT_LT(std::abs(outwards(plain, 27)), 1e-3);
  EXPECT_GT(outwards(flow, 27), 0.1);
  EXPECT_LT(outwards(flow, 37), -0.1);
}

TEST(VolumePotential, ForceIsTheGradientOfItsValueInSpace) {
  for (const bool sheared : {false, true}) {
    const VolumeFrame frame = oblique(sheared);
    const auto image = VolumePotential::create(
        noise({12, 10, 8}, frame), {.smoothing = 1, .line = 0.5, .edge = 1, .termination = 0.1});
    ASSERT_TRUE(image) << image.error().message();
    const Point at = frame.origin + frame.directions * Point(5.3, 4.4, 3.7);
    const Eigen::Vector3d f = image->force(at);
    for (int d = 0; d < 3; ++d) {
      Point step = Point::Zero();
      step[d] = 1e-5;
      EXPECT_NEAR(f[d], (image->value(at + step) - image->value(at - step)) / 2e-5, 1e-7);
    }
  }
}

TEST(VolumePotential, SumsToTheLeftHaveTheIntensityAsTheirSlope) {
  const auto image = VolumePotential::create(testing::blurred_ball(30, {15, 15, 15}, 8, 2),
                                             {.smoothing = 0, .edge = 0, .region = 1});
  ASSERT_TRUE(image);
  for (double x = 3; x < 27; x += 0.7) {
    const Point at(x, 13.2, 16.1), step(1e-4, 0, 0);
    const double slope =
        (image->intensity_to_the_left(at + step) - image->intensity_to_the_left(at - step)) / 2e-4;
    EXPECT_NEAR(slope, image->intensity(at), 0.02);  // the trapezoidal rule's, for an edge of σ 2
  }
}

TEST(VolumePotential, RefusesWhatMakesNoSense) {
  const VolumeImage volume = noise({4, 4, 4});
  const auto refused = [](const VolumeImage& v, const ImagePotentialSettings& s,
                          const std::optional<VolumeImage>& m) {
    const auto made = VolumePotential::create(v, s, m);
    return made ? std::string("accepted") : made.error().message();
  };
  EXPECT_EQ(refused(volume, {}, {}), "accepted");
  VolumeImage bad = volume;
  bad.values[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refused(bad, {}, {}).find("voxel 5"), std::string::npos);
  bad = volume;
  bad.values.pop_back();
  EXPECT_NE(refused(bad, {}, {}).find("63 values"), std::string::npos);
  bad = volume;
  bad.frame.directions.col(2) = bad.frame.directions.col(1);
  EXPECT_NE(refused(bad, {}, {}).find("in a plane"), std::string::npos);
  EXPECT_NE(refused(volume, {.smoothing = -1}, {}).find("smoothing"), std::string::npos);
  EXPECT_NE(refused(volume, {.distance = 1}, {}).find("no mask"), std::string::npos);
  EXPECT_NE(refused(volume, {.distance = 1}, noise({4, 4, 3})).find("same size"),
            std::string::npos);
  EXPECT_NE(refused(volume, {.distance = 1}, VolumeImage{{4, 4, 4}, std::vector<double>(64, 0), {}})
                .find("no voxel"),
            std::string::npos);
  EXPECT_NE(
      refused(noise({4, 4, 4}, oblique(true)), {.distance = 1}, volume).find("not perpendicular"),
      std::string::npos);
}

}  // namespace
}  // namespace knead
