#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/session/command.hpp"
#include "knead/session/document.hpp"

namespace knead {

/// One command from its JSON form. Errors (input) name the field; an unknown command or field lists
/// the known ones.
[[nodiscard]] Expected<Command> parse_command(std::string_view json);

/// The commands of a list [...], and of nothing else. Errors (input) name the place, as
/// "commands[2].radius".
[[nodiscard]] Expected<std::vector<Command>> parse_commands(std::string_view json);

/// Such a list, one command per line.
[[nodiscard]] std::string commands_json(const std::vector<Command>& commands);

/// The JSON form of a command, every field written out, numbers to 17 significant digits; parsing
/// it gives back the same command.
[[nodiscard]] std::string to_json(const Command& command);

/// The first command of a session by default: {"do": "hold", "mode": "position", "all": true}, so
/// that every face still fits its neighbours.
[[nodiscard]] Command default_hold();

/// The commands of a script {"knead": 2, "commands": [...]}, the first of them `default_hold`.
/// `name` stands for the file in errors, which give the line of a syntax error, or the path of a
/// wrong value ("commands[2].radius"). \param before number of commands before those that the
/// script lists; may be null
[[nodiscard]] Expected<std::vector<Command>> parse_script(std::string_view json,
                                                          const std::string& name,
                                                          std::size_t* before = nullptr);

/// A script that does the same as these commands, one per line: without a `default_hold` at their
/// beginning; where they begin with neither that nor `new`, it first holds nothing.
[[nodiscard]] std::string script_json(const std::vector<Command>& commands);

/// All commands, in the order of the help.
[[nodiscard]] std::vector<std::string> command_names();

/// For help texts: every command on a line, and below it the names of its fields with their
/// defaults.
[[nodiscard]] std::string command_help();

/// What one command does, and every field on a line: name, meaning, default. Error (usage): no such
/// command.
[[nodiscard]] Expected<std::string> command_help(const std::string& name);

/// The fields of a command as a table in Markdown: field, default, meaning. Empty if there is no
/// such command or it has no fields.
[[nodiscard]] std::string command_table(const std::string& name);

/// JSON schemas (draft 2020-12) of scripts, and of Knead documents (docs/knead-document.md).
[[nodiscard]] std::string script_schema();
[[nodiscard]] std::string document_schema();

// Errors of scripts with their places, as programs show them: "press.json: commands[3]: radius: …".

/// The error of reading a script: its file is the script, and what would be wrong usage of a
/// function is wrong input. Where the text is a file of another kind (CAD, image, compressed,
/// empty), that is what is said.
[[nodiscard]] Error error_of_script(Error error, std::string_view text, const std::string& script);

/// The error of executing a command of a script: its file is the script, its place begins with
/// "commands[k]" (nothing for commands that scripts begin with, without k), then the CAD file where
/// it is about an entity of that.
[[nodiscard]] Error error_at_command(Error error, const Document& document,
                                     const std::string& script, std::optional<std::size_t> k);

}  // namespace knead
