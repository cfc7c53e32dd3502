// Images of the collection against the references beside them: what scikit-image finds, and silhouettes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "knead/image/snake.hpp"
#include "knead/image_file.hpp"

namespace knead {
namespace {

using Places = std::vector<std::array<double, 2>>;

class RealImage : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(directory())) GTEST_SKIP() << "the collection of images is not there";
  }
  static std::string directory() { return std::string(KNEAD_SHARED_DIR) + "/data/images/"; }
  static Image read(const std::string& name) {
    const auto image = cli::read_image(directory() + name);
    EXPECT_TRUE(image) << name;
    return image ? *image : Image{};
  }
};

Places ellipse(double x, double y, double a, double b) {
  Places places;
  for (int k = 0; k < 400; ++k) {
    const double t = 2 * std::numbers::pi * k / 400;
    places.push_back({x + a * std::cos(t), y + b * std::sin(t)});
  }
  return places;
}

/// A reference contour: rows and columns.
Places reference(const std::string& file) {
  std::ifstream in(file);
  Places places;
  for (std::string line; std::getline(in, line);) {
    const std::size_t comma = line.find(',');
    if (line.empty() || line.front() == '#' || comma == line.npos) continue;
    places.push_back({std::stod(line.substr(comma + 1)), std::stod(line)});
  }
  return places;
}

double distance(const std::array<double, 2>& p, const Places& line, bool closed) {
  double nearest = 1e9;
  for (std::size_t k = 0; k + (closed ? 0 : 1) < line.size(); ++k) {
    const auto &a = line[k], &b = line[(k + 1) % line.size()];
    const double dx = b[0] - a[0], dy = b[1] - a[1], q = dx * dx + dy * dy;
    const double r = q > 0 ? std::clamp(((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / q, 0.0, 1.0) : 0;
    nearest = std::min(nearest, std::hypot(a[0] + r * dx - p[0], a[1] + r * dy - p[1]));
  }
  return nearest;
}

/// The mean of the mean distances of each from the other.
double mean_distance(const Places& a, const Places& b, bool closed) {
  double there = 0, back = 0;
  for (const auto& p : a) there += distance(p, b, closed) / static_cast<double>(a.size());
  for (const auto& p : b) back += distance(p, a, closed) / static_cast<double>(b.size());
  return (there + back) / 2;
}

SnakeResult run(const Image& image, const ImagePotentialSettings& energies, const Places& start,
                const SnakeSettings& settings) {
  const auto potential = ImagePotential::create(image, energies);
  EXPECT_TRUE(potential);
  auto curve = curve_through(start, settings);
  EXPECT_TRUE(curve);
  auto snakes = run_snakes(*potential, {*curve}, {settings});
  EXPECT_TRUE(snakes);
  return snakes->front();
}

// scikit-image's examples: their finite differences count the parameter in points, 400 around the face and 99 along the
// text.

TEST_F(RealImage, TheFaceIsTheOneThatScikitImageFinds) {
  const SnakeSettings settings{.control_points = 50, .units = 400, .alpha = 0.015, .beta = 10, .gamma = 0.001};
  const SnakeResult snake =
      run(read("astronaut.png"), {.smoothing = 3, .edge = 1}, ellipse(220, 100, 100, 100), settings);
  EXPECT_TRUE(snake.converged);
  EXPECT_EQ(crossings(snake), 0);
  EXPECT_LT(mean_distance(polyline(snake), reference(directory() + "ref_astronaut.csv"), true), 1);
}

TEST_F(RealImage, TheLineOfTextIsTheOneThatScikitImageFinds) {
  const SnakeSettings settings{
      .closed = false, .control_points = 50, .units = 99, .alpha = 0.1, .beta = 1, .gamma = 0.1};
  const SnakeResult snake =
      run(read("text.png"), {.smoothing = 1, .line = -5, .edge = 0}, {{5, 136}, {424, 50}}, settings);
  EXPECT_TRUE(snake.converged);
  EXPECT_LT(mean_distance(polyline(snake), reference(directory() + "ref_text_fixed.csv"), false), 1);
}

TEST_F(RealImage, TheLineWithFreeEndsIsTheOneThatScikitImageFinds) {
  // Its free ends are not drawn in by the stretch of the snake, which is what
  // `end_tension` is for; by the natural conditions of the energy it would contract.
  const SnakeSettings settings{.closed = false,
                               .control_points = 50,
                               .units = 99,
                               .alpha = 0.1,
                               .beta = 1,
                               .gamma = 0.1,
                               .hold_ends = false,
                               .end_tension = 1};
  const SnakeResult snake =
      run(read("text.png"), {.smoothing = 3, .line = -5, .edge = 0}, {{5, 70}, {424, 40}}, settings);
  EXPECT_TRUE(snake.converged);
  EXPECT_LT(mean_distance(polyline(snake), reference(directory() + "ref_text_free.csv"), false), 0.5);
}

TEST_F(RealImage, TheHorseIsFoundFromItsBoundingEllipse) {
  const Image image = read("horse.png");
  int left = image.width, right = 0, top = image.height, bottom = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (image.at(x, y) > 0.5) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  const SnakeSettings settings{
      .control_points = 100, .units = 1000, .alpha = 0.05, .beta = 0.5, .gamma = 0.1, .motion = 0.05};
  const SnakeResult snake =
      run(image, {.smoothing = 2, .edge = 0, .region = 1},
          ellipse((left + right) / 2.0, (top + bottom) / 2.0, (right - left) / 2.0, (bottom - top) / 2.0), settings);
  EXPECT_TRUE(snake.converged);
  EXPECT_EQ(crossings(snake), 0);
  const Image mask = mask_of(snake, image.width, image.height);
  double both = 0, sum = 0;
  for (std::size_t k = 0; k < mask.values.size(); ++k) {
    const bool inside = mask.values[k] > 0.5, horse = image.values[k] <= 0.5;
    both += inside && horse;
    sum += inside + horse;
  }
  EXPECT_GE(2 * both / sum, 0.97);
}

}  // namespace
}  // namespace knead
