#pragma once

#include <string>

namespace knead::figures {

/// How a printed number was shortened to its digits.
enum class Cut { rounded, truncated };

/// Whether the printed number is the exact one rounded (or truncated) to the digits that are
/// printed. `slack`, relative to the exact number, is the error it may have had before rounding.
[[nodiscard]] bool is_right(const std::string& printed, long double exact, Cut cut = Cut::rounded,
                            double slack = 0);

/// The printed number with the digits that differ from the exact one in bold (Markdown); unchanged
/// if it is right, empty if nothing is printed.
[[nodiscard]] std::string marked(const std::string& printed, long double exact,
                                 Cut cut = Cut::rounded, double slack = 0);

/// The error not marked in our own columns: two ulp, by which a double may fall on the other side
/// of a rounding boundary.
inline constexpr double two_ulp = 4.5e-16;

/// `value` in the form of `pattern`, a printed number: as many decimals, and an exponent where the
/// pattern has one.
[[nodiscard]] std::string printed_like(const std::string& pattern, double value);

}  // namespace knead::figures
