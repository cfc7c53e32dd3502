// What the schema of scripts allows is what the reader of commands accepts, and nothing else: shown
// by values drawn from the schema, and by the same values with one thing changed.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "../support/long_run.hpp"
#include "knead/session/command_json.hpp"
#include "schema_check.hpp"

namespace knead::testing {
namespace {

using Json = nlohmann::json;

bool is_required(const Json& command, const std::string& name) {
  const auto required = command.value("required", std::vector<std::string>());
  return std::ranges::find(required, name) != required.end();
}

/// Draws values that a schema allows: bounds of ranges as often as what lies between them, every
/// choice, lists of all lengths that are short, members that may be left out or not.
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : random_(seed) {}

  Json value(const Json& schema) {
    if (schema.contains("const")) return schema.at("const");
    for (const char* word : {"enum", "oneOf", "anyOf"}) {
      if (!schema.contains(word)) continue;
      const Json& all = schema.at(word);
      const Json& one = all.at(static_cast<std::size_t>(below(static_cast<int>(all.size()))));
      return std::string(word) == "enum" ? one : value(one);
    }
    if (schema.contains("pattern")) return "#" + std::to_string(below(1000));
    const std::string type = schema.at("type");
    if (type == "boolean") return below(2) == 0;
    if (type == "string") return std::string(static_cast<std::size_t>(below(4)), "a\" #"[below(4)]);
    if (type == "number") return number(schema);
    if (type == "integer") return std::floor(std::nextafter(number(schema, 1), 1e300));
    if (type == "array") return list(schema);
    return object(schema);
  }

  int below(int count) { return static_cast<int>(random_() % static_cast<std::uint32_t>(count)); }

 private:
  double number(const Json& schema, double step = 0) {
    const auto bound = [&](const char* closed, const char* open, double side) {
      if (schema.contains(closed)) return schema.at(closed).get<double>();
      if (!schema.contains(open)) return side * 1e300;
      const double x = schema.at(open);
      return step > 0 ? x - side * step : std::nextafter(x, -side * 1e300);
    };
    const double least = bound("minimum", "exclusiveMinimum", -1),
                 most = bound("maximum", "exclusiveMaximum", 1);
    if (const int kind = below(4); kind < 2) return kind == 0 ? least : most;
    const double from = std::max(least, -1e3), to = std::max(from, std::min(most, 1e3));
    return std::clamp(from + (to - from) * below(1001) / 1000, least, most);
  }
  Json list(const Json& schema) {
    const int least = schema.value("minItems", 0), most = schema.value("maxItems", least + 3);
    Json result = Json::array();
    for (int k = least + below(most - least + 1); k > 0; --k)
      result.push_back(value(schema.at("items")));
    return result;
  }
  Json object(const Json& schema) {
    Json result = Json::object();
    for (const auto& [name, member] : schema.at("properties").items()) {
      if (below(3) == 0 || is_required(schema, name)) result[name] = value(member);
    }
    // What depends on a member that has another value, or none, is left out.
    const Json dependents = schema.value("dependentSchemas", Json::object());
    for (const auto& [name, dependent] : dependents.items()) {
      if (result.contains(name) && !against(result, dependent, "").empty()) result.erase(name);
    }
    return result;
  }
  std::mt19937 random_;
};

/// The places in a value, of itself and all that is in it.
void places(const Json& value, const Json::json_pointer& here,
            std::vector<Json::json_pointer>& all) {
  all.push_back(here);
  if (value.is_object()) {
    for (const auto& [name, member] : value.items()) places(member, here / name, all);
  }
  if (value.is_array()) {
    for (std::size_t k = 0; k < value.size(); ++k) places(value[k], here / k, all);
  }
}

/// One thing changed: a member or entry removed, replaced, or added.
Json changed(Json value, const Json& command, Draw& draw) {
  static const std::vector<Json> others = {nullptr,
                                           true,
                                           0,
                                           -1,
                                           1,
                                           1.5,
                                           2,
                                           -0.5,
                                           1e11,
                                           3e9,
                                           -3e9,
                                           1e300,
                                           "",
                                           "middle",
                                           "#4",
                                           "u",
                                           "u0",
                                           "sphere",
                                           "plane",
                                           "glue",
                                           Json::array(),
                                           {0.5},
                                           {0.5, 0.5},
                                           {-1, 2},
                                           {0, 1, 2},
                                           {{0, 0}, {1, 1}},
                                           {"u0", "no"},
                                           Json::object()};
  const auto any_other = [&] {
    return others[static_cast<std::size_t>(draw.below(static_cast<int>(others.size())))];
  };
  const Json& properties = command.at("properties");
  std::vector<Json::json_pointer> all;
  places(value, Json::json_pointer(), all);
  const int kind = draw.below(6);
  if (kind == 0) {  // a field that may exist
    auto field = properties.begin();
    std::advance(field, draw.below(static_cast<int>(properties.size())));
    value[field.key()] = draw.below(2) == 0 ? any_other() : draw.value(field.value());
  } else if (kind == 1) {
    value[draw.below(2) == 0 ? "radiuss" : "which"] = any_other();
  } else if (all.size() > 1) {
    const Json::json_pointer place =
        all[1 + static_cast<std::size_t>(draw.below(static_cast<int>(all.size()) - 1))];
    Json& parent = value.at(place.parent_pointer());
    if (kind > 2) {
      value.at(place) = any_other();
    } else if (parent.is_object()) {
      parent.erase(place.back());
    } else {
      parent.erase(std::stoul(place.back()));
    }
  }
  return value;
}

const Json& commands() {
  static const Json schema = Json::parse(script_schema());
  return schema.at("properties").at("commands").at("items").at("oneOf");
}

TEST(SchemaDraw, WhatTheSchemaAllowsIsAccepted) {
  Draw draw(1);
  const int count = long_run() ? 20000 : 600;
  for (const Json& command : commands()) {
    std::set<std::string> met;
    for (int k = 0; k < count; ++k) {
      const Json drawn = draw.value(command);
      ASSERT_EQ(against(drawn, command, ""), "") << drawn;
      for (const auto& [name, value] : drawn.items()) met.insert(name);
      const auto read = parse_command(drawn.dump());
      ASSERT_TRUE(read) << drawn << "\n" << read.error().message();
    }
    EXPECT_EQ(met.size(), command.at("properties").size()) << command.at("properties").at("do");
  }
}

TEST(SchemaDraw, OneChangeIsRefusedWhereTheSchemaForbidsItAndOnlyThere) {
  Draw draw(2);
  const int count = long_run() ? 40000 : 1500;
  int allowed = 0, refused = 0;
  for (const Json& command : commands()) {
    for (int k = 0; k < count; ++k) {
      const Json value = changed(draw.value(command), command, draw);
      if (value.value("do", Json()) != command.at("properties").at("do").at("const"))
        continue;  // another command
      const std::string wrong = against(value, command, "");
      const auto read = parse_command(value.dump());
      ASSERT_EQ(wrong.empty(), read.has_value()) << value << "\n"
                                                 << wrong << (read ? "" : read.error().message());
      ++(read ? allowed : refused);
    }
  }
  EXPECT_GT(allowed, count);
  EXPECT_GT(refused, 10 * count);
}

// Each kind of what is wrong, at every field of every command that can be wrong in that way.
TEST(SchemaDraw, EveryFieldRefusesWhatIsOutOfRangeUnknownMissingOrOfAnotherType) {
  Draw draw(3);
  std::map<std::string, int> kinds;
  for (const Json& command : commands()) {
    for (const auto& [name, member] : command.at("properties").items()) {
      if (name == "do") continue;
      const auto is_refused = [&](const char* kind, const Json& value) {
        Json json = draw.value(command);
        json.erase(name);
        if (!value.is_discarded()) json[name] = value;
        EXPECT_FALSE(parse_command(json.dump())) << kind << ": " << json;
        ++kinds[kind];
      };
      is_refused("type", Json{{"a", 1}});
      is_refused("type", nullptr);
      if (is_required(command, name)) is_refused("missing", Json(Json::value_t::discarded));
      for (const auto& [word, outside] : {std::pair("minimum", -1), std::pair("maximum", 1)}) {
        if (member.contains(word)) is_refused("range", member.at(word).get<double>() + outside);
      }
      for (const char* word : {"exclusiveMinimum", "exclusiveMaximum"}) {
        if (member.contains(word)) is_refused("range", member.at(word));
      }
      if (member.contains("oneOf")) is_refused("choice", "glue");
    }
    Json more = draw.value(command);
    more["radiuss"] = 1;
    EXPECT_FALSE(parse_command(more.dump())) << more;
  }
  EXPECT_GT(kinds["type"], 500);
  EXPECT_GT(kinds["range"], 60);
  EXPECT_GT(kinds["choice"], 20);
  EXPECT_GT(kinds["missing"], 8);
}

}  // namespace
}  // namespace knead::testing
