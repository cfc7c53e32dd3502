#include "run_script.hpp"

#include <fmt/format.h>

#include <utility>

#include "cli.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/session/command_json.hpp"
#include "progress.hpp"

namespace knead::cli {
namespace {

/// The error of a command with its place in the script; one about an entity names the CAD file that it is in.
Error within_script(Error error, const Session& session, const Script& script, std::size_t command) {
  const std::string place =
      command < script.implied ? std::string() : fmt::format("commands[{}]", command - script.implied);
  if (error.file.empty() && error.where.starts_with('#') && !session.document().is_fresh()) {
    error.file = session.document().name();
  }
  if (!error.file.empty() && error.file != script.name) {
    const std::string line = error.line > 0 ? fmt::format(":{}", error.line) : "";
    error.where = error.file + line + (error.where.empty() ? "" : ": " + error.where);
  }
  error.file = script.name;
  error.line = 0;
  return place.empty() ? error : error.within(place);
}

}  // namespace

Expected<Script> read_script(const std::string& name) {
  const auto text = read_file(name);
  if (!text) return std::unexpected(text.error());
  Script script;
  script.name = name;
  auto commands = parse_script(*text, name, &script.implied);
  if (!commands) return std::unexpected(commands.error());
  script.commands = std::move(*commands);
  return script;
}

Expected<void> check_source(const std::string& file, bool fresh) {
  if (fresh != file.empty()) {
    return usage_error(fresh ? "both a file and --new are given" : "neither a file nor --new is given", "FILE",
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
    auto done = session.execute(command, progress, go_on);
    if (stops && Interrupt::asked()) return execution;
    if (!done) return std::unexpected(within_script(std::move(done.error()), session, script, execution.commands));
    ++execution.commands;
  }
  execution.complete = true;
  return execution;
}

std::string modes_json(const SessionState& state) {
  std::string text;
  const auto list = [&](const char* name, const char* value, const std::vector<ModeRecord>& modes) {
    if (modes.empty()) return;
    text += fmt::format(",\n\"{}\":[", name);
    for (std::size_t k = 0; k < modes.size(); ++k) {
      text += fmt::format("{}\n {{\"{}\":{},\"residual\":{}}}", k == 0 ? "" : ",", value, json_number(modes[k].value),
                          json_number(modes[k].residual));
    }
    text += "]";
  };
  list("modes", "frequency", state.modes);
  list("buckling", "load_factor", state.buckling);
  return text;
}

}  // namespace knead::cli
