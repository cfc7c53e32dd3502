#include "knead/session/command_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "command_text.hpp"
#include "restated.hpp"

namespace knead {
namespace {

// --- reading -------------------------------------------------------------------------------------------------------

/// Each `read` returns what the value should have been, or an empty string on success.
std::string read(const Json& j, double& out) {
  if (!j.is_number()) return "a number";
  out = j.get<double>();
  return std::isfinite(out) ? "" : "a finite number";
}

std::string read(const Json& j, int& out) {
  constexpr double limit = 2e9;
  double value = 0;
  if (!read(j, value).empty() || value != std::floor(value) || std::abs(value) > limit) return "a whole number";
  out = static_cast<int>(value);
  return "";
}

std::string read(const Json& j, bool& out) {
  if (!j.is_boolean()) return "true or false";
  out = j.get<bool>();
  return "";
}

std::string read(const Json& j, std::string& out) {
  if (!j.is_string()) return "a string";
  out = j.get<std::string>();
  return "";
}

/// An edge by its name, where it may be left out.
std::string read(const Json& j, EdgeChoice& out) {
  for (const Choice<EdgeChoice>& c : edge_choices) {
    if (!j.is_string() || j.get_ref<const std::string&>() != c.name) continue;
    out = c.value;
    return "";
  }
  return "one of: all, u0, u1, v0, v1";
}

template <class T, std::size_t N>
std::string read(const Json& j, std::array<T, N>& out);
template <class T>
std::string read(const Json& j, std::vector<T>& out);

template <class T, std::size_t N>
std::string read(const Json& j, std::array<T, N>& out) {
  const std::string wanted = fmt::format("a list of {} {}", N,
                                         std::is_same_v<T, int>      ? "whole numbers"
                                         : std::is_same_v<T, double> ? "numbers"
                                                                     : "lists of numbers");
  if (!j.is_array() || j.size() != N) return wanted;
  for (std::size_t k = 0; k < N; ++k) {
    if (!read(j[k], out[k]).empty()) return wanted;
  }
  return "";
}

template <class T>
std::string read(const Json& j, std::vector<T>& out) {
  if (!j.is_array()) return "a list";
  out.resize(j.size());
  for (std::size_t k = 0; k < j.size(); ++k) {
    if (std::string wanted = read(j[k], out[k]); !wanted.empty()) return fmt::format("a list, each entry {}", wanted);
  }
  return "";
}

template <class T>
std::string read(const Json& j, std::optional<T>& out) {
  return read(j, out.emplace());
}

struct Reader {
  const Json& json;
  std::optional<Error> error = {};
  std::vector<std::string_view> known = {};

  void fail(std::string_view name, std::string what, std::string remedy) {
    if (!error) error = Error{ErrorKind::input, std::move(what), std::string(name), std::move(remedy)};
  }

  template <class T>
  void field(std::string_view name, Presence presence, T& member, std::string_view) {
    known.push_back(name);
    const auto it = json.find(name);
    if (it == json.end()) {
      if (presence == Presence::required) fail(name, "the field is missing", fmt::format("give \"{}\"", name));
      return;
    }
    if (const std::string wanted = read(*it, member); !wanted.empty()) {
      fail(name, fmt::format("{} does not fit", it->dump()), "give " + wanted);
    }
  }

  template <class E>
  void choice(std::string_view name, E& member, std::span<const Choice<E>> choices, std::string_view) {
    known.push_back(name);
    const auto it = json.find(name);
    if (it == json.end()) return;
    std::vector<std::string_view> names;
    for (const Choice<E>& c : choices) {
      if (it->is_string() && it->get_ref<const std::string&>() == c.name) {
        member = c.value;
        return;
      }
      names.push_back(c.name);
    }
    fail(name, fmt::format("{} is not known", it->dump()), "use one of: " + joined(names));
  }

  template <class E>
  void choice(std::string_view name, std::optional<E>& member, std::span<const Choice<E>> choices,
              std::string_view help) {
    if (!json.contains(name)) {
      known.push_back(name);
      return;
    }
    choice(name, member.emplace(), choices, help);
  }
};

Expected<Command> read_command(const Json& json) {
  if (!json.is_object()) return input_error("a command must be an object", {}, R"(write {"do": "...", ...})");
  const auto name = json.find("do");
  if (name == json.end() || !name->is_string()) {
    return input_error("the command has no name", "do", R"(write {"do": "...", ...})");
  }
  std::optional<Expected<Command>> result;
  std::vector<std::string_view> names;
  for_each_command([&]<class C>(C command) {
    using Info = CommandInfo<C>;
    names.push_back(Info::name);
    if (name->get_ref<const std::string&>() != Info::name) return;
    Reader reader{json};
    Info::visit(command, reader);
    for (const auto& item : json.items()) {
      if (item.key() == "do" || std::ranges::find(reader.known, item.key()) != reader.known.end()) continue;
      reader.fail(item.key(), fmt::format("\"{}\" has no such field", Info::name),
                  reader.known.empty() ? "it has none but \"do\"" : "the fields are: " + joined(reader.known));
    }
    if (reader.error) {
      result = std::unexpected(*reader.error);
    } else {
      result = make_command(std::move(command));
    }
  });
  if (result) return *result;
  return input_error(fmt::format("{} is not a command", name->dump()), "do", "the commands are: " + joined(names));
}

/// Notes where the text stops being JSON; builds nothing.
struct SyntaxCheck : nlohmann::json_sax<Json> {
  std::size_t position = 0;
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t at, const std::string&, const nlohmann::detail::exception&) override {
    position = at;
    return false;
  }
};

Expected<Json> parse_json(std::string_view text) {
  SyntaxCheck check;
  if (!Json::sax_parse(text, &check)) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(check.position, text.size()));
    const auto line = 1 + std::count(text.begin(), end, '\n');
    Error error{ErrorKind::input, "this is not JSON", {}, "check quotes, commas and brackets just before this place"};
    error.line = static_cast<int>(line);
    return std::unexpected(error);
  }
  return Json::parse(text, nullptr, false);
}

// --- writing -------------------------------------------------------------------------------------------------------

struct Writer {
  std::string text;
  void add(std::string_view name, const std::string& value) { text += fmt::format(",\"{}\":{}", name, value); }

  template <class T>
  void field(std::string_view name, Presence, const T& member, std::string_view) {
    add(name, write(member));
  }
  template <class T>
  void field(std::string_view name, Presence, const std::optional<T>& member, std::string_view) {
    if (member) add(name, write(*member));
  }
  template <class E>
  void choice(std::string_view name, const E& member, std::span<const Choice<E>> choices, std::string_view) {
    add(name, fmt::format("\"{}\"", name_of(member, choices)));
  }
  template <class E>
  void choice(std::string_view name, const std::optional<E>& member, std::span<const Choice<E>> choices,
              std::string_view help) {
    if (member) choice(name, *member, choices, help);
  }
};

}  // namespace

Expected<Command> parse_command(std::string_view text) {
  auto json = parse_json(text);
  if (!json) return std::unexpected(json.error());
  return read_command(*json);
}

std::string to_json(const Command& command) {
  return std::visit(
      []<class C>(const C& c) {
        Writer writer;
        CommandInfo<C>::visit(c, writer);
        return fmt::format("{{\"do\":\"{}\"{}}}", CommandInfo<C>::name, writer.text);
      },
      command.any().fields);
}

std::string to_json(const Constraint& constraint) { return to_json(restated(constraint)); }
std::string to_json(const SceneForce& force) { return to_json(make_command(ForceCommand{force})); }
std::string to_json(const Load& load) { return to_json(make_command(LoadCommand{load})); }
std::string to_json(const EvolutionPolicy& evolution) { return to_json(make_command(EvolveCommand{evolution})); }
std::string to_json(const SeamPolicy& seams) { return to_json(make_command(SeamsCommand{seams})); }

Expected<std::vector<Command>> parse_script(std::string_view text, const std::string& name) {
  const auto fail = [&name](Error error) {
    error.file = name;
    return std::unexpected(std::move(error));
  };
  auto json = parse_json(text);
  if (!json) return fail(json.error());
  constexpr const char* form = R"(write {"knead": 1, "commands": [...]})";
  if (!json->is_object()) return fail({ErrorKind::input, "a script must be an object", {}, form});
  for (const auto& item : json->items()) {
    if (item.key() != "knead" && item.key() != "commands") {
      return fail({ErrorKind::input, "a script has no such field", item.key(), "the fields are: knead, commands"});
    }
  }
  const auto version = json->find("knead");
  if (version == json->end() || *version != 1) {
    return fail({ErrorKind::input, "the version of the script is not 1", "knead", form});
  }
  const auto list = json->find("commands");
  if (list == json->end() || !list->is_array()) {
    return fail({ErrorKind::input, "the list of commands is missing", "commands", form});
  }
  std::vector<Command> commands;
  for (std::size_t k = 0; k < list->size(); ++k) {
    auto command = read_command((*list)[k]);
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

Command::Command(AnyCommand command) : any_(std::make_shared<const AnyCommand>(std::move(command))) {}

std::string_view Command::name() const {
  return std::visit([]<class C>(const C&) { return CommandInfo<C>::name; }, any_->fields);
}

std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for_each_command([&names]<class C>(const C&) { names.emplace_back(CommandInfo<C>::name); });
  return names;
}

}  // namespace knead
