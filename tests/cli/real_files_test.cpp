#include <algorithm>
#include <cmath>

#include "program.hpp"

namespace knead::testing {
namespace {

// Scripts with nothing but defaults on files from real CAD systems.

std::vector<std::string> step_files() {
  std::vector<std::string> files;
  const std::filesystem::path collection = std::filesystem::path(KNEAD_SHARED_DIR) / "data/cad";
  if (!std::filesystem::exists(collection)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(collection)) {
    if (entry.path().extension() == ".stp" || entry.path().extension() == ".step") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

TEST(RealFiles, KeepEveryByteUnderAnEmptyScript) {
  const std::vector<std::string> files = step_files();
  if (files.empty()) GTEST_SKIP() << "no collection of CAD files beside the project";
  const Workshop workshop;
  const std::string script = workshop.script(Json::array()), out = workshop / "out.step";
  for (const std::string& file : files) {
    EXPECT_EQ(knead({"sculpt", file, "-o", out, "--script", script}).code, 0) << file;
    EXPECT_TRUE(identical(content_of(out), content_of(file))) << file;
  }
}

TEST(RealFiles, TheReportHasTheAnglesAtASmoothEdgeThatFollows) {
  const std::string file = std::filesystem::path(KNEAD_SHARED_DIR) / "data/cad/NIST_MBE_PMI_5.stp";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no collection of CAD files beside the project";
  const Workshop workshop;
  const std::string out = workshop / "out.step", report = workshop / "report.json";
  const Json commands = {command("select", {{"surfaces", {"#2649", "#2692"}}}), command("hold", {{"mode", "trim"}}),
                         command("edge", {{"which", "#1831"}, {"hold", "follow"}}), command("step")};
  const Outcome run = knead({"sculpt", file, "-o", out, "--script", workshop.script(commands), "--report", report});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("edge #1831 follows smoothly"), std::string::npos) << run.out;
  int found = 0;
  const Json result = Json::parse(content_of(report));
  for (const Json& surface : result.at("edges")) {
    for (const Json& edge : surface.at("edges")) {
      EXPECT_EQ(edge.contains("angle"), edge.at("id") == "#1831");
      if (!edge.contains("angle")) continue;
      ++found;
      EXPECT_LT(edge.at("angle_before").get<double>(), 1e-9);
      EXPECT_LT(edge.at("angle").get<double>(), 1e-3);
    }
  }
  EXPECT_EQ(found, 2) << "once for each surface";
}

TEST(RealFiles, IgesFilesAreListedAndKept) {
  const std::string file = std::filesystem::path(KNEAD_SHARED_DIR) / "data/cad/wing128.igs";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no collection of CAD files beside the project";
  const Json info = knead({"info", file, "--json"}).json();
  EXPECT_EQ(info.at("format"), "IGES");
  EXPECT_EQ(info.at("units"), "inch");
  EXPECT_EQ(info.at("surfaces").size(), 2U);
  const Json& remarks = info.at("remarks");
  EXPECT_NE(std::ranges::find(remarks, "2 x 128 (B-spline surface)"), remarks.end()) << remarks;
  const Workshop workshop;
  const std::string script = workshop.script(Json::array()), out = workshop / "out.igs";
  EXPECT_EQ(knead({"sculpt", file, "-o", out, "--script", script}).code, 0);
  EXPECT_TRUE(identical(content_of(out), content_of(file)));
  EXPECT_TRUE(fails_with(knead({"sculpt", file, "-o", workshop / "out.step", "--script", script}), 2,
                         {"--output", "IGES", ".igs, .iges"}));
}

TEST(RealFiles, APartOfAnAssemblyChangesInAllItsPlaces) {
  const std::string file = std::filesystem::path(KNEAD_SHARED_DIR) / "data/cad/as1-oc-214.stp";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no collection of CAD files beside the project";
  const Json parts = knead({"info", file, "--json"}).json().at("assembly").at("parts");
  const auto nut = std::ranges::find_if(parts, [](const Json& part) { return part.at("name") == "nut"; });
  ASSERT_NE(nut, parts.end());
  ASSERT_EQ(nut->at("places").size(), 8U);
  const Workshop workshop;
  const std::string out = workshop / "out.step", report = workshop / "report.json";
  const Json commands = {command("select", {{"surface", nut->at("surfaces")[0]}}), command("hold", {{"mode", "free"}}),
                         command("tool", {{"radius", 0.1}, {"relative", true}, {"at", {0.4, 0.45}}}),
                         command("move", {{"by", {0.03, 0.04, 0.05}}, {"relative", true}}),
                         command("step", {{"lambda", 10}})};
  const Outcome run = knead({"sculpt", file, "-o", out, "--script", workshop.script(commands), "--report", report});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("its part \"nut\" stands in 8 places of the assembly"), std::string::npos) << run.out;
  const Json places = Json::parse(content_of(report)).at("places");
  ASSERT_EQ(places.size(), 1U);
  EXPECT_EQ(places[0].at("surface"), nut->at("surfaces")[0]);
  EXPECT_EQ(places[0].at("places"), 8);
  const Json after = knead({"info", out, "--json"}).json().at("assembly");
  EXPECT_EQ(after.at("parts"), parts) << "placements stay";
}

TEST(RealFiles, TakeADentInTheirFirstSurface) {
  const std::vector<std::string> files = step_files();
  if (files.empty()) GTEST_SKIP() << "no collection of CAD files beside the project";
  const Workshop workshop;
  const std::string out = workshop / "out.step", report = workshop / "report.json";
  for (const std::string& file : files) {
    const Json surfaces = knead({"info", file, "--json"}).json().at("surfaces");
    if (surfaces.empty()) continue;
    const Json& s = surfaces.front();
    if (file.ends_with("simple_wing.stp")) continue;  // its first surface is collapsed to a line
    const Json commands = {command("select", {{"surface", s.at("id")}}), command("hold", {{"rows", 1}}),
                           command("tool", {{"radius", 0.1}, {"relative", true}, {"at", {0.4, 0.45}}}),
                           command("move", {{"by", {0.03, 0.04, 0.05}}, {"relative", true}}),
                           command("step", {{"lambda", 10}})};
    const Outcome run = knead({"sculpt", file, "-o", out, "--script", workshop.script(commands), "--report", report});
    ASSERT_EQ(run.code, 0) << file << ": " << run.err;
    const Json result = Json::parse(content_of(report));
    const bool all_held = s.at("net").at(0) <= 2 || s.at("net").at(1) <= 2;
    double size = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double side = s.at("bounding_box")[1][c].get<double>() - s.at("bounding_box")[0][c].get<double>();
      size += side * side;
    }
    const double largest = result.at("largest_displacement");
    EXPECT_EQ(largest > 0, !all_held) << file;
    EXPECT_LT(largest, 0.2 * std::sqrt(size)) << file << ": a ball of a tenth leaves no larger dent";
    EXPECT_TRUE(result.at("residual").is_number()) << file;
    EXPECT_TRUE(result.at("energy_after").is_number()) << file;
  }
}

}  // namespace
}  // namespace knead::testing
