#include "studio_state.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "knead/session/command_json.hpp"

namespace knead::studio {

std::string state_json(const Session& session) { return session_json(session); }
std::string journal_json(const Session& session) { return commands_json(session.journal()); }

Expected<void> carry_out(Session& session, std::string_view lines, const ActOptions& options,
                         const Session::Progress& progress) {
  std::vector<Command> commands;
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    auto command = parse_command(lines.substr(0, end));
    if (!command) return std::unexpected(command.error());
    commands.push_back(*std::move(command));
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  if (commands.empty()) {
    session.drop_unchanged();
    return {};
  }
  auto done = session.act(commands, options, progress);
  if (!done) return std::unexpected(std::move(done.error()));
  return {};
}

std::size_t begin_history(Session& session, int commands) {
  if (commands < 0) {
    session.begin_history();
  } else {
    session.begin_history_after(static_cast<std::size_t>(commands));
  }
  return session.opening_commands();
}

}  // namespace knead::studio
