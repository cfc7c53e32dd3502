#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "knead/scene/display_range.hpp"

namespace knead::studio {

/// [{"name", "title", "unit", "signed", "palette", "help", "limits" (null without), "share", "compares", "settings":
/// [{"name", "title", "unit", "value", "help"}, …]}, …]: the data of menus and legends.
[[nodiscard]] std::string displays_json();

/// {"lower": …, "upper": …, "least": …, "greatest": …}, or null.
[[nodiscard]] std::string range_json(const std::optional<DisplayRange>& range);

/// A display and its settings as requested by the page.
struct AskedDisplay {
  const Display* display = nullptr;  ///< null: none
  std::vector<std::vector<double>> settings;
};

/// Reads {"display": "draft", "settings": {"direction": [0, 0, 1]}}; an empty text, or "none", means none. Errors
/// (usage): no such display or setting (`display_settings`), invalid JSON.
[[nodiscard]] Expected<AskedDisplay> read_display(std::string_view text);

}  // namespace knead::studio
