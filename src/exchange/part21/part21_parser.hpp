#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "part21.hpp"
#include "part21_lexer.hpp"
#include "part21_text.hpp"

namespace knead {

/// Recursive descent over the grammar of ISO 10303-21, annex A, filling a `Part21File`.
///
/// Functions return false after `fail` has stored the first error.
class Part21Parser {
 public:
  /// \param names_only entities are forgotten once they have been read, except for their names;
  /// their references are not followed
  explicit Part21Parser(Part21File& file, bool names_only = false)
      : file_(file), lexer_(file.bytes_), names_only_(names_only) {}

  [[nodiscard]] Expected<void> parse();

 private:
  using Kind = Part21Token::Kind;

  bool file_structure();
  bool header_section();
  bool data_section();
  bool anchor_section();
  bool reference_section();
  bool signature_section();
  bool after_the_end();

  bool instance(std::uint32_t scope);
  bool scope(std::uint32_t owner);
  bool export_list();
  bool record(std::uint32_t owner);
  bool typed(int depth);
  bool parameter(int depth);
  bool parameter_list(int depth);
  bool define(const Part21Token& name, std::uint32_t index);
  bool sort_names();
  bool resolve();
  bool resolve_range(std::uint32_t first, std::uint32_t last, std::uint32_t owner);

  void advance() { token_ = lexer_.next(); }
  [[nodiscard]] std::string_view text() const { return file_.text({token_.begin, token_.end}); }
  [[nodiscard]] bool at_symbol(char c) const {
    return token_.kind == Kind::symbol && file_.bytes_[token_.begin] == c;
  }
  [[nodiscard]] bool at_keyword(std::string_view keyword) const;
  bool expect_symbol(char c, const char* after);
  bool expect_keyword(std::string_view keyword, const char* remedy);

  bool fail(std::string what, std::string remedy = {}) {
    return fail_at(token_.begin, std::move(what), std::move(remedy));
  }
  bool fail_at(std::uint32_t byte, std::string what, std::string remedy = {});
  // "found X" for the present token.
  bool fail_expected(const std::string& expected);
  [[nodiscard]] std::string place() const;

  std::uint32_t push(Part21Kind kind, ByteRange bytes);
  void close(std::uint32_t value);
  // The present token names a part of the record being read.
  void note_part();
  void sort_parts();

  Part21File& file_;
  Part21Lexer lexer_;
  bool names_only_ = false;
  Part21Token token_;
  std::string section_ = "exchange structure";
  std::uint32_t closed_ = 0;             // behind the last typed parameter or part
  std::uint32_t current_ = no_instance;  // instance being read, for errors
  // The names of parts: a number for each, those met lately, and the parts with their instances.
  std::map<std::string_view, std::uint32_t, KeywordOrder> keyword_numbers_;
  std::array<std::pair<std::string_view, std::uint32_t>, 256> recent_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> parts_;
  std::vector<ByteRange> anchors_;  // ranges of values that belong to no instance
  Error error_;
  bool failed_ = false;
};

}  // namespace knead
