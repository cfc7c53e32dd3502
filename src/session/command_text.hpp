#pragma once

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "commands.hpp"

namespace knead {

using Json = nlohmann::json;

// What reading, writing and help of commands share.

/// Calls f(CommandInfo<C>{}, C{}) for every kind of command.
template <class F, std::size_t I = 0>
void for_each_command(F&& f) {
  if constexpr (I < std::variant_size_v<CommandVariant>) {
    f(std::variant_alternative_t<I, CommandVariant>{});
    for_each_command<F, I + 1>(std::forward<F>(f));
  }
}

inline std::string joined(const std::vector<std::string_view>& names) {
  std::string text;
  for (std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

inline std::string number(double value) {
  if (value == 0) return std::signbit(value) ? "-0.0" : "0";  // "-0" would be read as the whole number 0
  return fmt::format("{:.17g}", value);
}
inline std::string write(double value) { return number(value); }
inline std::string write(int value) { return fmt::format("{}", value); }
inline std::string write(bool value) { return value ? "true" : "false"; }
inline std::string write(EdgeChoice value);
inline std::string write(const std::string& value) {
  return Json(value).dump(-1, ' ', false, Json::error_handler_t::replace);
}

template <class T, std::size_t N>
std::string write(const std::array<T, N>& value);
template <class T>
std::string write(const std::vector<T>& value);

template <class Range>
std::string write_list(const Range& value) {
  std::string text;
  for (const auto& entry : value) text += (text.empty() ? "" : ",") + write(entry);
  return "[" + text + "]";
}
template <class T, std::size_t N>
std::string write(const std::array<T, N>& value) {
  return write_list(value);
}
template <class T>
std::string write(const std::vector<T>& value) {
  return write_list(value);
}

template <class E>
std::string_view name_of(E value, std::span<const Choice<E>> choices) {
  for (const Choice<E>& c : choices) {
    if (c.value == value) return c.name;
  }
  return {};
}

inline std::string write(EdgeChoice value) {
  return fmt::format("\"{}\"", name_of(value, std::span<const Choice<EdgeChoice>>(edge_choices)));
}

}  // namespace knead
