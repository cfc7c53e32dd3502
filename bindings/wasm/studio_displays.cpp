#include "studio_displays.hpp"

#include <nlohmann/json.hpp>

namespace knead::studio {
namespace {

using Json = nlohmann::json;

Json of(const DisplaySetting& s) {
  return {{"name", s.name},
          {"title", s.title},
          {"unit", s.unit},
          {"value", s.value.size() == 1 ? Json(s.value.front()) : Json(s.value)},
          {"help", s.help}};
}

Json of(const Display& d) {
  Json settings = Json::array();
  for (const DisplaySetting& s : d.settings) settings.push_back(of(s));
  return {{"name", d.name},
          {"title", d.title},
          {"unit", d.unit},
          {"signed", d.is_signed},
          {"palette", d.palette == DisplayPalette::rising ? "rising" : "diverging"},
          {"help", d.help},
          {"limits", d.limits ? Json(*d.limits) : Json()},
          {"tolerance", d.tolerance},
          {"compares", d.compares},
          {"sees_model", d.sees_model},
          {"settings", std::move(settings)}};
}

/// A number, or an array of numbers; anything else is a list of the wrong length.
std::vector<double> numbers(const Json& json) {
  if (json.is_number()) return {json.get<double>()};
  std::vector<double> result;
  if (!json.is_array()) return result;
  for (const Json& x : json) {
    if (!x.is_number()) return {};
    result.push_back(x.get<double>());
  }
  return result;
}

}  // namespace

std::string displays_json() {
  Json json = Json::array();
  for (const Display& d : displays()) json.push_back(of(d));
  return json.dump();
}

std::string range_json(const std::optional<DisplayRange>& range) {
  if (!range) return "null";
  return Json{{"lower", range->lower}, {"upper", range->upper}, {"least", range->least}, {"greatest", range->greatest}}
      .dump();
}

Expected<AskedDisplay> read_display(std::string_view text) {
  if (text.empty()) return AskedDisplay{};
  const Json json = Json::parse(text, nullptr, false);
  const auto name = json.is_object() ? json.find("display") : json.end();
  if (!json.is_object() || name == json.end() || !name->is_string()) {
    return std::unexpected(
        Error{ErrorKind::usage, "this asks for no display", {}, R"(write {"display": "deviation"})"});
  }
  if (*name == "none") return AskedDisplay{};
  const auto display = find_display(name->get<std::string>());
  if (!display) return std::unexpected(display.error());
  std::vector<std::pair<std::string, std::vector<double>>> given;
  if (const auto settings = json.find("settings"); settings != json.end() && settings->is_object()) {
    for (const auto& [key, value] : settings->items()) given.emplace_back(key, numbers(value));
  }
  auto values = display_settings(**display, given);
  if (!values) return std::unexpected(values.error());
  return AskedDisplay{*display, *std::move(values)};
}

}  // namespace knead::studio
