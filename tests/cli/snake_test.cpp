#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <thread>

#include "knead/image_file.hpp"
#include "program.hpp"

namespace knead::testing {
namespace {

/// A bright disc of radius 20 around (40, 34).
std::string disc() {
  Image image{90, 70, {}};
  for (int y = 0; y < 70; ++y) {
    for (int x = 0; x < 90; ++x)
      image.values.push_back(std::hypot(x - 40, y - 34) < 20 ? 0.9 : 0.1);
  }
  const auto png = cli::png_of(image);
  return png ? *png : std::string();
}

class SnakeCommand : public ::testing::Test {
 protected:
  std::string file(const std::string& name) { return (directory_ / name).string(); }
  void SetUp() override {
    std::filesystem::create_directories(directory_);
    std::ofstream(file("disc.png"), std::ios::binary) << disc();
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

 private:
  std::filesystem::path directory_ =
      std::filesystem::temp_directory_path() /
      (std::string("knead_snake_") +
       ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

std::string contents(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(SnakeCommand, FindsADiscWithoutAScript) {
  const Outcome out =
      knead({"snake", file("disc.png"), "-o", file("contour.json"), "--mask", file("mask.png")});
  ASSERT_EQ(out.code, 0) << out.err;
  const Json json = Json::parse(contents(file("contour.json")));
  EXPECT_EQ(json.at("width"), 90);
  const Json& snake = json.at("snakes").at(0);
  EXPECT_EQ(snake.at("closed"), true);
  EXPECT_EQ(snake.at("crossings"), 0);
  EXPECT_NEAR(snake.at("area").get<double>(), 3.14159265 * 400, 25);
  EXPECT_EQ(snake.at("knots").size(), snake.at("control_points").size() + 4);
  const auto mask = cli::read_image(file("mask.png"));
  ASSERT_TRUE(mask);
  EXPECT_EQ(mask->at(40, 34), 1);
  EXPECT_EQ(mask->at(5, 5), 0);
}

TEST_F(SnakeCommand, RunsAScriptAndWritesPointsAndDrawings) {
  std::ofstream(file("script.json"))
      << R"({"knead":2,"image":{"region":1,"smoothing":1},"settings":{"alpha":0.01,"beta":0.1,)"
         R"("gamma":0.2,"units":100},)"
      << R"("snakes":[{"shape":"ellipse","centre":[40,34],"radii":8,"control_points":16}]})";
  for (const char* name : {"contour.csv", "contour.svg"}) {
    const Outcome out =
        knead({"snake", file("disc.png"), "--script", file("script.json"), "-o", file(name)});
    ASSERT_EQ(out.code, 0) << out.err;
    EXPECT_NE(out.out.find("16 control points"), std::string::npos) << out.out;
  }
  EXPECT_EQ(contents(file("contour.csv")).substr(0, 10), "snake,x,y\n");
  EXPECT_NE(contents(file("contour.svg")).find("<polygon points="), std::string::npos);
}

TEST_F(SnakeCommand, StartsAtBlobs) {
  std::ofstream(file("script.json"))
      << R"({"knead":2,"channel":"red","image":{"relative_region":true},)"
      << R"("settings":{"control_points":12,"alpha":0.1,"beta":5,"gamma":1,"units":100,"band":8},)"
      << R"("blobs":{"radii":[10,30],"contrast":0.2}})";
  const Outcome out = knead(
      {"snake", file("disc.png"), "--script", file("script.json"), "-o", file("contour.json")});
  ASSERT_EQ(out.code, 0) << out.err;
  const Json json = Json::parse(contents(file("contour.json")));
  ASSERT_EQ(json.at("snakes").size(), 1U);
  EXPECT_NEAR(json.at("snakes").at(0).at("area").get<double>(), 3.14159265 * 400, 25);
}

TEST_F(SnakeCommand, ReadsAPipeOnceFromItsStart) {
  const std::string bytes = disc();
  ASSERT_LT(bytes.size(), 65536U) << "the pipe holds all of it";
  std::array<int, 2> ends = {};
  ASSERT_EQ(pipe(ends.data()), 0);
  ASSERT_EQ(write(ends[1], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  close(ends[1]);
  const Outcome out =
      knead({"snake", "/dev/fd/" + std::to_string(ends[0]), "-o", file("piped.svg")});
  close(ends[0]);
  ASSERT_EQ(out.code, 0) << out.err;
  ASSERT_EQ(knead({"snake", file("disc.png"), "-o", file("read.svg")}).code, 0);
  EXPECT_EQ(contents(file("piped.svg")), contents(file("read.svg")));
}

TEST_F(SnakeCommand, ReadsANamedPipeOnce) {
  ASSERT_EQ(mkfifo(file("fifo").c_str(), 0600), 0);
  std::thread writer([this] { std::ofstream(file("fifo"), std::ios::binary) << disc(); });
  const Outcome out = knead({"snake", file("fifo"), "-o", file("contour.svg")});
  // Lets the writer go where nobody read.
  const int reader = open(file("fifo").c_str(), O_RDONLY | O_NONBLOCK);
  writer.join();
  close(reader);
  EXPECT_EQ(out.code, 0) << out.err;
  EXPECT_TRUE(std::filesystem::exists(file("contour.svg")));
}

TEST_F(SnakeCommand, SaysWhatIsWrong) {
  EXPECT_TRUE(fails_with(knead({"snake", file("none.png")}), 3, {"none.png"}));
  EXPECT_TRUE(
      fails_with(knead({"snake", file("disc.png"), "-o", file("contour.txt")}), 2, {".csv"}));
  EXPECT_TRUE(fails_with(knead({"snake", file("disc.png"), "--mask", file("mask.jpg")}), 2,
                         {"--mask", ".png"}));
  EXPECT_FALSE(std::filesystem::exists(file("mask.jpg")));
  std::ofstream(file("bad.json")) << R"({"knead":2,"snakes":[{"radius":3}]})";
  EXPECT_TRUE(
      fails_with(knead({"snake", file("disc.png"), "--script", file("bad.json")}), 3, {"radii"}));
  std::ofstream(file("empty.json")) << R"({"knead":2,"snakes":[]})";
  EXPECT_TRUE(fails_with(knead({"snake", file("disc.png"), "--script", file("empty.json")}), 3,
                         {"no snake"}));
  std::ofstream(file("none.json")) << R"({"knead":2,"blobs":{"contrast":2}})";
  EXPECT_TRUE(fails_with(knead({"snake", file("disc.png"), "--script", file("none.json")}), 3,
                         {"blobs", "contrast"}));
  std::ofstream(file("text.png")) << "no image";
  EXPECT_TRUE(fails_with(knead({"snake", file("text.png")}), 3, {"PNG"}));
}

}  // namespace
}  // namespace knead::testing
