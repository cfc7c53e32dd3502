#include "knead/session/command_json.hpp"
#include "program.hpp"

namespace knead::testing {
namespace {

TEST(Help, TellsTheExitCodesEverywhere) {
  for (const char* name : {"", "info", "sculpt", "gramian", "stiffness"}) {
    std::vector<std::string> arguments{name, "--help"};
    if (*name == '\0') arguments.erase(arguments.begin());
    const Outcome run = knead(arguments);
    EXPECT_EQ(run.code, 0);
    EXPECT_TRUE(run.err.empty());
    EXPECT_NE(run.out.find("0 success, 2 wrong usage, 3 bad input, 4 numerical failure"), std::string::npos) << name;
  }
}

TEST(Help, SculptNamesEveryCommandAndField) {
  const std::string help = knead({"sculpt", "--help"}).out;
  // The command room writes every field of a command that was given all of them.
  const char* const commands[] = {R"({"do":"select","surface":"#1"})",
                                  R"({"do":"material"})",
                                  R"({"do":"rest"})",
                                  R"({"do":"hold"})",
                                  R"({"do":"pin","control_points":[[0,0]]})",
                                  R"({"do":"release"})",
                                  R"({"do":"tool","radius":1,"position":[0,0,0],"range":1})",
                                  R"({"do":"tool","at":[0,0]})",
                                  R"({"do":"remove","tool":"a"})",
                                  R"({"do":"move","tool":"a","by":[0,0,0],"relative":true})",
                                  R"({"do":"step"})",
                                  R"({"do":"undo"})",
                                  R"({"do":"redo"})"};
  for (const char* text : commands) {
    const auto command = parse_command(text);
    ASSERT_TRUE(command) << text << ": " << command.error().message();
    const Json json = Json::parse(to_json(*command));
    const std::string name = json.at("do");
    const std::size_t at = help.find("\n  " + name + " ");
    ASSERT_NE(at, std::string::npos) << name;
    for (const auto& [field, value] : json.items()) {
      if (field != "do") {
        EXPECT_NE(help.find("\n      " + field + " ", at), std::string::npos) << name << "." << field;
      }
    }
  }
}

TEST(Help, SculptNamesEveryFieldOfTheReport) {
  const std::string help = knead({"sculpt", "--help"}).out;
  for (const char* field : {"steps", "time", "energy", "residual", "largest_displacement", "energy_before",
                            "energy_after", "control_points_moved"}) {
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
