#include "run_script.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "cli.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/session/command_json.hpp"

namespace knead::cli {
namespace {

/// "step 12 of 60" on standard error, when that is a terminal and the work has taken more than a second.
class ProgressLine {
 public:
  void show(int done, int total) {
    const auto now = std::chrono::steady_clock::now();
    if (!terminal_ || now - start_ < std::chrono::seconds(1) || now - shown_ < std::chrono::milliseconds(100)) return;
    shown_ = now;
    fmt::print(stderr, "\rstep {} of {} ", done, total);
    std::fflush(stderr);
  }
  ~ProgressLine() {
    if (shown_ > start_) fmt::print(stderr, "\r\x1b[K");
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), shown_ = start_;
};

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

Expected<Document> open_document(const std::string& file, bool fresh) {
  return fresh ? Document::fresh("sheet") : Document::open(file);
}

Expected<void> execute(Session& session, const Script& script) {
  ProgressLine line;
  for (std::size_t k = 0; k < script.commands.size(); ++k) {
    auto done = session.execute(script.commands[k], [&line](int step, int total) { line.show(step, total); });
    if (done) continue;
    Error error =
        k < script.implied ? done.error() : done.error().within(fmt::format("commands[{}]", k - script.implied));
    error.file = script.name;
    return std::unexpected(error);
  }
  return {};
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
