#include "studio_state.hpp"

#include "knead/session/command_json.hpp"
#include "knead/session/session_info.hpp"

namespace knead::studio {

std::string error_json(const Error& error) { return knead::error_json(error); }
std::string state_json(const Session& session) { return session_json(session); }
std::string steps_json(const SessionState& state, std::size_t first) { return knead::steps_json(state, first); }
std::string journal_json(const Session& session) { return script_json(session.journal()); }

}  // namespace knead::studio
