#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cad_input.hpp"
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
[[nodiscard]] Expected<Document> open_document(const std::string& file, bool fresh,
                                               const UnpackOption& most);

/// How far a script came.
struct Execution {
  /// So many are done; of the next one, if it is `step`, some steps may be.
  std::size_t commands = 0;
  bool complete = false;
};

/// Executes all commands, with progress on a terminal; with `stops`, until Ctrl+C is pressed
/// (`Interrupt`). The error names the script, the command, and the CAD file where it is about an
/// entity of that.
[[nodiscard]] Expected<Execution> execute(Session& session, const Script& script,
                                          bool stops = false);

}  // namespace knead::cli
