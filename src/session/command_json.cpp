#include "knead/session/command_json.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "commands.hpp"
#include "describe/record_json.hpp"

namespace knead {

static std::string_view tag_of(const CommandVariant*) { return "do"; }

template <>
const Type& type_of<CommandVariant>() {
  return make_type<CommandVariant>();
}

namespace {

/// The same with the fields that its texts stand for (`text_forms`). Error (input): such a field is
/// given beside the text.
Expected<Json> spelled_out(Json json) {
  const Type& commands = type_of<CommandVariant>();
  const Json* const name = json.find(commands.name);
  const int k = name != nullptr ? commands.variant(name->text) : -1;
  if (k < 0) return json;
  const Type& command = *commands.variants[static_cast<std::size_t>(k)];
  for (const TextForm& form : text_forms) {
    if (command.find(form.field) == nullptr || command.find(form.stands_for) == nullptr) continue;
    const auto at = std::ranges::find(json.members, form.field,
                                      [](const auto& member) { return member.first; });
    if (at == json.members.end() || !at->second.is(Json::Kind::text)) continue;
    const std::string& text = at->second.text;
    if (form.begins ? !text.starts_with(form.text) : text != form.text) continue;
    if (json.find(form.stands_for) != nullptr) {
      return input_error(fmt::format("\"{}\": {} says it already", form.field, shown(at->second)),
                         form.stands_for, "leave one of them out");
    }
    at->first = form.stands_for;
    if (!form.begins) at->second = {.kind = Json::Kind::boolean, .boolean = true};
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
    return input_error(
        "scripts of version 1 are not read any more", "knead",
        "translate it to version 2: \"Scripts of version 1\" in docs/scripts.md says how");
  }
  return input_error("the version of the script is not 2", "knead", form);
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
  return hold != nullptr && hold->mode == HoldMode::position && hold->all.value_or(false);
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
  for (std::size_t k = 0; k < commands.size(); ++k)
    text += (k == 0 ? "\n  " : ",\n  ") + to_json(commands[k]);
  return text + (commands.empty() ? "]" : "\n]");
}

}  // namespace

Expected<Command> read_command(const Json& given) {
  const auto json = spelled_out(given);
  if (!json) return std::unexpected(json.error());
  AnyCommand any;
  if (auto status = read_variant(*json, type_of<CommandVariant>(), &any.fields, "command");
      !status) {
    return std::unexpected(status.error());
  }
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
  if (auto status = read_commands(*json, commands); !status) return std::unexpected(status.error());
  return commands;
}

std::string to_json(const Command& command) {
  return to_json(type_of<CommandVariant>(), &command.any().fields);
}

Expected<std::vector<Command>> parse_script(std::string_view text, const std::string& name,
                                            std::size_t* before) {
  const auto fail = [&name](Error error) {
    error.file = name;
    return std::unexpected(std::move(error));
  };
  const auto json = parse_json(text);
  if (!json) return fail(json.error());
  constexpr const char* form = R"(write {"knead": 2, "commands": [...]})";
  if (!json->is(Json::Kind::object))
    return fail({ErrorKind::input, "a script must be an object", {}, form});
  for (const auto& [member, value] : json->members) {
    if (member != "knead" && member != "commands") {
      return fail({ErrorKind::input, "a script has no such field", member,
                   "the fields are: knead, commands"});
    }
  }
  if (auto version = check_version(*json, form); !version) return fail(version.error());
  const Json* list = json->find("commands");
  if (list == nullptr || !list->is(Json::Kind::list)) {
    return fail({ErrorKind::input, "the list of commands is missing", "commands", form});
  }
  std::vector<Command> commands = {default_hold()};
  if (before != nullptr) *before = commands.size();
  if (auto status = read_commands(*list, commands); !status) return fail(status.error());
  return commands;
}

std::string commands_json(const std::vector<Command>& commands) {
  return list_json(commands) + "\n";
}

std::string script_json(const std::vector<Command>& commands) {
  std::vector<Command> listed = commands;
  if (!listed.empty() && is_default_hold(listed.front())) {
    listed.erase(listed.begin());
  } else if (!listed.empty() && fields_of<NewCommand>(listed.front()) == nullptr) {
    listed.insert(listed.begin(),
                  hold_nothing());  // a document that begins with `new` has no faces to hold
  }
  return fmt::format("{{\"knead\": {}, \"commands\": {}}}\n", script_version, list_json(listed));
}

Command default_hold() {
  HoldCommand hold;
  hold.mode = HoldMode::position;
  hold.all = true;
  return make_command(hold);
}

Command::Command(AnyCommand command)
    : any_(std::make_shared<const AnyCommand>(std::move(command))) {}

std::string_view Command::name() const {
  return type_of<CommandVariant>().variants[any_->fields.index()]->name;
}

std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for (const Type* command : type_of<CommandVariant>().variants) names.emplace_back(command->name);
  return names;
}

}  // namespace knead
