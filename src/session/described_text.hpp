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

/// Collects TypeScript declarations, each type once, those that others need first.
class TypeScript {
 public:
  std::string text;

  /// A record as `name`, or a variant as the union `name` of its records, which are called as they are with `suffix`
  /// ("step" is StepCommand); records inside are called as they are ("step info" is StepInfo). What may be left out is
  /// optional, or with Absent::null null, where what is no std::optional is always there.
  void declare(const Type& type, const std::string& name, const std::string& suffix, Absent absent = Absent::left_out);

  /// What the records of a variant are made of, as the constant `name`: per record its help and its numbers, with unit
  /// and the values that they have by default.
  void list(const Type& variant, const std::string& name);

 private:
  void record(const Type& type, const std::string& name, std::string_view tag, const std::string& suffix,
              Absent absent);
  std::string member(const Field& field, bool always_there, const std::string& suffix, Absent absent);
  std::string member_of_any(const Type& variant, std::string_view name);
  std::string written(const Type& type, const std::string& suffix, Absent absent);
  std::vector<std::pair<const Type*, std::string>> names_;
};

}  // namespace knead
