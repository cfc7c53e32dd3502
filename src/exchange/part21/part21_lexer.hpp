#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "knead/base/error.hpp"

namespace knead {

/// A token of an exchange structure (ISO 10303-21, 6.3 and 6.4), with its bytes.
struct Part21Token {
  enum class Kind : std::uint8_t {
    end,      // of the file
    keyword,  // NAME, !NAME, ISO-10303-21, &SCOPE
    integer,
    real,
    string,
    binary,
    enumeration,
    name,    // #12
    other,   // @12, #NAME, @NAME, <resource>
    symbol,  // one of ( ) , ; = / $ * { } :
    bad,     // not in the grammar: `problem` says why
  };
  Kind kind = Kind::end;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  const char* problem = nullptr;
};

/// Splits the bytes into tokens, one at a time. A bad token is returned repeatedly.
class Part21Lexer {
 public:
  explicit Part21Lexer(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] Part21Token next();
  [[nodiscard]] std::uint32_t position() const { return position_; }
  /// Behind the keyword that begins here.
  [[nodiscard]] std::uint32_t end_of_keyword(std::uint32_t begin) const;
  void set_position(std::uint32_t position) { position_ = position; }

 private:
  [[nodiscard]] char at(std::uint32_t k) const { return k < bytes_.size() ? bytes_[k] : '\0'; }
  // Past white space, comments and print control directives; false at an unterminated comment.
  [[nodiscard]] bool skip_separators();
  [[nodiscard]] Part21Token token(Part21Token::Kind kind, std::uint32_t end);
  [[nodiscard]] Part21Token bad(const char* problem) const;
  [[nodiscard]] Part21Token number();
  [[nodiscard]] Part21Token string();
  [[nodiscard]] Part21Token keyword();
  [[nodiscard]] Part21Token instance_name();
  [[nodiscard]] Part21Token delimited(Part21Token::Kind kind, char last, const char* problem);

  std::string_view bytes_;
  std::uint32_t position_ = 0;
};

}  // namespace knead
