#include "knead/session/command_json.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "commands.hpp"
#include "described_json.hpp"

namespace knead {

static std::string_view tag_of(const CommandVariant*) { return "do"; }

template <>
const Type& type_of<CommandVariant>() {
  return make_type<CommandVariant>();
}

namespace {

/// The same with the fields that its texts stand for (`text_forms`).
Json spelled_out(Json json) {
  for (auto& [name, value] : json.members) {
    const auto form = std::ranges::find(text_forms, name, &TextForm::field);
    if (form == std::end(text_forms) || !value.is(Json::Kind::text)) continue;
    if (form->begins ? !value.text.starts_with(form->text) : value.text != form->text) continue;
    name = form->stands_for;
    if (form->begins) continue;
    value = {};
    value.kind = Json::Kind::boolean;
    value.boolean = true;
  }
  return json;
}

/// The form of scripts that is read; older ones are translated by hand.
constexpr int script_version = 2;

Expected<void> check_version(const Json& json, const char* form) {
  const Json* version = json.find("knead");
  const bool number = version != nullptr && version->is(Json::Kind::number);
  if (number && version->number == script_version) return {};
  if (number && version->number == 1) {
    return input_error("scripts of version 1 are not read any more", "knead",
                       "translate it to version 2: \"Scripts of version 1\" in docs/scripts.md says how");
  }
  return input_error("the version of the script is not 2", "knead", form);
}

/// The error for a field made meaningless by the rest of a command.
template <class C>
Expected<void> check_applicable(const Json& json, const C& command) {
  if constexpr (requires { inapplicable(command, std::string_view{}); }) {
    for (const auto& [name, value] : json.members) {
      const bool says_nothing = value.is(Json::Kind::null) || (value.is(Json::Kind::list) && value.list.empty());
      if (says_nothing) continue;
      if (const auto error = inapplicable(command, name)) return std::unexpected(*error);
    }
  }
  return {};
}

/// Appends the commands of a list.
Expected<void> read_commands(const Json& list, std::vector<Command>& commands) {
  for (std::size_t k = 0; k < list.list.size(); ++k) {
    auto command = read_command(list.list[k]);
    if (!command) {
      Error error = command.error();
      error.where = fmt::format("commands[{}]", k) + (error.where.empty() ? "" : "." + error.where);
      return std::unexpected(std::move(error));
    }
    commands.push_back(std::move(*command));
  }
  return {};
}

bool is_default_hold(const Command& command) {
  const auto* hold = fields_of<HoldCommand>(command);
  return hold != nullptr && hold->mode == HoldMode::trim && hold->all.value_or(false);
}

/// Undoes what scripts begin with.
Command hold_nothing() {
  HoldCommand hold;
  hold.rows = 0;
  hold.all = true;
  return make_command(hold);
}

/// One per line.
std::string list_json(std::span<const Command> commands) {
  std::string text = "[";
  for (std::size_t k = 0; k < commands.size(); ++k) text += (k == 0 ? "\n  " : ",\n  ") + to_json(commands[k]);
  return text + (commands.empty() ? "]" : "\n]");
}

}  // namespace

Expected<Command> read_command(const Json& given) {
  const Json json = spelled_out(given);
  AnyCommand any;
  if (auto done = read_variant(json, type_of<CommandVariant>(), &any.fields, "command"); !done) {
    return std::unexpected(done.error());
  }
  const auto check = [&](const auto& command) { return check_applicable(json, command); };
  if (auto done = std::visit(check, any.fields); !done) return std::unexpected(done.error());
  return Command(std::move(any));
}

Expected<Command> parse_command(std::string_view text) {
  const auto json = parse_json(text);
  if (!json) return std::unexpected(json.error());
  return read_command(*json);
}

Expected<std::vector<Command>> parse_commands(std::string_view text) {
  const auto json = parse_json(text);
  if (!json) return std::unexpected(json.error());
  if (!json->is(Json::Kind::list))
    return input_error("this is no list of commands", "commands", R"(write [{"do": …}])");
  std::vector<Command> commands;
  if (auto done = read_commands(*json, commands); !done) return std::unexpected(done.error());
  return commands;
}

std::string to_json(const Command& command) { return to_json(type_of<CommandVariant>(), &command.any().fields); }

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
  if (auto version = check_version(*json, form); !version) return fail(version.error());
  const Json* list = json->find("commands");
  if (list == nullptr || !list->is(Json::Kind::list)) {
    return fail({ErrorKind::input, "the list of commands is missing", "commands", form});
  }
  std::vector<Command> commands = {default_hold()};
  if (before != nullptr) *before = commands.size();
  if (auto done = read_commands(*list, commands); !done) return fail(done.error());
  return commands;
}

std::string commands_json(const std::vector<Command>& commands) { return list_json(commands) + "\n"; }

std::string script_json(const std::vector<Command>& commands) {
  std::vector<Command> listed = commands;
  if (!listed.empty() && is_default_hold(listed.front())) {
    listed.erase(listed.begin());
  } else if (!listed.empty() && fields_of<NewCommand>(listed.front()) == nullptr) {
    listed.insert(listed.begin(), hold_nothing());  // a document that begins with `new` has no faces to hold
  }
  return fmt::format("{{\"knead\": {}, \"commands\": {}}}\n", script_version, list_json(listed));
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
