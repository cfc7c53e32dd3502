#pragma once

#include <string>

namespace knead::figures {

/// How a printed number was cut to its digits.
enum class Cut { rounded, truncated };

/// Whether the printed number is the exact one rounded (or truncated) to the digits that are printed.
[[nodiscard]] bool is_right(const std::string& printed, long double exact, Cut cut = Cut::rounded);

/// The printed number with the digits that are not those of the exact one in bold (Markdown); unchanged where it is
/// right, empty where nothing is printed.
[[nodiscard]] std::string marked(const std::string& printed, long double exact, Cut cut = Cut::rounded);

/// `value` in the form of `pattern`, a printed number: as many decimals, and an exponent where the pattern has one.
[[nodiscard]] std::string printed_like(const std::string& pattern, double value);

}  // namespace knead::figures
