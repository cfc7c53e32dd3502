#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "knead/exchange/step_file.hpp"
#include "knead/session/session.hpp"

namespace knead::cli {

/// The parts of an assembly and where they stand; nothing for a file whose coordinates are the model's.
void print_parts(const step::File& file);

/// {"unit", "parts": [{"name", "unit", "surfaces", "faces", "places": [{"path", "matrix"}]}], "warnings"}; or the error
/// under "reason".
[[nodiscard]] nlohmann::ordered_json parts_json(const step::File& file);

/// A line for every changed surface whose part is used several times: the change shows in all its places.
void print_places(const Session& session);

/// The same as a JSON list: [{"surface", "part", "places"}].
[[nodiscard]] nlohmann::ordered_json places_json(const Session& session);

}  // namespace knead::cli
