#include "knead/session/command_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "session/commands.hpp"

namespace knead {
namespace {

template <class C>
C parsed(const std::string& json) {
  auto command = parse_command(json);
  if (!command) {
    ADD_FAILURE() << json << ": " << command.error().message();
    return {};
  }
  const C* const fields = fields_of<C>(*command);
  if (fields == nullptr) {
    ADD_FAILURE() << json << " is another command";
    return {};
  }
  return *fields;
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
  const auto material =
      parsed<MaterialCommand>(R"({"do":"material","alpha":[1,0.5,2],"beta":[3,4,5]})");
  EXPECT_EQ(material.alpha, (std::vector<double>{1, 0.5, 2}));
  EXPECT_EQ(material.beta, (std::vector<double>{3, 4, 5}));
  EXPECT_EQ(parsed<RestCommand>(R"({"do":"rest","mode":"none"})").mode, RestMode::none);
  EXPECT_EQ(parsed<HoldCommand>(R"({"do":"hold","rows":3})").rows, 3);
  EXPECT_EQ(parsed<PinCommand>(R"({"do":"pin","control_points":[[1,2],[3,4]]})").control_points,
            (std::vector<std::vector<int>>{{1, 2}, {3, 4}}));
  parsed<ReleaseCommand>(R"({"do":"release"})");
  const auto tool = parsed<ToolCommand>(
      R"({"do":"tool","name":"ball","shape":"sphere","radius":0.1,"position":[1,2,3],)"
      R"("mode":"proximity","stiffness":50,"range":0.05,"relative":true})");
  EXPECT_EQ(tool.name, "ball");
  EXPECT_EQ(tool.measures.radius, 0.1);
  EXPECT_EQ(tool.position, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(tool.mode, ToolMode::proximity);
  EXPECT_EQ(tool.stiffness, 50);
  EXPECT_EQ(tool.range, 0.05);
  EXPECT_TRUE(tool.relative);
  EXPECT_EQ(parsed<ToolCommand>(R"({"do":"tool","at":[0.5,0.25]})").at,
            (std::array<double, 2>{0.5, 0.25}));
  EXPECT_EQ(parsed<RemoveCommand>(R"({"do":"remove","tool":"ball"})").tool, "ball");
  const auto move = parsed<MoveCommand>(R"({"do":"move","tool":"ball","by":[1,-2,3.5]})");
  EXPECT_EQ(move.tool, "ball");
  EXPECT_EQ(move.by, (std::array<double, 3>{1, -2, 3.5}));
  const auto step =
      parsed<StepCommand>(R"({"do":"step","count":60,"lambda":2.5,"weight":"identity"})");
  EXPECT_EQ(step.count, 60);
  EXPECT_EQ(step.lambda, 2.5);
  EXPECT_EQ(step.weight, StepWeight::identity);
  parsed<UndoCommand>(R"({"do":"undo"})");
  parsed<RedoCommand>(R"({"do":"redo"})");
}

/// Every command with all of its fields, none at its default.
const std::vector<std::string> all_commands = {
    R"({"do":"new","shape":"torus","radius":3,"minor":0.5,"profile":[],)"
    R"("degree":[2,4],"net":[5,6],"knots_u":[0,0,1,1],"knots_v":[0,1],)"
    R"("points":[[1,2,3],[4,5,0.10000000000000001]],"weights":[1,2.5],)"
    R"("position":[1,2,3],"unit":"inch","name":"a \"b\""})",
    R"({"do":"new","shape":"plane","size":[2,3],"profile":[],"degree":3,"net":8,)"
    R"("knots_u":[],"knots_v":[],"points":[],"weights":[],"position":[0,0,0]})",
    R"({"do":"new","shape":"revolution","profile":[[1,0],[2,1.5]],"degree":3,)"
    R"("net":8,"knots_u":[],"knots_v":[],"points":[],"weights":[],)"
    R"("position":[0,0,0]})",
    R"({"do":"new","shape":"curve","form":"helix","radius":1,"height":4,"turns":2,)"
    R"("profile":[],"degree":3,"net":8,"knots_u":[],"knots_v":[],"points":[],)"
    R"("weights":[],"position":[0,0,0]})",
    R"({"do":"convert","surface":"#1","surfaces":["#2","#3"],"neighbours":true})",
    R"({"do":"select","surface":"#1","surfaces":["#2","#3"],"connected":true})",
    R"({"do":"lock","surfaces":["#2"],"locked":false})",
    R"({"do":"material","alpha":[0.10000000000000001,0.5,1],"beta":[1e-300,2,3],)"
    R"("mass":2,"damping":3,"region":[[0,0.5],[0.25,1]],"falloff":0.25,)"
    R"("coefficient":"beta22","counts":[2,2],"samples":[1,2,3,4],"reset":true})",
    R"({"do":"rest","mode":"none"})",
    R"({"do":"scaling","mode":"raw"})",
    R"({"do":"hold","rows":3})",
    R"({"do":"pin","control_points":[[1,2],[3,4]],"at":[0.5,0.25],"to":[1,2,3]})",
    R"({"do":"edge","which":"v1","hold":"curvature"})",
    R"({"do":"freeze","region":[[0.25,0.5],[0,0.125]]})",
    R"({"do":"keep","u":0.5,"v":0.25,"curve":[[0,0],[1,1]],"tolerance":0.001})",
    R"({"do":"symmetry","edge":"u1","mirror":"v","point":[1,2,3],"normal":[0,0,1]})",
    R"({"do":"smooth","knot_lines":false,"poles":false})",
    R"({"do":"seams","couple":false,"tolerance":0.5,"smooth":false})",
    R"({"do":"release"})",
    R"({"do":"release","what":["pins","symmetry"]})",
    R"({"do":"tool","name":"t","shape":"torus","radius":1,"minor":0.25,)"
    R"("axis":[1,0,0],"orientation":[0,0,0,1],"scale":[1,2,3],"position":[1,2,3],)"
    R"("at":[0.5,1],"mode":"proximity","stiffness":5,"range":2,"direction":"push",)"
    R"("touches":"all","rigid":true,"friction":0.5,"plasticity":0.25,)"
    R"("relative":true})",
    R"({"do":"tool","name":"u","shape":"cone","radius":1,"height":3,)"
    R"("top_radius":0.5,"at":[0,1],"mode":"imprint","direction":"pull",)"
    R"("touches":"visible","rigid":false,"friction":0,"plasticity":0,)"
    R"("relative":false})",
    R"({"do":"tool","name":"u","shape":"bowl","thickness":0.125,"at":[0,1],)"
    R"("mode":"imprint","direction":"pull","touches":"visible","rigid":false,)"
    R"("friction":0,"plasticity":0,"relative":false})",
    R"({"do":"tool","name":"u","shape":"superellipsoid","exponents":[0.5,2],)"
    R"("at":[0,1],"mode":"imprint","direction":"pull","touches":"visible",)"
    R"("rigid":false,"friction":0,"plasticity":0,"relative":false})",
    R"({"do":"tool","name":"u","shape":"surface","surface":"#9","at":[0,1],)"
    R"("mode":"imprint","direction":"pull","touches":"visible","rigid":false,)"
    R"("friction":0,"plasticity":0,"relative":false})",
    R"({"do":"tool","name":"u","shape":"box","rounding":0.0625,"sizes":[1,2,3],)"
    R"("at":[0,1],"mode":"imprint","direction":"pull","touches":"visible",)"
    R"("rigid":false,"friction":0,"plasticity":0,"relative":false})",
    R"({"do":"edit_tool","relative":false})",
    R"({"do":"edit_tool","tool":"a","name":"a","shape":"torus","radius":1,)"
    R"("minor":0.25,"height":3,"top_radius":0.5,"thickness":0.125,)"
    R"("rounding":0.0625,"sizes":[1,2,3],"exponents":[0.5,2],"surface":"#9",)"
    R"("axis":[1,0,0],"orientation":[0,0,0,1],"scale":[1,2,3],"position":[1,2,3],)"
    R"("at":[0.5,1],"mode":"proximity","stiffness":5,"range":2,"direction":"push",)"
    R"("rigid":false,"friction":0.5,"plasticity":0.25,"relative":true})",
    R"({"do":"remove","tool":"a"})",
    R"({"do":"remove"})",
    R"({"do":"move","tool":"a","by":[0.33333333333333331,0,0],"relative":true})",
    R"({"do":"turn","tool":"a","axis":[0,1,0],"angle":30})",
    R"({"do":"scale","tool":"a","by":[1,2,3]})",
    R"({"do":"force","name":"f","kind":"volcano","at":[0.25,0.75],"to":[1,2,3],)"
    R"("strength":7,"core":0.5})",
    R"({"do":"load","vector":[1,2,3],"gravity":[0,0,-9],"pressure":2,)"
    R"("wind":[3,0,0],"counts":[2,2],"samples":[[1,0,0],[0,1,0],[0,0,1],[2,2,2]]})",
    R"({"do":"limit","distance":0.5,"relative":true})",
    R"({"do":"limit","relative":false})",
    R"({"do":"evolve","mode":"dynamic","lambda":3,"time_step":0.5,)"
    R"("weight":"identity","route":"gauss","accuracy":"interactive",)"
    R"("solver":"iterative","energy_tolerance":1e-08})",
    R"({"do":"evolve","mode":"static","lambda":1,"time_step":0.125,)"
    R"("weight":"mass","route":"analytic","accuracy":"exact","solver":"automatic",)"
    R"("energy_tolerance":1e-10})",
    R"({"do":"step","count":3,"lambda":1,"weight":"mass"})",
    R"({"do":"stroke","tool":"a","path":[[1,2,3],[4,5,6]],"steps":3,)"
    R"("plasticity":0.5,"relative":true})",
    R"({"do":"brush","kind":"inflate","path":[[0.25,0.5],[0.5,0.5]],)"
    R"("surface":"#1","surfaces":[],"pressure":[0.5,1],"presses":"size",)"
    R"("tilt":[[0,0,1],[0,1,1]],"radius":3,"height":-1,"strength":0.5,"core":0.25,)"
    R"("by":[1,2,3],"angle":30,"factor":2,"pattern":[],"steady":0.5,)"
    R"("mirror":[[1,2,3],[0,0,1]],"axis":[[1,2,3],[0,0,1]],"radial":3,"open":true,)"
    R"("relative":true})",
    R"({"do":"mask","change":"grow","radius":3,"relative":true})",
    R"({"do":"lattice","net":[4,5,6],"degree":[2,3,1],"margin":0.5,"steps":2,)"
    R"("lambda":3,"hold":["u0","w1"],"which":[],"again":false})",
    R"({"do":"lattice","net":[4,5,6],"degree":[2,3,1],"margin":0.5,"steps":2,)"
    R"("lambda":3,"hold":[],"which":[7],"by":[0,1,2],"again":false})",
    R"({"do":"morph","space":"x; y; 0","vectors":"1 2 3 0 0 1","from":"a","to":"b","scan":"c",)"
    R"("align":true,"noise":0.5,"scale":-1,"tolerance":0.25,"faces":["#1"],"keep":["#2"],)"
    R"("place":["a/b"],"convert":false,"refine":2,"reach":3,"along":"normal","unit":"mm",)"
    R"("columns":["a"],"field":"d","strict":true})",
    R"({"do":"points","which":[3,4],"rows_u":[1],"rows_v":[0,2],"by":[1,2,3],)"
    R"("to":[[1,2,3],[-0.0,5,6]],"relative":true})",
    R"({"do":"weights","which":[3,4],"rows_u":[1],"rows_v":[0,2],"weight":2,"by":0.5})",
    R"({"do":"knots","direction":"v","knots":[0,0,0.25,1,1]})",
    R"({"do":"relax","at":[0.5,0.25],"radius":0.5,"strength":0.25,"relative":true})",
    R"({"do":"drag","at":[0.5,0.25],"by":[1,2,3],"radius":0.5,"strength":5,)"
    R"("steps":3,"plasticity":0.5,"relative":true})",
    R"({"do":"refine","region":[[0,0.5],[0,1]],"under":"a","knots_u":[0.5,0.5],)"
    R"("knots_v":[0.25],"permission":"auto"})",
    R"({"do":"elevate","by":[0,2]})",
    R"({"do":"coarsen","tolerance":0.001})",
    R"({"do":"measure","name":"tip","surface":"#1","at":[0.25,1]})",
    R"({"do":"remove","measurement":"tip"})",
    R"({"do":"modes","count":4})",
    R"({"do":"buckling","count":2})",
    R"({"do":"undo"})",
    R"({"do":"redo"})"};

TEST(CommandJson, WritesWhatItReads) {
  std::set<std::string> names;
  for (const std::string& json : all_commands) {
    const auto command = parse_command(json);
    ASSERT_TRUE(command) << json << ": " << command.error().message();
    EXPECT_EQ(to_json(*command), json);
    names.insert(nlohmann::json::parse(json).at("do"));
  }
  const std::vector<std::string> known = command_names();
  EXPECT_EQ(names, std::set<std::string>(known.begin(), known.end())) << "every command is here";
}

TEST(CommandJson, EveryFieldOfEveryCommandIsNamedWhereItsValueIsWrong) {
  int fields = 0;
  for (const std::string& text : all_commands) {
    const nlohmann::json whole = nlohmann::json::parse(text);
    for (const auto& [field, value] : whole.items()) {
      if (field == "do") continue;
      for (const nlohmann::json& wrong :
           {nlohmann::json::object(), nlohmann::json(nullptr), nlohmann::json({"x", 1})}) {
        nlohmann::json json = whole;
        json[field] = wrong;
        const Error e = error_of(json.dump());
        EXPECT_EQ(e.where.substr(0, e.where.find('[')), field) << text;
        EXPECT_EQ(e.kind, ErrorKind::input);
        EXPECT_FALSE(e.remedy.empty());
      }
      ++fields;
    }
  }
  EXPECT_GT(fields, 90);
}

TEST(CommandJson, AScriptOfItsOwnWritingIsReadBack) {
  const std::vector<Command> commands = {make_command(HoldCommand{1}), make_command(StepCommand{}),
                                         make_command(UndoCommand{})};
  const auto read = parse_script(script_json(commands), "script");
  ASSERT_TRUE(read);
  EXPECT_EQ(script_json(*read), script_json(commands));
  EXPECT_EQ(parse_script(script_json({}), "script")->size(), 1U) << "the default hold";
}

TEST(CommandJson, AnUnknownCommandListsTheKnownOnes) {
  const Error e = error_of(R"({"do":"hammer"})");
  EXPECT_EQ(e.kind, ErrorKind::input);
  for (const char* name :
       {"select", "material", "rest", "hold", "pin", "tool", "move", "step", "undo", "redo"}) {
    EXPECT_NE(e.remedy.find(name), std::string::npos) << name;
  }
}

TEST(CommandJson, AnUnknownFieldListsTheKnownOnes) {
  const Error e = error_of(R"({"do":"step","cuont":3})");
  EXPECT_EQ(e.where, "cuont");
  EXPECT_NE(e.remedy.find("count, lambda, weight"), std::string::npos);
}

TEST(CommandJson, ATextIsNotGivenBesideTheFieldThatItStandsFor) {
  for (const auto& [json, field] :
       {std::pair(R"({"do":"measure","name":"a","at":"middle","middle":false})", "middle"),
        {R"({"do":"measure","name":"a","at":"middle","middle":true})", "middle"},
        {R"({"do":"edge","which":"#1","edge":"#2"})", "edge"}}) {
    const auto command = parse_command(json);
    ASSERT_FALSE(command) << json;
    EXPECT_EQ(command.error().where, field) << command.error().message();
    EXPECT_EQ(command.error().remedy, "leave one of them out");
  }
  EXPECT_EQ(parsed<EdgeCommand>(R"({"do":"edge","which":"#1"})").edge, "#1");
}

TEST(CommandJson, WrongValuesAreNamed) {
  EXPECT_EQ(error_of(R"({"do":"step","count":2.5})").where, "count");
  EXPECT_EQ(error_of(R"({"do":"step","count":1e30})").where, "count");
  EXPECT_EQ(error_of(R"({"do":"step","lambda":"1"})").where, "lambda");
  EXPECT_EQ(error_of(R"({"do":"tool","position":[1,2]})").where, "position");
  EXPECT_EQ(error_of(R"({"do":"tool","mode":"glue"})").where, "mode");
  EXPECT_EQ(error_of(R"({"do":"pin","control_points":[[1,0.5]]})").where, "control_points");
  EXPECT_EQ(error_of(R"({"count":3})").where, "do");
  EXPECT_EQ(error_of(R"([1])").kind, ErrorKind::input);
}

TEST(CommandJson, ScriptErrorsSayWhere) {
  const auto place = [](const std::string& text) { return parse_script(text, "s.json").error(); };
  EXPECT_EQ(place("{\"knead\": 2,\n \"commands\": [\n  {\"do\": \"step\"},,\n]}").line, 3);
  EXPECT_EQ(place(R"({"knead":2,"commands":[{"do":"step"},{"do":"tool","radius":"x"}]})").where,
            "commands[1].radius");
  EXPECT_EQ(place(R"({"knead":3,"commands":[]})").where, "knead");
  EXPECT_EQ(place(R"({"knead":2})").where, "commands");
  EXPECT_EQ(place(R"({"knead":2,"commands":[],"comands":[]})").where, "comands");
  EXPECT_EQ(place("").file, "s.json");
}

TEST(CommandJson, HelpNamesEveryCommandAndField) {
  const std::string brief = "\n" + command_help();
  for (const std::string& text : all_commands) {
    const nlohmann::json command = nlohmann::json::parse(text);
    const std::string name = command.at("do");
    const auto help = command_help(name);
    ASSERT_TRUE(help);
    for (const auto& [field, value] : command.items()) {
      if (field == "do") continue;
      EXPECT_NE(help->find("\n  " + field + " "), std::string::npos) << name << "." << field;
      EXPECT_NE(brief.find(" " + field, brief.find("\n  " + name + " ")), std::string::npos)
          << name << "." << field;
    }
  }
  EXPECT_EQ(command_help("hammer").error().kind, ErrorKind::usage);
}

}  // namespace
}  // namespace knead
