#include "program.hpp"

namespace knead::testing {
namespace {

TEST(Sculpt, SaysThatLengthsWithoutAUnitAreWrittenAsMillimetres) {
  const Workshop workshop;
  const std::string script = workshop.script(Json::array());
  const std::string square = workshop.file(
      "square.g2", "200 1 0 0\n3 0\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
  const std::string said =
      "lengths are written as millimetres: " + square + " does not say what they are";
  const Outcome other =
      knead({"sculpt", square, "-o", workshop / "square.step", "--script", script});
  ASSERT_EQ(other.code, 0) << other.err;
  EXPECT_NE(other.out.find(said), std::string::npos) << other.out;
  const Outcome same = knead({"sculpt", square, "-o", workshop / "same.g2", "--script", script});
  ASSERT_EQ(same.code, 0) << same.err;
  EXPECT_EQ(same.out.find("millimetres"), std::string::npos) << "the format has no unit";
}

TEST(Sculpt, MakesAndBendsACurve) {
  const Workshop workshop;
  const std::string script = workshop.script(
      {command("new", {{"shape", "curve"}, {"form", "helix"}, {"net", 40}, {"name", "wire"}}),
       command("edge"), command("force", {{"at", {0.5}}, {"kind", "dead"}, {"vector", {0, 0, 5}}}),
       command("step", {{"count", 4}})});
  const Outcome run = knead({"sculpt", "--new", "-o", workshop / "wire.step", "--script", script,
                             "--report", workshop / "wire.json"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("curve #1 \"wire\", lengths in mm\n  degree 3, net 40"), std::string::npos)
      << run.out;
  EXPECT_NE(run.out.find("(0 surfaces, 1 curve or volume changed)"), std::string::npos) << run.out;
  const Json report = Json::parse(content_of(workshop / "wire.json"));
  EXPECT_EQ(report.at("steps").size(), 4U);
  EXPECT_GT(report.at("largest_displacement").get<double>(), 1e-3);
  EXPECT_GT(report.at("energy_after").get<double>(), 0);
  EXPECT_NE(report.at("notes").dump().find("the helix is met to"), std::string::npos);
  const std::string written = content_of(workshop / "wire.step");
  EXPECT_NE(written.find("B_SPLINE_CURVE_WITH_KNOTS('wire',3"), std::string::npos);
  EXPECT_NE(written.find("GEOMETRIC_CURVE_SET"), std::string::npos);
}

TEST(Sculpt, ReportsWhichToolAStepEntersDeepest) {
  const Workshop workshop;
  const auto ball = [](const char* name, double height) {
    return command("tool", {{"name", name}, {"radius", 0.2}, {"position", {0.5, 0.5, height}}});
  };
  const std::string report = workshop / "report.json";
  const Json commands = {command("new"),
                         ball("far", 3),
                         ball("near", 0.1),
                         command("step"),
                         command("remove", {{"tool", "near"}}),
                         command("step")};
  const Outcome run = knead({"sculpt", "--new", "-o", workshop / "out.step", "--script",
                             workshop.script(commands), "--report", report});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json steps = Json::parse(content_of(report)).at("steps");
  EXPECT_GT(steps.at(0).at("gap").get<double>(), 0);
  EXPECT_EQ(steps.at(0).at("gap_tool"), "near");
  EXPECT_EQ(steps.at(1).at("gap"), 0);
  EXPECT_FALSE(steps.at(1).contains("gap_tool"));
}

}  // namespace
}  // namespace knead::testing
