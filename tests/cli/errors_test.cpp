#include <algorithm>

#include "program.hpp"

namespace knead::testing {
namespace {

namespace fs = std::filesystem;

/// Runs a script on the sample; nothing but the script may be left afterwards.
::testing::AssertionResult refused(const std::string& script, int code,
                                   const std::vector<std::string>& named) {
  const Workshop workshop;
  const std::string path = workshop.file("script.json", script);
  const Outcome run =
      knead({"sculpt", bonnet(), "-o", workshop / "out.step", "--script", path, "--report",
             workshop / "report.json", "--picture", workshop / "picture.svg"});
  if (workshop.files() != std::vector<std::string>{"script.json"}) {
    return ::testing::AssertionFailure() << "files are left behind";
  }
  auto all = named;
  all.push_back(path);
  return fails_with(run, code, all);
}

::testing::AssertionResult refused(const Json& commands, int code,
                                   const std::vector<std::string>& named) {
  return refused(Json{{"knead", 2}, {"commands", commands}}.dump(), code, named);
}

const Json skin = command("select", {{"surface", "#285"}});

TEST(Errors, AScriptThatIsNoScript) {
  EXPECT_TRUE(refused(std::string("{"), 3, {":1:", "JSON"}));
  EXPECT_TRUE(refused(std::string("{\"knead\": 2,\n\"commands\": [\n{\"do\" \"step\"}]}"), 3,
                      {":3:", "JSON"}));
  EXPECT_TRUE(refused(std::string("[]"), 3, {"\"commands\""}));
  EXPECT_TRUE(refused(std::string("{}"), 3, {"knead", "version"}));
  EXPECT_TRUE(refused(std::string(R"({"knead":3,"commands":[]})"), 3, {"knead", "version"}));
  EXPECT_TRUE(refused(std::string(R"({"knead":2})"), 3, {"commands"}));
  EXPECT_TRUE(
      refused(std::string(R"({"knead":2,"commands":[],"x":1})"), 3, {"x", "knead, commands"}));
}

TEST(Errors, AnUnknownCommandOrFieldListsTheKnownOnes) {
  EXPECT_TRUE(refused(Json::array({command("squash")}), 3,
                      {"commands[0]", "squash", "new", "select", "material", "rest", "hold", "pin",
                       "tool", "move", "step", "undo", "redo"}));
  EXPECT_TRUE(refused(Json{skin, command("step", {{"counts", 3}})}, 3,
                      {"commands[1]", "counts", "count", "lambda", "weight"}));
  EXPECT_TRUE(refused(Json{skin, command("rest", {{"mode", "x"}})}, 3,
                      {"commands[1].mode", "shape", "none"}));
}

TEST(Errors, AWrongValueIsNamedWithItsPlaceAndRemedy) {
  const auto tool = [](Json fields) {
    fields["at"] = {0.5, 0.5};
    return Json{skin, command("tool", std::move(fields))};
  };
  EXPECT_TRUE(refused(Json::array({command("step")}), 3, {"commands[0]", "#285"}));
  EXPECT_TRUE(
      refused(Json::array({command("select", {{"surface", "#1"}})}), 3, {"#1", "#285", "#1044"}));
  EXPECT_TRUE(refused(Json::array({command("select")}), 3, {"commands[0]", "surface", "missing"}));
  EXPECT_TRUE(
      refused(Json{skin, command("hold", {{"rows", -1}})}, 3, {"commands[1]", "rows", ">= 0"}));
  EXPECT_TRUE(
      refused(Json{skin, command("hold", {{"rows", 1.5}})}, 3, {"commands[1].rows", "whole"}));
  EXPECT_TRUE(refused(Json{skin, command("pin", {{"control_points", {{0, 0}, {14, 0}}}})}, 3,
                      {"commands[1]", "control_points[1]", "14 by 12"}));
  EXPECT_TRUE(refused(Json{skin, command("tool")}, 3, {"commands[1]", "position", "at"}));
  EXPECT_TRUE(refused(tool({{"radius", 0}}), 3, {"commands[1]", "radius", "> 0"}));
  EXPECT_TRUE(refused(tool({{"radius", "big"}}), 3, {"commands[1].radius", "a number"}));
  EXPECT_TRUE(refused(tool({{"shape", "cube"}}), 3, {"cube", "sphere"}));
  EXPECT_TRUE(refused(tool({{"stiffness", -1}}), 3, {"commands[1]", "stiffness", "from 0"}));
  EXPECT_TRUE(refused(tool({{"mode", "proximity"}, {"range", 0}}), 3, {"range", "> 0"}));
  EXPECT_TRUE(
      refused(Json{skin, command("move", {{"by", {0, 0, 1}}})}, 3, {"commands[1]", "tool"}));
  EXPECT_TRUE(refused(Json{skin, command("material", {{"alpha", {1, 2, 1}}})}, 3,
                      {"commands[1]", "alpha12"}));
  EXPECT_TRUE(
      refused(Json{skin, command("step", {{"lambda", -1}})}, 3, {"commands[1]", "lambda", ">= 0"}));
  EXPECT_TRUE(refused(Json::array({command("undo")}), 3, {"commands[0]", "nothing to undo"}));
}

TEST(Errors, ASingularStepIsANumericalFailure) {
  const Json nothing_to_hold_it = {skin,
                                   command("material", {{"alpha", {0, 0, 0}}, {"beta", {0, 0, 0}}}),
                                   command("step", {{"lambda", 0}})};
  EXPECT_TRUE(refused(nothing_to_hold_it, 4, {"commands[2]", "lambda"}));
}

TEST(Errors, ABalanceThatNothingHoldsIsANumericalFailure) {
  const Json loose = {command("hold", {{"rows", 0}, {"all", true}}), skin,
                      command("load", {{"vector", {0, 0, 1}}}),
                      command("evolve", {{"mode", "static"}})};
  EXPECT_TRUE(refused(loose, 4, {"commands[3]", "evolve", "hold an edge or pin points"}));
}

TEST(Errors, AFileOrNewIsNeeded) {
  const Workshop workshop;
  const std::string script = workshop.script(Json::array()), out = workshop / "out.step";
  EXPECT_TRUE(fails_with(knead({"sculpt", "-o", out, "--script", script}), 2, {"FILE", "--new"}));
  EXPECT_TRUE(fails_with(knead({"sculpt", bonnet(), "--new", "-o", out, "--script", script}), 2,
                         {"FILE", "--new"}));
  EXPECT_TRUE(
      fails_with(knead({"sculpt", "--new", "-o", out, "--script", script}), 3, {"no surface"}));
}

TEST(Errors, ABrokenFileIsNamedWithLineAndEntityAndNothingIsWritten) {
  const Workshop workshop;
  const std::string whole = content_of(bonnet());
  const std::size_t record = whole.find("\n#246") + 1;
  const std::string half = workshop.file("half.step", whole.substr(0, record + 12));
  const auto line = 1 + std::ranges::count(whole.substr(0, record), '\n');
  const std::string script = workshop.script(Json::array());
  EXPECT_TRUE(fails_with(knead({"sculpt", half, "-o", workshop / "out.step", "--script", script}),
                         3,
                         {half + ":" + std::to_string(line) + ":", "#246", "get the whole file"}));
  EXPECT_FALSE(fs::exists(workshop / "out.step"));
  EXPECT_TRUE(fails_with(knead({"info", script}), 3, {script, "STEP"}));
}

TEST(Errors, FilesThatCannotBeReadOrWrittenAreNamed) {
  const Workshop workshop;
  const std::string script = workshop.script(Json::array()), out = workshop / "out.step";
  EXPECT_TRUE(fails_with(knead({"info", "/no/such.step"}), 3, {"/no/such.step", "check the path"}));
  EXPECT_TRUE(fails_with(knead({"info", workshop / ""}), 3, {"Is a directory"}));
  EXPECT_TRUE(fails_with(knead({"sculpt", bonnet(), "-o", out, "--script", "/no/such.json"}), 3,
                         {"/no/such.json"}));
  EXPECT_TRUE(fails_with(knead({"sculpt", "/no/such.step", "-o", out, "--script", script}), 3,
                         {"/no/such.step"}));
  EXPECT_TRUE(fails_with(knead({"sculpt", bonnet(), "-o", "/no/out.step", "--script", script}), 3,
                         {"/no/out.step"}));
  EXPECT_TRUE(fails_with(knead({"sculpt", bonnet(), "-o", workshop / "", "--script", script}), 3,
                         {"directory"}));
  EXPECT_TRUE(fails_with(
      knead({"sculpt", bonnet(), "-o", out, "--script", script, "--report", "/no/r.json"}), 3,
      {"/no/r.json"}));
  EXPECT_EQ(workshop.files(), std::vector<std::string>{"script.json"});
}

TEST(Errors, AFullStandardOutputFails) {
  const std::string full = "/dev/full";
  if (!fs::exists(full)) GTEST_SKIP() << "this system has no " << full;
  // What fits the buffer is lost when it is flushed, what does not before.
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"info", bonnet()}, {"schema"}}) {
    EXPECT_TRUE(
        fails_with(knead(arguments, full), 3, {"standard output", "could not be written", "full"}))
        << arguments[0];
  }
}

TEST(Errors, NoOutputOverwritesAnotherFileOfTheCall) {
  const Workshop workshop;
  const std::string script = workshop.script(Json::array()), out = workshop / "out.step";
  const std::string file = workshop.file("in.step", content_of(bonnet()));
  EXPECT_TRUE(fails_with(knead({"sculpt", file, "-o", out, "--script", script, "--report", out}), 2,
                         {"--report", "--output"}));
  EXPECT_TRUE(fails_with(knead({"sculpt", file, "-o", out, "--script", script, "--report", file}),
                         2, {"--report"}));
  EXPECT_TRUE(fails_with(knead({"sculpt", file, "-o", script, "--script", script}), 2,
                         {"--output", "--script"}));
  EXPECT_TRUE(identical(content_of(file), content_of(bonnet())));
  EXPECT_FALSE(fs::exists(out));
}

TEST(Errors, AnOutputWhoseNamePromisesAnotherFormatIsRefused) {
  const Workshop workshop;
  const std::string script = workshop.script(Json::array());
  for (const char* name : {"out.g2", "out.stl", "out.json"}) {
    EXPECT_TRUE(fails_with(knead({"sculpt", bonnet(), "-o", workshop / name, "--script", script}),
                           2, {"--output", name, ".step", "knead mesh"}));
  }
  EXPECT_EQ(workshop.files(), std::vector<std::string>{fs::path(script).filename().string()});
  EXPECT_EQ(knead({"sculpt", bonnet(), "-o", workshop / "OUT.STP", "--script", script}).code, 0);
  const std::string odd = workshop.file("part.txt", content_of(bonnet()));
  EXPECT_EQ(knead({"sculpt", odd, "-o", odd, "--script", script}).code, 0)
      << "as the input is called";
}

TEST(Errors, WrongUsageIsNamed) {
  EXPECT_TRUE(fails_with(knead({}), 2, {"--help"}));
  EXPECT_TRUE(fails_with(knead({"squash"}), 2,
                         {"squash", "info, sculpt, analyse, commands, gramian, stiffness"}));
  EXPECT_TRUE(fails_with(knead({"info"}), 2, {"FILE", "knead info --help"}));
  EXPECT_TRUE(
      fails_with(knead({"info", bonnet(), "--colour"}), 2, {"--colour", "knead info --help"}));
  EXPECT_TRUE(fails_with(knead({"sculpt", bonnet(), "--script", "x"}), 2,
                         {"--output", "knead sculpt --help"}));
  EXPECT_TRUE(fails_with(knead({"sculpt", bonnet(), "-o", "x"}), 2, {"--script"}));
}

}  // namespace
}  // namespace knead::testing
