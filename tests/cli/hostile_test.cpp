// What is hostile by accident or on purpose: the program ends with one line and an exit code, and
// writes nothing.
#include <sys/stat.h>
#include <sys/wait.h>

#include <cstdlib>

#include "less_memory.hpp"
#include "program.hpp"
#include "support/sanitized.hpp"

namespace knead::testing {
namespace {

TEST(Hostile, WithoutMemoryTheProgramSaysSo) {
  if (sanitized()) GTEST_SKIP() << "the sanitizer reserves more";
  const Workshop workshop;
  Json nets = Json::array();
  for (int k = 0; k < 5; ++k) nets.push_back(command("new", {{"net", {2000, 2000}}}));
  const std::string script = workshop.script(nets);
  const LessMemory limit(rlim_t{400} << 20U);
  EXPECT_TRUE(fails_with(
      knead({"sculpt", "--new", "-o", workshop / "out.step", "--script", script}), 4, {"memory"}));
  EXPECT_EQ(workshop.files(), std::vector<std::string>{"script.json"});
}

TEST(Hostile, MoreControlPointsThanADocumentHoldsAreRefusedBeforeTheyAreMade) {
  const Workshop workshop;
  Json nets = Json::array();
  for (int k = 0; k < 20; ++k) nets.push_back(command("new", {{"net", {2000, 2000}}}));
  EXPECT_TRUE(fails_with(
      knead({"sculpt", "--new", "-o", workshop / "out.step", "--script", workshop.script(nets)}), 3,
      {"commands[5]: net", "24000000 control points", "20 million"}));
  EXPECT_EQ(workshop.files(), std::vector<std::string>{"script.json"});
}

TEST(Hostile, MoreControlPointsThanCanBeMovedTogetherAreRefusedBeforeAStep) {
  const Workshop workshop;
  const std::string script =
      workshop.script({command("new", {{"net", {2000, 2000}}}),
                       command("load", {{"gravity", {0, 0, -1}}}), command("step")});
  EXPECT_TRUE(
      fails_with(knead({"sculpt", "--new", "-o", workshop / "out.step", "--script", script}), 3,
                 {"4000000 control points", "1000000", "coarser"}));
}

TEST(Hostile, TextFromFilesDoesNotReachTheTerminalRaw) {
  const Workshop workshop;
  const std::string out = workshop / "out.step";
  const std::string lines =
      workshop.script(Json::array({command("new", {{"shape", "a\nb\x1B[2J"}})}));
  EXPECT_TRUE(
      fails_with(knead({"sculpt", "--new", "-o", out, "--script", lines}), 3, {"a\\nb\\u001b[2J"}));
  const std::string huge =
      workshop.script(Json::array({command("new", {{"shape", std::string(2000000, 'x')}})}));
  const Outcome run = knead({"sculpt", "--new", "-o", out, "--script", huge});
  EXPECT_TRUE(fails_with(run, 3, {"…", "is not known"}));
  EXPECT_LT(run.err.size(), 3000U);
  const std::string named =
      workshop.script(Json::array({command("new", {{"name", "\x1B[31mred\n"}})}));
  ASSERT_EQ(knead({"sculpt", "--new", "-o", out, "--script", named}).code, 0);
  const Outcome info = knead({"info", out});
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_EQ(info.out.find('\x1B'), std::string::npos) << info.out;
}

TEST(Hostile, AFileOfAnotherFormatIsCalledByItsName) {
  const Workshop workshop;
  const std::string file = workshop.file("part.step", "solid part\nfacet normal 0 0 1\n");
  for (const auto& arguments :
       std::vector<std::vector<std::string>>{{"info", file},
                                             {"sculpt", file, "-o", workshop / "out.step",
                                              "--script", workshop.script(Json::array())},
                                             {"mesh", file, "--out", workshop / "out.stl"}}) {
    EXPECT_TRUE(fails_with(knead(arguments), 3, {file, "STL", "export"})) << arguments[0];
  }
}

TEST(Hostile, AProtectedOutputIsRefusedBeforeAnythingIsDone) {
  const Workshop workshop;
  const std::string out = workshop.file("out.step", "mine");
  ASSERT_EQ(chmod(out.c_str(), 0444), 0);
  const std::string script =
      workshop.script({command("new"), command("step", {{"count", 100000}})});
  EXPECT_TRUE(fails_with(knead({"sculpt", "--new", "-o", out, "--script", script}), 3,
                         {out, "may not be written to"}));
  EXPECT_EQ(content_of(out), "mine");
}

TEST(Hostile, ALimitThatAStepCannotKeepIsAnError) {
  const Workshop workshop;
  const std::string script = workshop.script(
      {command("new", {{"size", {15, 15.5}}, {"degree", {1, 4}}, {"net", {2, 5}}}),
       command("limit", {{"distance", 1.7}}),
       command("force", {{"at", {0.9, 0.6}}, {"to", {6, -4, -5}}, {"strength", 1e10}}),
       command("edge", {{"which", "v0"}}), command("step")});
  EXPECT_TRUE(
      fails_with(knead({"sculpt", "--new", "-o", workshop / "out.step", "--script", script}), 4,
                 {"commands[4]", "beyond the limit of 1.7", "refine the net"}));
  EXPECT_EQ(workshop.files(), std::vector<std::string>{"script.json"});
}

/// The exit code of the program with these arguments after Ctrl+C in its first second. In the
/// foreground `timeout` sends one signal; else another one follows to the whole group, and a second
/// Ctrl+C ends the program at once.
int interrupted(const std::string& arguments) {
  const std::string line = "timeout --foreground -s INT 1 " + program() + " " + arguments +
                           " >/dev/null 2>&1 </dev/null";
  const int status = std::system(line.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Hostile, CtrlCWritesWhatStandsOnlyIfAsked) {
  const Workshop workshop;
  const std::string script = workshop.script({command("new"), command("edge", {{"which", "all"}}),
                                              command("load", {{"gravity", {0, 0, -1}}}),
                                              command("step", {{"count", 1000000}})});
  const std::string arguments = "sculpt --new -o " + workshop / "out.step" + " --script " + script;
  constexpr int timed_out = 124;
  EXPECT_EQ(interrupted(arguments), timed_out);
  EXPECT_EQ(workshop.files(), std::vector<std::string>{"script.json"});
  EXPECT_EQ(interrupted(arguments + " --keep-partial --report " + workshop / "report.json"),
            timed_out);
  ASSERT_EQ(workshop.files(), (std::vector<std::string>{"out.step", "report.json", "script.json"}));
  const auto steps = Json::parse(content_of(workshop / "report.json")).at("steps").size();
  EXPECT_GE(steps, 1U);
  EXPECT_LT(steps, 1000000U);
  EXPECT_TRUE(step::File::parse(content_of(workshop / "out.step"), "out.step"));
}

TEST(Hostile, ErrorsAboutASurfaceNameTheCadFile) {
  const Workshop workshop;
  const std::string part = workshop / "part.step";
  const std::string make = workshop.script(
      Json::array({command("new", {{"size", {15, 15.5}}, {"degree", {1, 4}}, {"net", {2, 5}}})}));
  ASSERT_EQ(knead({"sculpt", "--new", "-o", part, "--script", make}).code, 0);
  const std::string script = workshop.script_of_all(
      {command("limit", {{"distance", 1.7}}),
       command("force", {{"at", {0.9, 0.6}}, {"to", {6, -4, -5}}, {"strength", 1e10}}),
       command("edge", {{"which", "v0"}}), command("step")});
  EXPECT_TRUE(fails_with(knead({"sculpt", part, "-o", workshop / "out.step", "--script", script}),
                         4,
                         {script + ": commands[4]: " + part + ": #", "beyond the limit of 1.7"}));
}

}  // namespace
}  // namespace knead::testing
