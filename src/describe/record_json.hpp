#pragma once

#include "describe.hpp"
#include "json.hpp"

namespace knead {

/// Reads an object's members into the fields of a record; missing fields keep their values. Members
/// named `tag`, which gave the type, are skipped. Errors (input) name the field, with its path: an
/// unknown one, with the known ones listed; one of the wrong type, of a number out of its range, or
/// of a text that is not among its choices; a required one that is missing; one that another leaves
/// no meaning (`OnlyWith`).
[[nodiscard]] Expected<void> read_record(const Json& json, const Type& type, void* record,
                                         std::string_view tag = {});

/// Reads an object into a variant: its tag says which. Errors: as above; for an unknown name the
/// known ones are listed, called `what` ("shape": "the shapes are: …").
[[nodiscard]] Expected<void> read_variant(const Json& json, const Type& type, void* variant,
                                          std::string_view what);

/// A text in the place of a field's value, which stands for another field of the same record: "at":
/// "middle" for "middle": true, "which": "#456" for "edge": "#456".
struct TextForm {
  std::string_view field, stands_for, text;
  bool begins = false;  ///< the text begins so, and is the value of the other field; else the other
                        ///< one is a flag
};
inline constexpr TextForm text_forms[] = {{"at", "middle", "middle"}, {"which", "edge", "#", true}};
/// That of a field; null if there is none.
[[nodiscard]] const TextForm* text_form(const Type& record, const Field& field);

/// Whole numbers are from minus to plus this.
inline constexpr double largest_integer = 2e9;

/// How a field without a value is written; variants always omit it, as commands do.
enum class Absent { left_out, null };

/// The JSON form of a value. Records are objects with their fields in order, variants have their
/// tag first; opaque parts are left out.
[[nodiscard]] std::string to_json(const Type& type, const void* value,
                                  Absent absent = Absent::left_out,
                                  JsonNumber number = json_number);

/// Names separated by commas.
[[nodiscard]] std::string joined(const std::vector<std::string_view>& names);
[[nodiscard]] std::vector<std::string_view> names_of(std::span<const Choice> choices);
/// The names of a record's fields, including a flat variant's tag and the fields of all its
/// alternatives, each once.
[[nodiscard]] std::vector<std::string_view> field_names(const Type& type);
[[nodiscard]] std::vector<std::string_view> variant_names(const Type& type);

}  // namespace knead
