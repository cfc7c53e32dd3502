#include <fmt/format.h>

#include "cli.hpp"
#include "knead/session/command_json.hpp"

namespace knead::cli {

Action add_commands(CLI::App& app) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("commands", "explain the commands of scripts");
  command->add_option("NAME", *name, "the command to explain; left out: all in short")->type_name("");
  command->footer(std::string(exit_codes));
  return [name]() -> Expected<void> {
    const auto text = name->empty() ? Expected<std::string>(command_help()) : command_help(*name);
    if (!text) return std::unexpected(text.error());
    fmt::print("{}", *text);
    return {};
  };
}

}  // namespace knead::cli
