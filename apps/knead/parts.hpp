#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "knead/brep/model.hpp"
#include "knead/session/session.hpp"

namespace knead::cli {

/// The parts of an assembly and where they stand; nothing for a file whose coordinates are the model's.
void print_parts(const brep::Model& model);

/// {"unit", "parts": [{"name", "unit", "surfaces", "faces", "places": [{"path", "matrix"}]}], "warnings"}; or the error
/// under "reason".
[[nodiscard]] nlohmann::ordered_json parts_json(const brep::Model& model);

/// A changed surface whose part is used several times: the change shows in all its places.
struct RepeatedSurface {
  std::string surface, part;
  std::size_t places = 0;
};
[[nodiscard]] std::vector<RepeatedSurface> repeated_surfaces(const Session& session);

/// A line for each.
void print_places(std::span<const RepeatedSurface> surfaces);

/// [{"surface", "part", "places"}].
[[nodiscard]] nlohmann::ordered_json places_json(std::span<const RepeatedSurface> surfaces);

}  // namespace knead::cli
