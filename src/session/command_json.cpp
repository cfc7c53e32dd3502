#include "knead/session/command_json.hpp"

#include <fmt/format.h>

#include "described_json.hpp"
#include "restated.hpp"

namespace knead {

static std::string_view tag_of(const CommandVariant*) { return "do"; }

template <>
const Type& type_of<CommandVariant>() {
  return make_type<CommandVariant>();
}

namespace {

/// "at": "middle" is "middle": true, and "which": "#456" is "edge": "#456".
Json spelled_out(Json json) {
  for (auto& [name, value] : json.members) {
    if (!value.is(Json::Kind::text)) continue;
    if (name == "at" && value.text == "middle") {
      name = "middle";
      value = {};
      value.kind = Json::Kind::boolean;
      value.boolean = true;
    } else if (name == "which" && value.text.starts_with("#")) {
      name = "edge";
    }
  }
  return json;
}

Expected<Command> read_command(const Json& given) {
  const Json json = spelled_out(given);
  CommandVariant fields;
  if (auto done = read_variant(json, type_of<CommandVariant>(), &fields, "command"); !done) {
    return std::unexpected(done.error());
  }
  return make_command(std::move(fields));
}

}  // namespace

Expected<Command> parse_command(std::string_view text) {
  const auto json = parse_json(text);
  if (!json) return std::unexpected(json.error());
  return read_command(*json);
}

std::string to_json(const Command& command) { return to_json(type_of<CommandVariant>(), &command.any().fields); }

std::string to_json(const Constraint& constraint) { return to_json(restated(constraint)); }
std::string to_json(const SceneForce& force) { return to_json(make_command(ForceCommand{force})); }
std::string to_json(const Load& load) { return to_json(make_command(LoadCommand{load})); }
std::string to_json(const EvolutionPolicy& evolution) { return to_json(make_command(EvolveCommand{evolution})); }
std::string to_json(const SeamPolicy& seams) { return to_json(make_command(SeamsCommand{seams})); }

Expected<std::vector<Command>> parse_script(std::string_view text, const std::string& name, std::size_t* before) {
  const auto fail = [&name](Error error) {
    error.file = name;
    return std::unexpected(std::move(error));
  };
  const auto json = parse_json(text);
  if (!json) return fail(json.error());
  constexpr const char* form = R"(write {"knead": 2, "commands": [...]})";
  if (!json->is(Json::Kind::object)) return fail({ErrorKind::input, "a script must be an object", {}, form});
  for (const auto& [member, value] : json->members) {
    if (member != "knead" && member != "commands") {
      return fail({ErrorKind::input, "a script has no such field", member, "the fields are: knead, commands"});
    }
  }
  const Json* version = json->find("knead");
  if (version == nullptr || !version->is(Json::Kind::number) || (version->number != 1 && version->number != 2)) {
    return fail({ErrorKind::input, "the version of the script is not 1 or 2", "knead", form});
  }
  const Json* list = json->find("commands");
  if (list == nullptr || !list->is(Json::Kind::list)) {
    return fail({ErrorKind::input, "the list of commands is missing", "commands", form});
  }
  std::vector<Command> commands;
  if (version->number == 2) commands.push_back(default_hold());
  if (before != nullptr) *before = commands.size();
  for (std::size_t k = 0; k < list->list.size(); ++k) {
    auto command = read_command(list->list[k]);
    if (!command) {
      Error error = command.error();
      error.where = fmt::format("commands[{}]", k) + (error.where.empty() ? "" : "." + error.where);
      return fail(std::move(error));
    }
    commands.push_back(std::move(*command));
  }
  return commands;
}

std::string script_json(const std::vector<Command>& commands) {
  std::string text = "{\"knead\": 1, \"commands\": [";
  for (std::size_t k = 0; k < commands.size(); ++k) text += (k == 0 ? "\n  " : ",\n  ") + to_json(commands[k]);
  return text + (commands.empty() ? "]}\n" : "\n]}\n");
}

Command default_hold() {
  HoldCommand hold;
  hold.mode = HoldMode::trim;
  hold.all = true;
  return make_command(hold);
}

Command::Command(AnyCommand command) : any_(std::make_shared<const AnyCommand>(std::move(command))) {}

std::string_view Command::name() const { return type_of<CommandVariant>().variants[any_->fields.index()]->name; }

std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for (const Type* command : type_of<CommandVariant>().variants) names.emplace_back(command->name);
  return names;
}

}  // namespace knead
