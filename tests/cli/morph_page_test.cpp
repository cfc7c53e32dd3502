// What `knead morph` reports, against closed forms, and the page that it writes of it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <regex>

#include "knead/image/image.hpp"
#include "knead/image_file.hpp"
#include "knead/spline/evaluate.hpp"
#include "program.hpp"
#include "session/schema_check.hpp"
#include "support/made_files.hpp"

namespace knead::testing {
namespace {

namespace fs = std::filesystem;

/// The square from 0 to 1, with ∂u × ∂v along z.
Surface square(int degree) {
  const auto knots = *KnotVector::clamped_uniform(degree, degree + 1);
  Points net((degree + 1) * (degree + 1), 3);
  for (int i = 0; i <= degree; ++i) {
    for (int j = 0; j <= degree; ++j)
      net.row((degree + 1) * i + j) << double(i) / degree, double(j) / degree, 0;
  }
  return *Surface::create({knots, knots}, net);
}

std::string square_file(const Workshop& workshop, int degree = 1) {
  StepBuilder b;
  b.surface(square(degree), "square");
  return workshop.file("square.step", b.forward("AUTOMOTIVE_DESIGN"));
}

Json report_of(const Workshop& workshop, const std::string& file, std::vector<std::string> how) {
  const std::string report = workshop / "report.json";
  how.insert(how.begin(), {"morph", file, "-o", workshop / "out.step", "--report", report});
  const Outcome run = knead(how);
  EXPECT_EQ(run.code, 0) << run.err;
  Json said = Json::parse(content_of(report));
  const Json& one = said.is_array() ? said[0] : said;
  EXPECT_EQ(against(one, knead({"schema", "morph"}).json(), "report"), "");
  return said;
}

// Sums of a few thousand equal numbers are off by a few thousand roundings at most.
constexpr double rounding = 1e-12;

TEST(MorphReport, AnOffsetIsItsOwnSignedMean) {
  const Workshop workshop;
  const std::string file = square_file(workshop);
  for (const double offset : {0.25, -0.125}) {
    const Json said = report_of(workshop, file, {"--space", fmt::format("0; 0; {}", offset)});
    const Json& before = said["before"];
    for (const char* field : {"mean", "rms", "of_95", "of_99", "largest"})
      EXPECT_NEAR(before[field].get<double>(), std::abs(offset), rounding) << field;
    for (const char* field : {"signed_mean", "signed_least", "signed_most"}) {
      EXPECT_NEAR(before[field].get<double>(), offset, rounding) << field;
      EXPECT_NEAR(said["after"][field].get<double>(), 0, rounding) << field;
    }
    EXPECT_EQ(said["surfaces"][0]["before"], before) << "the only surface";
    // All of the points are at one end of the histogram, or at the other.
    const auto counts = said["histogram_before"]["counts"].get<std::vector<int>>();
    EXPECT_EQ(offset > 0 ? counts.back() : counts.front(), said["used"].get<int>());
    EXPECT_NEAR(said["histogram_before"]["limit"].get<double>(), std::abs(offset), rounding);
  }
}

TEST(MorphReport, WhatSlidesAlongAFaceHasNoSignedPart) {
  const Workshop workshop;
  const Json said = report_of(workshop, square_file(workshop), {"--space", "0.3; 0.4; 0"});
  EXPECT_NEAR(said["before"]["mean"].get<double>(), 0.5, rounding);
  EXPECT_NEAR(said["before"]["signed_most"].get<double>(), 0, rounding);
  EXPECT_NEAR(said["before"]["signed_least"].get<double>(), 0, rounding);
}

TEST(MorphReport, OutwardIsAwayFromTheSolid) {
  const Workshop workshop;
  const Json said =
      report_of(workshop, workshop.file("block.step", block_file()), {"--space", "0; 0; 0.1"});
  int below = 0, upright = 0, above = 0;
  for (const Json& surface : said["surfaces"]) {
    const double mean = surface["before"]["signed_mean"].get<double>();
    if (std::abs(mean + 0.1) < rounding) ++below;  // the floor: its outward normal is −z
    if (std::abs(mean) < rounding) ++upright;      // four walls
    if (mean > 0.09) ++above;                      // two patches of the roof, which is bent
  }
  EXPECT_EQ(below, 1) << said["surfaces"].dump(1);
  EXPECT_EQ(upright, 4);
  EXPECT_EQ(above, 2);
}

TEST(MorphReport, PercentilesAreThoseOfTheData) {
  const Workshop workshop;
  std::string vectors;  // of 100 points displacements of 0.001, 0.002, … 0.1
  for (int k = 0; k < 100; ++k)
    vectors += fmt::format("{} {} 0 0 0 {}\n", 0.05 + 0.1 * (k % 10), 0.05 + 0.1 * (k / 10),
                           0.001 * (k + 1));
  const Json said = report_of(workshop, square_file(workshop),
                              {"--vectors", workshop.file("v.txt", vectors), "--tolerance", "1"});
  EXPECT_NEAR(said["before"]["of_95"].get<double>(), 0.095, rounding);
  EXPECT_NEAR(said["before"]["of_99"].get<double>(), 0.099, rounding);
  EXPECT_NEAR(said["before"]["mean"].get<double>(), 0.0505, rounding);
  EXPECT_NEAR(said["before"]["signed_least"].get<double>(), 0.001, rounding);
  EXPECT_TRUE(said["between"].is_null()) << "nothing is known between them";
  EXPECT_EQ(said["bytes_after"], fs::file_size(workshop / "out.step"));
}

/// A wave that the net is too coarse for.
TEST(MorphReport, ErrorsBetweenTheDataAreThoseOfTheFile) {
  const Workshop workshop;
  const Json said = report_of(workshop, square_file(workshop, 3),
                              {"--space", "0; 0; 0.01*sin(7*x)", "--refine", "1"});
  const Surface moved = surface_of(workshop / "out.step", said["surfaces"][0]["id"]);
  // One span in each direction has 24 lines of data; errors are measured in the middles between.
  double largest = 0, squares = 0;
  constexpr int middles = 23;
  for (int i = 1; i <= middles; ++i) {
    for (int j = 1; j <= middles; ++j) {
      const double x = i / 24.0, y = j / 24.0;
      const Point wanted(x, y, 0.01 * std::sin(7 * x));
      const double error = (*evaluate_point<2>(moved, {x, y}) - wanted).norm();
      largest = std::max(largest, error);
      squares += error * error;
    }
  }
  EXPECT_GT(largest, 1e-3);
  EXPECT_EQ(said["points_between"], middles * middles);
  EXPECT_NEAR(said["between"]["largest"].get<double>(), largest, rounding);
  EXPECT_NEAR(said["between"]["rms"].get<double>(), std::sqrt(squares / (middles * middles)),
              rounding);
}

/// Names that a page links to, in its text and in its pictures.
std::vector<std::string> links_of(const std::string& page) {
  std::vector<std::string> result;
  const std::regex link(R"(\]\(([^)#]+)\))");
  for (std::sregex_iterator at(page.begin(), page.end(), link), end; at != end; ++at)
    result.push_back((*at)[1]);
  return result;
}

double mean_of(const std::string& file, ImageChannel channel) {
  const auto image = cli::read_image(file, channel);
  EXPECT_TRUE(image) << image.error().message();
  if (!image) return 0;
  EXPECT_EQ(image->width, 2 * image->height) << "two views";
  double sum = 0;
  for (const double x : image->values) sum += x / static_cast<double>(image->values.size());
  return sum;
}

TEST(MorphPage, ItsLinksResolveAndItsPicturesShowTheDeviation) {
  const Workshop workshop;
  const std::string file = workshop.file("block.step", block_file()), page = workshop / "page";
  const Outcome run = knead({"morph", file, "-o", workshop / "out.step", "--space",
                             "0.1*(x-2); 0.1*(y-1); 0.1*z", "--page", page});
  ASSERT_EQ(run.code, 0) << run.err;
  const std::string text = content_of(page + "/README.md");
  for (const char* part : {"block.step, moved to follow data", "**Verdict:** nothing is above",
                           "| before |", "points between the data", "## By face", "left out",
                           "## Edges", "bytes of the file", "| fit |"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  const auto links = links_of(text);
  EXPECT_EQ(links.size(), 6U);
  for (const std::string& name : links) EXPECT_TRUE(fs::exists(page + "/" + name)) << name;
  EXPECT_EQ(std::distance(fs::directory_iterator(page), fs::directory_iterator()), 7);
  // The block grows: its data lie outside, which is red; afterwards nothing is missing.
  const std::string before = page + "/before.png", after = page + "/after.png";
  EXPECT_GT(mean_of(before, ImageChannel::red), mean_of(before, ImageChannel::blue) + 0.05);
  EXPECT_NEAR(mean_of(after, ImageChannel::red), mean_of(after, ImageChannel::blue), 1e-3);
  // And if it shrinks they lie inside.
  ASSERT_EQ(knead({"morph", file, "-o", workshop / "out.step", "--space",
                   "0.1*(x-2); 0.1*(y-1); 0.1*z", "--scale", "-1", "--page", page + "/"})
                .code,
            0);
  EXPECT_GT(mean_of(before, ImageChannel::blue), mean_of(before, ImageChannel::red) + 0.05);
}

TEST(MorphPage, SeveralScalesAreSeveralPages) {
  const Workshop workshop;
  const Outcome run = knead({"morph", square_file(workshop), "-o", workshop / "out.step", "--space",
                             "0; 0; 0.1", "--scale", "-1,0", "--page", workshop / "page"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(fs::exists(workshop / "page_-1/before.png"));
  EXPECT_NE(content_of(workshop / "page_0/README.md").find("byte for byte"), std::string::npos);
  EXPECT_FALSE(fs::exists(workshop / "page_0/before.png"));
  EXPECT_FALSE(fs::exists(workshop / "page"));
}

TEST(MorphPage, NamesOfFilesAreNoMarkdown) {
  const Workshop workshop;
  const std::string file = square_file(workshop), odd = workshop / "a|b[c](d).step";
  fs::copy_file(file, odd);
  ASSERT_EQ(knead({"morph", odd, "-o", workshop / "out.step", "--space", "0; 0; 0.1*x*1*1",
                   "--page", workshop / "page"})
                .code,
            0);
  const std::string text = content_of(workshop / "page/README.md");
  EXPECT_NE(text.find(R"(a\|b\[c\](d).step)"), std::string::npos) << text;
  EXPECT_NE(text.find(R"(0.1\*x\*1\*1)"), std::string::npos) << text;
}

TEST(MorphPage, ItReplacesNothingButItself) {
  const Workshop workshop;
  const std::string file = square_file(workshop), out = workshop / "out.step";
  const auto run = [&](const std::string& page) {
    return knead({"morph", file, "-o", out, "--space", "0; 0; 0.1", "--page", page});
  };
  EXPECT_TRUE(fails_with(run(file), 3, {"--page", "it is no directory"}));
  EXPECT_TRUE(fails_with(run(file + "/page"), 3, {"--page"}));
  fs::create_directory(workshop / "mine");
  std::ofstream(workshop / "mine/README.md") << "# Mine\n";
  std::ofstream(workshop / "mine/notes.txt") << "kept";
  EXPECT_TRUE(fails_with(run(workshop / "mine"), 3, {"--page", "README.md is there"}));
  EXPECT_EQ(content_of(workshop / "mine/README.md"), "# Mine\n");
  EXPECT_FALSE(fs::exists(out)) << "it is said before anything is done";
  fs::remove(workshop / "mine/README.md");
  EXPECT_EQ(run(workshop / "mine").code, 0);
  EXPECT_EQ(run(workshop / "mine").code, 0) << "a page is replaced";
  EXPECT_EQ(content_of(workshop / "mine/notes.txt"), "kept");
  EXPECT_EQ(std::distance(fs::directory_iterator(workshop / "mine"), fs::directory_iterator()), 8);
}

}  // namespace
}  // namespace knead::testing
