#include "run_script.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "cli.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/session/command_json.hpp"
#include "progress.hpp"
#include "working.hpp"

namespace knead::cli {
namespace {

/// The place of a command in its script; none of one that scripts begin with.
std::optional<std::size_t> place_in(const Script& script, std::size_t command) {
  return command < script.implied ? std::nullopt : std::optional(command - script.implied);
}

}  // namespace

Expected<Script> read_script(const std::string& name) {
  const auto text = read_file(name);
  if (!text) return std::unexpected(text.error());
  Script script;
  script.name = name;
  auto commands = parse_script(*text, name, &script.implied);
  if (!commands) return std::unexpected(error_of_script(commands.error(), *text, name));
  script.commands = std::move(*commands);
  return script;
}

Expected<void> check_source(const std::string& file, bool fresh) {
  if (fresh != file.empty()) {
    return usage_error(
        fresh ? "both a file and --new are given" : "neither a file nor --new is given", "FILE",
        "name a STEP file, or give --new to start without one");
  }
  return {};
}

Expected<Document> open_document(const std::string& file, bool fresh, const UnpackOption& most) {
  if (fresh) return Document::fresh("sheet");
  ProgressLine line;
  announce_reading(line, file);
  return Document::open(file, most.options());
}

Expected<Execution> execute(Session& session, const Script& script, bool stops) {
  ProgressLine line;
  const auto progress = [&](int step, int total) {
    line.show("step", static_cast<std::size_t>(step), static_cast<std::size_t>(total));
    return !(stops && Interrupt::asked());
  };
  const auto go_on = [&] { return !(stops && Interrupt::asked()); };
  Execution execution;
  for (const Command& command : script.commands) {
    if (execution.commands == script.implied)
      session.begin_history();  // what a script begins with is not undone
    const auto place = place_in(script, execution.commands);
    work_on(script.name + (place ? fmt::format(": commands[{}]", *place) : ""));
    auto status = session.execute(command, progress, go_on);
    if (stops && Interrupt::asked()) return execution;
    if (!status)
      return std::unexpected(
          error_at_command(std::move(status.error()), session.document(), script.name, place));
    ++execution.commands;
  }
  work_on({});
  execution.complete = true;
  return execution;
}

}  // namespace knead::cli
