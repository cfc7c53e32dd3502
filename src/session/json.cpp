#include "json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace knead {
namespace {

using Library = nlohmann::json;

/// Builds the tree, and notes where the text stops being JSON.
class Builder : public nlohmann::json_sax<Library> {
 public:
  Json root;
  std::size_t position = 0;

  bool null() override { return put({}); }
  bool boolean(bool value) override { return put({.kind = Json::Kind::boolean, .boolean = value}); }
  bool number_integer(number_integer_t value) override { return put_number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return put_number(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return put_number(value); }
  bool string(string_t& value) override { return put({.kind = Json::Kind::text, .text = value}); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open({.kind = Json::Kind::object}); }
  bool key(string_t& name) override {
    names_.push_back(name);
    return true;
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open({.kind = Json::Kind::list}); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t at, const std::string&, const nlohmann::detail::exception&) override {
    position = at;
    return false;
  }

 private:
  bool put_number(double value) { return put({.kind = Json::Kind::number, .number = value}); }
  bool open(Json json) {
    open_.push_back(std::move(json));
    return true;
  }
  bool close() {
    Json json = std::move(open_.back());
    open_.pop_back();
    return put(std::move(json));
  }
  bool put(Json json) {
    if (open_.empty()) {
      root = std::move(json);
      return true;
    }
    Json& into = open_.back();
    if (into.is(Json::Kind::list)) {
      into.list.push_back(std::move(json));
      return true;
    }
    std::string name = std::move(names_.back());
    names_.pop_back();
    const auto same = std::ranges::find(into.members, name, &std::pair<std::string, Json>::first);
    if (same != into.members.end()) {
      same->second = std::move(json);
    } else {
      into.members.emplace_back(std::move(name), std::move(json));
    }
    return true;
  }
  std::vector<Json> open_;          // lists and objects still open, from the outside in
  std::vector<std::string> names_;  // of members whose values are still to come
};

}  // namespace

const Json* Json::find(std::string_view name) const {
  const auto found = std::ranges::find(members, name, &std::pair<std::string, Json>::first);
  return found == members.end() ? nullptr : &found->second;
}

Expected<Json> parse_json(std::string_view text) {
  Builder builder;
  if (Library::sax_parse(text, &builder)) return std::move(builder.root);
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(builder.position, text.size()));
  Error error{ErrorKind::input, "this is not JSON", {}, "check quotes, commas and brackets just before this place"};
  error.line = static_cast<int>(1 + std::count(text.begin(), end, '\n'));
  return std::unexpected(error);
}

std::string shown(const Json& json) {
  std::string text;
  switch (json.kind) {
    case Json::Kind::null:
      return "null";
    case Json::Kind::boolean:
      return json.boolean ? "true" : "false";
    case Json::Kind::number:
      return fmt::format("{}", json.number);
    case Json::Kind::text:
      return json_text(json.text);
    case Json::Kind::list:
      for (const Json& entry : json.list) text += (text.empty() ? "" : ",") + shown(entry);
      return "[" + text + "]";
    case Json::Kind::object:
      for (const auto& [name, value] : json.members) {
        text += (text.empty() ? "" : ",") + json_text(name) + ":" + shown(value);
      }
      return "{" + text + "}";
  }
  return text;
}

std::string json_text(std::string_view text) {
  return Library(text).dump(-1, ' ', false, Library::error_handler_t::replace);
}

std::string json_number(double value) {
  if (!std::isfinite(value)) return "null";
  if (value == 0) return std::signbit(value) ? "-0.0" : "0";  // "-0" would be read as the whole number 0
  return fmt::format("{:.17g}", value);
}

}  // namespace knead
