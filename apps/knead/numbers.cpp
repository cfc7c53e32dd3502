#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "cli.hpp"
#include "knead/gramian/gramian.hpp"

namespace knead::cli {

std::vector<std::string> items_of(const std::string& list, std::string_view separators) {
  std::vector<std::string> items;
  std::string item;
  for (const char c : list + ",") {
    const bool ends = c == ',' || separators.find(c) != separators.npos;
    if (!ends && (c != ' ' || !item.empty())) {
      item += c;
    } else if (!item.empty()) {
      items.push_back(std::exchange(item, {}));
    }
  }
  return items;
}

Expected<std::vector<double>> parse_numbers(const std::string& text, const std::string& option) {
  std::vector<double> numbers;
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  const auto is_separator = [&](char c) { return c == ',' || is_space(c); };
  const char *at = text.data(), *end = at + text.size();
  while (true) {
    while (at != end && is_space(*at)) ++at;
    if (at == end) return numbers;
    if (*at == ',') {
      return usage_error("there is no number before this comma",
                         fmt::format("{} entry {}", option, numbers.size()),
                         "write decimals separated by single commas");
    }
    const char* stop = at;
    while (stop != end && !is_separator(*stop)) ++stop;
    double value = 0;
    const char* first = *at == '+' ? at + 1 : at;
    const auto [parsed, code] = std::from_chars(first, stop, value);
    if (code == std::errc::result_out_of_range || (code == std::errc{} && !std::isfinite(value))) {
      return usage_error(fmt::format("\"{}\" is not a finite number", std::string(at, stop)),
                         fmt::format("{} entry {}", option, numbers.size()),
                         "use numbers below 1.8e308");
    }
    if (code != std::errc{} || parsed != stop) {
      return usage_error(fmt::format("\"{}\" is not a number", std::string(at, stop)),
                         fmt::format("{} entry {}", option, numbers.size()),
                         "write decimals separated by commas");
    }
    numbers.push_back(value);
    at = stop;
    while (at != end && is_space(*at)) ++at;
    if (at != end && *at == ',') ++at;
  }
}

std::string gramian_method_help() {
  return fmt::format("Gramians by: {}, {}, {} or {} (default {})", name(GramianMethod::gauss),
                     name(GramianMethod::gauss_reduced), name(GramianMethod::analytic),
                     name(GramianMethod::recurrence), name(default_gramian_method));
}

std::string json_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.17g}", value) : "null";
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace knead::cli
