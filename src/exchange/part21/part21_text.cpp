#include "part21_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "base/read_double.hpp"
#include "exchange/iso8859.hpp"

namespace knead {
namespace {

char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  c = upper(c);
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

void append_utf8(std::string& out, char32_t code) {
  if (code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) code = 0xFFFD;
  const auto byte = [&out](char32_t value) {
    out += static_cast<char>(static_cast<unsigned char>(value));
  };
  if (code < 0x80) {
    byte(code);
  } else if (code < 0x800) {
    byte(0xC0 | (code >> 6));
    byte(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    byte(0xE0 | (code >> 12));
    byte(0x80 | ((code >> 6) & 0x3F));
    byte(0x80 | (code & 0x3F));
  } else {
    byte(0xF0 | (code >> 18));
    byte(0x80 | ((code >> 12) & 0x3F));
    byte(0x80 | ((code >> 6) & 0x3F));
    byte(0x80 | (code & 0x3F));
  }
}

// Length of the well-formed UTF-8 sequence at k, 0 if there is none (Unicode Standard, table 3-7).
std::size_t utf8_length(std::string_view text, std::size_t k) {
  const auto at = [text](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const auto lead = at(k);
  const std::size_t length = lead < 0x80   ? 1
                             : lead < 0xC2 ? 0
                             : lead < 0xE0 ? 2
                             : lead < 0xF0 ? 3
                             : lead < 0xF5 ? 4
                                           : 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((at(k + i) & 0xC0) != 0x80) return 0;
  }
  const auto second = at(k + 1);
  if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F) ||
      (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F)) {
    return 0;
  }
  return length;
}

// The power of ten just above a non-zero unsigned number, precise enough to tell a number too large
// for a double from one too small.
std::int64_t decimal_magnitude(std::string_view text) {
  const auto mark = std::min(text.find_first_of("eE"), text.size());
  const auto mantissa = text.substr(0, mark);
  const auto point = static_cast<std::int64_t>(std::min(mantissa.find('.'), mantissa.size()));
  const auto lead = static_cast<std::int64_t>(mantissa.find_first_of("123456789"));
  std::int64_t exponent = 0;
  if (mark < text.size()) {
    auto digits = text.substr(mark + 1);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    if (std::from_chars(digits.data(), digits.data() + digits.size(), exponent).ec != std::errc()) {
      return digits.starts_with('-') ? -1 : 1;
    }
    exponent = std::clamp(exponent, std::int64_t{-1} << 40, std::int64_t{1} << 40);
  }
  return exponent + point - lead;
}

// Decodes one string literal to UTF-8.
// The directives of ISO 10303-21: \X\hh is one character of ISO 8859-1, \X2\…\X0\ characters of
// four digits each, \X4\…\X0\ of eight, \S\c is the character c + 128 of the alphabet that \PA\ to
// \PI\ choose (ISO 8859-1 to 8859-9), '' and \\ are the characters themselves. Bytes above 127 are
// UTF-8 in edition 3 and were not allowed before, where writers put ISO 8859-1 all the same: a
// string that is well-formed UTF-8 as a whole is hardly ever anything else, and any other string is
// taken for ISO 8859-1. Faults are never errors: names do not matter to the shape.
class Decoder {
 public:
  explicit Decoder(std::string_view text) : text_(text) {
    for (std::size_t k = 0; k < text.size() && utf8_;) {
      const auto length = utf8_length(text, k);
      utf8_ = length > 0;
      k += length;
    }
  }

  std::string decode() {
    while (k_ < text_.size()) step();
    return std::move(out_);
  }

 private:
  void step() {
    const char c = text_[k_];
    if (c == '\r' || c == '\n') {
      ++k_;
    } else if (c == '\'') {
      out_ += c;
      k_ += text_.substr(k_).starts_with("''") ? 2 : 1;
    } else if (c == '\\') {
      directive();
    } else {
      if (utf8_ || static_cast<unsigned char>(c) < 0x80) {
        out_ += c;
      } else {
        append_utf8(out_, static_cast<unsigned char>(c));
      }
      ++k_;
    }
  }

  void directive() {
    const auto rest = text_.substr(k_);
    if (rest.starts_with("\\\\")) {
      out_ += '\\';
      k_ += 2;
    } else if (rest.starts_with("\\X2\\")) {
      extended(4);
    } else if (rest.starts_with("\\X4\\")) {
      extended(8);
    } else if (rest.starts_with("\\X\\") && rest.size() >= 5 && hex_digit(rest[3]) >= 0 &&
               hex_digit(rest[4]) >= 0) {
      append_utf8(out_, static_cast<char32_t>(16 * hex_digit(rest[3]) + hex_digit(rest[4])));
      k_ += 5;
    } else if (rest.starts_with("\\S\\") && rest.size() >= 4) {
      shifted(rest[3]);
      k_ += 4;
    } else if (rest.size() >= 4 && rest[1] == 'P' && rest[2] >= 'A' && rest[2] <= 'I' &&
               rest[3] == '\\') {
      alphabet_ = static_cast<std::size_t>(rest[2] - 'A');
      k_ += 4;
    } else if (rest.starts_with("\\N\\") || rest.starts_with("\\F\\")) {
      k_ += 3;
    } else {
      out_ += '\\';  // not a directive: an unescaped path
      ++k_;
    }
  }

  void shifted(char c) {
    const auto code = (static_cast<unsigned char>(c) & 0x7FU) + 0x80U;
    if (alphabet_ == 0 || code < 0xA0) return append_utf8(out_, code);
    const auto unicode = iso8859[alphabet_ - 1][code - 0xA0];
    append_utf8(out_, unicode == 0 ? 0xFFFD : unicode);
  }

  // \X2\hhhhhhhh…\X0\: 4 (UTF-16, surrogate pairs as writers use them) or 8 digits per character.
  void extended(std::size_t digits) {
    k_ += 4;
    char32_t high = 0;
    for (;;) {
      while (k_ < text_.size() && (text_[k_] == '\r' || text_[k_] == '\n')) ++k_;
      char32_t code = 0;
      std::size_t n = 0;
      for (; n < digits && k_ + n < text_.size() && hex_digit(text_[k_ + n]) >= 0; ++n) {
        code = 16 * code + static_cast<char32_t>(hex_digit(text_[k_ + n]));
      }
      k_ += n;
      if (n < digits) break;
      if (high != 0 && code >= 0xDC00 && code < 0xE000) {
        append_utf8(out_, 0x10000 + ((high - 0xD800) << 10) + (code - 0xDC00));
        high = 0;
        continue;
      }
      if (high != 0) append_utf8(out_, 0xFFFD);
      high = digits == 4 && code >= 0xD800 && code < 0xDC00 ? code : 0;
      if (high == 0) append_utf8(out_, code);
    }
    if (high != 0) append_utf8(out_, 0xFFFD);
    if (text_.substr(k_).starts_with("\\X0\\")) k_ += 4;
  }

  std::string_view text_;
  std::size_t k_ = 0;
  std::size_t alphabet_ = 0;
  bool utf8_ = true;
  std::string out_;
};

}  // namespace

bool same_keyword(std::string_view a, std::string_view b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(),
                                            [](char x, char y) { return upper(x) == upper(y); });
}

bool KeywordOrder::operator()(std::string_view a, std::string_view b) const {
  return std::ranges::lexicographical_compare(a, b,
                                              [](char x, char y) { return upper(x) < upper(y); });
}

std::optional<std::uint64_t> parse_instance_name(std::string_view text) {
  std::uint64_t id = 0;
  const auto digits = text.substr(1);
  const auto [last, error] = std::from_chars(digits.data(), digits.data() + digits.size(), id);
  if (error != std::errc() || last != digits.data() + digits.size() ||
      id > std::numeric_limits<std::int64_t>::max())
    return std::nullopt;
  return id;
}

// Fortran writers put D for E. Too small a number is zero; too large a number is none.
std::optional<double> parse_real(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  std::string copy;
  if (text.find_first_of("dD") != std::string_view::npos) {
    copy = text;
    std::replace_if(
        copy.begin(), copy.end(), [](char c) { return c == 'd' || c == 'D'; }, 'E');
    text = copy;
  }
  double value = 0;
  const auto [last, error] = read_double(text.data(), text.data() + text.size(), value);
  if (last != text.data() + text.size() || error == std::errc::invalid_argument)
    return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    if (decimal_magnitude(text) > 0) return std::nullopt;
    value = 0;
  }
  return negative ? -value : value;
}

// 17 significant digits: reading gives the same double again.
std::string format_real(double value) {
  std::string text = fmt::format("{:.16e}", value);
  std::replace(text.begin(), text.end(), 'e', 'E');
  return text;
}

// As std::to_chars does: fixed notation, or scientific if shorter. Its tables alone would be an
// eighth of the studio module's download size.
std::string format_shortest_real(double value) {
  if (!std::isfinite(value)) return fmt::format("{}", value);
  const std::string shortest = fmt::format("{}", std::abs(value)),
                    sign = std::signbit(value) ? "-" : "";
  const std::size_t marker = std::min(shortest.find('e'), shortest.size());
  int exponent = marker < shortest.size() ? std::atoi(shortest.c_str() + marker + 1) : 0;
  std::string digits = shortest.substr(0, marker);
  const std::size_t point = std::min(digits.find('.'), digits.size());
  exponent += static_cast<int>(point) - 1;  // of the first digit
  if (point < digits.size()) digits.erase(point, 1);
  const std::size_t zeros = std::min(digits.find_first_not_of('0'), digits.size());
  digits.erase(0, zeros);
  exponent -= static_cast<int>(zeros);
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.empty()) return sign + "0.";

  const auto count = static_cast<int>(digits.size());
  const std::string scientific = fmt::format("{}.{}E{:+03}", digits[0], digits.substr(1), exponent);
  // Without a bare point.
  const int scientific_length = static_cast<int>(scientific.size()) - (count == 1 ? 1 : 0);
  const int fixed_length = exponent < 0           ? count - exponent + 1
                           : exponent + 1 < count ? count + 1
                                                  : exponent + 1;
  if (scientific_length < fixed_length) return sign + scientific;
  if (exponent < 0)
    return sign + "0." + std::string(static_cast<std::size_t>(-exponent - 1), '0') + digits;
  if (exponent + 1 > count)
    return sign + fmt::format("{:.0f}.", std::abs(value));  // all digits of the integer
  return sign + digits.insert(static_cast<std::size_t>(exponent) + 1, ".");
}

std::string encode_string(std::string_view text) {
  std::string out = "'";
  const auto hex = [&out](char32_t code, int digits) {
    for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4)
      out += "0123456789ABCDEF"[(code >> shift) & 0xF];
  };
  for (std::size_t k = 0; k < text.size();) {
    const auto byte = static_cast<unsigned char>(text[k]);
    const auto length = utf8_length(text, k);
    if (length == 1 && byte >= 0x20 && byte != 0x7F) {
      if (byte == '\'' || byte == '\\') out += text[k];
      out += text[k++];
      continue;
    }
    char32_t code = length == 0 ? 0xFFFD : length == 1 ? byte : byte & (0xFFU >> (length + 1));
    for (std::size_t i = 1; i < length; ++i)
      code = (code << 6) | (static_cast<unsigned char>(text[k + i]) & 0x3FU);
    out += code < 0x10000 ? "\\X2\\" : "\\X4\\";
    hex(code, code < 0x10000 ? 4 : 8);
    out += "\\X0\\";
    k += std::max<std::size_t>(length, 1);
  }
  return out + "'";
}

std::string decode_string(std::string_view literal) {
  if (literal.size() >= 2 && literal.front() == '\'' && literal.back() == '\'') {
    literal = literal.substr(1, literal.size() - 2);
  }
  return Decoder(literal).decode();
}

}  // namespace knead
