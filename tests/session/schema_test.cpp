// The schemas of scripts and documents hold for the files there are; the tables of docs/scripts.md are those of the
// engine.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "knead/session/command_json.hpp"
#include "knead/session/session_info.hpp"

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

/// What of a value is against a schema, with its place; empty where all is right. The part of JSON schema that is used.
std::string against(const Json& value, const Json& schema, const std::string& place) {
  for (const auto& [word, wanted] : schema.items()) {
    const std::string here = place + " (" + word + ")";
    if (word == "type") {
      const bool right = wanted == "object"    ? value.is_object()
                         : wanted == "array"   ? value.is_array()
                         : wanted == "string"  ? value.is_string()
                         : wanted == "boolean" ? value.is_boolean()
                         : wanted == "integer"
                             ? value.is_number() && value.get<double>() == std::floor(value.get<double>())
                         : wanted == "number" ? value.is_number()
                                              : value.is_null();
      if (!right) return here;
    } else if (word == "const") {
      if (value != wanted) return here;
    } else if (word == "enum") {
      if (std::ranges::find(wanted, value) == wanted.end()) return here;
    } else if (word == "required") {
      for (const Json& name : wanted) {
        if (!value.contains(name.get<std::string>())) return here + ": " + name.get<std::string>();
      }
    } else if (word == "properties") {
      for (const auto& [name, member] : value.items()) {
        if (!wanted.contains(name)) {
          if (schema.value("additionalProperties", true)) continue;
          return place + " (unknown): " + name;
        }
        if (auto wrong = against(member, wanted.at(name), place + "." + name); !wrong.empty()) return wrong;
      }
    } else if (word == "items") {
      for (std::size_t k = 0; value.is_array() && k < value.size(); ++k) {
        if (auto wrong = against(value[k], wanted, place + "[" + std::to_string(k) + "]"); !wrong.empty()) return wrong;
      }
    } else if (word == "oneOf" || word == "anyOf") {
      const auto right =
          std::ranges::count_if(wanted, [&](const Json& one) { return against(value, one, "").empty(); });
      if (right == 0 || (word == "oneOf" && right > 1)) return here;
    } else if (word == "minimum") {
      if (value < wanted) return here;
    } else if (word == "maximum") {
      if (value > wanted) return here;
    } else if (word == "exclusiveMinimum") {
      if (value <= wanted) return here;
    } else if (word == "exclusiveMaximum") {
      if (value >= wanted) return here;
    } else if (word == "pattern") {
      if (!value.is_string() || !std::regex_search(value.get<std::string>(), std::regex(wanted.get<std::string>())))
        return here;
    } else if (word == "minItems") {
      if (value.size() < wanted) return here;
    } else if (word == "maxItems") {
      if (value.size() > wanted) return here;
    } else if (word != "$schema" && word != "description" && word != "default" && word != "additionalProperties") {
      return here + ": this test does not know the word";
    }
  }
  return "";
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

TEST(Schema, EveryFieldOfEveryCommandHasAText) {
  const Json schema = Json::parse(script_schema());
  int fields = 0;
  for (const Json& command : schema.at("properties").at("commands").at("items").at("oneOf")) {
    const std::string name = command.at("properties").at("do").at("const");
    EXPECT_NE(command.value("description", ""), "") << name;
    for (const auto& [field, member] : command.at("properties").items()) {
      if (field == "do") continue;
      EXPECT_NE(member.value("description", ""), "") << name << "." << field;
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
        const bool allowed = against(json, command, "").empty(), read = parse_command(json.dump()).has_value();
        EXPECT_EQ(allowed, read) << json;
        taken += read;
      }
    }
  }
  EXPECT_EQ(taken, 4 + 4) << "the middle of tool, edit_tool, drag and measure; three sides and an edge";
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
    const std::string expected = "<!-- fields of " + name + " -->\n" + table + "<!-- end of fields -->\n";
    EXPECT_NE(page.find(expected), std::string::npos) << "run scripts/docs.sh; " << name << ":\n" << table;
  }
}

TEST(SessionTypes, TheModuleDeclaresWhatThePageReads) {
  const std::string types = session_typescript();
  for (const char* text :
       {"export type AnyCommand =", "export type SessionInfo = {", "export type SurfaceInfo = {",
        "export type ToolInfo = {", "export type StepInfo = {", "  last: StepInfo | null;",
        "  constraints: AnyCommand[];", "  limit: number | null;", "  do: 'evolve';", "  lambda: number;",
        "  alpha: [number | null, number | null, number | null];", "  radius?: number;"}) {
    EXPECT_NE(types.find(text), std::string::npos) << text << "\n" << types;
  }
}

}  // namespace
}  // namespace knead::testing
