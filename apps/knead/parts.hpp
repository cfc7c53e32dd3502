#pragma once

#include <nlohmann/json.hpp>
#include <span>

#include "knead/exchange/file_info.hpp"
#include "knead/session/report.hpp"

namespace knead::cli {

/// The parts of an assembly and where they stand; nothing for a file whose coordinates are the model's.
void print_parts(const FileInfo& info);

/// A line for each.
void print_places(std::span<const RepeatedSurface> surfaces);

/// [{"surface", "part", "places"}].
[[nodiscard]] nlohmann::ordered_json places_json(std::span<const RepeatedSurface> surfaces);

}  // namespace knead::cli
