#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "describe/text.hpp"
#include "knead/exchange/morph.hpp"
#include "queries.hpp"
#include "session/commands.hpp"

namespace knead::studio {
namespace {

/// "face_edges", "Request" → FaceEdgesRequest
std::string type_name(std::string_view named, std::string_view suffix) {
  std::string name;
  bool upper = true;
  for (const char c : named) {
    if (c != '_')
      name += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    upper = c == '_';
  }
  return name + std::string(suffix);
}

/// What a call with all fields by name takes, and with the first one alone where there is one.
std::string method(const Type& command, std::string_view first) {
  const std::string type = type_name(command.name, "Command");
  const auto needs = [&](std::string_view given) {
    return std::ranges::any_of(command.fields, [&](const Field& f) {
      return f.presence == Presence::required && f.name != given;
    });
  };
  const std::string head = fmt::format("  /** {} */\n  '{}'(", command.help, command.name);
  std::string text = head + fmt::format("fields{}: Omit<{}, 'do'> & Options): Result;\n",
                                        needs("") ? "" : "?", type);
  if (first.empty()) return text;
  return text + head +
         fmt::format(
             "{0}: NonNullable<{1}['{0}']>, fields{2}: Omit<{1}, 'do' | '{0}'> & Options): "
             "Result;\n",
             first, type, needs(first) ? "" : "?");
}

}  // namespace

void declare_commands(TypeScript& types) {
  std::string methods, table;
  for (const Type* command : type_of<CommandVariant>().variants) {
    const auto named = std::ranges::find_if(
        command->fields, [](const Field& f) { return f.type->kind != Kind::opaque; });
    const std::string_view first = named == command->fields.end() ? "" : named->name;
    methods += method(*command, first);
    table += fmt::format("  {}: '{}',\n", command->name, first);
  }
  types.text +=
      "/** Every command as a method: its fields by name, the first one also alone before the "
      "others. */\n"
      "export interface CommandMethods<Result, Options> {\n" +
      methods + "}\n\n" +
      "/** Of each command the field that may stand alone; empty: it has none. */\nexport const "
      "firstFields = {\n" +
      table + "} as const;\n\n";
  std::string phases;
  for (const std::string_view phase : morph_phases)
    phases += fmt::format("{}'{}'", phases.empty() ? "" : ", ", phase);
  types.text +=
      "/** What `morph` does, in this order; each has as many of the steps that it tells of. */\n"
      "export const morphPhases = [" +
      phases + "] as const;\n\n";
}

void declare_queries(TypeScript& types) {
  std::string table;
  for (const Query& query : queries()) {
    const std::string name = type_name(query.request->name, "Request");
    types.declare(*query.request, name, "");
    table += fmt::format("  {}: {{ request: {}; answer: {} }};\n", query.request->name, name,
                         types.written(*query.answer, "Info", Absent::null));
  }
  std::string methods, names;
  for (const DocumentQuery& query : knead::document_queries()) {
    const auto required = [](const Field& f) { return f.presence == Presence::required; };
    methods += fmt::format("  /** {} */\n  {}(request{}: {}): {};\n", query.request->help,
                           query.request->name,
                           std::ranges::any_of(query.request->fields, required) ? "" : "?",
                           type_name(query.request->name, "Request"),
                           types.written(*query.answer, "Info", Absent::null));
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", query.request->name);
  }
  types.text +=
      "/** What can be asked of a document: each is a method. */\n"
      "export interface QueryMethods {\n" +
      methods + "}\n\nexport const documentQueries = [" + names + "] as const;\n\n";
  types.text += "/** What the page can ask the engine for. */\nexport interface Queries {\n" +
                table + "}\n\n";
}

}  // namespace knead::studio
