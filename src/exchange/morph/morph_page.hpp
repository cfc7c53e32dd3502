#pragma once

#include <string>

#include "knead/exchange/morph.hpp"

namespace knead::detail {

/// `morph_page` of a report. \param illustrated with links to the pictures of `illustrated_page`
[[nodiscard]] std::string page_text(const MorphReport& report, bool illustrated);

/// Two histograms side by side, before and after, each over its own range, with the tolerance.
[[nodiscard]] std::string histogram_drawing(const MorphReport& report);

/// The colours of a picture from −limit to limit, with numbers.
[[nodiscard]] std::string scale_drawing(double limit, const std::string& unit);

/// Red, green and blue of a value from −1 to 1, and what lies beyond: blue over white to red.
[[nodiscard]] std::array<double, 3> colour_of(double value);

}  // namespace knead::detail
