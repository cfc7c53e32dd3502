#include "components.hpp"

#include <fmt/format.h>

#include <string_view>

namespace knead {
namespace {

constexpr std::string_view component_letters = "xyz";

}  // namespace

Expected<Components> components_of(const std::optional<std::string>& text) {
  if (!text) return all_components;
  Components components = {};
  bool valid = !text->empty();
  for (char letter : *text) {
    const std::size_t c = component_letters.find(letter);
    valid = valid && c != std::string_view::npos && !components[c];
    if (valid) components[c] = true;
  }
  if (valid) return components;
  return input_error(fmt::format("\"{}\" does not name coordinates", *text), "components",
                     R"(use each of x, y and z at most once, as "z" or "xy")");
}

std::optional<std::string> components_text(const Components& components) {
  if (components == all_components) return std::nullopt;
  std::string text;
  for (std::size_t c = 0; c < 3; ++c) {
    if (components[c]) text += component_letters[c];
  }
  return text;
}

}  // namespace knead
