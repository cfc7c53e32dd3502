#include "studio_state.hpp"

#include "knead/session/command_json.hpp"

namespace knead::studio {

std::string state_json(const Session& session) { return session_json(session); }
std::string journal_json(const Session& session) { return script_json(session.journal()); }

}  // namespace knead::studio
