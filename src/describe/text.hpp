#pragma once

#include "record_json.hpp"

namespace knead {

// Descriptions as text, for people and for other programs.

/// A default for people: with the fewest digits; empty if there is none to show (optionals, empty
/// lists).
[[nodiscard]] std::string shown_default(const Field& field, const Type& record);

/// The names of a record's fields with their defaults, in lines of at most 110 characters, indented
/// by 14.
[[nodiscard]] std::string brief_help(const Type& record);

/// A line for each field: name, meaning, default.
[[nodiscard]] std::string full_help(const Type& record);

/// A table in Markdown: field, default, meaning.
[[nodiscard]] std::string markdown_table(const Type& record);

/// A JSON schema (draft 2020-12) of a value's JSON form, without "$schema"; records forbid unknown
/// members. Members without a value may be omitted, or are null.
[[nodiscard]] std::string schema_of(const Type& type, Absent absent = Absent::left_out);

/// Collects TypeScript declarations, each type once, after the types it uses.
class TypeScript {
 public:
  std::string text;

  /// A record as `name`, or a variant as the union `name` of its records, which keep their names
  /// plus `suffix` ("step" is StepCommand); records inside keep their names ("step info" is
  /// StepInfo). Members that may be omitted are optional, or with Absent::null null; then all but
  /// std::optional members are always present.
  void declare(const Type& type, const std::string& name, const std::string& suffix,
               Absent absent = Absent::left_out);

  /// The contents of a variant's records, as the constant `name`: per record its help and its
  /// numbers, with units and default values.
  void list(const Type& variant, const std::string& name);

  /// The type of a value, after the declarations that it needs. An opaque one is called by its
  /// name.
  std::string written(const Type& type, const std::string& suffix, Absent absent,
                      std::span<const Choice> named = {});

 private:
  void record(const Type& type, const std::string& name, std::string_view tag,
              const std::string& suffix, Absent absent);
  std::string member(const Type& owner, const Field& field, bool always_there,
                     const std::string& suffix, Absent absent);
  std::string member_of_any(const Type& variant, std::string_view name);
  std::vector<std::pair<const Type*, std::string>> names_;
};

}  // namespace knead
