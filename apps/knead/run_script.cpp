#include "run_script.hpp"

#include <fmt/format.h>

#include <utility>

#include "cli.hpp"
#include "knead/exchange/compression.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/nrrd.hpp"
#include "knead/session/command_json.hpp"
#include "progress.hpp"
#include "working.hpp"

namespace knead::cli {
namespace {

/// ": commands[3]"; nothing of a command that scripts begin with.
std::string place_in(const Script& script, std::size_t command) {
  return command < script.implied ? std::string() : fmt::format(": commands[{}]", command - script.implied);
}

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
  if (error.kind == ErrorKind::usage) error.kind = ErrorKind::input;
  return place.empty() ? error : error.within(place);
}

/// What the bytes of a file are where they are known to be no script: "a STEP file".
std::string kind_of_file(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.find_first_not_of(" \t\r\n") == bytes.npos) return "an empty file";
  if (bytes.starts_with("\x89PNG"sv) || bytes.starts_with("\xFF\xD8\xFF"sv)) return "an image";
  if (is_nrrd(bytes)) return "an NRRD file";
  if (compression_of(bytes) != Compression::none) return "a compressed file";
  if (bytes[0] == '{' || bytes[0] == '[') return {};
  for (const Format& format : formats()) {
    if (format.recognises == nullptr || !format.recognises(bytes)) continue;
    const bool vowel = std::string_view("AEIO").find(format.name.front()) != std::string_view::npos;
    return fmt::format("{} {} file", vowel ? "an" : "a", format.name);
  }
  return {};
}

}  // namespace

Error in_script(Error error, std::string_view text, const std::string& name) {
  if (const std::string kind = kind_of_file(text); !kind.empty()) {
    error = {ErrorKind::input,
             "this is " + kind + ", not a script",
             {},
             R"(write JSON: {"knead": 2, "commands": [...]}; `knead commands` explains them)"};
  }
  if (error.kind == ErrorKind::usage) error.kind = ErrorKind::input;
  error.file = name;
  return error;
}

Expected<Script> read_script(const std::string& name) {
  const auto text = read_file(name);
  if (!text) return std::unexpected(text.error());
  Script script;
  script.name = name;
  auto commands = parse_script(*text, name, &script.implied);
  if (!commands) return std::unexpected(in_script(commands.error(), *text, name));
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
    if (execution.commands == script.implied) session.begin_history();  // what a script begins with is not undone
    work_on(script.name + place_in(script, execution.commands));
    auto done = session.execute(command, progress, go_on);
    if (stops && Interrupt::asked()) return execution;
    if (!done) return std::unexpected(within_script(std::move(done.error()), session, script, execution.commands));
    ++execution.commands;
  }
  work_on({});
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
