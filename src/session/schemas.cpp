#include "commands.hpp"
#include "describe/text.hpp"
#include "knead/session/command_json.hpp"

namespace knead {

// The formats of files as written.

struct ScriptForm {
  int version = 2;
  std::vector<CommandVariant> commands;
};

static void describe(ScriptForm& s, Fields& fields) {
  fields.name("script", "The commands of a session.");
  fields.add(
      "knead", s.version,
      {.help = "the version of the form", .range = between(2, 2), .presence = Presence::required});
  fields.add("commands", s.commands, {.help = "run in order", .presence = Presence::required});
}

struct SourceForm {
  enum class Kind { step, rhino } kind = Kind::step;
  std::string name, bytes;
};

std::span<const Choice> choices(SourceForm::Kind) {
  static constexpr Choice list[] = {{"step", SourceForm::Kind::step},
                                    {"rhino", SourceForm::Kind::rhino}};
  return list;
}

static void describe(SourceForm& s, Fields& fields) {
  fields.name("source", "The file that a session began with.");
  fields.add("kind", s.kind, {.presence = Presence::required});
  fields.add("name", s.name, {.presence = Presence::required});
  fields.add("bytes", s.bytes, {.help = "in base64", .presence = Presence::required});
}

struct DocumentForm {
  int version = 3;
  std::string name;
  std::optional<SourceForm> source;
  std::vector<CommandVariant> commands;
  std::optional<std::string> snapshot;
};

static void describe(DocumentForm& d, Fields& fields) {
  fields.name("document", "A session with the file that it began with.");
  fields.add(
      "knead", d.version,
      {.help = "the version of the form", .range = between(3, 3), .presence = Presence::required});
  fields.add("name", d.name, {.help = "what the studio calls it"});
  fields.add("source", d.source, {.help = "left out: the session began without a file"});
  fields.add("commands", d.commands, {.help = "run in order", .presence = Presence::required});
  fields.add("snapshot", d.snapshot, {.help = "the resulting state, in base64"});
}

static std::string whole_schema(const Type& type) {
  return R"({"$schema":"https://json-schema.org/draft/2020-12/schema",)" +
         schema_of(type).substr(1) + "\n";
}

std::string script_schema() { return whole_schema(type_of<ScriptForm>()); }
std::string document_schema() { return whole_schema(type_of<DocumentForm>()); }

}  // namespace knead
