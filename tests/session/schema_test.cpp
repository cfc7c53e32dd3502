// The schemas of scripts and documents hold for the files there are; the tables of docs/scripts.md
// are those of the engine.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "knead/session/command_json.hpp"
#include "knead/session/session_info.hpp"
#include "schema_check.hpp"

namespace knead::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(Schema, TheScriptsOfTheRepositoryAreValid) {
  const Json schema = Json::parse(script_schema());
  const fs::path root = KNEAD_SOURCE_DIR;
  int checked = 0;
  for (const char* folder : {"examples", "samples", "tests/scenarios"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (entry.path().extension() != ".json") continue;
      Json script = Json::parse(text_of(entry.path()), nullptr, false);
      if (!script.is_object() || !script.contains("commands")) continue;
      script = {{"knead", 2}, {"commands", script.at("commands")}};
      EXPECT_EQ(against(script, schema, entry.path().filename()), "");
      ++checked;
    }
  }
  EXPECT_GT(checked, 5);
}

TEST(Schema, WhatIsWrongIsFound) {
  const Json schema = Json::parse(script_schema());
  const auto wrong = [&schema](const std::string& command) {
    return !against(Json::parse(R"({"knead":2,"commands":[)" + command + "]}"), schema, "").empty();
  };
  EXPECT_FALSE(wrong(R"({"do":"step","count":3})"));
  EXPECT_TRUE(wrong(R"({"do":"hammer"})"));
  EXPECT_TRUE(wrong(R"({"do":"step","cuont":3})"));
  EXPECT_TRUE(wrong(R"({"do":"step","count":2.5})"));
  EXPECT_TRUE(wrong(R"({"do":"move"})"));
  EXPECT_TRUE(wrong(R"({"do":"tool","radius":0,"at":[0,0]})"));
  EXPECT_TRUE(wrong(R"({"do":"tool","mode":"glue","at":[0,0]})"));
}

/// Whether a schema lists texts without saying of each what it means.
bool has_bare_choices(const Json& schema) {
  if (schema.contains("enum")) return true;
  for (const char* word : {"oneOf", "anyOf"}) {
    if (schema.contains(word) && std::ranges::any_of(schema.at(word), has_bare_choices))
      return true;
  }
  if (schema.contains("items")) return has_bare_choices(schema.at("items"));
  return schema.contains("const") && schema.value("description", "").empty() &&
         schema.at("const") != "middle";
}

TEST(Schema, EveryFieldAndChoiceOfEveryCommandHasAText) {
  const Json schema = Json::parse(script_schema());
  int fields = 0;
  for (const Json& command : schema.at("properties").at("commands").at("items").at("oneOf")) {
    const std::string name = command.at("properties").at("do").at("const");
    EXPECT_NE(command.value("description", ""), "") << name;
    for (const auto& [field, member] : command.at("properties").items()) {
      if (field == "do") continue;
      EXPECT_NE(member.value("description", ""), "") << name << "." << field;
      EXPECT_FALSE(has_bare_choices(member)) << name << "." << field;
      ++fields;
    }
  }
  EXPECT_GT(fields, 250);
}

// What stands for another field is in the schema where the reader takes it, and nowhere else.
TEST(Schema, AllowsTheTextsThatTheReaderOfCommandsTakes) {
  const Json schema = Json::parse(script_schema());
  int taken = 0;
  for (const Json& command : schema.at("properties").at("commands").at("items").at("oneOf")) {
    const std::string name = command.at("properties").at("do").at("const");
    for (const char* const field : {"at", "which"}) {
      for (const char* const text : {"middle", "mid", "#45", "u0", "w1", "all", ""}) {
        Json json = {{"do", name}, {field, text}};
        if (name == "drag") json["by"] = {0, 0, 1};
        const bool allowed = against(json, command, "").empty(),
                   read = parse_command(json.dump()).has_value();
        EXPECT_EQ(allowed, read) << json;
        taken += read;
      }
    }
  }
  EXPECT_EQ(taken, 4 + 4)
      << "the middle of tool, edit_tool, drag and measure; three sides and an edge";
}

TEST(Schema, DocumentsHaveCommandsAndASource) {
  const Json schema = Json::parse(document_schema());
  Json document = {{"knead", 3}, {"name", "a"}, {"commands", Json::array({{{"do", "step"}}})}};
  EXPECT_EQ(against(document, schema, ""), "");
  document["source"] = {{"kind", "step"}, {"name", "a.step"}, {"bytes", ""}};
  EXPECT_EQ(against(document, schema, ""), "");
  document["source"]["kind"] = "paper";
  EXPECT_NE(against(document, schema, ""), "");
}

TEST(Docs, TheTablesOfCommandsAreThoseOfTheEngine) {
  const std::string page = text_of(fs::path(KNEAD_SOURCE_DIR) / "docs/scripts.md");
  for (const std::string& name : command_names()) {
    const std::string table = command_table(name);
    if (table.empty()) continue;
    const std::string expected =
        "<!-- fields of " + name + " -->\n" + table + "<!-- end of fields -->\n";
    EXPECT_NE(page.find(expected), std::string::npos) << "run scripts/docs.sh; " << name << ":\n"
                                                      << table;
  }
}

TEST(SessionTypes, TheModuleDeclaresWhatThePageReads) {
  const std::string types = session_typescript();
  for (const char* text :
       {"export type AnyCommand =", "export type SessionInfo = {", "export type SurfaceInfo = {",
        "export type ToolInfo = {", "export type StepInfo = {", "  last: StepInfo | null;",
        "  constraints: AnyCommand[];", "  limit: number | null;", "  do: 'evolve';",
        "  lambda: number;", "  alpha: [number | null, number | null, number | null];",
        "  radius?: number;"}) {
    EXPECT_NE(types.find(text), std::string::npos) << text << "\n" << types;
  }
}

}  // namespace
}  // namespace knead::testing
