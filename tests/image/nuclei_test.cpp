// Nuclei under a microscope against the outlines that biologists drew.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include "knead/image/image.hpp"
#include "knead/image/snake.hpp"
#include "knead/image/snake_script.hpp"
#include "knead/image_file.hpp"
#include "support/foreign_files.hpp"

namespace knead {
namespace {

struct Nucleus {
  double x = 0, y = 0, area = 0;  ///< centre and pixels
  bool touches = false;           ///< another, also by a corner
};

class Nuclei : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path picture = testing::foreign("data/images/stardist_img2d.png"),
                                mask = testing::foreign("data/images/stardist_mask2d.png");
    KNEAD_NEEDS((std::vector{picture, mask}));
    image = *cli::read_image(picture.string());
    labels = *cli::read_image(mask.string());
    std::map<int, Nucleus> all;
    for (int y = 0; y < labels.height; ++y) {
      for (int x = 0; x < labels.width; ++x) {
        if (label(x, y) == 0) continue;
        Nucleus& n = all[label(x, y)];
        n.x += x;
        n.y += y;
        ++n.area;
        n.touches = n.touches || has_neighbour(x, y);
      }
    }
    for (auto& [l, n] : all) {
      if (n.area <= 60 || n.touches) continue;
      n.x /= n.area;
      n.y /= n.area;
      alone[l] = n;
    }
  }
  int label(int x, int y) const { return static_cast<int>(std::lround(labels.at(x, y) * 65535)); }
  bool has_neighbour(int x, int y) const {
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, labels.height - 1); ++j) {
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, labels.width - 1); ++i) {
        if (label(i, j) != 0 && label(i, j) != label(x, y)) return true;
      }
    }
    return false;
  }
  /// Dice of a contour with each nucleus that it meets.
  std::map<int, double> dice(const SnakeResult& snake) const {
    const Image mask = mask_of(snake, image.width, image.height);
    std::map<int, double> both;
    double inside = 0;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        if (mask.at(x, y) == 0) continue;
        ++inside;
        ++both[label(x, y)];
      }
    }
    std::map<int, double> result;
    for (const auto& [l, n] : both) {
      const auto nucleus = alone.find(l);
      if (nucleus != alone.end()) result[l] = 2 * n / (inside + nucleus->second.area);
    }
    return result;
  }

  Image image, labels;
  std::map<int, Nucleus> alone;  ///< those of more than 60 pixels that touch no other
};

/// One for all of them; as a script it is in docs/snakes.md.
constexpr const char* settings = R"("image":{"smoothing":1,"region":1,"relative_region":true},
  "settings":{"control_points":10,"units":100,"alpha":0.1,"beta":5,"gamma":1,
  "band":8,"motion":0.02,"max_iterations":500})";

Expected<std::vector<SnakeResult>> run(const Image& image, const SnakeScript& script) {
  const auto potential = ImagePotential::create(image, script.image);
  const auto starts = starts_of(script, image);
  if (!starts) return std::unexpected(starts.error());
  std::vector<Curve> curves;
  for (const SnakeStart& start : *starts) {
    curves.push_back(*curve_through(*points_of(start), settings_of(script, start)));
  }
  return run_snakes(*potential, curves, std::vector<SnakeSettings>(curves.size(), script.settings));
}

TEST_F(Nuclei, AreFoundFromCirclesOfHalfTheirSize) {
  SnakeScript script =
      *parse_snake_script(fmt::format(R"({{"knead":2,{},"snakes":[{{}}]}})", settings));
  script.snakes.clear();
  for (const auto& [l, n] : alone) {
    const double radius = std::sqrt(n.area / std::numbers::pi) / 2;
    script.snakes.push_back({.centre = {n.x, n.y}, .radii = {radius, radius}});
  }
  ASSERT_EQ(alone.size(), 79U);
  const auto snakes = run(image, script);
  ASSERT_TRUE(snakes) << snakes.error().message();
  double sum = 0;
  int resting = 0, crossed = 0;
  std::size_t k = 0;
  for (const auto& [l, n] : alone) {
    const SnakeResult& snake = (*snakes)[k++];
    const auto found = dice(snake);
    sum += found.contains(l) ? found.at(l) : 0;
    resting += snake.converged;
    crossed += crossings(snake) > 0;
  }
  RecordProperty("mean_dice", fmt::format("{}", sum / 79));
  EXPECT_GE(sum / 79, 0.92);
  EXPECT_EQ(crossed, 0);
  EXPECT_GE(resting, 60);
}

TEST_F(Nuclei, AreFoundWithoutKnowingWhereTheyAre) {
  const SnakeScript script = *parse_snake_script(
      fmt::format(R"({{"knead":2,{},"blobs":{{"radii":[7,14],"contrast":0.05}}}})", settings));
  const auto snakes = run(image, script);
  ASSERT_TRUE(snakes) << snakes.error().message();
  std::map<int, double> best;
  for (const SnakeResult& snake : *snakes) {
    for (const auto& [l, d] : dice(snake)) best[l] = std::max(best[l], d);
  }
  double sum = 0;
  for (const auto& [l, d] : best) sum += d;
  RecordProperty("mean_dice", fmt::format("{}", sum / 79));
  EXPECT_GE(sum / 79, 0.9);
  EXPECT_LE(snakes->size(), 125U);  // nuclei in all
}

}  // namespace
}  // namespace knead
