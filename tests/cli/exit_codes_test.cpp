// A script's fault is 3, an option's value 2, whatever function of the library finds it; what is
// written is said.
#include <sys/stat.h>

#include <cstdlib>

#include "exchange/face_builder.hpp"
#include "program.hpp"
#include "step_sheet.hpp"

namespace knead::testing {
namespace {

namespace fs = std::filesystem;

/// The names of all files of the workshop but scripts.
std::vector<std::string> results_in(const Workshop& workshop) {
  std::vector<std::string> names = workshop.files();
  std::erase_if(names, [](const std::string& name) { return name.ends_with("script.json"); });
  return names;
}

TEST(ExitCodes, AScriptsFaultIsThree) {
  const Workshop workshop;
  const auto refused = [&](const Json& commands, const std::vector<std::string>& named) {
    const std::string script = workshop.script(commands);
    for (const auto& [program, output] :
         {std::pair("sculpt", "--output"), std::pair("analyse", "--results")}) {
      const Outcome run =
          knead({program, "--new", output, workshop / "out.step", "--script", script});
      if (auto right = fails_with(run, 3, named); !right) return right;
    }
    return ::testing::AssertionSuccess();
  };
  // Functions of the library for which these are arguments call them wrong usage.
  EXPECT_TRUE(refused(
      {command("new"), command("material", {{"plasticity", 0.5}, {"region", {{0, 1}, {0, 0.5}}}})},
      {"commands[1]", "no value to paint"}));
  EXPECT_TRUE(refused({command("new"), command("undo"), command("undo")}, {"commands[2]"}));
  EXPECT_TRUE(results_in(workshop).empty());
}

TEST(ExitCodes, TheValueOfAnOptionIsTwo) {
  const Workshop workshop;
  const std::string stl = workshop / "a.stl", script = workshop.script(Json::array()),
                    knots = "0,0,1,1";
  const std::vector<std::pair<std::vector<std::string>, std::string>> calls = {
      {{"gramian", "--degree", "26", "--knots", knots}, "--degree"},
      {{"gramian", "--degree", "1", "--knots", "0,0,1e999,1"}, "--knots"},
      {{"gramian", "--degree", "1", "--knots", "0,1,0,1"}, "--knots"},
      {{"gramian", "--degree", "1", "--knots", knots, "--rational-weights", "1"},
       "--rational-weights"},
      {{"gramian", "--degree", "1", "--knots", knots, "--rational-weights", "1,1", "--tolerance",
        "nan"},
       "--tolerance"},
      {{"basis", "--degree", "1", "--knots", knots, "--index", "2"}, "--index"},
      {{"basis", "--degree", "1", "--knots", knots, "--to", "inf"}, "--to"},
      {{"stiffness", "--net", "1x4"}, "--net"},
      {{"stiffness", "--net", "100000x100000"}, "--net"},
      {{"stiffness", "--net", "4x4", "--alpha", "-1,0,1"}, "--alpha"},
      {{"stiffness", "--knots-u", knots, "--knots-v", knots, "--degree", "1", "--weights", "1"},
       "--weights"},
      {{"matrices", bonnet(), "--surface", "#1", "--out", workshop / "m"}, "--surface"},
      {{"matrices", bonnet(), "--surface", "#285", "--mass", "nan", "--out", workshop / "m"},
       "--mass"},
      {{"matrices", bonnet(), "--surface", "#285", "--beta", "-1,0,1", "--out", workshop / "m"},
       "--beta"},
      {{"mesh", bonnet(), "--out", stl, "--tolerance", "0"}, "--tolerance"},
      {{"mesh", bonnet(), "--out", stl, "--untrimmed", "--detail", "0"}, "--detail"},
      {{"export", bonnet(), "--out", workshop / "a.igs", "--unit", "ell"}, "--unit"},
      {{"analyse", bonnet(), "--script", script, "--results", workshop / "r.json", "--samples",
        "1"},
       "--samples"}};
  for (const auto& [arguments, option] : calls) {
    EXPECT_TRUE(fails_with(knead(arguments), 2, {option})) << arguments[0] << " " << option;
  }
  EXPECT_TRUE(results_in(workshop).empty());
}

TEST(ExitCodes, WhatAFileOfAnOptionHoldsIsThree) {
  const Workshop workshop;
  const std::string file = workshop.file("knots.txt", "0 0 1e999 1");
  EXPECT_TRUE(
      fails_with(knead({"gramian", "--degree", "1", "--knots-file", file}), 3, {file, "entry 2"}));
}

TEST(ExitCodes, AnOptionWithoutEffectIsTwo) {
  const Workshop workshop;
  const std::string script = workshop.script(Json::array()), out = workshop / "out.step",
                    knots = "0,0,1,1";
  const std::vector<std::pair<std::vector<std::string>, std::string>> calls = {
      {{"info", bonnet(), "--json", "--faces"}, "--faces"},
      {{"sculpt", bonnet(), "-o", out, "--script", script, "--schema", "ap214"}, "--schema"},
      {{"sculpt", "--new", "-o", workshop / "a.igs", "--script", script, "--schema", "ap242"},
       "--schema"},
      {{"export", bonnet(), "--out", workshop / "a.igs", "--schema", "ap214"}, "--schema"},
      {{"commands", "--table"}, "--table"},
      {{"stiffness", "--net", "4x4", "--tolerance", "1e-6"}, "--tolerance"},
      {{"matrices", "--knots-u", knots, "--knots-v", knots, "--degree", "1", "--surface", "#1",
        "--out", out},
       "--surface"},
      {{"matrices", bonnet(), "--surface", "#285", "--degree", "2", "--out", out}, "--degree"}};
  for (const auto& [arguments, option] : calls) {
    EXPECT_TRUE(fails_with(knead(arguments), 2, {option})) << arguments[0] << " " << option;
  }
  EXPECT_TRUE(results_in(workshop).empty());
  const std::string sheet = workshop.script(Json::array({command("new")}), "new_script.json");
  EXPECT_EQ(knead({"sculpt", "--new", "-o", out, "--script", sheet, "--schema", "ap214"}).code, 0);
}

TEST(ExitCodes, AMisspeltEnvironmentIsTwo) {
  for (const auto& [variable, value] :
       {std::pair("KNEAD_INSTRUCTION_SET", "vector129"), std::pair("KNEAD_THREADS", "two"),
        std::pair("KNEAD_THREADS", "0")}) {
    const char* const before = std::getenv(variable);
    const std::string kept = before != nullptr ? before : "";
    setenv(variable, value, 1);
    EXPECT_TRUE(fails_with(knead({"info", bonnet()}), 2, {variable, value}));
    EXPECT_EQ(knead({"--version"}).code, 0);
    if (before != nullptr) {
      setenv(variable, kept.c_str(), 1);
    } else {
      unsetenv(variable);
    }
  }
  setenv("KNEAD_INSTRUCTION_SET", "vector128", 1);
  EXPECT_EQ(knead({"info", bonnet()}).code, 0);
  unsetenv("KNEAD_INSTRUCTION_SET");
}

TEST(ExitCodes, AnUnknownUnitIsThatOfTheOptionInEveryFormat) {
  const Workshop workshop;
  FaceBuilder b;
  const int p = b.vertex(0, 0, 0), q = b.vertex(1, 0, 0), r = b.vertex(1, 1, 0),
            t = b.vertex(0, 1, 0);
  b.face(10, {b.bound({b.line(p, q, {0, 0, 0}, {1, 0, 0}), b.line(q, r, {1, 0, 0}, {0, 1, 0}),
                       b.line(r, t, {1, 1, 0}, {-1, 0, 0}), b.line(t, p, {0, 1, 0}, {0, -1, 0})})});
  const std::string file = workshop.file("unitless.step", step_text(square + b.text()));
  for (const char* name : {"a.step", "a.igs"})
    EXPECT_TRUE(fails_with(knead({"export", file, "--out", workshop / name, "--unit", "ell"}), 2,
                           {"--unit", "the unit ell is not known"}));
}

TEST(ExitCodes, APictureThatCannotBeDrawnLeavesTheWork) {
  const Workshop workshop;
  const std::string out = workshop / "out.step", report = workshop / "r.json",
                    picture = workshop / "p.svg";
  const std::string nothing = workshop.script(Json::array());
  const Outcome unselected = knead({"sculpt", bonnet(), "-o", out, "--script", nothing, "--report",
                                    report, "--picture", picture});
  EXPECT_TRUE(fails_with(
      unselected, 3, {"--picture", "no surface is selected", "written: " + report + ", " + out}));
  EXPECT_TRUE(identical(content_of(out), content_of(bonnet())));
  EXPECT_EQ(results_in(workshop), (std::vector<std::string>{"out.step", "r.json"}));

  // All control points on one line: a surface without area, which the model has no unit for.
  const Surface skin = surface_of(bonnet(), "#285");
  Points line = skin.control_points();
  line.rightCols(2).setZero();
  const std::string thin =
      workshop.file("thin.step", step_sheet(*Surface::create(skin.knots(), line)));
  const std::string flat = workshop / "flat.step";
  const Outcome run =
      knead({"sculpt", thin, "-o", flat, "--script", nothing, "--picture", picture});
  EXPECT_NE(run.code, 0);
  EXPECT_NE(run.err.find("--picture"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("written: " + flat), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(picture));
}

TEST(ExitCodes, APictureIsAnSvgFileByItsName) {
  const Workshop workshop;
  const std::string script = workshop.script(Json::array()), out = workshop / "out.step";
  EXPECT_TRUE(fails_with(
      knead({"sculpt", bonnet(), "-o", out, "--script", script, "--picture", workshop / "p.png"}),
      2, {"--picture", "p.png", ".svg"}));
  EXPECT_TRUE(fails_with(knead({"analyse", bonnet(), "--results", out, "--script", script, "--vtu",
                                workshop / "p.vtk"}),
                         2, {"--vtu", "p.vtk", ".vtu"}));
  EXPECT_TRUE(results_in(workshop).empty());
}

TEST(ExitCodes, WhatIsWrittenIsSaidWhereStandardOutputIsFull) {
  const std::string full = "/dev/full";
  if (!fs::exists(full)) GTEST_SKIP() << "this system has no " << full;
  const Workshop workshop;
  const std::string out = workshop / "out.step", report = workshop / "r.json";
  // More lines than a buffer holds: printing fails before anything is written.
  Json commands = {command("new")};
  for (int k = 0; k < 300; ++k)
    commands.push_back(command("tool", {{"name", "t" + std::to_string(k)}, {"at", {0.5, 0.5}}}));
  const std::string script = workshop.script(commands);
  EXPECT_TRUE(fails_with(
      knead({"sculpt", "--new", "-o", out, "--script", script, "--report", report}, full), 3,
      {"standard output", "what is printed could not be written",
       "written: " + report + ", " + out}));
  EXPECT_EQ(results_in(workshop), (std::vector<std::string>{"out.step", "r.json"}));
}

TEST(ExitCodes, ASetOfMatricesComesTogetherOrNotAtAll) {
  const Workshop workshop;
  const std::string made = workshop / "made";
  const auto run = [&](const std::string& directory) {
    return knead({"matrices", bonnet(), "--surface", "#285", "--out", directory});
  };
  fs::create_directories(made + "/points.npy");  // in the way of one of the last files
  EXPECT_TRUE(fails_with(run(made), 3, {"points.npy"}));
  std::size_t left = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(made)) ++left;
  EXPECT_EQ(left, 1U);
  const std::string inside = workshop.file("file", "") + "/in/it";
  EXPECT_TRUE(fails_with(run(inside), 3, {"--out"}));
  EXPECT_EQ(run(workshop / "a/b").code, 0);
  EXPECT_TRUE(fs::exists(workshop / "a/b/matrices.json"));
  EXPECT_EQ(std::distance(fs::directory_iterator(workshop / "a/b"), fs::directory_iterator()), 22);
}

TEST(ExitCodes, AConvertedSurfaceIsAChange) {
  const Workshop workshop;
  const std::string script =
      workshop.script(Json::array({command("convert", {{"surface", "#534"}})}));
  const Outcome run = knead({"sculpt", bonnet(), "-o", workshop / "out.step", "--script", script});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("(1 surface changed)"), std::string::npos) << run.out;
}

}  // namespace
}  // namespace knead::testing
