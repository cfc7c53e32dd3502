#include "part21_lexer.hpp"

namespace knead {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_'; }
bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace

bool Part21Lexer::skip_separators() {
  for (;;) {
    const char c = at(position_);
    if (is_space(c)) {
      ++position_;
    } else if (c == '/' && at(position_ + 1) == '*') {
      const auto close = bytes_.find("*/", position_ + 2);
      if (close == std::string_view::npos) return false;
      position_ = static_cast<std::uint32_t>(close + 2);
    } else if (c == '\\' && (at(position_ + 1) == 'N' || at(position_ + 1) == 'F') &&
               at(position_ + 2) == '\\') {
      position_ += 3;  // print control directive (ISO 10303-21, 6.6)
    } else {
      return true;
    }
  }
}

Part21Token Part21Lexer::token(Part21Token::Kind kind, std::uint32_t end) {
  const Part21Token result{kind, position_, end};
  position_ = end;
  return result;
}

Part21Token Part21Lexer::bad(const char* problem) const {
  return {Part21Token::Kind::bad, position_, position_, problem};
}

Part21Token Part21Lexer::next() {
  if (!skip_separators()) return bad("a comment is not closed");
  if (position_ >= bytes_.size()) return token(Part21Token::Kind::end, position_);
  const char c = at(position_);
  switch (c) {
    case '(':
    case ')':
    case ',':
    case ';':
    case '=':
    case '/':
    case '$':
    case '*':
    case '{':
    case '}':
    case ':':
      return token(Part21Token::Kind::symbol, position_ + 1);
    case '\'':
      return string();
    case '"':
      return delimited(Part21Token::Kind::binary, '"', "a binary is not closed");
    case '<':
      return delimited(Part21Token::Kind::other, '>', "a resource is not closed");
    case '#':
    case '@':
      return instance_name();
    case '.':
      if (is_digit(at(position_ + 1))) return number();
      return delimited(Part21Token::Kind::enumeration, '.', "an enumeration is not closed");
    case '+':
    case '-':
      return number();
    default:
      break;
  }
  if (is_digit(c)) return number();
  if (is_letter(c) || c == '!' || c == '&') return keyword();
  return bad("a character that has no place here");
}

Part21Token Part21Lexer::number() {
  std::uint32_t k = position_;
  if (at(k) == '+' || at(k) == '-') ++k;
  const std::uint32_t digits = k;
  while (is_digit(at(k))) ++k;
  std::uint32_t count = k - digits;
  bool real = false;
  if (at(k) == '.') {
    real = true;
    const std::uint32_t fraction = ++k;
    while (is_digit(at(k))) ++k;
    count += k - fraction;
  }
  if (count == 0) return bad("a number without digits");
  if (at(k) == 'E' || at(k) == 'e' || at(k) == 'D' || at(k) == 'd') {
    real = true;
    ++k;
    if (at(k) == '+' || at(k) == '-') ++k;
    if (!is_digit(at(k))) return bad("a number without digits in its exponent");
    while (is_digit(at(k))) ++k;
  }
  if (is_letter(at(k)) || at(k) == '.') return bad("a number runs into something else");
  return token(real ? Part21Token::Kind::real : Part21Token::Kind::integer, k);
}

Part21Token Part21Lexer::string() {
  for (auto k = position_ + 1;;) {
    const auto quote = bytes_.find('\'', k);
    if (quote == std::string_view::npos) return bad("a string is not closed");
    if (at(static_cast<std::uint32_t>(quote) + 1) != '\'') {
      return token(Part21Token::Kind::string, static_cast<std::uint32_t>(quote) + 1);
    }
    k = static_cast<std::uint32_t>(quote) + 2;
  }
}

std::uint32_t Part21Lexer::end_of_keyword(std::uint32_t begin) const {
  auto k = begin;
  if (at(k) == '!' || at(k) == '&') ++k;
  // Hyphens occur only in ISO-10303-21 and END-ISO-10303-21.
  while (is_letter(at(k)) || is_digit(at(k)) || at(k) == '-') ++k;
  return k;
}

Part21Token Part21Lexer::keyword() {
  const bool marked = at(position_) == '!' || at(position_) == '&';
  if (!is_letter(at(position_ + (marked ? 1 : 0)))) return bad("a keyword without letters");
  return token(Part21Token::Kind::keyword, end_of_keyword(position_));
}

Part21Token Part21Lexer::instance_name() {
  std::uint32_t k = position_ + 1;
  if (is_digit(at(k))) {
    while (is_digit(at(k))) ++k;
    if (is_letter(at(k))) return bad("an instance name runs into something else");
    return token(at(position_) == '#' ? Part21Token::Kind::name : Part21Token::Kind::other, k);
  }
  if (!is_letter(at(k))) return bad("an instance name without a number");
  while (is_letter(at(k)) || is_digit(at(k))) ++k;
  return token(Part21Token::Kind::other, k);
}

Part21Token Part21Lexer::delimited(Part21Token::Kind kind, char last, const char* problem) {
  std::uint32_t k = position_ + 1;
  // None of these may continue past the end of a line, except a binary, which is wrapped like a
  // string.
  while (k < bytes_.size() && at(k) != last &&
         (kind == Part21Token::Kind::binary || !is_space(at(k))))
    ++k;
  if (at(k) != last || k >= bytes_.size()) return bad(problem);
  return token(kind, k + 1);
}

}  // namespace knead
