#pragma once

#include <string>
#include <string_view>

#include "session/session_state.hpp"

namespace knead {

/// Adds a note unless it is there.
void note_once(SessionRecord& record, Note note);
/// Adds a note of which only the last stands: others that begin alike go.
void note_last(SessionRecord& record, std::string_view begins, const std::string& note,
               Diagnostic read = {});

}  // namespace knead
