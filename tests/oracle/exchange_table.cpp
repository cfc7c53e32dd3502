#include "oracle/exchange_table.hpp"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <vector>

#include "knead/exchange/file_io.hpp"

namespace knead::oracle {
namespace {

constexpr const char* end_of_table = "<!-- end of table -->";

std::vector<std::string> lines_of_page() {
  std::vector<std::string> lines;
  const auto text = read_file(exchange_page());
  std::istringstream from(text.value_or(""));
  for (std::string line; std::getline(from, line);) lines.push_back(line);
  return lines;
}

}  // namespace

std::filesystem::path exchange_page() {
  return std::filesystem::path(KNEAD_SOURCE_DIR) / "docs/exchange.md";
}

std::string key_of(const std::string& file, const std::string& held) {
  return "| " + file + " | " + held + " |";
}

std::optional<std::string> row_of_page(const std::string& key) {
  for (const std::string& line : lines_of_page()) {
    if (line.starts_with(key)) return line;
  }
  return std::nullopt;
}

void put_row(const std::string& key, const std::string& row) {
  std::vector<std::string> lines = lines_of_page();
  auto place =
      std::ranges::find_if(lines, [&](const std::string& line) { return line.starts_with(key); });
  if (place != lines.end()) {
    *place = row;
  } else {
    place = std::ranges::find(lines, end_of_table);
    if (place == lines.end()) return;
    lines.insert(place, row);
  }
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  static_cast<void>(write_file_atomically(exchange_page(), text));
}

std::string figure(double value, double least) {
  char text[40];
  if (value < least) {
    std::snprintf(text, sizeof text, "< %.0e", least);
  } else {
    std::snprintf(text, sizeof text, "%.2g", value);
  }
  return text;
}

}  // namespace knead::oracle
