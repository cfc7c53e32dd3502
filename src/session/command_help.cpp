#include "command_text.hpp"
#include "knead/session/command_json.hpp"

namespace knead {
namespace {

/// A default for people: as few digits as it takes; nothing for an empty list.
template <class T>
std::string shown(const T& value) {
  const Json json = Json::parse(write(value), nullptr, false);
  return json.is_array() && json.empty() ? "" : json.dump();
}

/// One line of help per field: name, meaning, default.
struct HelpWriter {
  std::string text;
  void add(std::string_view name, const std::string& value, std::string_view help) {
    text += fmt::format("  {:<15} {}{}\n", name, help, help.empty() && !value.empty() ? value.substr(1) : value);
  }
  template <class T>
  void field(std::string_view name, Presence presence, const T& member, std::string_view help) {
    const std::string value = shown(member);
    add(name, presence == Presence::required ? " (required)" : value.empty() ? "" : " (default " + value + ")", help);
  }
  template <class T>
  void field(std::string_view name, Presence, const std::optional<T>&, std::string_view help) {
    add(name, "", help);
  }
  template <class E>
  void choice(std::string_view name, const E& member, std::span<const Choice<E>> choices, std::string_view help) {
    std::vector<std::string_view> names;
    for (const Choice<E>& c : choices) names.push_back(c.name);
    add(name, fmt::format(" ({}; default {})", joined(names), name_of(member, choices)), help);
  }
  template <class E>
  void choice(std::string_view name, const std::optional<E>&, std::span<const Choice<E>> choices,
              std::string_view help) {
    std::vector<std::string_view> names;
    for (const Choice<E>& c : choices) names.push_back(c.name);
    add(name, fmt::format(" ({})", joined(names)), help);
  }
};

/// The fields in a few lines: names with their defaults.
struct BriefWriter {
  static constexpr std::size_t indent = 14, width = 110;
  std::string text = {};
  std::size_t column = indent;

  void add(std::string_view name, const std::string& value) {
    const std::string entry = fmt::format("{}{}{}", name, value.empty() ? "" : " ", value);
    if (!text.empty()) {
      text += ",";
      column += 1;
    }
    if (text.empty() || column + 1 + entry.size() > width) {
      text += fmt::format("{}{:{}}", text.empty() ? "" : "\n", "", indent);
      column = indent;
    } else {
      text += " ";
      column += 1;
    }
    text += entry;
    column += entry.size();
  }
  template <class T>
  void field(std::string_view name, Presence presence, const T& member, std::string_view) {
    add(name, presence == Presence::required ? "(required)" : shown(member));
  }
  template <class T>
  void field(std::string_view name, Presence, const std::optional<T>&, std::string_view) {
    add(name, "");
  }
  template <class E>
  void choice(std::string_view name, const E& member, std::span<const Choice<E>> choices, std::string_view) {
    add(name, fmt::format("\"{}\"", name_of(member, choices)));
  }
  template <class E>
  void choice(std::string_view name, const std::optional<E>&, std::span<const Choice<E>>, std::string_view) {
    add(name, "");
  }
};

}  // namespace

std::string command_help() {
  std::string text;
  for_each_command([&text]<class C>(const C& command) {
    BriefWriter writer;
    CommandInfo<C>::visit(command, writer);
    text += fmt::format("  {:<11} {}\n{}{}", CommandInfo<C>::name, CommandInfo<C>::help, writer.text,
                        writer.text.empty() ? "" : "\n");
  });
  return text;
}

Expected<std::string> command_help(const std::string& name) {
  std::string text;
  for_each_command([&]<class C>(const C& command) {
    if (CommandInfo<C>::name != name) return;
    HelpWriter writer;
    CommandInfo<C>::visit(command, writer);
    text = fmt::format("{}: {}\n{}", name, CommandInfo<C>::help, writer.text.empty() ? "  (no fields)\n" : writer.text);
  });
  if (!text.empty()) return text;
  std::string known;
  for (const std::string& other : command_names()) known += (known.empty() ? "" : ", ") + other;
  return std::unexpected(
      Error{ErrorKind::usage, "there is no command \"" + name + "\"", "NAME", "the commands are: " + known});
}

}  // namespace knead
