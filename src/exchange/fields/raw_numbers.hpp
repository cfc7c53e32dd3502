#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace knead::fields {

/// The type of a number as bytes hold it.
struct RawNumber {
  enum class Kind { whole, natural, real };
  Kind kind = Kind::real;
  std::size_t bytes = 8;  ///< 1, 2, 4 or 8; of real numbers 4 or 8
};

/// The type of this name, in any case: "float", "Float64", "uchar", "Int32", "vtktypeint64", …;
/// none: there is no such type.
[[nodiscard]] std::optional<RawNumber> raw_number_of(std::string_view name);

/// The number that begins at `bytes`, of which `type.bytes` must be there. Whole numbers beyond
/// 2^53 are rounded.
[[nodiscard]] double read_raw(const char* bytes, const RawNumber& type, bool big_endian);

/// What base64 text stands for (RFC 4648), white space between its characters left out. Padding may
/// end any group of four: texts written one after the other are read as one. None: a character that
/// does not belong there. \param most stops after so many bytes
[[nodiscard]] std::optional<std::string> base64_decoded(std::string_view text, std::size_t most);

}  // namespace knead::fields
