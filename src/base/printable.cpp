#include "knead/base/printable.hpp"

#include <algorithm>
#include <cassert>

namespace knead {
namespace {

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// Bytes of the UTF-8 character at the start of the text; 0 if there is none, or it controls the
/// terminal.
std::size_t length_of_character(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  if (lead < 0x20 || lead == 0x7F) return 0;
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 && lead < 0xF5 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead >= 0xF5 || text.size() < length) return 0;
  if (!std::ranges::all_of(text.substr(1, length - 1), continues)) return 0;
  const auto second = static_cast<unsigned char>(text[1]);
  if (lead == 0xC2 && second < 0xA0) return 0;  // C1
  if ((lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90))
    return 0;  // longer than needed
  if ((lead == 0xED && second >= 0xA0) || (lead == 0xF4 && second >= 0x90))
    return 0;  // not characters
  return length;
}

std::string escaped(std::string_view text) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string result;
  while (!text.empty()) {
    const std::size_t length = length_of_character(text);
    if (length > 0) {
      result += text.substr(0, length);
      text.remove_prefix(length);
      continue;
    }
    const auto byte = static_cast<unsigned char>(text[0]);
    if (byte == '\n' || byte == '\t' || byte == '\r') {
      result += byte == '\n' ? "\\n" : byte == '\t' ? "\\t" : "\\r";
    } else {
      result += {'\\', 'x', digits[byte >> 4U], digits[byte & 15U]};
    }
    text.remove_prefix(1);
  }
  return result;
}

}  // namespace

std::string printable(std::string_view text, std::size_t most) {
  assert(most >= 16);
  constexpr std::string_view dots = "…";
  if (text.size() <= most) return escaped(text);
  std::size_t first = (most - dots.size()) * 3 / 4,
              last = text.size() - (most - dots.size() - first);
  while (first > 0 && continues(text[first])) --first;
  while (last < text.size() && continues(text[last])) ++last;
  return escaped(text.substr(0, first)) + std::string(dots) + escaped(text.substr(last));
}

std::string xml_text(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return result;
}

}  // namespace knead
