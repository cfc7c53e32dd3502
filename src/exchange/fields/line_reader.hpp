#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "knead/base/error.hpp"

namespace knead::fields {

/// An input error of a data file, at a line (1-based; 0: none).
[[nodiscard]] std::unexpected<Error> data_error(std::string_view file, int line, std::string what,
                                                std::string remedy = {});

/// The lines of a text, each without its end ("\n", "\r\n").
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}

  /// Whether there is another line, which is `line()` then.
  [[nodiscard]] bool next();
  [[nodiscard]] std::string_view line() const { return line_; }
  /// Its number, from 1.
  [[nodiscard]] int number() const { return number_; }
  /// The byte after it and its end.
  [[nodiscard]] std::size_t end() const { return at_; }

 private:
  std::string_view text_, line_;
  std::size_t at_ = 0;
  int number_ = 0;
};

/// Without white space at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// In lower case (ASCII).
[[nodiscard]] std::string lower_case(std::string_view text);

/// The words of a line, separated by white space and any of `separators`.
[[nodiscard]] std::vector<std::string_view> words_of(std::string_view line,
                                                     std::string_view separators = {});

/// Whether a text is a number as a whole, NaN and infinities included; `value` is it then.
[[nodiscard]] bool is_number(std::string_view text, double& value);

/// A finite number. Errors (input): it is none, NaN, or an infinity.
[[nodiscard]] Expected<double> finite_number(std::string_view text, std::string_view file,
                                             int line);

/// A count from 0 to `most`. Errors (input): it is none, or above.
[[nodiscard]] Expected<std::size_t> count_in(std::string_view text, std::size_t most,
                                             std::string_view what, std::string_view file,
                                             int line);

}  // namespace knead::fields
