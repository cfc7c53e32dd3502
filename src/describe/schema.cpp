#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "text.hpp"

namespace knead {
namespace {

std::string bounds(Range range, Kind kind) {
  if (kind == Kind::integer) {
    range.least = std::max(range.least, -largest_integer);
    range.most = std::min(range.most, largest_integer);
  }
  std::string text;
  if (std::isfinite(range.least)) {
    text += fmt::format(",\"{}\":{}", range.open_below ? "exclusiveMinimum" : "minimum",
                        json_number(range.least));
  }
  if (std::isfinite(range.most)) {
    text += fmt::format(",\"{}\":{}", range.open_above ? "exclusiveMaximum" : "maximum",
                        json_number(range.most));
  }
  return text;
}

// JSON Schema (draft 2020-12) of a type from the same description that reads and writes it, so that
// the two cannot differ. Given values may leave fields out; written ones have all of them, and null
// for an optional that is empty (`Absent`). Variants are objects told apart by a constant member,
// `oneOf`; a field that has a meaning only with some values of another one is a dependent schema of
// that field.
class Schema {
 public:
  explicit Schema(Absent absent) : absent_(absent) {}

  std::string value(const Type& type, const Field* field) {
    const Range range = field != nullptr ? field->range : Range{};
    switch (type.kind) {
      case Kind::boolean:
        return R"({"type":"boolean"})";
      case Kind::integer:
        return R"({"type":"integer")" + bounds(range, type.kind) + "}";
      case Kind::number:
        return R"({"type":"number")" + bounds(range, type.kind) + "}";
      case Kind::text:
        if (field == nullptr || field->choices.empty()) return R"({"type":"string"})";
        return choices(field->choices);
      case Kind::choice:
        return choices(type.choices);
      case Kind::optional:
        if (absent_ == Absent::left_out) return value(*type.element, field);
        return fmt::format(R"({{"anyOf":[{},{{"type":"null"}}]}})", value(*type.element, field));
      case Kind::list:
        return fmt::format(R"({{"type":"array","items":{}}})", value(*type.element, field));
      case Kind::array:
        return fmt::format(R"({{"type":"array","items":{},"minItems":{},"maxItems":{}}})",
                           value(*type.element, field), type.length, type.length);
      case Kind::record:
        return record(type, {});
      case Kind::variant: {
        std::string all;
        for (const Type* held : type.variants)
          all += (all.empty() ? "" : ",\n") + record(*held, type.name);
        return "{\"oneOf\":[" + all + "]}";
      }
      case Kind::opaque:
        return "{}";
    }
    return "{}";
  }

 private:
  static std::string names(const std::vector<std::string_view>& all) {
    std::string text;
    for (std::string_view name : all)
      text += fmt::format("{}\"{}\"", text.empty() ? "" : ",", name);
    return "{\"enum\":[" + text + "]}";
  }

  /// Each with its text, if they have one.
  static std::string choices(std::span<const Choice> all) {
    if (std::ranges::all_of(all, [](const Choice& c) { return c.help.empty(); }))
      return names(names_of(all));
    std::string text;
    for (const Choice& c : all) {
      text += fmt::format("{}{{\"const\":\"{}\",\"description\":{}}}", text.empty() ? "" : ",",
                          c.name, json_text(c.help));
    }
    return "{\"oneOf\":[" + text + "]}";
  }

  /// What a field requires of the one that gives it a meaning (`OnlyWith`).
  /// Where the other field is left out its initial value counts: only if that gives no meaning must
  /// the other one be there. An empty list says nothing and is always allowed, as when records are
  /// read.
  static std::string requirement(const Field& field, const Type& owner) {
    const auto& [other, values] = field.only;
    const auto& initial = *static_cast<const std::string*>(owner.find(other)->of(owner.initial));
    const bool stands = std::ranges::find(values, initial) != values.end();
    const std::string schema = fmt::format(
        R"({{"properties":{{"{}":{}}}{}}})", other, names({values.begin(), values.end()}),
        stands ? std::string() : fmt::format(R"(,"required":["{}"])", other));
    if (field.type->kind != Kind::list) return schema;
    return fmt::format(R"({{"anyOf":[{{"properties":{{"{}":{{"maxItems":0}}}}}},{}]}})", field.name,
                       schema);
  }

  /// With its description and default in front.
  std::string member(const Field& field, const Type& owner) {
    std::string schema =
        field.flat ? names(variant_names(*field.type)) : value(*field.type, &field);
    if (field.uniform)
      schema = "{\"anyOf\":[" + value(field.type->innermost(), &field) + "," + schema + "]}";
    if (const TextForm* form = text_form(owner, field);
        form != nullptr && absent_ == Absent::left_out) {
      const std::string text =
          form->begins ? fmt::format(R"({{"type":"string","pattern":"^{}"}})", form->text)
                       : fmt::format(R"({{"const":"{}"}})", form->text);
      schema = "{\"anyOf\":[" + schema + "," + text + "]}";
    }
    std::string about;
    if (!field.help.empty()) about += "\"description\":" + json_text(field.help) + ",";
    const Type& type = *field.type;
    if (absent_ == Absent::left_out && field.presence == Presence::optional &&
        field.fallback.empty() && !field.flat && type.kind != Kind::optional &&
        type.kind != Kind::record && type.kind != Kind::variant && field.factor == 1) {
      about += "\"default\":" + to_json(type, field.of(owner.initial)) + ",";
    }
    return "{" + about + schema.substr(1);
  }

  std::string record(const Type& type, std::string_view tag) {
    Members members;
    if (!tag.empty()) {
      members.properties = fmt::format("\n  \"{}\":{{\"const\":\"{}\"}}", tag, type.name);
      members.require(tag);
      members.seen.push_back(tag);
    }
    add_members(type, members, true);
    std::string text = R"({"type":"object",)";
    if (!type.help.empty()) text += "\"description\":" + json_text(type.help) + ",";
    if (!members.required.empty()) text += "\"required\":[" + members.required + "],";
    if (!members.dependent.empty()) text += "\"dependentSchemas\":{" + members.dependent + "},";
    return text + R"("additionalProperties":false,"properties":{)" + members.properties + "}}";
  }

  struct Members {
    std::string properties, required, dependent;
    std::vector<std::string_view> seen;
    void depends(std::string_view name, const std::string& schema) {
      dependent += fmt::format("{}\n  \"{}\":{}", dependent.empty() ? "" : ",", name, schema);
    }
    void require(std::string_view name) {
      required += fmt::format("{}\"{}\"", required.empty() ? "" : ",", name);
    }
  };

  void add_members(const Type& type, Members& members, bool always) {
    for (const Field& field : type.fields) {
      if (field.type->kind == Kind::opaque ||
          std::ranges::find(members.seen, field.name) != members.seen.end())
        continue;
      members.seen.push_back(field.name);
      members.properties += fmt::format("{}\n  \"{}\":{}", members.properties.empty() ? "" : ",",
                                        field.name, member(field, type));
      const bool required = field.presence == Presence::required ||
                            (absent_ == Absent::null && !field.flat && !field.omit_empty);
      if (always && required) members.require(field.name);
      if (!field.only.field.empty()) {
        members.depends(field.name, requirement(field, type));
      }
      if (const TextForm* form = text_form(type, field);
          form != nullptr && absent_ == Absent::left_out) {
        members.depends(form->stands_for, fmt::format(R"({{"properties":{{"{}":{}}}}})", field.name,
                                                      value(*field.type, &field)));
      }
      if (!field.flat) continue;
      for (const Type* held : field.type->variants) add_members(*held, members, false);
    }
  }

  Absent absent_;
};

}  // namespace

std::string schema_of(const Type& type, Absent absent) {
  return Schema(absent).value(type, nullptr);
}

}  // namespace knead
