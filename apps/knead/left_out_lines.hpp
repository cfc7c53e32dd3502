#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "knead/exchange/left_out.hpp"

namespace knead::cli {

/// A block of lines on standard output; nothing if nothing is left out.
void print_left_out(const std::vector<LeftOut>& list);
/// A warning each on standard error.
void warn_left_out(const std::vector<LeftOut>& list);
/// [{"what": "points", "count": 2, "reason": "…", "remedy": null, "ids": ["#7", "#9"]}, …]
[[nodiscard]] nlohmann::ordered_json left_out_json(const std::vector<LeftOut>& list);

}  // namespace knead::cli
