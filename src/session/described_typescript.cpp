#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "described_text.hpp"

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

class Declarations {
 public:
  Declarations(Absent absent, std::vector<const Type*>& written) : absent_(absent), written_(written) {}

  void declare(const Type& type, const std::string& name, const std::string& suffix) {
    if (std::ranges::find(written_, &type) != written_.end()) return;
    written_.push_back(&type);
    if (type.kind == Kind::variant) {
      std::string alternatives;
      for (const Type* held : type.variants) {
        const std::string held_name = pascal(held->name) + suffix;
        declare_record(*held, held_name, type.name);
        alternatives += "\n  | " + held_name;
      }
      text += fmt::format("export type {} ={};\n\n", name, alternatives);
    } else {
      declare_record(type, name, {});
    }
  }

  std::string text;

 private:
  void declare_record(const Type& type, const std::string& name, std::string_view tag) {
    std::string body;
    if (!tag.empty()) body += fmt::format("  {}: '{}';\n", tag, type.name);
    std::string more;
    for (const Field& field : type.fields) {
      if (field.type->kind == Kind::opaque) continue;
      if (field.flat) {
        const std::string variant = pascal(field.name) + "Fields";
        declare(*field.type, variant, pascal(field.name));
        more += " & " + variant;
        continue;
      }
      const std::string unit = field.unit == Unit::length     ? "length"
                               : field.unit == Unit::angle    ? "degrees"
                               : field.unit == Unit::fraction ? "fraction"
                                                              : "";
      std::string about(field.help);
      if (!unit.empty()) about += (about.empty() ? "" : " ") + ("(" + unit + ")");
      if (!about.empty()) body += fmt::format("  /** {} */\n", about);
      const bool left_out = absent_ == Absent::left_out && field.presence == Presence::optional;
      body += fmt::format("  {}{}: {};\n", field.name, left_out ? "?" : "", type_of_field(field));
    }
    if (!type.help.empty()) text += fmt::format("/** {} */\n", type.help);
    if (more.empty()) {
      text += fmt::format("export interface {} {{\n{}}}\n\n", name, body);
    } else {
      text += fmt::format("export type {} = {{\n{}}}{};\n\n", name, body, more);
    }
  }

  std::string type_of_field(const Field& field) {
    return (field.uniform ? "number | " : "") + written_type(*field.type);
  }

  std::string written_type(const Type& type) {
    switch (type.kind) {
      case Kind::boolean:
        return "boolean";
      case Kind::integer:
      case Kind::number:
        return "number";
      case Kind::text:
        return "string";
      case Kind::choice: {
        std::string names;
        for (const Choice& choice : type.choices)
          names += fmt::format("{}'{}'", names.empty() ? "" : " | ", choice.name);
        return names;
      }
      case Kind::optional:
        return written_type(*type.element) + (absent_ == Absent::null ? " | null" : "");
      case Kind::list: {
        const std::string element = written_type(*type.element);
        return element.find('|') == std::string::npos ? element + "[]" : "(" + element + ")[]";
      }
      case Kind::array: {
        std::string entries;
        for (std::size_t k = 0; k < type.length; ++k) entries += (k > 0 ? ", " : "") + written_type(*type.element);
        return "[" + entries + "]";
      }
      case Kind::record:
      case Kind::variant: {
        Declarations inner(absent_, written_);
        inner.declare(type, pascal(type.name), "");
        text = inner.text + text;  // declared where it is first needed, so before
        return pascal(type.name);
      }
      case Kind::opaque:
        return "unknown";
    }
    return "unknown";
  }

  Absent absent_;
  std::vector<const Type*>& written_;
};

}  // namespace

std::string typescript(const Type& type, Absent absent, const std::string& name, const std::string& suffix,
                       std::vector<const Type*>& written) {
  Declarations declarations(absent, written);
  declarations.declare(type, name, suffix);
  return std::move(declarations.text);
}

}  // namespace knead
