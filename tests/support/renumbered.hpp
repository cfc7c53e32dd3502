#pragma once

#include <cctype>
#include <string>

namespace knead::testing {

/// The entities of a DATA section of STEP with `offset` added to their names.
inline std::string renumbered(const std::string& data, long offset) {
  std::string result;
  bool quoted = false;
  for (std::size_t i = 0; i < data.size(); ++i) {
    result += data[i];
    if (data[i] == '\'') quoted = !quoted;
    if (data[i] != '#' || quoted) continue;
    std::size_t end = i + 1;
    while (end < data.size() && std::isdigit(static_cast<unsigned char>(data[end]))) ++end;
    result += std::to_string(std::stol(data.substr(i + 1, end - i - 1)) + offset);
    i = end - 1;
  }
  return result;
}

}  // namespace knead::testing
