#include "display.hpp"

#include <algorithm>
#include <cmath>

#include "displays/all.hpp"

namespace knead {
namespace {

/// "deviation, mean, …"
template <class List>
std::string names_of(const List& list) {
  std::string text;
  for (const auto& item : list) text += (text.empty() ? "" : ", ") + std::string(item.name);
  return text.empty() ? "none" : text;
}

}  // namespace

std::span<const Display> displays() {
  static const std::vector<Display> all = [] {
    std::vector<Display> list;
    for (Display (*make)() : all_displays) list.push_back(make());
    return list;
  }();
  return all;
}

Expected<const Display*> find_display(std::string_view name) {
  const auto found = std::ranges::find(displays(), name, &Display::name);
  if (found != displays().end()) return &*found;
  return std::unexpected(Error{ErrorKind::usage,
                               "there is no display \"" + std::string(name) + "\"",
                               {},
                               "name one of these: " + names_of(displays())});
}

Expected<std::vector<std::vector<double>>> display_settings(
    const Display& display, std::span<const std::pair<std::string, std::vector<double>>> given) {
  std::vector<std::vector<double>> values;
  for (const DisplaySetting& setting : display.settings) values.push_back(setting.value);
  for (const auto& [name, value] : given) {
    const auto found = std::ranges::find(display.settings, name, &DisplaySetting::name);
    const std::string where = "settings." + name;
    if (found == display.settings.end()) {
      return std::unexpected(Error{
          ErrorKind::usage, "the display \"" + std::string(display.name) + "\" has no such setting",
          where, "its settings: " + names_of(display.settings)});
    }
    const std::size_t count = found->value.size();
    if (value.size() != count ||
        !std::ranges::all_of(value, [](double x) { return std::isfinite(x); })) {
      return std::unexpected(
          Error{ErrorKind::usage,
                "this is not " +
                    (count == 1 ? std::string("a number") : std::to_string(count) + " numbers"),
                where, std::string(found->help)});
    }
    values[static_cast<std::size_t>(found - display.settings.begin())] = value;
  }
  return values;
}

}  // namespace knead
