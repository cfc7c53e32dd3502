#pragma once

#include <string>
#include <string_view>

#include "knead/base/error.hpp"

namespace knead::cli {

/// Whether these are the bytes of a document that the studio saves (docs/knead-document.md); a
/// script alone is none.
[[nodiscard]] bool is_knead_document(std::string_view bytes);

/// Prints what is in a Knead document: the file that it begins with, its commands, views, and
/// whether it has a snapshot. Errors (input): it is damaged, which the studio would say too.
[[nodiscard]] Expected<void> show_knead_document(std::string_view bytes, const std::string& name,
                                                 bool as_json);

}  // namespace knead::cli
