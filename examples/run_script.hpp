#pragma once

#include <string>

#include "knead/session/session.hpp"

namespace knead::examples {

/// The session after a script, as `knead sculpt` runs it: on this STEP file, or on a new sheet if
/// `file` is empty.
[[nodiscard]] Expected<Session> run_script(const std::string& script, const std::string& file);

}  // namespace knead::examples
