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

Expected<int> version_in(const Json& json, std::string_view what, const char* form) {
  const Json* version = json.find("knead");
  if (version != nullptr && version->is(Json::Kind::number) && (version->number == 1 || version->number == 2)) {
    return static_cast<int>(version->number);
  }
  return input_error(fmt::format("the version of the {} is neither 1 nor 2", what), "knead", form);
}

/// Fields made meaningless by the rest of a command: errors, or notes in version 1.
template <class C>
Expected<void> leave_out(const Json& json, int version, const C& command, AnyCommand& any) {
  if constexpr (requires { inapplicable(command, std::string_view{}); }) {
    Json rest = json;
    for (const auto& [name, value] : json.members) {
      const bool says_nothing = value.is(Json::Kind::null) || (value.is(Json::Kind::list) && value.list.empty());
      const std::optional<Error> error = inapplicable(command, name);
      if (!error || says_nothing) continue;
      if (version > 1) return std::unexpected(*error);
      any.notes.push_back(
          fmt::format("{}: {}, and it was left out; {}", type_of<C>().name, error->what, error->remedy));
      std::erase_if(rest.members, [&](const auto& member) { return member.first == name; });
    }
    if (any.notes.empty()) return {};
    CommandVariant without;
    if (auto done = read_variant(rest, type_of<CommandVariant>(), &without, "command"); !done) return done;
    any.without = std::move(without);
  }
  return {};
}

/// A command of this version, unless it states its own.
Expected<Command> read_command(const Json& given, int version) {
  Json json = spelled_out(given);
  if (json.is(Json::Kind::object) && json.find("knead") != nullptr) {
    const auto own = version_in(json, "command", "leave it out, or give 1 or 2");
    if (!own) return std::unexpected(own.error());
    version = *own;
    std::erase_if(json.members, [](const auto& member) { return member.first == "knead"; });
  }
  AnyCommand any;
  if (auto done = read_variant(json, type_of<CommandVariant>(), &any.fields, "command"); !done) {
    return std::unexpected(done.error());
  }
  const auto complete = [&](auto& command) -> Expected<void> {
    if constexpr (requires { read_as_version_1(command); }) {
      if (version == 1) read_as_version_1(command);
    }
    if constexpr (requires { read_as_version_2(command); }) {
      if (version == 2) read_as_version_2(command);
    }
    return leave_out(json, version, command, any);
  };
  if (auto done = std::visit(complete, any.fields); !done) return std::unexpected(done.error());
  return Command(std::move(any));
}

}  // namespace

Expected<Command> parse_command(std::string_view text) {
  const auto json = parse_json(text);
  if (!json) return std::unexpected(json.error());
  return read_command(*json, 1);
}

std::string to_json(const Command& command) { return to_json(type_of<CommandVariant>(), &command.any().fields); }

std::string to_json(const Constraint& constraint) { return to_json(restated(constraint)); }
std::string to_json(const SceneForce& force) { return to_json(make_command(restated(force))); }
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
  const auto version = version_in(*json, "script", form);
  if (!version) return fail(version.error());
  const Json* list = json->find("commands");
  if (list == nullptr || !list->is(Json::Kind::list)) {
    return fail({ErrorKind::input, "the list of commands is missing", "commands", form});
  }
  std::vector<Command> commands;
  if (*version == 2) commands.push_back(default_hold());
  if (before != nullptr) *before = commands.size();
  for (std::size_t k = 0; k < list->list.size(); ++k) {
    auto command = read_command(list->list[k], *version);
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
