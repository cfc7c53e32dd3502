#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace knead::cli {

/// Prints like `fmt::print`, but goes on where nothing can be written: work is worth more than what
/// is said about it. The program says at its end that standard output failed.
template <class... T>
void say(std::FILE* stream, fmt::format_string<T...> text, T&&... values) {
  const std::string line = fmt::format(text, std::forward<T>(values)...);
  static_cast<void>(std::fwrite(line.data(), 1, line.size(), stream));
}

template <class... T>
void say(fmt::format_string<T...> text, T&&... values) {
  say(stdout, text, std::forward<T>(values)...);
}

}  // namespace knead::cli
