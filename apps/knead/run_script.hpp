#pragma once

#include <string>
#include <vector>

#include "knead/session/session.hpp"

namespace knead::cli {

/// The commands of a script file.
struct Script {
  std::string name;
  std::vector<Command> commands;
  std::size_t implied = 0;  ///< the first so many are implied by the script's version
};

[[nodiscard]] Expected<Script> read_script(const std::string& name);

/// A usage error where both a file and none, or neither, is asked for.
[[nodiscard]] Expected<void> check_source(const std::string& file, bool fresh);
/// Opens a CAD file, or begins without one.
[[nodiscard]] Expected<Document> open_document(const std::string& file, bool fresh);

/// Executes all commands, with progress on a terminal. The error names the script and the command.
[[nodiscard]] Expected<void> execute(Session& session, const Script& script);

/// The lists `modes` and `buckling` of reports, each after a comma; nothing where there are none.
[[nodiscard]] std::string modes_json(const SessionState& state);

}  // namespace knead::cli
