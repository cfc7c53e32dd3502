#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "knead/session/document.hpp"

namespace knead {

// Errors of scripts with their places, as programs show them: "press.json: commands[3]: radius: …".

/// The error of reading a script: its file is the script, and what would be wrong usage of a function is wrong input.
/// Where the text is a file of another kind (CAD, image, compressed, empty), that is what is said.
[[nodiscard]] Error error_of_script(Error error, std::string_view text, const std::string& script);

/// The error of executing a command of a script: its file is the script, its place begins with "commands[k]" (nothing
/// for commands that scripts begin with, without k), then the CAD file where it is about an entity of that.
[[nodiscard]] Error error_at_command(Error error, const Document& document, const std::string& script,
                                     std::optional<std::size_t> k);

}  // namespace knead
