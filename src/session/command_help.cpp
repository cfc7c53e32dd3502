#include <fmt/format.h>

#include "commands.hpp"
#include "describe/text.hpp"
#include "knead/session/command_json.hpp"

namespace knead {

std::string command_help() {
  std::string text;
  for (const Type* command : type_of<CommandVariant>().variants) {
    const std::string fields = brief_help(*command);
    text += fmt::format("  {:<11} {}\n{}{}", command->name, command->help, fields,
                        fields.empty() ? "" : "\n");
  }
  return text;
}

Expected<std::string> command_help(const std::string& name) {
  const Type& commands = type_of<CommandVariant>();
  const int k = commands.variant(name);
  if (k < 0) {
    return usage_error("there is no command \"" + name + "\"", "NAME",
                       "the commands are: " + joined(variant_names(commands)));
  }
  const Type& command = *commands.variants[static_cast<std::size_t>(k)];
  const std::string fields = full_help(command);
  return fmt::format("{}: {}\n{}", name, command.help, fields.empty() ? "  (no fields)\n" : fields);
}

std::string command_table(const std::string& name) {
  const Type& commands = type_of<CommandVariant>();
  const int k = commands.variant(name);
  return k < 0 ? "" : markdown_table(*commands.variants[static_cast<std::size_t>(k)]);
}

}  // namespace knead
