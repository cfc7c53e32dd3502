#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

namespace knead::testing {

/// What of a value is against a schema, with its place; empty where all is right. The part of JSON
/// schema that is used.
inline std::string against(const nlohmann::json& value, const nlohmann::json& schema,
                           const std::string& place) {
  for (const auto& [word, wanted] : schema.items()) {
    const std::string here = place + " (" + word + ")";
    if (word == "type") {
      const bool right =
          wanted == "object"    ? value.is_object()
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
      for (const nlohmann::json& name : wanted) {
        if (value.is_object() && !value.contains(name.get<std::string>()))
          return here + ": " + name.get<std::string>();
      }
    } else if (word == "properties") {
      if (!value.is_object()) continue;
      for (const auto& [name, member] : value.items()) {
        if (!wanted.contains(name)) {
          if (schema.value("additionalProperties", true)) continue;
          return place + " (unknown): " + name;
        }
        if (auto wrong = against(member, wanted.at(name), place + "." + name); !wrong.empty())
          return wrong;
      }
    } else if (word == "items") {
      for (std::size_t k = 0; value.is_array() && k < value.size(); ++k) {
        if (auto wrong = against(value[k], wanted, place + "[" + std::to_string(k) + "]");
            !wrong.empty())
          return wrong;
      }
    } else if (word == "oneOf" || word == "anyOf") {
      const auto right = std::ranges::count_if(
          wanted, [&](const nlohmann::json& one) { return against(value, one, "").empty(); });
      if (right == 0 || (word == "oneOf" && right > 1)) return here;
    } else if (word == "dependentSchemas") {
      for (const auto& [name, dependent] : wanted.items()) {
        if (value.contains(name) && !against(value, dependent, "").empty())
          return here + ": " + name;
      }
    } else if (word == "minimum") {
      if (value.is_number() && value < wanted) return here;
    } else if (word == "maximum") {
      if (value.is_number() && value > wanted) return here;
    } else if (word == "exclusiveMinimum") {
      if (value.is_number() && value <= wanted) return here;
    } else if (word == "exclusiveMaximum") {
      if (value.is_number() && value >= wanted) return here;
    } else if (word == "pattern") {
      if (!value.is_string() ||
          !std::regex_search(value.get<std::string>(), std::regex(wanted.get<std::string>())))
        return here;
    } else if (word == "minItems") {
      if (value.is_array() && value.size() < wanted) return here;
    } else if (word == "maxItems") {
      if (value.is_array() && value.size() > wanted) return here;
    } else if (word != "$schema" && word != "description" && word != "default" &&
               word != "additionalProperties") {
      return here + ": this test does not know the word";
    }
  }
  return "";
}

}  // namespace knead::testing
