#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace knead {

/// Keywords are upper case by the standard; some writers use lower case.
[[nodiscard]] bool same_keyword(std::string_view a, std::string_view b);

/// An order in which keywords that differ in case alone are equal.
struct KeywordOrder {
  [[nodiscard]] bool operator()(std::string_view a, std::string_view b) const;
};

/// "#12" or "#0012" to 12; none above 2^63 − 1.
[[nodiscard]] std::optional<std::uint64_t> parse_instance_name(std::string_view text);

/// The double nearest to an integer or real of an exchange structure ("1.", "-.5", "+1.E+02",
/// "1.D0"), ties to even, whatever the number of digits; too small becomes a zero of its sign. None
/// if it is too large for a double.
[[nodiscard]] std::optional<double> parse_real(std::string_view text);

/// A REAL of ISO 10303-21 with 17 significant digits, "-1.2345678901234567E+02": `parse_real` gives
/// back the same bits.
[[nodiscard]] std::string format_real(double value);

/// A REAL with the fewest digits that restore the same bits, "0.5", "1.", "1.E-05",
/// "-1.2345678901234567E+200".
[[nodiscard]] std::string format_shortest_real(double value);

/// A string literal with its quotes for a text in UTF-8: ' and \\ doubled, everything outside
/// ASCII's printable characters as \X2\ or \X4\. What is not UTF-8 becomes U+FFFD. `decode_string`
/// gives the text back.
[[nodiscard]] std::string encode_string(std::string_view text);

/// A string literal with its quotes, decoded to UTF-8 for display: '' and \\, \X\hh, \X2\…\X0\,
/// \X4\…\X0\, \S\c with the alphabets \PA\ to \PI\ (ISO 8859-1 to -9). Line breaks of wrapped
/// literals vanish. Bytes above 127, which the standard forbids, are taken for UTF-8, or for ISO
/// 8859-1 where they are not. What cannot be decoded becomes U+FFFD.
[[nodiscard]] std::string decode_string(std::string_view literal);

}  // namespace knead
