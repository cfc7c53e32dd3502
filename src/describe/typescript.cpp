#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "text.hpp"

namespace knead {
namespace {

/// "step record" → StepRecord
std::string pascal(std::string_view name) {
  std::string text;
  bool upper = true;
  for (const char c : name) {
    if (c == ' ' || c == '_' || c == '-') {
      upper = true;
      continue;
    }
    text += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    upper = false;
  }
  return text;
}

std::string about(const Field& field) {
  std::string text(field.help);
  const char* unit = field.unit == Unit::length     ? "(length)"
                     : field.unit == Unit::angle    ? "(degrees)"
                     : field.unit == Unit::fraction ? "(fraction)"
                                                    : "";
  if (*unit != '\0') text += (text.empty() ? "" : " ") + std::string(unit);
  return text.empty() ? "" : fmt::format("  /** {} */\n", text);
}

/// A JavaScript string literal.
std::string literal(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "'";
}

}  // namespace

void TypeScript::declare(const Type& type, const std::string& name, const std::string& suffix,
                         Absent absent) {
  if (std::ranges::find(names_, &type, &std::pair<const Type*, std::string>::first) != names_.end())
    return;
  names_.emplace_back(&type, name);
  if (type.kind != Kind::variant) return record(type, name, {}, suffix, absent);
  std::string alternatives;
  for (const Type* held : type.variants) {
    const std::string held_name = pascal(held->name) + suffix;
    record(*held, held_name, type.name, suffix, absent);
    alternatives += "\n  | " + held_name;
  }
  text += fmt::format("export type {} ={};\n\n", name, alternatives);
}

void TypeScript::list(const Type& variant, const std::string& name) {
  std::string records;
  for (const Type* held : variant.variants) {
    std::string fields;
    for (const Field& field : held->fields) {
      if (!field.type->numeric()) continue;
      const auto* numbers = static_cast<const double*>(field.of(held->initial));
      const std::size_t count = field.type->kind == Kind::array ? field.type->length : 1;
      std::string initial;
      for (std::size_t k = 0; k < count; ++k)
        initial += fmt::format("{}{}", k == 0 ? "" : ", ", numbers[k] * field.factor);
      fields += fmt::format("\n      {{ name: {}, help: {}, length: {}, initial: [{}] }},",
                            literal(field.name), literal(field.help), field.unit == Unit::length,
                            initial);
    }
    records += fmt::format("  {}: {{ help: {}, fields: [{}{}] }},\n", held->name,
                           literal(held->help), fields, fields.empty() ? "" : "\n    ");
  }
  text += fmt::format(
      "type Numbers = {{ help: string; fields: {{ name: string; help: string; length: boolean; "
      "initial: number[] }}[] }};\n\nexport const {}: Record<string, Numbers> = {{\n{}}};\n",
      name, records);
}

void TypeScript::record(const Type& type, const std::string& name, std::string_view tag,
                        const std::string& suffix, Absent absent) {
  std::string body;
  if (!tag.empty()) body += fmt::format("  {}: '{}';\n", tag, type.name);
  for (const Field& field : type.fields) {
    if (field.type->kind == Kind::opaque && field.type->name.empty()) continue;
    if (!field.flat) {
      // A record of a variant omits what is absent, whatever contains it.
      const bool null = absent == Absent::null;
      const bool there =
          !field.omit_empty && (null ? tag.empty() || field.type->kind != Kind::optional
                                     : field.presence == Presence::required);
      body += member(type, field, there, suffix,
                     tag.empty() && !field.omit_empty ? absent : Absent::left_out);
      continue;
    }
    std::string names;
    for (std::string_view n : variant_names(*field.type))
      names += fmt::format("{}'{}'", names.empty() ? "" : " | ", n);
    body += about(field) + fmt::format("  {}: {};\n", field.name, names);
    std::vector<std::string_view> seen;
    for (const Type* held : field.type->variants) {
      for (const Field& part : held->fields) {
        if (part.type->kind == Kind::opaque || std::ranges::find(seen, part.name) != seen.end())
          continue;
        seen.push_back(part.name);
        body += fmt::format("  {}?: {};\n", part.name, member_of_any(*field.type, part.name));
      }
    }
  }
  if (!type.help.empty()) text += fmt::format("/** {} */\n", type.help);
  text += fmt::format("export type {} = {{\n{}}};\n\n", name, body);
}

std::string TypeScript::member(const Type& owner, const Field& field, bool always_there,
                               const std::string& suffix, Absent absent) {
  std::string instead;
  if (const TextForm* form = text_form(owner, field);
      form != nullptr && absent == Absent::left_out) {
    instead = form->begins ? fmt::format(" | `{}${{string}}`", form->text)
                           : fmt::format(" | '{}'", form->text);
  }
  return about(field) + fmt::format("  {}{}: {}{}{};\n", field.name, always_there ? "" : "?",
                                    field.uniform ? "number | " : "",
                                    written(*field.type, suffix, absent, field.named()), instead);
}

std::string TypeScript::member_of_any(const Type& variant, std::string_view name) {
  std::vector<std::string> types;
  const auto add = [&types](std::string type) {
    if (std::ranges::find(types, type) == types.end()) types.push_back(std::move(type));
  };
  for (const Type* held : variant.variants) {
    const Field* field = held->find(name);
    if (field == nullptr) continue;
    if (field->uniform) add("number");
    add(written(*field->type, "", Absent::left_out, field->named()));
  }
  std::string text_of_types;
  for (const std::string& type : types)
    text_of_types += (text_of_types.empty() ? "" : " | ") + type;
  return text_of_types;
}

std::string TypeScript::written(const Type& type, const std::string& suffix, Absent absent,
                                std::span<const Choice> named) {
  switch (type.kind) {
    case Kind::boolean:
      return "boolean";
    case Kind::integer:
    case Kind::number:
      return "number";
    case Kind::text:
    case Kind::choice: {
      if (named.empty()) return "string";
      std::string names;
      for (const Choice& choice : named)
        names += fmt::format("{}'{}'", names.empty() ? "" : " | ", choice.name);
      return names;
    }
    case Kind::optional:
      return written(*type.element, suffix, absent, named) +
             (absent == Absent::null ? " | null" : "");
    case Kind::list: {
      const std::string element = written(*type.element, suffix, absent, named);
      return element.find('|') == std::string::npos ? element + "[]" : "(" + element + ")[]";
    }
    case Kind::array: {
      const std::string element = written(*type.element, suffix, absent, named);
      std::string entries;
      for (std::size_t k = 0; k < type.length; ++k) entries += (k > 0 ? ", " : "") + element;
      return "[" + entries + "]";
    }
    case Kind::record:
    case Kind::variant: {
      const auto known =
          std::ranges::find(names_, &type, &std::pair<const Type*, std::string>::first);
      if (known != names_.end()) return known->second;
      // A union of one is that record.
      const bool one = type.kind == Kind::variant && type.variants.size() == 1;
      std::string name = one ? pascal(type.variants.front()->name) + suffix : pascal(type.name);
      if (one) {
        names_.emplace_back(&type, name);
        record(*type.variants.front(), name, type.name, suffix, absent);
      } else {
        declare(type, name, suffix, absent);
      }
      return name;
    }
    case Kind::opaque:
      return type.name.empty() ? "unknown" : std::string(type.name);
  }
  return "unknown";
}

}  // namespace knead
