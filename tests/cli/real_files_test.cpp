#include <algorithm>
#include <cmath>

#include "program.hpp"
#include "support/own_files.hpp"

namespace knead::testing {
namespace {

// Scripts with nothing but defaults on files from real CAD systems.

class StepFile : public FileTest {
 protected:
  const std::string file_ = path_.string();
};

TEST_P(StepFile, KeepsEveryByteUnderAnEmptyScript) {
  const Workshop workshop;
  const std::string script = workshop.script(Json::array()), out = workshop / "out.step";
  EXPECT_EQ(knead({"sculpt", file_, "-o", out, "--script", script}).code, 0);
  EXPECT_TRUE(identical(content_of(out), content_of(file_)));
}

TEST(RealFiles, TheReportHasTheAnglesAtASmoothEdgeThatFollows) {
  const std::string file = foreign_cad("NIST_MBE_PMI_5.stp").string();
  KNEAD_NEEDS(file);
  const Workshop workshop;
  const std::string out = workshop / "out.step", report = workshop / "report.json";
  const Json commands = {command("select", {{"surfaces", {"#2649", "#2692"}}}),
                         command("hold", {{"mode", "position"}}),
                         command("edge", {{"which", "#1831"}, {"hold", "follow"}}),
                         command("step")};
  const Outcome run = knead({"sculpt", file, "-o", out, "--script",
                             workshop.script_of_all(commands), "--report", report});
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
  const std::string file = foreign_cad("wing128.igs").string();
  KNEAD_NEEDS(file);
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
  EXPECT_TRUE(fails_with(knead({"sculpt", file, "-o", workshop / "out.g2", "--script", script}), 2,
                         {"--output", "IGES", ".igs, .iges"}));
  const std::string other = workshop / "out.step";
  ASSERT_EQ(knead({"sculpt", file, "-o", other, "--script", script}).code, 0);
  const Json written = knead({"info", other, "--json"}).json();
  ASSERT_EQ(written.at("surfaces").size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(written.at("surfaces")[k].at("knots"), info.at("surfaces")[k].at("knots"));
    EXPECT_EQ(written.at("surfaces")[k].at("bounding_box"),
              info.at("surfaces")[k].at("bounding_box"));
  }
}

TEST(RealFiles, APartOfAnAssemblyChangesInAllItsPlaces) {
  const std::string file = foreign_cad("as1-oc-214.stp").string();
  KNEAD_NEEDS(file);
  const Json parts = knead({"info", file, "--json"}).json().at("assembly").at("parts");
  const auto nut =
      std::ranges::find_if(parts, [](const Json& part) { return part.at("name") == "nut"; });
  ASSERT_NE(nut, parts.end());
  ASSERT_EQ(nut->at("places").size(), 8U);
  const Workshop workshop;
  const std::string out = workshop / "out.step", report = workshop / "report.json";
  const Json commands = {
      command("select", {{"surface", nut->at("surfaces")[0]}}), command("hold", {{"mode", "open"}}),
      command("tool", {{"radius", 0.1}, {"relative", true}, {"at", {0.4, 0.45}}}),
      command("move", {{"by", {0.03, 0.04, 0.05}}, {"relative", true}}),
      command("step", {{"lambda", 10}})};
  const Outcome run = knead({"sculpt", file, "-o", out, "--script",
                             workshop.script_of_all(commands), "--report", report});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("its part \"nut\" stands in 8 places of the assembly"), std::string::npos)
      << run.out;
  const Json places = Json::parse(content_of(report)).at("places");
  ASSERT_EQ(places.size(), 1U);
  EXPECT_EQ(places[0].at("surface"), nut->at("surfaces")[0]);
  EXPECT_EQ(places[0].at("places"), 8);
  const Json after = knead({"info", out, "--json"}).json().at("assembly");
  EXPECT_EQ(after.at("parts"), parts) << "placements stay";
}

TEST_P(StepFile, TakesADentInItsFirstSurface) {
  const Json surfaces = knead({"info", file_, "--json"}).json().at("surfaces");
  if (surfaces.empty()) GTEST_SKIP() << "no B-spline surfaces";
  const Json& s = surfaces.front();
  if (GetParam() == "simple_wing.stp") GTEST_SKIP() << "its first surface is collapsed to a line";
  const Workshop workshop;
  const std::string out = workshop / "out.step", report = workshop / "report.json";
  const Json commands = {
      command("select", {{"surface", s.at("id")}}),
      command("hold", {{"mode", "open"}}),
      command("hold", {{"rows", 1}}),
      command("tool", {{"radius", 0.1}, {"relative", true}, {"at", {0.4, 0.45}}}),
      command("move", {{"by", {0.03, 0.04, 0.05}}, {"relative", true}}),
      command("step", {{"lambda", 10}})};
  const Outcome run = knead({"sculpt", file_, "-o", out, "--script",
                             workshop.script_of_all(commands), "--report", report});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json result = Json::parse(content_of(report));
  const bool all_held = s.at("net").at(0) <= 2 || s.at("net").at(1) <= 2;
  double size = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double side =
        s.at("bounding_box")[1][c].get<double>() - s.at("bounding_box")[0][c].get<double>();
    size += side * side;
  }
  const double largest = result.at("largest_displacement");
  EXPECT_EQ(largest > 0, !all_held);
  EXPECT_LT(largest, 0.2 * std::sqrt(size)) << "a ball of a tenth leaves no larger dent";
  EXPECT_TRUE(result.at("residual").is_number());
  EXPECT_TRUE(result.at("energy_after").is_number());
}

INSTANTIATE_TEST_SUITE_P(Files, StepFile, ::testing::ValuesIn(step_files()), file_test_name);

}  // namespace
}  // namespace knead::testing
