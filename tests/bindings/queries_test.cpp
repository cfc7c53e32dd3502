#include "queries.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "session/described_text.hpp"

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
  if (field.name == "format") return "stl";
  switch (field.type->kind) {
    case Kind::text:
      return "x";
    case Kind::array:
      if (field.type->element->kind == Kind::integer) return std::vector<int>(field.type->length, 4);
      return std::vector<double>(field.type->length, 0.5);
    case Kind::opaque:
      return field.type->name == "AnyCommand[]" ? JsonValue::array() : JsonValue(0);
    default:
      return field.name == "teeth" || field.name == "margin" ? 1 : 0;
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
    for (const Field& field : request.fields) EXPECT_FALSE(field.help.empty()) << request.name << "." << field.name;
    EXPECT_NE(types.text.find("\n  " + std::string(request.name) + ": { request: "), std::string::npos) << request.name;
  }
  EXPECT_EQ(types.text.find(": unknown"), std::string::npos);
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
    const JsonValue reply = ask(name, request);
    ASSERT_EQ(reply.contains("error"), of_files.contains(name)) << name << ": " << reply;
    if (reply.contains("error")) continue;
    const Type& type = *query.answer;
    if (type.kind == Kind::record) {
      for (const Field& field : type.fields) {
        const std::string member(field.name);
        EXPECT_TRUE(field.type->kind == Kind::opaque ? reply["memory"].contains(member)
                                                     : reply["answer"].contains(member))
            << name << "." << member;
      }
    }
    EXPECT_EQ(type.kind == Kind::list, reply["answer"].is_array() && type.kind != Kind::array) << name;
  }
}

TEST_F(QueriesOfThePage, ThatAreWrongAreErrorsThatNameTheField) {
  EXPECT_EQ(ask("state")["error"]["what"], "nothing is open");
  EXPECT_EQ(ask("beauty")["error"]["what"], "the engine answers no query \"beauty\"");
  sheet();
  EXPECT_EQ(ask("room")["error"]["where"], "surface");
  EXPECT_EQ(ask("room", {{"surface", "x"}})["error"]["where"], "surface");
  EXPECT_EQ(ask("room", {{"surface", 0}, {"colour", 1}})["error"]["where"], "colour");
  EXPECT_EQ(ask("act")["error"]["where"], "commands");
  EXPECT_EQ(ask("act", {{"commands", "undo"}})["error"]["where"], "commands");
  EXPECT_EQ(ask("picture",
                {{"surface", 0}, {"display", "draft"}, {"settings", {{"direction", {0, "x", 1}}}}})["error"]["where"],
            "settings.direction");
  EXPECT_EQ(ask("picture", {{"surface", 9}})["error"]["kind"], "usage");
  EXPECT_EQ(ask("act", {{"commands", {{{"do", "step"}, {"count", "x"}}}}})["error"]["where"], "count");
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
  const auto* first = reinterpret_cast<const float*>(reply["memory"]["positions"][1].get<std::uintptr_t>());
  EXPECT_EQ(first, studio_.pictures.picture().positions.data());  // not copied
  EXPECT_EQ(ask("control_points", {{"surface", 0}})["memory"][""][2], 3 * 36);
}

}  // namespace
}  // namespace knead::studio
