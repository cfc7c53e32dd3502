#pragma once

#include <nlohmann/json.hpp>
#include <span>

#include "knead/brep/model.hpp"
#include "knead/session/report.hpp"

namespace knead::cli {

/// The parts of an assembly and where they stand; nothing for a file whose coordinates are the model's.
void print_parts(const brep::Model& model);

/// {"unit", "parts": [{"name", "unit", "surfaces", "faces", "places": [{"path", "matrix"}]}], "warnings"}; or the error
/// under "reason".
[[nodiscard]] nlohmann::ordered_json parts_json(const brep::Model& model);

/// A line for each.
void print_places(std::span<const RepeatedSurface> surfaces);

/// [{"surface", "part", "places"}].
[[nodiscard]] nlohmann::ordered_json places_json(std::span<const RepeatedSurface> surfaces);

}  // namespace knead::cli
