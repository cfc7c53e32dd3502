#pragma once

#include <string>

#include "exchange/two_sheets.hpp"
#include "knead/exchange/format.hpp"
#include "knead/session/command_json.hpp"
#include "session/session_state.hpp"

namespace knead::testing {

inline Expected<void> run_all(Session& session, const Expected<std::vector<Command>>& commands) {
  if (!commands) return std::unexpected(commands.error());
  for (const Command& command : *commands) {
    if (auto status = session.execute(command); !status) return status;
  }
  return {};
}

/// Runs a script of these commands up to the first that fails.
inline Expected<void> run(Session& session, const std::string& commands) {
  return run_all(session, parse_script(R"({"knead":2,"commands":[)" + commands + "]}", "script"));
}

/// Runs these commands alone: nothing is held that was not.
inline Expected<void> run_on(Session& session, const std::string& commands) {
  return run_all(session, parse_commands("[" + commands + "]"));
}

inline Session opened(const TwoSheets& sheets) {
  return Session(Document::from(*open_source(sheets.text, "sheets.step")));
}

/// Both of two sheets, and a press into the middle of their edge.
inline const std::string both = R"({"do":"select","surfaces":["#10","#20"]})";
inline const std::string press = R"({"do":"material","alpha":[1,0,1],"beta":[0.003,0.003,0.003]},
  {"do":"tool","name":"ball","radius":0.2,"rigid":true,"position":[1,0.5,0.16]},
  {"do":"evolve","mode":"static"})";

}  // namespace knead::testing
