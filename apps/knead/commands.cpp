#include <fmt/format.h>

#include "cli.hpp"
#include "knead/session/command_json.hpp"
#include "say.hpp"

namespace knead::cli {

Action add_commands(CLI::App& app) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("commands", "explain the commands of scripts");
  command->add_option("NAME", *name, "the command to explain (default: all, in brief)")
      ->type_name("");
  auto table = std::make_shared<bool>(false);
  command->add_flag("--table", *table,
                    "print the fields of NAME as a table in Markdown, as docs/scripts.md has it");
  command->footer(std::string(exit_codes));
  return [name, table]() -> Expected<void> {
    if (*table && name->empty()) {
      return usage_error("a table is that of one command", "--table",
                         "give NAME too, or leave it out");
    }
    const auto text = name->empty() ? Expected<std::string>(command_help()) : command_help(*name);
    if (!text) return std::unexpected(text.error());
    say("{}", *table ? command_table(*name) : *text);
    return {};
  };
}

}  // namespace knead::cli
