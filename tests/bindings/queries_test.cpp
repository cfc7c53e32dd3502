#include "queries.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "describe/text.hpp"
#include "knead/session/command_json.hpp"

namespace knead::studio {
namespace {

using JsonValue = nlohmann::json;

/// The page's end of the call.
class QueriesOfThePage : public ::testing::Test {
 protected:
  JsonValue ask(const std::string& query, const JsonValue& request = JsonValue::object(),
                const std::string& bytes = "") {
    const std::string text = JsonValue{{"query", query}, {"request", request}}.dump();
    return JsonValue::parse(call(studio_, bytes + text, text.size(), kept_));
  }
  JsonValue answer(const std::string& query, const JsonValue& request = JsonValue::object(),
                   const std::string& bytes = "") {
    const JsonValue reply = ask(query, request, bytes);
    EXPECT_TRUE(reply.contains("answer")) << query << ": " << reply;
    return reply.value("answer", JsonValue());
  }
  std::string bytes_of(const JsonValue& reply) {
    EXPECT_EQ(reply["memory"][""][0], "Uint8Array");
    const auto at = reply["memory"][""][1].get<std::uintptr_t>();
    return {reinterpret_cast<const char*>(at), reply["memory"][""][2].get<std::size_t>()};
  }
  void sheet() {
    answer("fresh", {{"name", "sheet"}});
    answer("act", {{"commands",
                    {{{"do", "new"}, {"size", {10, 10}}, {"net", {6, 6}}},
                     {{"do", "tool"}, {"name", "ball"}, {"radius", 1}, {"position", {5, 5, 3}}},
                     {{"do", "new"}, {"shape", "curve"}, {"size", 5}, {"net", 6}},
                     {{"do", "select"}, {"surface", "#1"}}}}});
  }
  Studio studio_;
  Answer kept_;
};

/// A value for a field that must be there.
JsonValue value_for(const Field& field) {
  if (field.name == "name") return "x.stl";
  switch (field.type->kind) {
    case Kind::text:
      return "x";
    case Kind::array:
      if (field.type->element->kind == Kind::integer)
        return std::vector<int>(field.type->length, 4);
      return std::vector<double>(field.type->length, 0.5);
    case Kind::opaque:
      return field.type->name == "AnyCommand[]" ? JsonValue::array() : JsonValue(0);
    default:
      return field.name == "teeth" || field.name == "margin" ? 1 : 0;
  }
}

void expect_type(const Type& type, const JsonValue& value, const std::string& at);

void expect_member(const Field& field, const JsonValue& object, const std::string& at) {
  const std::string name(field.name);
  if (object.contains(name)) {
    // Numbers that are all the same may be one.
    const bool one = field.uniform && object[name].is_number();
    return expect_type(one ? *field.type->element : *field.type, object[name], at + "." + name);
  }
  EXPECT_TRUE(field.omit_empty) << at << "." << name << " is missing";
}

/// `tag`: the object is of a variant, which leaves out what has no value.
void expect_record(const Type& type, const JsonValue& object, const std::string& at,
                   std::string_view tag = {}) {
  ASSERT_TRUE(object.is_object()) << at << ": " << object;
  std::set<std::string> known = {std::string(tag)};
  for (const Field& field : type.fields) {
    known.emplace(field.name);
    if (field.type->kind == Kind::opaque) continue;
    if (!field.flat) {
      if (tag.empty() || field.type->kind != Kind::optional ||
          object.contains(std::string(field.name))) {
        expect_member(field, object, at);
      }
      continue;
    }
    const int k = field.type->variant(object.value(std::string(field.name), ""));
    ASSERT_GE(k, 0) << at << "." << field.name;
    for (const Field& part : field.type->variants[static_cast<std::size_t>(k)]->fields) {
      known.emplace(part.name);
      if (part.type->kind != Kind::opaque) expect_member(part, object, at);
    }
  }
  for (const auto& [name, value] : object.items())
    EXPECT_TRUE(known.contains(name)) << at << "." << name;
}

void expect_type(const Type& type, const JsonValue& value, const std::string& at) {
  switch (type.kind) {
    case Kind::boolean:
      EXPECT_TRUE(value.is_boolean()) << at << ": " << value;
      break;
    case Kind::integer:
      EXPECT_TRUE(value.is_number_integer()) << at << ": " << value;
      break;
    case Kind::number:
      EXPECT_TRUE(value.is_number()) << at << ": " << value;
      break;
    case Kind::text:
      EXPECT_TRUE(value.is_string()) << at << ": " << value;
      break;
    case Kind::choice:
      EXPECT_TRUE(value.is_string() && type.choice(value.get<std::string>()) != nullptr)
          << at << ": " << value;
      break;
    case Kind::optional:
      if (!value.is_null()) expect_type(*type.element, value, at);
      break;
    case Kind::list:
    case Kind::array:
      ASSERT_TRUE(value.is_array()) << at << ": " << value;
      EXPECT_TRUE(type.kind == Kind::list || value.size() == type.length) << at;
      for (std::size_t k = 0; k < value.size(); ++k) {
        expect_type(*type.element, value[k], at + "[" + std::to_string(k) + "]");
      }
      break;
    case Kind::record:
      expect_record(type, value, at);
      break;
    case Kind::variant: {
      ASSERT_TRUE(value.is_object()) << at << ": " << value;
      const int k = type.variant(value.value(std::string(type.name), ""));
      ASSERT_GE(k, 0) << at << ": " << value;
      expect_record(*type.variants[static_cast<std::size_t>(k)], value, at, type.name);
      break;
    }
    case Kind::opaque:  // in memory, or a value of the page's own type
      EXPECT_EQ(type.name == "AnyCommand[]", value.is_array()) << at << ": " << value;
      break;
  }
}

TEST_F(QueriesOfThePage, SayWhatTheyAreAndHaveTypes) {
  std::set<std::string_view> names;
  TypeScript types;
  declare_queries(types);
  for (const Query& query : queries()) {
    const Type& request = *query.request;
    EXPECT_TRUE(names.insert(request.name).second) << request.name;
    EXPECT_TRUE(request.help.ends_with('.')) << request.name;
    for (const Field& field : request.fields)
      EXPECT_FALSE(field.help.empty()) << request.name << "." << field.name;
    EXPECT_NE(types.text.find("\n  " + std::string(request.name) + ": { request: "),
              std::string::npos)
        << request.name;
  }
  EXPECT_EQ(types.text.find(": unknown"), std::string::npos);
}

TEST_F(QueriesOfThePage, TypesHaveEveryCommandAsAMethod) {
  TypeScript types;
  declare_commands(types);
  for (const std::string& command : command_names()) {
    EXPECT_NE(types.text.find("\n  '" + command + "'(fields"), std::string::npos) << command;
    EXPECT_NE(types.text.find("\n  " + command + ": '"), std::string::npos) << command;
  }
  EXPECT_NE(
      types.text.find(
          "'step'(count: NonNullable<StepCommand['count']>, fields?: Omit<StepCommand, 'do' | "
          "'count'> & Options): Result;"),
      std::string::npos);
}

TEST_F(QueriesOfThePage, RunAScriptWholeOrNotAtAll) {
  sheet();
  const auto run = [this](const std::string& script, bool list) {
    return ask("run", {{"script", script.size()}, {"list", list}, {"name", "press.json"}}, script);
  };
  const std::string good = R"({"do": "hold", "rows": 1}, {"do": "measure", "name": "middle"})";
  const JsonValue refused = run(
      R"({"knead": 2, "commands": [)" + good + R"(, {"do": "select", "surface": "#9"}]})", false);
  EXPECT_EQ(refused["file"], "press.json");
  EXPECT_EQ(refused["error"]["where"], "commands[2]: surface");
  EXPECT_EQ(answer("state")["surfaces"][0]["hold"], 0);
  EXPECT_EQ(run("{\n]", false)["line"], 2);
  EXPECT_TRUE(run("[" + good + "]", true).contains("answer"));
  EXPECT_EQ(answer("state")["surfaces"][0]["hold"], 1);
  // Each command is an entry of the history.
  answer("execute", {{"commands", {{{"do", "undo"}}}}});
  EXPECT_EQ(answer("state")["surfaces"][0]["hold"], 1);
  EXPECT_EQ(answer("state")["readings"].size(), 0);
}

TEST_F(QueriesOfThePage, CommandsAreStoppedBetweenSteps) {
  sheet();
  answer("execute", {{"commands", {{{"do", "hold"}, {"rows", 1}}}}});
  int told = 0;
  studio_.progress = [&](int steps, int total) {
    EXPECT_EQ(total, 9);
    told = steps;
    return steps < 3;
  };
  answer("execute",
         {{"commands", {{{"do", "step"}, {"count", 9}}, {{"do", "hold"}, {"rows", 2}}}}});
  EXPECT_EQ(told, 3);
  EXPECT_EQ(answer("state")["steps"], 3);
  EXPECT_EQ(answer("state")["surfaces"][0]["hold"], 1);
}

TEST_F(QueriesOfThePage, AnswerEachInItsType) {
  const std::set<std::string_view> of_files = {"open", "restore", "face_reading"};
  for (const Query& query : queries()) {
    const std::string name(query.request->name);
    if (!of_files.contains(name)) sheet();
    JsonValue request = JsonValue::object();
    for (const Field& field : query.request->fields) {
      if (field.presence == Presence::required) request[std::string(field.name)] = value_for(field);
    }
    if (name == "section_combs") request["plane"] = {1, 0, 0, 4.5};
    if (name == "morphed" || name == "deviation") request["space"] = "0; 0; 1";
    const std::string script = name == "run" ? R"({"knead": 2, "commands": []})" : "";
    if (name == "run") request["script"] = script.size();
    const JsonValue reply = ask(name, request, script);
    ASSERT_EQ(reply.contains("error"), of_files.contains(name)) << name << ": " << reply;
    if (reply.contains("error")) continue;
    const Type& type = *query.answer;
    expect_type(type, reply["answer"], name);
    const JsonValue& held = reply.value("memory", JsonValue::object());
    EXPECT_EQ(type.kind == Kind::opaque && type.count != nullptr, held.contains("")) << name;
    for (const Field& field : type.fields) {
      const std::string member(field.name);
      EXPECT_EQ(field.type->kind == Kind::opaque, held.contains(member)) << name << "." << member;
      EXPECT_TRUE(!held.contains(member) || held[member][0] == std::string(field.type->name))
          << name << "." << member;
    }
  }
}

TEST_F(QueriesOfThePage, CheckHasTheCourseOfEdgesWhereItIsAskedFor) {
  sheet();
  const JsonValue plain = answer("check"), drawn = answer("check", {{"courses", true}});
  ASSERT_EQ(plain["edges"].size(), 4);
  ASSERT_EQ(drawn["edges"].size(), 4);
  for (const JsonValue& edge : plain["edges"]) EXPECT_FALSE(edge.contains("course"));
  for (const JsonValue& edge : drawn["edges"]) {
    EXPECT_EQ(edge["course"].front(), edge["start"]);
    EXPECT_EQ(edge["course"].back(), edge["end"]);
  }
  EXPECT_EQ(ask("check", {{"courses", "x"}})["error"]["where"], "courses");
}

TEST_F(QueriesOfThePage, ThatAreWrongAreErrorsThatNameTheField) {
  EXPECT_EQ(ask("state")["error"]["what"], "nothing is open");
  EXPECT_EQ(ask("beauty")["error"]["what"], "the engine answers no query \"beauty\"");
  sheet();
  EXPECT_EQ(ask("edge_distance")["error"]["where"], "surface");
  EXPECT_EQ(ask("edge_distance", {{"surface", "x"}})["error"]["where"], "surface");
  EXPECT_EQ(ask("edge_distance", {{"surface", 0}, {"colour", 1}})["error"]["where"], "colour");
  EXPECT_EQ(ask("act")["error"]["where"], "commands");
  EXPECT_EQ(ask("act", {{"commands", "undo"}})["error"]["where"], "commands");
  EXPECT_EQ(ask("picture", {{"surface", 0},
                            {"display", "draft"},
                            {"settings", {{"direction", {0, "x", 1}}}}})["error"]["where"],
            "settings.direction");
  EXPECT_EQ(ask("picture", {{"surface", 9}})["error"]["kind"], "usage");
  EXPECT_EQ(ask("act", {{"commands", {{{"do", "step"}, {"count", "x"}}}}})["error"]["where"],
            "count");
  EXPECT_EQ(ask("open", {{"name", "x.step"}, {"file", 100}}, "few")["error"]["kind"], "usage");
  EXPECT_TRUE(JsonValue::parse(call(studio_, "no JSON", 7, kept_)).contains("error"));
  EXPECT_TRUE(JsonValue::parse(call(studio_, "short", 100, kept_)).contains("error"));
}

TEST_F(QueriesOfThePage, TakeBytesInTheOrderOfTheRequest) {
  sheet();
  const JsonValue state = answer("state");
  const std::string snapshot = bytes_of(ask("snapshot", {{"history_bytes", 0}}));
  answer("fresh", {{"name", "another"}});
  // The source is of no bytes, wherever it stands.
  answer("restore", {{"name", "sheet"}, {"snapshot", snapshot.size()}, {"source", 0}}, snapshot);
  EXPECT_EQ(answer("state")["surfaces"], state["surfaces"]);
}

TEST_F(QueriesOfThePage, LeaveArraysInMemory) {
  sheet();
  const JsonValue reply = ask("picture", {{"surface", 0}, {"detail", 8}, {"display", "deviation"}});
  const auto [m, n] = reply["answer"]["counts"].get<std::array<std::size_t, 2>>();
  EXPECT_EQ(reply["memory"]["positions"][0], "Float32Array");
  EXPECT_EQ(reply["memory"]["positions"][2], 3 * m * n);
  EXPECT_EQ(reply["memory"]["values"][2], m * n);
  EXPECT_EQ(reply["memory"]["lines_u"][0], "Uint32Array");
  const auto* first =
      reinterpret_cast<const float*>(reply["memory"]["positions"][1].get<std::uintptr_t>());
  EXPECT_EQ(first, studio_.pictures.picture().positions.data());  // not copied
  EXPECT_EQ(ask("control_points", {{"surface", 0}})["memory"][""][2], 3 * 36);
}

}  // namespace
}  // namespace knead::studio
