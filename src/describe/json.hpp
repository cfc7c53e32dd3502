#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "knead/base/error.hpp"

namespace knead {

/// A JSON value as written. (Only json.cpp sees the parser's library.)
struct Json {
  enum class Kind { null, boolean, number, text, list, object };
  Kind kind = Kind::null;
  bool boolean = false;
  double number = 0;
  std::string text = {};
  std::vector<Json> list = {};
  std::vector<std::pair<std::string, Json>> members = {};  ///< each name once

  [[nodiscard]] bool is(Kind other) const { return kind == other; }
  /// The member of that name; null if there is none.
  [[nodiscard]] const Json* find(std::string_view name) const;
};

/// Lists and objects inside each other; commands need six. Far beyond use, it keeps what a few
/// bytes can ask for within the stack.
inline constexpr std::size_t max_json_depth = 64;

/// Errors: what is not JSON, with its line; a name given twice in an object; more than
/// `max_json_depth` levels.
[[nodiscard]] Expected<Json> parse_json(std::string_view text);

/// For messages: the value on one line, numbers with the fewest digits, shortened to 120 bytes.
[[nodiscard]] std::string shown(const Json& json);

/// Text in quotes with escapes; what is not UTF-8 becomes U+FFFD.
[[nodiscard]] std::string json_text(std::string_view text);

/// 17 significant digits, which read back to the same bits; null if not finite.
[[nodiscard]] std::string json_number(double value);
/// The fewest digits that read back to the same bits, with a point: "1.0"; null if not finite.
[[nodiscard]] std::string shortest_json_number(double value);
using JsonNumber = std::string (*)(double);

/// The same value over several lines, indented by one blank a level.
[[nodiscard]] std::string indented_json(std::string_view json);

}  // namespace knead
