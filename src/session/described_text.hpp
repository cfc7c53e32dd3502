#pragma once

#include "described_json.hpp"

namespace knead {

// What a description says, for people and for other programs.

/// A default for people: as few digits as it takes; empty where there is none to show (optionals, empty lists).
[[nodiscard]] std::string shown_default(const Field& field, const Type& record);

/// The names of a record's fields with their defaults, in lines of at most 110 characters, indented by 14.
[[nodiscard]] std::string brief_help(const Type& record);

/// A line for each field: name, meaning, default.
[[nodiscard]] std::string full_help(const Type& record);

/// A table in Markdown: field, default, meaning.
[[nodiscard]] std::string markdown_table(const Type& record);

/// A JSON schema (draft 2020-12) of a value's JSON form, without "$schema"; records forbid unknown members. Members
/// without a value may be left out, or are null.
[[nodiscard]] std::string schema_of(const Type& type, Absent absent = Absent::left_out);

/// The TypeScript declarations of a record or of a variant's records and their union, and of the records in them.
/// "step record" is called StepRecord; the records of a variant get `suffix`. Each is written once per `written`.
[[nodiscard]] std::string typescript(const Type& type, Absent absent, const std::string& name,
                                     const std::string& suffix, std::vector<const Type*>& written);

}  // namespace knead
