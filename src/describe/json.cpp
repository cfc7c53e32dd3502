#include "json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "knead/base/printable.hpp"

namespace knead {
namespace {

using Library = nlohmann::json;

constexpr std::size_t longest_shown = 120;  // bytes of a value in a message

/// Builds the tree, and notes where the text stops being JSON, or what about it is refused.
class Builder : public nlohmann::json_sax<Library> {
 public:
  Json root;
  std::size_t position = 0;
  bool too_large = false;  ///< it stopped at a number that no double holds
  std::optional<Error> refused;

  bool null() override { return put({}); }
  bool boolean(bool value) override { return put({.kind = Json::Kind::boolean, .boolean = value}); }
  bool number_integer(number_integer_t value) override {
    return put_number(static_cast<double>(value));
  }
  bool number_unsigned(number_unsigned_t value) override {
    return put_number(static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) override { return put_number(value); }
  bool string(string_t& value) override { return put({.kind = Json::Kind::text, .text = value}); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open({.kind = Json::Kind::object}); }
  bool key(string_t& name) override {
    if (!known_.back().insert(name).second) {
      refused =
          Error{ErrorKind::input, "the field is given twice", place(name), "leave one of them out"};
      return false;
    }
    names_.push_back(name);
    return true;
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open({.kind = Json::Kind::list}); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t at, const std::string&,
                   const nlohmann::detail::exception& exception) override {
    constexpr int number_out_of_range = 406;
    position = at;
    too_large = exception.id == number_out_of_range;
    return false;
  }

 private:
  /// "commands[2].name" for a member of the innermost object.
  [[nodiscard]] std::string place(const std::string& name) const {
    std::string text;
    std::size_t named = 0;
    for (const Json& outer : open_) {
      if (outer.is(Json::Kind::list)) {
        text += fmt::format("[{}]", outer.list.size());
      } else {
        text += (text.empty() ? "" : ".") + (named < names_.size() ? names_[named++] : name);
      }
    }
    return text;
  }
  bool put_number(double value) { return put({.kind = Json::Kind::number, .number = value}); }
  bool open(Json json) {
    if (open_.size() == max_json_depth) {
      refused = Error{ErrorKind::input,
                      fmt::format("lists and objects are nested more than {} deep", max_json_depth),
                      {},
                      "commands need six levels"};
      return false;
    }
    if (json.is(Json::Kind::object)) known_.emplace_back();
    open_.push_back(std::move(json));
    return true;
  }
  bool close() {
    Json json = std::move(open_.back());
    open_.pop_back();
    if (json.is(Json::Kind::object)) known_.pop_back();
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
    into.members.emplace_back(std::move(name), std::move(json));
    return true;
  }
  std::vector<Json> open_;          // lists and objects still open, from the outside in
  std::vector<std::string> names_;  // of members whose values are still to come
  std::vector<std::set<std::string>>
      known_;  // of each open object: sorted, so that no choice of names makes it slow
};

/// The word that the text has at or just before this position: letters, digits and signs.
std::string_view word_at(std::string_view text, std::size_t position) {
  const auto part = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.';
  };
  std::size_t first = std::min(position, text.size()), last = first;
  while (first > 0 && part(text[first - 1])) --first;
  while (last < text.size() && part(text[last])) ++last;
  return text.substr(first, last - first);
}

/// Whether the text is UTF-16, with or without its mark: every other byte of its first brackets and
/// quotes is zero.
bool is_utf_16(std::string_view text) {
  return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF") ||
         (text.size() > 1 && (text[0] == '\0') != (text[1] == '\0'));
}

Error not_json(std::string_view text, const Builder& builder) {
  if (is_utf_16(text)) return {ErrorKind::input, "the text is UTF-16", {}, "save it as UTF-8"};
  const std::string_view word = word_at(text, builder.position);
  if (builder.too_large) {
    return {ErrorKind::input,
            fmt::format("{} is too large for a number", printable(word, 40)),
            {},
            "numbers go to 1.79e308"};
  }
  for (const std::string_view name :
       {"NaN", "nan", "NAN", "Infinity", "inf", "-Infinity", "-inf", "-nan"}) {
    if (word == name) {
      return {ErrorKind::input,
              fmt::format("{} is not a number in JSON", name),
              {},
              "write a finite number"};
    }
  }
  return {ErrorKind::input,
          "this is not JSON",
          {},
          "check quotes, commas and brackets just before this place"};
}

}  // namespace

const Json* Json::find(std::string_view name) const {
  const auto found = std::ranges::find(members, name, &std::pair<std::string, Json>::first);
  return found == members.end() ? nullptr : &found->second;
}

Expected<Json> parse_json(std::string_view text) {
  Builder builder;
  if (Library::sax_parse(text, &builder)) return std::move(builder.root);
  if (builder.refused) return std::unexpected(std::move(*builder.refused));
  const auto end =
      text.begin() + static_cast<std::ptrdiff_t>(std::min(builder.position, text.size()));
  Error error = not_json(text, builder);
  error.line = static_cast<int>(1 + std::count(text.begin(), end, '\n'));
  return std::unexpected(error);
}

namespace {

/// Appends the value until the text is longer than a message needs.
void show(const Json& json, std::string& text) {
  if (text.size() > longest_shown) return;
  const auto opened = [&text](char bracket) {
    if (text.back() != bracket) text += ',';
  };
  switch (json.kind) {
    case Json::Kind::null:
      text += "null";
      return;
    case Json::Kind::boolean:
      text += json.boolean ? "true" : "false";
      return;
    case Json::Kind::number:
      text += fmt::format("{}", json.number);
      return;
    case Json::Kind::text:
      text += json_text(json.text);
      return;
    case Json::Kind::list:
      text += '[';
      for (const Json& entry : json.list) {
        if (text.size() > longest_shown) break;
        opened('[');
        show(entry, text);
      }
      text += ']';
      return;
    case Json::Kind::object:
      text += '{';
      for (const auto& [name, value] : json.members) {
        if (text.size() > longest_shown) break;
        opened('{');
        text += json_text(name) + ":";
        show(value, text);
      }
      text += '}';
      return;
  }
}

}  // namespace

std::string shown(const Json& json) {
  std::string text;
  show(json, text);
  return printable(text, longest_shown);
}

std::string json_text(std::string_view text) {
  return Library(text).dump(-1, ' ', false, Library::error_handler_t::replace);
}

std::string json_number(double value) {
  if (!std::isfinite(value)) return "null";
  if (value == 0)
    return std::signbit(value) ? "-0.0" : "0";  // "-0" would be read as the whole number 0
  return fmt::format("{:.17g}", value);
}

std::string shortest_json_number(double value) { return Library(value).dump(); }

std::string indented_json(std::string_view json) {
  return nlohmann::ordered_json::parse(json, nullptr, false).dump(1);
}

}  // namespace knead
