// Scripts: the one version that is read, and that what is written of a session does the same as the
// session.
#include <filesystem>
#include <fstream>

#include "sheet.hpp"

namespace knead {
namespace {

namespace fs = std::filesystem;
using testing::fresh;
using testing::open_sample;
using testing::run;
using testing::same_state;

const fs::path data = fs::path(KNEAD_SOURCE_DIR) / "tests/session/data";

std::string text_of(const std::string& name) {
  std::ifstream in(data / name);
  return {std::istreambuf_iterator<char>(in), {}};
}

void run_all(Session& session, const Expected<std::vector<Command>>& commands) {
  ASSERT_TRUE(commands) << commands.error().message();
  for (const Command& command : *commands) {
    const auto status = session.execute(command);
    ASSERT_TRUE(status) << to_json(command) << ": " << status.error().message();
  }
}

TEST(Script, OfVersion1IsRefusedWithThePageThatSaysHowToGoOn) {
  const auto script = parse_script(R"({"knead": 1, "commands": [{"do": "step"}]})", "old.json");
  ASSERT_FALSE(script);
  const Error& error = script.error();
  EXPECT_EQ(error.file, "old.json");
  EXPECT_EQ(error.where, "knead");
  EXPECT_NE(error.what.find("version 1"), std::string::npos) << error.what;
  EXPECT_NE(error.remedy.find("docs/scripts.md"), std::string::npos) << error.remedy;
  EXPECT_EQ(error.message().find('\n'), std::string::npos);
}

TEST(Script, OfNoVersionThatThereIsIsRefused) {
  for (const char* const version : {"0", "1.5", "3", "\"2\"", "null", "[2]", "true"}) {
    const auto script =
        parse_script(std::string(R"({"commands":[],"knead":)") + version + "}", "s");
    ASSERT_FALSE(script) << version;
    EXPECT_EQ(script.error().where, "knead");
    EXPECT_NE(script.error().remedy.find(R"({"knead": 2)"), std::string::npos)
        << script.error().remedy;
  }
}

TEST(Script, ACommandHasNoVersionOfItsOwn) {
  for (const char* const version : {"1", "2"}) {
    const auto command = parse_command(std::string(R"({"do":"step","knead":)") + version + "}");
    ASSERT_FALSE(command);
    EXPECT_EQ(command.error().where, "knead");
  }
}

TEST(Script, BeginsWithTheEdgesOfAllFacesHeld) {
  const auto script = parse_script(R"({"knead": 2, "commands": []})", "s");
  ASSERT_TRUE(script);
  ASSERT_EQ(script->size(), 1U);
  EXPECT_EQ(to_json(script->front()), to_json(default_hold()));
}

TEST(Script, OfASessionDoesTheSame) {
  for (const char* name : {"holds.json", "symmetry.json", "paint.json"}) {
    Session session = fresh(), again = fresh();
    run_all(session, parse_script(text_of(name), name));
    run_all(again, parse_script(script_json(session.journal()), "journal"));
    EXPECT_TRUE(same_state(again.state(), session.state())) << name;
  }
}

TEST(Script, OfAFileHoldsNothingWhereTheSessionDidNot) {
  const std::vector<std::string> select = {R"({"do":"select","surface":"#285"})"};
  Session session = open_sample(), again = open_sample();
  run(session, select);
  const std::string script = script_json(session.journal());
  EXPECT_NE(script.find(R"("knead": 2)"), std::string::npos) << script;
  run_all(again, parse_script(script, "journal"));
  EXPECT_TRUE(same_state(again.state(), session.state())) << script;
  // One that holds the edges at first says so by its version alone.
  Session held = open_sample(), likewise = open_sample();
  run(held, {to_json(default_hold()), select[0]});
  const std::string shorter = script_json(held.journal());
  EXPECT_EQ(shorter.find(R"("hold")"), std::string::npos) << shorter;
  run_all(likewise, parse_script(shorter, "journal"));
  EXPECT_TRUE(same_state(likewise.state(), held.state())) << shorter;
}

TEST(Script, ThatResetsAPaintedMaterialHasTheEnergyOfItsTime) {
  Session session = fresh();
  run_all(session, parse_script(text_of("paint.json"), "paint.json"));
  EXPECT_NEAR(session.state().steps.back().energy, 0.0024080287226643012, 1e-12);
  EXPECT_NEAR(session.state().steps.back().largest_displacement, 0.13526452927786894, 1e-10);
}

TEST(CommandList, IsReadWithNothingBeforeIt) {
  const auto commands = parse_commands(R"([{"do":"step","count":2},{"do":"undo"}])");
  ASSERT_TRUE(commands);
  EXPECT_EQ(commands->size(), 2U);
  EXPECT_EQ(commands_json(*parse_commands(commands_json(*commands))), commands_json(*commands));
  EXPECT_TRUE(parse_commands("[]")->empty());
  EXPECT_EQ(commands_json({}), "[]\n");
  EXPECT_EQ(parse_commands(R"([{"do":"step"},{"do":"step","count":"x"}])").error().where,
            "commands[1].count");
  EXPECT_EQ(parse_commands(R"({"knead":2,"commands":[]})").error().where, "commands");
}

}  // namespace
}  // namespace knead
