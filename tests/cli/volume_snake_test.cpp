#include <cmath>
#include <filesystem>
#include <fstream>

#include "knead/exchange/format.hpp"
#include "knead/image/volume.hpp"
#include "program.hpp"

namespace knead::testing {
namespace {

/// A bright ball of radius 6 around (12, −4, 30) or a ring of radii 6 and 2.5, on voxels of 0.5 ×
/// 0.5 × 1.
VolumeImage bright(bool ring) {
  VolumeImage volume{{40, 40, 20}, {}, {}};
  volume.frame.directions.diagonal() << 0.5, 0.5, 1;
  volume.frame.origin << 2, -14, 20.5;
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j < 40; ++j) {
      for (int i = 0; i < 40; ++i) {
        const Point d =
            volume.frame.origin + volume.frame.directions * Point(i, j, k) - Point(12, -4, 30);
        const double out = ring ? std::hypot(std::hypot(d[0], d[1]) - 6, d[2]) - 2.5 : d.norm() - 6;
        volume.values.push_back(std::clamp(100 - 100 * out, 20.0, 180.0));
      }
    }
  }
  return volume;
}

class VolumeSnakeCommand : public ::testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& name) const {
    return (directory_ / name).string();
  }
  void SetUp() override {
    std::filesystem::create_directories(directory_);
    std::ofstream(file("ball.nrrd"), std::ios::binary) << nrrd_bytes(bright(false));
    std::ofstream(file("ring.nrrd"), std::ios::binary) << nrrd_bytes(bright(true));
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

 private:
  std::filesystem::path directory_ =
      std::filesystem::temp_directory_path() /
      (std::string("knead_volume_") +
       ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

constexpr double ball_volume = 4 * M_PI / 3 * 216;

TEST_F(VolumeSnakeCommand, FindsABallAsAnExactSurfaceAndItsMask) {
  std::ofstream(file("script.json"))
      << R"({"knead":2,"image":{"region":1},"settings":{"motion":0.05,"control_points":[14,10]},)"
      << R"("snakes":[{"centre":[13,-4,30],"radii":3}]})";
  const Outcome out = knead({"snake", file("ball.nrrd"), "--script", file("script.json"), "-o",
                             file("ball.step"), "--mask", file("mask.nrrd")});
  ASSERT_EQ(out.code, 0) << out.err;
  EXPECT_NE(out.out.find("14 x 10 control points"), std::string::npos) << out.out;
  EXPECT_NE(out.out.find("at rest"), std::string::npos) << out.out;
  EXPECT_EQ(out.out.find("crosses"), std::string::npos) << out.out;
  const auto source = open_source(bytes_of(file("ball.step")), "ball.step");
  ASSERT_TRUE(source) << source.error().message();
  ASSERT_EQ((*source)->surfaces().size(), 1U);
  const Surface& surface = *(*source)->surfaces()[0].surface;
  EXPECT_TRUE(surface.knots()[0].clamped() && surface.knots()[1].clamped());
  EXPECT_FALSE(surface.rational());
  const auto mask = read_nrrd(file("mask.nrrd"));
  ASSERT_TRUE(mask) << mask.error().message();
  EXPECT_EQ(mask->volume.frame, bright(false).frame);
  double inside = 0;
  for (const double x : mask->volume.values) inside += x * 0.25;
  EXPECT_NEAR(inside, ball_volume, 0.05 * ball_volume);
}

TEST_F(VolumeSnakeCommand, WritesNumbersAndTriangles) {
  std::ofstream(file("script.json"))
      << R"({"knead":2,"grey":[20,180],"image":{"region":1,"smoothing":0.5},)"
         R"("settings":{"motion":0.05,"alpha":0.005,"beta":0.01},)"
      << R"("snakes":[{"shape":"torus","centre":[12,-4,30],"radii":[6,1.5],)"
         R"("control_points":[20,10]}]})";
  for (const char* name : {"ring.json", "ring.stl", "ring.obj"}) {
    const Outcome out =
        knead({"snake", file("ring.nrrd"), "--script", file("script.json"), "-o", file(name)});
    ASSERT_EQ(out.code, 0) << out.err;
    EXPECT_GT(std::filesystem::file_size(file(name)), 1000U);
  }
  const Json json = Json::parse(bytes_of(file("ring.json")));
  const Json& snake = json.at("snakes").at(0);
  EXPECT_EQ(snake.at("form"), "torus");
  EXPECT_EQ(snake.at("crossings"), 0);
  // Of a torus volume / area is half the tube. The region term rests at the mean of the means,
  // which in a thin ring lies below the middle grey, that of 2.5, and above a third of the way from
  // dark to bright, that of 2.77.
  const double area = snake.at("area").get<double>(),
               tube = 2 * snake.at("volume").get<double>() / area;
  EXPECT_GT(tube, 2.5);
  EXPECT_LT(tube, 2.77);
  EXPECT_NEAR(area / (4 * M_PI * M_PI * tube), 6, 0.05);
  EXPECT_EQ(snake.at("net"), Json::parse("[23,13]"));
  EXPECT_EQ(snake.at("control_points").size(), 23U * 13U);
}

TEST_F(VolumeSnakeCommand, SaysWhatIsWrong) {
  EXPECT_TRUE(fails_with(knead({"snake", file("ball.nrrd"), "-o", file("ball.png")}), 2,
                         {".step", ".stl"}));
  std::ofstream(file("bad.json")) << R"({"knead":2,"snakes":[{"centre":[0,0,0],"radii":[1,2]}]})";
  EXPECT_TRUE(fails_with(knead({"snake", file("ball.nrrd"), "--script", file("bad.json")}), 3,
                         {"snakes[0]", "radii"}));
  std::ofstream(file("flat.json")) << R"({"knead":2,"snakes":[{"centre":[0,0],"radii":3}]})";
  EXPECT_TRUE(fails_with(knead({"snake", file("ball.nrrd"), "--script", file("flat.json")}), 3,
                         {"centre"}));
  std::ofstream(file("grey.json"))
      << R"({"knead":2,"grey":[3,3],"snakes":[{"centre":[0,0,0],"radii":3}]})";
  EXPECT_TRUE(
      fails_with(knead({"snake", file("ball.nrrd"), "--script", file("grey.json")}), 3, {"grey"}));
  std::ofstream(file("packed.nrrd"))
      << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: gzip\n\n";
  EXPECT_TRUE(fails_with(knead({"snake", file("packed.nrrd")}), 3, {"packed.nrrd", "gzip", "raw"}));
}

}  // namespace
}  // namespace knead::testing
