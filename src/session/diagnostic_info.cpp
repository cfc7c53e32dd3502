#include "diagnostic_info.hpp"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <string_view>

#include "info_values.hpp"
#include "knead/session/session_info.hpp"

namespace knead {

void describe(FixInfo& f, Fields& fields) {
  fields.name("fix info", "Commands that help, one after the other.");
  fields.add("code", f.code);
  fields.add("commands", f.commands);
}

void describe(NoteInfo& n, Fields& fields) {
  fields.name("note info", "What a command did besides what it was asked for.");
  fields.add("text", n.text, {.help = "for people"});
  fields.add("code", n.code);
  fields.add("values", n.values, {.help = "null without a code"});
  fields.add("fixes", n.fixes);
}

void describe(ErrorInfo& e, Fields& fields) {
  fields.name("engine error info", "What went wrong, where, and what would be right.");
  fields.add("kind", e.kind, {.help = "usage, input or numerical"});
  fields.add("what", e.what);
  fields.add("where", e.where);
  fields.add("place", e.place,
             {.help = "`where`, unless that names a field of a command and what is wrong with it "
                      "is stated without it"});
  fields.add("remedy", e.remedy);
  fields.add("message", e.message, {.help = "all of it as one line"});
  fields.add("code", e.code);
  fields.add("values", e.values, {.help = "null without a code"});
  fields.add("fixes", e.fixes, {.help = "what can be done at once"});
}

DiagnosticValues values_of(const Diagnostic& diagnostic) {
  DiagnosticValues values;
  const Type& type = type_of<DiagnosticValues>();
  for (const NamedValue& named : diagnostic.values) {
    const Field* const field = type.find(named.name);
    assert(field != nullptr);
    void* const member = field->of(&values);
    const auto assign = [member]<class T>(const T& value) {
      using Member =
          std::conditional_t<std::is_same_v<T, std::vector<std::string>>, T, std::optional<T>>;
      *static_cast<Member*>(member) = value;
    };
    std::visit(assign, named.value);
  }
  return values;
}

std::vector<NamedValue> named_values(const DiagnosticValues& values) {
  std::vector<NamedValue> named;
  for (const Field& field : type_of<DiagnosticValues>().fields) {
    const void* const member = field.of(&values);
    if (field.type->count(member) == 0) continue;
    if (field.type->kind == Kind::list) {
      named.emplace_back(field.name, *static_cast<const std::vector<std::string>*>(member));
    } else if (field.type->element->kind == Kind::number) {
      named.emplace_back(field.name, **static_cast<const std::optional<double>*>(member));
    } else {
      named.emplace_back(field.name, **static_cast<const std::optional<std::string>*>(member));
    }
  }
  return named;
}

namespace {

/// Whether this is a name, "radius", or one of an array, "path[2]".
bool names_field(std::string_view where) {
  const std::string_view name = where.substr(0, where.find('['));
  return std::ranges::all_of(name,
                             [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

/// Fills what an error and a note have in common.
template <class Info>
void add(Info& info, const Diagnostic* diagnostic) {
  if (diagnostic == nullptr) return;
  info.code = diagnostic->code;
  info.values = values_of(*diagnostic);
  for (const Fix& fix : fixes_for(*diagnostic)) {
    FixInfo& added = info.fixes.emplace_back(FixInfo{fix.code, {}});
    for (const Command& command : fix.commands) added.commands.push_back(command.any().fields);
  }
}

}  // namespace

NoteInfo info_of(const Note& note) {
  NoteInfo info;
  info.text = note;
  add(info, note.diagnostic.get());
  return info;
}

std::string note_json(const Note& note) { return json_of(info_of(note)); }

std::string error_json(const Error& error) {
  ErrorInfo info;
  info.kind = error.kind == ErrorKind::numerical ? "numerical"
              : error.kind == ErrorKind::usage   ? "usage"
                                                 : "input";
  info.what = error.what;
  info.where = error.where;
  info.remedy = error.remedy;
  info.message = error.message();
  add(info, error.diagnostic.get());
  info.place = info.code != ErrorCode::out_of_range && names_field(error.where) ? "" : error.where;
  return "{\"error\":" + json_of(info) + "}";
}

}  // namespace knead
