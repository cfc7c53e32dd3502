#include <fmt/format.h>

#include <algorithm>

#include "text.hpp"

namespace knead {
namespace {

std::string people(const Type& type, const void* value, double factor) {
  switch (type.kind) {
    case Kind::integer:
      return fmt::format("{}", *static_cast<const int*>(value));
    case Kind::number:
      return fmt::format("{}", factor * *static_cast<const double*>(value));
    case Kind::optional:
      return type.count(value) == 0 ? "" : people(*type.element, type.part(value), factor);
    case Kind::list:
    case Kind::array: {
      std::string text;
      for (std::size_t k = 0; k < type.count(value); ++k) {
        text += (text.empty() ? "" : ",") + people(*type.element, type.part(value, k), factor);
      }
      return text.empty() ? "" : "[" + text + "]";
    }
    case Kind::variant:
      return fmt::format("\"{}\"",
                         type.variants[static_cast<std::size_t>(type.value(value))]->name);
    case Kind::record:
    case Kind::opaque:
      return "";
    default:
      return to_json(type, value);
  }
}

/// Without Markdown's links: "[text](address)" is "text".
std::string without_links(std::string text) {
  for (std::size_t from = text.find("]("); from != std::string::npos; from = text.find("](")) {
    const std::size_t open = text.rfind('[', from), close = text.find(')', from);
    if (open == std::string::npos || close == std::string::npos) break;
    text.replace(open, close + 1 - open, text.substr(open + 1, from - open - 1));
  }
  return text;
}

/// "; > 0": the range, if the help does not state it.
std::string range_note(const Field& field) {
  const std::string range = in_words(field.range);
  return range.empty() ? "" : (field.help.empty() ? "" : "; ") + range;
}

/// Visits the fields of a record, including those of the records of a flat variant, each once.
void each_field(const Type& record, std::vector<std::string_view>& seen, auto&& visit) {
  for (const Field& field : record.fields) {
    if (std::ranges::find(seen, field.name) != seen.end()) continue;
    seen.push_back(field.name);
    visit(field, record);
    if (!field.flat) continue;
    for (const Type* held : field.type->variants) each_field(*held, seen, visit);
  }
}

/// "collision (what it does), proximity (…)"
std::string allowed(const Field& field) {
  if (field.flat) return joined(variant_names(*field.type));
  std::string text;
  for (const Choice& choice : field.named()) {
    text += (text.empty() ? "" : ", ") + std::string(choice.name);
    if (!choice.help.empty()) text += " (" + without_links(std::string(choice.help)) + ")";
  }
  return text;
}

/// "|" would end a cell.
std::string cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2))
    text.insert(at, "\\");
  return text;
}

/// `"a"`: what it does. `"b"`: …
std::string meaning(const Field& field) {
  std::string text(field.help);
  text += range_note(field);
  const std::span<const Choice> named = field.named();
  bool explained = false;
  for (const Choice& choice : named) explained = explained || !choice.help.empty();
  if (!named.empty()) {
    std::string list;
    for (const Choice& choice : named) {
      list += list.empty() ? "" : explained ? ". " : ", ";
      list += fmt::format("`\"{}\"`", choice.name);
      if (!choice.help.empty()) list += fmt::format(": {}", choice.help);
    }
    text += (text.empty() ? "" : ": ") + list;
  }
  if (field.flat) {
    std::string list;
    for (std::string_view name : variant_names(*field.type))
      list += (list.empty() ? "`" : ", `") + std::string(name) + "`";
    text += (text.empty() ? "" : ": ") + list;
  }
  return text;
}

}  // namespace

std::string shown_default(const Field& field, const Type& record) {
  return people(*field.type, field.of(record.initial), field.factor);
}

std::string brief_help(const Type& record) {
  constexpr std::size_t indent = 14, width = 110;
  std::string text;
  std::size_t column = indent;
  std::vector<std::string_view> seen;
  each_field(record, seen, [&](const Field& field, const Type& owner) {
    const std::string value = field.presence == Presence::required ? "(required)"
                              : field.fallback.empty()             ? shown_default(field, owner)
                                                                   : "";
    const std::string entry = fmt::format("{}{}{}", field.name, value.empty() ? "" : " ", value);
    if (!text.empty()) {
      text += ",";
      column += 1;
    }
    if (text.empty() || column + 1 + entry.size() > width) {
      text += fmt::format("{}{:{}}", text.empty() ? "" : "\n", "", indent);
      column = indent;
    } else {
      text += " ";
      column += 1;
    }
    text += entry;
    column += entry.size();
  });
  return text;
}

std::string full_help(const Type& record) {
  std::string text;
  std::vector<std::string_view> seen;
  each_field(record, seen, [&](const Field& field, const Type& owner) {
    std::string what = without_links(std::string(field.help));
    what += range_note(field);
    if (const std::string names = allowed(field); !names.empty())
      what += (what.empty() ? "" : ": ") + names;
    const std::string value =
        !field.fallback.empty() ? std::string(field.fallback) : shown_default(field, owner);
    const std::string note = field.presence == Presence::required ? "(required)"
                             : value.empty()                      ? ""
                                                                  : "(default " + value + ")";
    text += fmt::format("  {:<15} {}{}{}\n", field.name, what,
                        what.empty() || note.empty() ? "" : " ", note);
  });
  return text;
}

std::string markdown_table(const Type& record) {
  if (record.fields.empty()) return "";
  std::string text = "| field | default | meaning |\n|---|---|---|\n";
  std::vector<std::string_view> seen;
  each_field(record, seen, [&](const Field& field, const Type& owner) {
    std::string value = shown_default(field, owner);
    if (!value.empty()) value = "`" + value + "`";
    if (!field.fallback.empty()) value = field.fallback;
    if (field.presence == Presence::required) value = "required";
    text += fmt::format("| `{}` |{}{} | {} |\n", field.name, value.empty() ? "" : " ", cell(value),
                        cell(meaning(field)));
  });
  return text;
}

}  // namespace knead
