#include "line_reader.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/read_double.hpp"
#include "exchange/nets/surface_text.hpp"
#include "knead/base/printable.hpp"

namespace knead::fields {

std::unexpected<Error> data_error(std::string_view file, int line, std::string what,
                                  std::string remedy) {
  return std::unexpected(
      Error(ErrorKind::input, std::move(what), {}, std::move(remedy), std::string(file), line));
}

bool LineReader::next() {
  if (at_ >= text_.size()) return false;
  const auto stop = text_.find('\n', at_);
  const auto end = stop == std::string_view::npos ? text_.size() : stop;
  line_ = text_.substr(at_, end - at_);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  at_ = stop == std::string_view::npos ? text_.size() : stop + 1;
  ++number_;
  return true;
}

static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

std::vector<std::string_view> words_of(std::string_view line, std::string_view separators) {
  std::vector<std::string_view> words;
  std::size_t begin = 0;
  for (std::size_t k = 0; k <= line.size(); ++k) {
    if (k < line.size() && !is_space(line[k]) && separators.find(line[k]) == separators.npos)
      continue;
    if (k > begin) words.push_back(line.substr(begin, k - begin));
    begin = k + 1;
  }
  return words;
}

bool is_number(std::string_view text, double& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text.empty()) return false;
  const auto [stop, problem] = read_double(text.data(), text.data() + text.size(), value);
  if (stop != text.data() + text.size()) return false;
  if (problem == std::errc::result_out_of_range)
    value = detail::is_tiny(text) ? 0 : std::numeric_limits<double>::infinity();
  return problem != std::errc::invalid_argument;
}

Expected<double> finite_number(std::string_view text, std::string_view file, int line) {
  double value = 0;
  if (!is_number(text, value))
    return data_error(file, line, fmt::format("\"{}\" is no number", printable(text, 40)));
  if (!std::isfinite(value))
    return data_error(file, line, fmt::format("{} is no finite number", printable(text, 40)),
                      "leave out points without a value");
  return value;
}

Expected<std::size_t> count_in(std::string_view text, std::size_t most, std::string_view what,
                               std::string_view file, int line) {
  std::size_t value = 0;
  const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem == std::errc::invalid_argument || stop != text.data() + text.size())
    return data_error(file, line,
                      fmt::format("\"{}\" is no number of {}", printable(text, 40), what));
  if (problem != std::errc() || value > most)
    return data_error(file, line,
                      fmt::format("{} {} are announced, more than the rest of the file can hold",
                                  printable(text, 40), what));
  return value;
}

}  // namespace knead::fields
