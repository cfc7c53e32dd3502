#include "record_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace knead {
namespace {

Error wrong(std::string_view field, std::string what, std::string remedy) {
  return {ErrorKind::input, std::move(what), std::string(field), std::move(remedy)};
}

// Reading

/// "a list of 3 numbers"
std::string numbers_wanted(const Type& type) {
  const Kind kind = type.element->kind;
  return fmt::format("a list of {} {}", type.length,
                     kind == Kind::integer  ? "whole numbers"
                     : kind == Kind::number ? "numbers"
                                            : "lists of numbers");
}

/// Reads anything but a record; returns what the value should have been, or nothing on success.
std::string read_value(const Json& json, const Type& type, void* value, const About& about,
                       bool uniform = false) {
  switch (type.kind) {
    case Kind::boolean:
      if (!json.is(Json::Kind::boolean)) return "true or false";
      *static_cast<bool*>(value) = json.boolean;
      return "";
    case Kind::integer: {
      const double x = json.number;
      const bool whole =
          json.is(Json::Kind::number) && x == std::floor(x) && std::abs(x) <= largest_integer;
      if (!whole) return "a whole number";
      *static_cast<int*>(value) = static_cast<int>(x);
      return "";
    }
    case Kind::number:
      if (!json.is(Json::Kind::number)) return "a number";
      *static_cast<double*>(value) = json.number / about.factor;
      return std::isfinite(json.number) ? "" : "a finite number";
    case Kind::text:
      if (!json.is(Json::Kind::text)) return "a string";
      *static_cast<std::string*>(value) = json.text;
      if (about.choices.empty() ||
          std::ranges::find(about.choices, json.text, &Choice::name) != about.choices.end()) {
        return "";
      }
      return "one of: " + joined(names_of(about.choices));
    case Kind::choice: {
      const Choice* choice = json.is(Json::Kind::text) ? type.choice(json.text) : nullptr;
      if (choice == nullptr) return "one of: " + joined(names_of(type.choices));
      type.assign(value, choice->value);
      return "";
    }
    case Kind::optional:
      type.resize(value, 1);
      return read_value(json, *type.element, type.at(value, 0), about, uniform);
    case Kind::list:
      if (uniform && json.is(Json::Kind::number)) {
        type.resize(value, 1);
        return read_value(json, *type.element, type.at(value, 0), about);
      }
      if (!json.is(Json::Kind::list)) return "a list";
      type.resize(value, json.list.size());
      for (std::size_t k = 0; k < json.list.size(); ++k) {
        const std::string wanted =
            read_value(json.list[k], *type.element, type.at(value, k), about);
        if (!wanted.empty()) return "a list, each entry " + wanted;
      }
      return "";
    case Kind::array:
      if (uniform && json.is(Json::Kind::number)) {
        for (std::size_t k = 0; k < type.length; ++k) {
          if (auto wanted = read_value(json, *type.element, type.at(value, k), about);
              !wanted.empty())
            return wanted;
        }
        return "";
      }
      if (!json.is(Json::Kind::list) || json.list.size() != type.length)
        return numbers_wanted(type);
      for (std::size_t k = 0; k < type.length; ++k) {
        if (!read_value(json.list[k], *type.element, type.at(value, k), about).empty())
          return numbers_wanted(type);
      }
      return "";
    default:
      return "left out";
  }
}

/// Reads a field that may hold records at any depth.
std::optional<Error> read_part(const Json& json, const Type& type, void* value,
                               std::string_view name, const About& about) {
  const Kind last = type.innermost().kind;
  // A text that is not known is named with its place.
  const bool listed =
      type.kind == Kind::list && !about.choices.empty() && json.is(Json::Kind::list);
  const bool in_optional = type.kind == Kind::optional && !about.choices.empty();
  if (last != Kind::record && last != Kind::variant && !listed && !in_optional) {
    const std::string wanted = read_value(json, type, value, about, about.uniform);
    if (wanted.empty()) return std::nullopt;
    if ((last == Kind::choice || !about.choices.empty()) && json.is(Json::Kind::text)) {
      return wrong(name, shown(json) + " is not known", "use " + wanted);
    }
    return wrong(name, shown(json) + " does not fit", "give " + wanted);
  }
  const auto inside = [&](Expected<void> status, const std::string& place) -> std::optional<Error> {
    if (status) return std::nullopt;
    Error error = status.error();
    error.where = place + (error.where.empty() ? "" : "." + error.where);
    return error;
  };
  switch (type.kind) {
    case Kind::record:
      return inside(read_record(json, type, value), std::string(name));
    case Kind::variant:
      return inside(read_variant(json, type, value, type.name), std::string(name));
    case Kind::optional:
      type.resize(value, 1);
      return read_part(json, *type.element, type.at(value, 0), name, about);
    default: {
      const bool fixed = type.kind == Kind::array;
      if (!json.is(Json::Kind::list) || (fixed && json.list.size() != type.length)) {
        return wrong(name, shown(json) + " does not fit",
                     fixed ? fmt::format("give {} entries", type.length) : "give a list");
      }
      if (!fixed) type.resize(value, json.list.size());
      for (std::size_t k = 0; k < json.list.size(); ++k) {
        const std::string place = fmt::format("{}[{}]", name, k);
        if (auto error = read_part(json.list[k], *type.element, type.at(value, k), place, about))
          return error;
      }
      return std::nullopt;
    }
  }
}

/// The error for a field that another one, of the value that it has, leaves no meaning. An empty
/// list says nothing.
std::optional<Error> without_meaning(const Json& given, const Field& field, const Type& type,
                                     const void* record) {
  if (field.only.field.empty() || (given.is(Json::Kind::list) && given.list.empty()))
    return std::nullopt;
  const auto& with = *static_cast<const std::string*>(type.find(field.only.field)->of(record));
  const auto has_meaning = [&with](const Field& f) {
    return std::ranges::find(f.only.values, with) != f.only.values.end();
  };
  if (has_meaning(field)) return std::nullopt;
  std::vector<std::string_view> known;
  for (const Field& other : type.fields) {
    if (has_meaning(other)) known.push_back(other.name);
  }
  return wrong(
      field.name, fmt::format("the {} {} has no {}", field.only.field, with, field.name),
      known.empty() ? "it has no measures of its own" : "its fields are: " + joined(known));
}

/// Reads the fields of one record that are in the object; ignores any other members.
std::optional<Error> read_fields(const Json& json, const Type& type, void* record) {
  for (const Field& field : type.fields) {
    void* member = field.of(record);
    const Json* found = json.find(field.name);
    if (field.flat) {
      const Type& variant = *field.type;
      if (found != nullptr) {
        const int k = found->is(Json::Kind::text) ? variant.variant(found->text) : -1;
        if (k < 0)
          return wrong(field.name, shown(*found) + " is not known",
                       "use one of: " + joined(variant_names(variant)));
        variant.assign(member, k);
      }
      const Type& held = *variant.variants[static_cast<std::size_t>(variant.value(member))];
      if (auto error = read_fields(json, held, variant.at(member, 0))) return error;
    } else if (found != nullptr) {
      if (auto error = without_meaning(*found, field, type, record)) return error;
      if (auto error = read_part(*found, *field.type, member, field.name, field)) return error;
    } else if (field.presence == Presence::required) {
      return wrong(field.name, "the field is missing", fmt::format("give \"{}\"", field.name));
    }
  }
  return std::nullopt;
}

bool has_field(const Type& type, const void* record, std::string_view name) {
  return std::ranges::any_of(type.fields, [&](const Field& field) {
    if (field.name == name) return true;
    if (!field.flat) return false;
    const auto held = static_cast<std::size_t>(field.type->value(field.of(record)));
    return has_field(*field.type->variants[held], field.type->part(field.of(record)), name);
  });
}

// Writing

/// The number that stands for all in a uniform field: of an array whose numbers are the same, or a
/// list of one. Null: there is none.
const void* one_for_all(const Type& type, const void* value) {
  const std::size_t count = type.count(value);
  if (type.kind == Kind::optional)
    return count == 0 ? nullptr : one_for_all(*type.element, type.part(value));
  if (type.kind == Kind::list) return count == 1 ? type.part(value) : nullptr;
  for (std::size_t k = 1; k < count; ++k) {
    if (*static_cast<const double*>(type.part(value, k)) !=
        *static_cast<const double*>(type.part(value)))
      return nullptr;
  }
  return type.part(value);
}

class JsonWriter {
 public:
  JsonWriter(Absent absent, JsonNumber number) : absent_(absent), number_(number) {}

  void value(const Type& type, const void* v, double factor = 1) {
    switch (type.kind) {
      case Kind::boolean:
        text += *static_cast<const bool*>(v) ? "true" : "false";
        break;
      case Kind::integer:
        text += fmt::format("{}", *static_cast<const int*>(v));
        break;
      case Kind::number:
        text += number_(factor * *static_cast<const double*>(v));
        break;
      case Kind::text:
        text += json_text(*static_cast<const std::string*>(v));
        break;
      case Kind::choice:
        text += fmt::format("\"{}\"", type.choice(type.value(v))->name);
        break;
      case Kind::optional:
        if (type.count(v) == 0) {
          text += "null";
        } else {
          value(*type.element, type.part(v), factor);
        }
        break;
      case Kind::list:
      case Kind::array:
        text += "[";
        for (std::size_t k = 0; k < type.count(v); ++k) {
          if (k > 0) text += ",";
          value(*type.element, type.part(v, k), factor);
        }
        text += "]";
        break;
      case Kind::record:
        text += "{";
        fields(type, v);
        text += "}";
        break;
      case Kind::variant:
        text += "{";
        {
          const Absent outside = std::exchange(absent_, Absent::left_out);
          variant(type, v);
          absent_ = outside;
        }
        text += "}";
        break;
      case Kind::opaque:
        text += "null";
        break;
    }
  }

  std::string text;

 private:
  void name(std::string_view n) {
    text += fmt::format("{}\"{}\":", text.ends_with('{') ? "" : ",", n);
  }
  void variant(const Type& type, const void* v) {
    const Type& held = *type.variants[static_cast<std::size_t>(type.value(v))];
    name(type.name);
    text += fmt::format("\"{}\"", held.name);
    fields(held, type.part(v));
  }
  void fields(const Type& type, const void* record) {
    for (const Field& field : type.fields) {
      const void* member = field.of(record);
      if (field.type->kind == Kind::opaque) continue;
      if (field.flat) {
        variant(*field.type, member);
        continue;
      }
      const bool omitted =
          field.omit_empty || (absent_ == Absent::left_out && field.type->kind == Kind::optional);
      if (omitted && is_empty(*field.type, member)) continue;
      name(field.name);
      const void* const one = field.uniform ? one_for_all(*field.type, member) : nullptr;
      if (one != nullptr) {
        value(field.type->innermost(), one, field.factor);
      } else {
        value(*field.type, member, field.factor);
      }
    }
  }
  static bool is_empty(const Type& type, const void* v) {
    return type.kind == Kind::text ? static_cast<const std::string*>(v)->empty()
                                   : type.count(v) == 0;
  }
  Absent absent_;
  JsonNumber number_;
};

void collect(const Type& type, std::vector<std::string_view>& names) {
  const auto add = [&names](std::string_view name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const Field& field : type.fields) {
    add(field.name);
    if (!field.flat) continue;
    for (const Type* held : field.type->variants) collect(*held, names);
  }
}

}  // namespace

Expected<void> read_record(const Json& json, const Type& type, void* record, std::string_view tag) {
  if (!json.is(Json::Kind::object)) {
    return std::unexpected(
        wrong({}, shown(json) + " does not fit", R"(give an object {"...": ...})"));
  }
  if (auto error = read_fields(json, type, record)) return std::unexpected(std::move(*error));
  for (const auto& [name, value] : json.members) {
    if (name == tag || has_field(type, record, name)) continue;
    const std::vector<std::string_view> known = field_names(type);
    return std::unexpected(wrong(name, fmt::format("\"{}\" has no such field", type.name),
                                 !known.empty() ? "the fields are: " + joined(known)
                                 : tag.empty()  ? "it has none"
                                                : fmt::format("it has none but \"{}\"", tag)));
  }
  return check_ranges(type, record);
}

Expected<void> read_variant(const Json& json, const Type& type, void* variant,
                            std::string_view what) {
  const std::string form = fmt::format("write {{\"{}\": \"...\", ...}}", type.name);
  if (!json.is(Json::Kind::object)) {
    return std::unexpected(wrong({}, fmt::format("a {} must be an object", what), form));
  }
  const Json* name = json.find(type.name);
  if (name == nullptr || !name->is(Json::Kind::text)) {
    return std::unexpected(wrong(type.name, fmt::format("the {} has no name", what), form));
  }
  const int k = type.variant(name->text);
  if (k < 0) {
    return std::unexpected(
        wrong(type.name, fmt::format("{} is not a {}", shown(*name), what),
              fmt::format("the {}s are: {}", what, joined(variant_names(type)))));
  }
  type.assign(variant, k);
  return read_record(json, *type.variants[static_cast<std::size_t>(k)], type.at(variant, 0),
                     type.name);
}

std::string to_json(const Type& type, const void* value, Absent absent, JsonNumber number) {
  JsonWriter writer(absent, number);
  writer.value(type, value);
  return std::move(writer.text);
}

const TextForm* text_form(const Type& record, const Field& field) {
  const auto form = std::ranges::find(text_forms, field.name, &TextForm::field);
  return form != std::end(text_forms) && record.find(form->stands_for) != nullptr ? form : nullptr;
}

std::string joined(const std::vector<std::string_view>& names) {
  std::string text;
  for (std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

std::vector<std::string_view> names_of(std::span<const Choice> choices) {
  std::vector<std::string_view> names;
  for (const Choice& choice : choices) names.push_back(choice.name);
  return names;
}

std::vector<std::string_view> field_names(const Type& type) {
  std::vector<std::string_view> names;
  collect(type, names);
  return names;
}

std::vector<std::string_view> variant_names(const Type& type) {
  std::vector<std::string_view> names;
  for (const Type* held : type.variants) names.push_back(held->name);
  return names;
}

}  // namespace knead
