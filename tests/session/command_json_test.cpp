#include "knead/session/command_json.hpp"

#include <gtest/gtest.h>

namespace knead {
namespace {

template <class C>
C parsed(const std::string& json) {
  auto command = parse_command(json);
  if (!command) {
    ADD_FAILURE() << json << ": " << command.error().message();
    return {};
  }
  if (!std::holds_alternative<C>(*command)) {
    ADD_FAILURE() << json << " is another command";
    return {};
  }
  return std::get<C>(*command);
}

Error error_of(const std::string& json) {
  auto command = parse_command(json);
  if (command) {
    ADD_FAILURE() << json << " was accepted";
    return {};
  }
  return command.error();
}

TEST(CommandJson, ReadsEveryCommand) {
  EXPECT_EQ(parsed<SelectCommand>(R"({"do":"select","surface":"#123"})").surface, "#123");
  const auto material = parsed<MaterialCommand>(R"({"do":"material","alpha":[1,0.5,2],"beta":[3,4,5]})").material;
  EXPECT_EQ(material, (Material{{1, 0.5, 2}, {3, 4, 5}}));
  EXPECT_EQ(parsed<RestCommand>(R"({"do":"rest","mode":"none"})").mode, RestMode::none);
  EXPECT_EQ(parsed<HoldCommand>(R"({"do":"hold","rows":3})").rows, 3);
  EXPECT_EQ(parsed<PinCommand>(R"({"do":"pin","control_points":[[1,2],[3,4]]})").control_points,
            (std::vector<std::array<int, 2>>{{1, 2}, {3, 4}}));
  parsed<ReleaseCommand>(R"({"do":"release"})");
  const auto tool = parsed<ToolCommand>(
      R"({"do":"tool","name":"ball","shape":"sphere","radius":0.1,"position":[1,2,3],"mode":"proximity","stiffness":50,"range":0.05,"relative":true})");
  EXPECT_EQ(tool.name, "ball");
  EXPECT_EQ(tool.radius, 0.1);
  EXPECT_EQ(tool.position, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(tool.mode, ToolMode::proximity);
  EXPECT_EQ(tool.stiffness, 50);
  EXPECT_EQ(tool.range, 0.05);
  EXPECT_TRUE(tool.relative);
  EXPECT_EQ(parsed<ToolCommand>(R"({"do":"tool","at":[0.5,0.25]})").at, (std::array<double, 2>{0.5, 0.25}));
  EXPECT_EQ(parsed<RemoveCommand>(R"({"do":"remove","tool":"ball"})").tool, "ball");
  const auto move = parsed<MoveCommand>(R"({"do":"move","tool":"ball","by":[1,-2,3.5]})");
  EXPECT_EQ(move.tool, "ball");
  EXPECT_EQ(move.by, (std::array<double, 3>{1, -2, 3.5}));
  const auto step = parsed<StepCommand>(R"({"do":"step","count":60,"lambda":2.5,"weight":"identity"})");
  EXPECT_EQ(step.count, 60);
  EXPECT_EQ(step.lambda, 2.5);
  EXPECT_EQ(step.weight, StepWeight::identity);
  parsed<UndoCommand>(R"({"do":"undo"})");
  parsed<RedoCommand>(R"({"do":"redo"})");
}

TEST(CommandJson, WritesWhatItReads) {
  for (
      const std::string json :
      {R"({"do":"select","surface":"#1"})",
       R"({"do":"material","alpha":[0.10000000000000001,0,1],"beta":[1e-300,2,3]})", R"({"do":"rest","mode":"shape"})",
       R"({"do":"hold","rows":2})", R"({"do":"pin","control_points":[[1,2]]})", R"({"do":"release"})",
       R"({"do":"tool","name":"a \"b\"","shape":"sphere","radius":1,"position":[1,2,3],"mode":"collision","stiffness":5,"range":2,"relative":false})",
       R"({"do":"tool","name":"t","shape":"sphere","at":[0,1],"mode":"proximity","relative":true})",
       R"({"do":"remove"})", R"({"do":"move","by":[0.33333333333333331,0,0],"relative":true})",
       R"({"do":"step","count":3,"lambda":1,"weight":"mass"})", R"({"do":"undo"})", R"({"do":"redo"})"}) {
    const auto command = parse_command(json);
    ASSERT_TRUE(command) << json;
    EXPECT_EQ(to_json(*command), json);
  }
}

TEST(CommandJson, AScriptOfItsOwnWritingIsReadBack) {
  const std::vector<Command> commands = {HoldCommand{1}, StepCommand{}, UndoCommand{}};
  const auto read = parse_script(script_json(commands), "script");
  ASSERT_TRUE(read);
  EXPECT_EQ(script_json(*read), script_json(commands));
  EXPECT_TRUE(parse_script(script_json({}), "script")->empty());
}

TEST(CommandJson, AnUnknownCommandListsTheKnownOnes) {
  const Error e = error_of(R"({"do":"hammer"})");
  EXPECT_EQ(e.kind, ErrorKind::input);
  for (const char* name : {"select", "material", "rest", "hold", "pin", "tool", "move", "step", "undo", "redo"}) {
    EXPECT_NE(e.remedy.find(name), std::string::npos) << name;
  }
}

TEST(CommandJson, AnUnknownFieldListsTheKnownOnes) {
  const Error e = error_of(R"({"do":"step","cuont":3})");
  EXPECT_EQ(e.where, "cuont");
  EXPECT_NE(e.remedy.find("count, lambda, weight"), std::string::npos);
}

TEST(CommandJson, WrongValuesAreNamed) {
  EXPECT_EQ(error_of(R"({"do":"step","count":2.5})").where, "count");
  EXPECT_EQ(error_of(R"({"do":"step","count":1e30})").where, "count");
  EXPECT_EQ(error_of(R"({"do":"step","lambda":"1"})").where, "lambda");
  EXPECT_EQ(error_of(R"({"do":"tool","position":[1,2]})").where, "position");
  EXPECT_EQ(error_of(R"({"do":"tool","mode":"glue"})").where, "mode");
  EXPECT_EQ(error_of(R"({"do":"pin","control_points":[[1,2,3]]})").where, "control_points");
  EXPECT_EQ(error_of(R"({"do":"select"})").where, "surface");
  EXPECT_EQ(error_of(R"({"count":3})").where, "do");
  EXPECT_EQ(error_of(R"([1])").kind, ErrorKind::input);
}

TEST(CommandJson, ScriptErrorsSayWhere) {
  const auto place = [](const std::string& text) { return parse_script(text, "s.json").error(); };
  EXPECT_EQ(place("{\"knead\": 1,\n \"commands\": [\n  {\"do\": \"step\"},,\n]}").line, 3);
  EXPECT_EQ(place(R"({"knead":1,"commands":[{"do":"step"},{"do":"tool","radius":"x"}]})").where, "commands[1].radius");
  EXPECT_EQ(place(R"({"knead":2,"commands":[]})").where, "knead");
  EXPECT_EQ(place(R"({"knead":1})").where, "commands");
  EXPECT_EQ(place(R"({"knead":1,"commands":[],"comands":[]})").where, "comands");
  EXPECT_EQ(place("").file, "s.json");
}

TEST(CommandJson, HelpNamesEveryCommandAndField) {
  const std::string help = command_help();
  for (const char* word : {"select",   "surface", "material",  "alpha",          "beta",     "rest",   "mode",
                           "hold",     "rows",    "pin",       "control_points", "release",  "tool",   "radius",
                           "position", "at",      "stiffness", "range",          "relative", "remove", "move",
                           "by",       "step",    "count",     "lambda",         "weight",   "undo",   "redo"}) {
    EXPECT_NE(help.find(std::string(" ") + word + " "), std::string::npos) << word;
  }
}

}  // namespace
}  // namespace knead
