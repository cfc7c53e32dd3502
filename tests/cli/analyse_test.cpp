#include <cmath>

#include "program.hpp"

namespace knead::testing {
namespace {

const Json strut = {
    command("new", {{"size", {10, 1}}, {"degree", {4, 2}}, {"net", {12, 3}}}),
    command("edge", {{"which", "u0"}, {"hold", "tangent"}}),
    command("material", {{"model", "shell"}, {"young", 1.2e6}, {"thickness", 0.1}, {"density", 1}}),
    command("force", {{"kind", "line"}, {"edge", "u1"}, {"vector", {-0.5, 0, 0}}}),
    command("evolve", {{"mode", "static"}}),
    command("modes", {{"count", 2}}),
    command("buckling", {{"count", 1}})};

TEST(Analyse, WritesResultsAndFields) {
  const Workshop workshop;
  const Outcome run = knead({"analyse", "--new", "--script", workshop.script(strut), "--results",
                             workshop / "r.json", "--vtu", workshop / "r.vtu", "--samples", "5"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json results = Json::parse(content_of(workshop / "r.json"));
  const Json& surface = results.at("surfaces").at(0);
  EXPECT_EQ(surface.at("counts"), Json({5, 5}));
  EXPECT_EQ(surface.at("points").size(), 75U);
  EXPECT_EQ(surface.at("von_mises").size(), 50U);
  EXPECT_EQ(surface.at("mode_2").size(), 75U);
  // π² E I / (4 L²) per width beside 0.5, and the reaction to the load.
  EXPECT_NEAR(results.at("buckling").at(0).at("load_factor").get<double>(), 4.934802, 1e-5);
  EXPECT_NEAR(results.at("reactions").at(0).at("force").at(0).get<double>(), 0.5, 1e-6);
  EXPECT_NE(content_of(workshop / "r.vtu").find("Name=\"buckling_1\" NumberOfComponents=\"3\""),
            std::string::npos);
}

TEST(Analyse, NamesWhatIsWrong) {
  const Workshop workshop;
  const std::string script = workshop.script(strut), results = workshop / "r.json";
  EXPECT_EQ(knead({"analyse", "--script", script, "--results", results}).code, 2);
  EXPECT_EQ(
      knead({"analyse", "--new", "--script", script, "--results", results, "--samples", "1"}).code,
      2);
  EXPECT_EQ(knead({"analyse", "--new", "--script", script, "--results", script}).code, 2);
  EXPECT_EQ(
      knead({"analyse", "--new", "--script", workshop.script(Json::array()), "--results", results})
          .code,
      3);
}

}  // namespace
}  // namespace knead::testing
