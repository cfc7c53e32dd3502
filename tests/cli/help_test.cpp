#include <sstream>

#include "knead/session/command_json.hpp"
#include "program.hpp"

namespace knead::testing {
namespace {

TEST(Help, TellsTheExitCodesEverywhere) {
  for (const char* name : {"", "info", "sculpt", "commands", "gramian", "stiffness", "mesh"}) {
    std::vector<std::string> arguments{name, "--help"};
    if (*name == '\0') arguments.erase(arguments.begin());
    const Outcome run = knead(arguments);
    EXPECT_EQ(run.code, 0);
    EXPECT_TRUE(run.err.empty());
    EXPECT_NE(run.out.find("0 success, 2 wrong usage, 3 bad input, 4 numerical failure"),
              std::string::npos)
        << name;
  }
}

TEST(Help, SculptNamesEveryCommandAndField) {
  const std::string help = knead({"sculpt", "--help"}).out;
  for (const std::string& name : command_names()) {
    const std::size_t at = help.find("\n  " + name + " ");
    ASSERT_NE(at, std::string::npos) << name;
    const Outcome run = knead({"commands", name});
    EXPECT_EQ(run.code, 0);
    EXPECT_TRUE(run.out.starts_with(name + ": ")) << run.out;
    std::istringstream lines(run.out);
    std::string line, field;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      ASSERT_TRUE(line.starts_with("  ")) << line;
      std::istringstream(line) >> field;
      if (field == "(no") continue;
      const std::size_t found = help.find(" " + field, at);
      EXPECT_LT(found, help.find("\n\n", at)) << name << "." << field;
    }
  }
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 130U) << line;
}

TEST(Help, CommandsListsAllOrExplainsOne) {
  const std::string all = knead({"commands"}).out;
  for (const std::string& name : command_names())
    EXPECT_NE(all.find("  " + name + " "), std::string::npos) << name;
  EXPECT_TRUE(
      fails_with(knead({"commands", "hammer"}), 2, {"hammer", "the commands are: new, select"}));
}

TEST(Help, SculptNamesEveryFieldOfTheReport) {
  const std::string help = knead({"sculpt", "--help"}).out;
  for (const char* field : {"steps",
                            "time",
                            "energy",
                            "residual",
                            "largest_displacement",
                            "energy_before",
                            "energy_after",
                            "control_points_moved",
                            "stretch",
                            "bend",
                            "kinetic",
                            "contact",
                            "gap",
                            "constraint_violation",
                            "converged",
                            "limited",
                            "load_factor",
                            "increments",
                            "note",
                            "seams",
                            "notes",
                            "coded_notes"}) {
    EXPECT_NE(help.find('"' + std::string(field) + '"'), std::string::npos) << field;
  }
}

TEST(Help, VersionIsOneLine) {
  const Outcome run = knead({"--version"});
  EXPECT_EQ(run.code, 0);
  EXPECT_TRUE(run.out.starts_with("knead ")) << run.out;
}

}  // namespace
}  // namespace knead::testing
