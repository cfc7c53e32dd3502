#pragma once

#include <optional>
#include <string>

#include "describe/describe.hpp"
#include "knead/exchange/morph.hpp"

namespace knead {

/// How surfaces follow data, as a command and a query are asked.
struct MorphRequest {
  std::string space;  ///< the displacement as three formulas; empty: a file says it
  MorphSettings settings;
  std::optional<std::string> along;  ///< "normal"
  bool strict = false;               ///< what is above what was wanted is an error
};

/// All of its fields but `space`, which comes before those of files.
void describe_following(MorphRequest& request, Fields& fields);

/// `morph_file` of a file by one kind of data. Errors: (usage) not one kind of data; (numerical)
/// something above what was wanted, if `strict`; those of `morph_file`.
[[nodiscard]] Expected<MorphedFile> follow_data(const std::shared_ptr<const Source>& source,
                                                MorphData data, const MorphRequest& request);

}  // namespace knead
