// Messages name what is meant, where, and what would be right.
#include "less_memory.hpp"
#include "program.hpp"
#include "support/sanitized.hpp"

namespace knead::testing {
namespace {

::testing::AssertionResult refused_anew(const Json& commands, int code,
                                        const std::vector<std::string>& named,
                                        const std::string& ending = ".step") {
  const Workshop workshop;
  const Outcome run = knead({"sculpt", "--new", "-o", workshop / ("out" + ending), "--script",
                             workshop.script(commands, "script.json")});
  if (workshop.files() != std::vector<std::string>{"script.json"}) {
    return ::testing::AssertionFailure() << "files are left behind";
  }
  return fails_with(run, code, named);
}

TEST(Messages, ATornSurfaceHasItsOwnId) {
  const Json torn = command(
      "new", {{"degree", {1, 1}}, {"net", {5, 4}}, {"knots_u", {0, 0, 0.5, 0.5, 0.7, 1, 1}}});
  for (const char* ending : {".step", ".igs"}) {
    EXPECT_TRUE(refused_anew({command("new"), torn}, 3,
                             {"script.json: #2: ", "torn along a knot", "of 1"}, ending));
  }
}

TEST(Messages, WithoutASurfaceItIsSaidHowOneIsMade) {
  for (const char* ending : {".step", ".igs"}) {
    EXPECT_TRUE(
        refused_anew(Json::array(), 3, {"script.json: ", "no surface to write", "`new`"}, ending));
  }
}

TEST(Messages, MemoryThatIsNotEnoughIsCounted) {
  if (sanitized()) GTEST_SKIP() << "the sanitizer reserves more";
  Json nets = Json::array();
  for (int k = 0; k < 5; ++k) nets.push_back(command("new", {{"net", {2000, 2000}}}));
  const LessMemory limit(rlim_t{400} << 20U);
  EXPECT_TRUE(refused_anew(nets, 4, {"script.json: commands[", "400 MiB"}));
}

TEST(Messages, AtTheHighestDegreeNothingIsOffered) {
  const Json sheet = command("new", {{"degree", {25, 1}}, {"net", {26, 2}}});
  EXPECT_TRUE(refused_anew({sheet, command("elevate", {{"by", {1, 0}}})}, 3,
                           {"commands[1]", "by", "25 is the highest degree there is"}));
}

TEST(Messages, ADistanceIsRefusedInShort) {
  const Workshop workshop;
  for (const char* tolerance : {"inf", "nan", "-1", "0"}) {
    const Outcome run =
        knead({"mesh", bonnet(), "--out", workshop / "a.stl", "--tolerance", tolerance});
    EXPECT_TRUE(fails_with(run, 2, {"--tolerance", tolerance, "above 0"}));
    EXPECT_LT(run.err.size(), 200U) << run.err;
  }
}

TEST(Messages, AFileThatIsNoScriptIsCalledByItsName) {
  const Workshop workshop;
  const std::string out = workshop / "out.step", script = workshop.script(Json::array());
  const std::string empty = workshop.file("empty.json", "\n"),
                    image = workshop.file("a.png", "\x89PNG\r\n");
  for (const auto& [file, name] :
       {std::pair(bonnet(), "STEP file"), std::pair(empty, "empty"), std::pair(image, "image")}) {
    EXPECT_TRUE(fails_with(knead({"sculpt", bonnet(), "-o", out, "--script", file}), 3,
                           {file, name, "not a script"}));
    EXPECT_TRUE(fails_with(knead({"analyse", bonnet(), "--results", out, "--script", file}), 3,
                           {file, name}));
  }
  EXPECT_TRUE(fails_with(knead({"info", script}), 3, {script, "a script", "--script"}));
}

TEST(Messages, AnUnknownFunctionComesWithTheList) {
  EXPECT_TRUE(
      refused_anew({command("new"), command("load", {{"formula", {"0", "0", "sinus(u)"}}})}, 3,
                   {"\"sinus\"", "variables are ", "functions are abs, ", "smoothstep", "mix"}));
}

TEST(Messages, AFormulaOfALoadIsNamedByItsField) {
  const auto refused = [](const char* formula, const std::vector<std::string>& named) {
    return refused_anew({command("new"), command("load", {{"formula", {"0", formula, "0"}}})}, 3,
                        named);
  };
  EXPECT_TRUE(refused("u", {"commands[1]: formula[1]: character 1: ", "variables are "}));
  EXPECT_TRUE(refused("1 2", {"formula[1]: character 3: ", "write one of + - * / ^"}));
  EXPECT_TRUE(refused("1 +", {"formula[1]: character 4: ", "write a number"}));
  EXPECT_TRUE(refused("(1", {"formula[1]: character 3: ", "write )"}));
  EXPECT_TRUE(refused("mix(1)", {"formula[1]: character 6: ", "write mix(a, b, c)"}));
}

TEST(Messages, WhatNobodyGaveIsNotQuoted) {
  // Finite numbers whose products are not.
  const Json brush = command(
      "brush", {{"kind", "twist"}, {"path", {{0.5, 0.5}}}, {"radius", 0.2}, {"angle", 1.79e308}});
  const Json ball = command("tool", {{"position", {0.5, 0.5, 0.2}}, {"radius", 0.1}});
  const Json stroke =
      command("stroke", {{"path", {{0, 0, 1}, {0, 1e300, 1}}}, {"plastic", "along"}});
  const Json away = command("move", {{"by", {0, 0, 1.79e308}}, {"relative", true}});
  for (const auto& [last, named] :
       {std::pair(brush, "angle: the number is too large; use a smaller one"),
        std::pair(stroke, "path: the path is too long; shorten it"),
        std::pair(away, "position: ")}) {
    const Workshop workshop;
    const Outcome run = knead({"sculpt", "--new", "-o", workshop / "out.step", "--script",
                               workshop.script({command("new"), ball, last})});
    EXPECT_TRUE(fails_with(run, 3, {"commands[2]: ", named, "; "}));
    EXPECT_EQ(run.err.find("inf"), std::string::npos) << run.err;
  }
}

TEST(Messages, WhatIsNotThereIsSoughtAmongWhatIs) {
  const Json measure = command("measure", {{"name", "tip"}, {"at", {0.5, 0.5}}});
  EXPECT_TRUE(refused_anew({command("new"), measure, command("remove", {{"measurement", "top"}})},
                           3, {"no measurement \"top\"", "the measurements are: tip"}));
  EXPECT_TRUE(refused_anew({command("new"), command("convert", {{"surface", "#1"}})}, 3,
                           {"only surfaces of a file can be converted", "begin with a file"}));
  EXPECT_TRUE(refused_anew(
      {command("new"), command("material", {{"plasticity", 0.5}, {"region", {{0, 1}, {0, 0.5}}}})},
      3, {"no value to paint; give one of alpha, beta, mass and damping"}));
}

TEST(Messages, AMorphNamesSurfacesByTheirIds) {
  const Workshop workshop;
  const std::string file = workshop / "sheet.step";
  ASSERT_EQ(knead({"sculpt", "--new", "-o", file, "--script",
                   workshop.script(Json::array({command("new")}))})
                .code,
            0);
  const std::string id =
      knead({"info", file, "--json"}).json().at("surfaces").at(0).at("id").get<std::string>();
  const Outcome run =
      knead({"morph", file, "-o", workshop / "out.step", "--space", "1e300*x; 0; 0"});
  EXPECT_TRUE(fails_with(run, 3, {id + ": control point ", "too large"}));
  EXPECT_EQ(run.err.find("surface 0"), std::string::npos) << run.err;
}

TEST(Messages, ARadiusWhoseSquareVanishesIsRefused) {
  // 5e-324 is above 0, but forces shared out by distances over its square are no numbers.
  for (const Json& small : {command("drag", {{"by", {0, 0, 0.1}}, {"radius", 5e-324}}),
                            command("relax", {{"at", {0.5, 0.5}}, {"radius", 1e-60}}),
                            command("mask", {{"change", "blur"}, {"radius", 1e-60}})}) {
    EXPECT_TRUE(refused_anew({command("new"), small}, 3, {"commands[1]: radius", "1e-50"}))
        << small;
  }
}

TEST(Messages, InfoShowsWhatIsInAKneadDocument) {
  const Workshop workshop;
  const std::string document = workshop.file("a.knead", R"({"knead": 3,
"name": "part.step",
"source": {"kind": "step", "name": "part.step", "bytes": "SVNPLTEwMzAzLTIxOw=="},
"commands": [
  {"do":"select","surface":"#21"},
  {"do":"hold","rows":2}
],
"views": [{"name": "front"}],
"snapshot": "S25l"}
)");
  const Outcome text = knead({"info", document});
  ASSERT_EQ(text.code, 0) << text.err;
  for (const char* part :
       {"Knead document of version 3, \"part.step\"",
        "begins with the STEP file \"part.step\", 13 bytes",
        "2 commands:", R"({"do":"hold","rows":2})", "view \"front\"", "a snapshot of 3 bytes"}) {
    EXPECT_NE(text.out.find(part), std::string::npos) << part << " in " << text.out;
  }
  const Json about = knead({"info", document, "--json"}).json();
  EXPECT_EQ(about.at("format"), "Knead document");
  EXPECT_EQ(about.at("source"), (Json{{"kind", "step"}, {"name", "part.step"}, {"bytes", 13}}));
  EXPECT_EQ(about.at("commands").size(), 2U);
  EXPECT_TRUE(fails_with(knead({"info", document, "--faces"}), 2, {"--faces"}));
  const std::string old =
      workshop.file("old.knead", R"({"knead": 2, "name": "part.step", "commands": []})");
  EXPECT_TRUE(fails_with(knead({"info", old}), 3, {old, "of version 2", "docs/scripts.md"}));
  const std::string half =
      workshop.file("half.knead", R"({"knead": 3, "name": "part.step", "comm)");
  EXPECT_TRUE(fails_with(knead({"info", half}), 3, {half, "not JSON"}));
  // Elsewhere it is no CAD file.
  EXPECT_TRUE(fails_with(knead({"mesh", document, "--out", workshop / "a.stl"}), 3,
                         {document, "Knead document", "studio", "knead info"}));
}

}  // namespace
}  // namespace knead::testing
