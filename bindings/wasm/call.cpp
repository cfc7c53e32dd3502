#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "describe/record_json.hpp"
#include "knead/session/session_info.hpp"
#include "queries.hpp"
#include "session/commands.hpp"

namespace knead::studio {
namespace {

Expected<void> read(const Json& json, Commands& commands) {
  if (!json.is(Json::Kind::list))
    return input_error("this is no list of commands", "commands", R"(write [{"do": …}])");
  for (const Json& one : json.list) {
    auto command = read_command(one);
    if (!command) return std::unexpected(std::move(command.error()));
    commands.push_back(*std::move(command));
  }
  return {};
}

/// Numbers, or lists of numbers; anything else is a list of the wrong length, or not finite.
void read(const Json& json, Settings& settings) {
  for (const auto& [name, value] : json.members) {
    auto& numbers = settings.emplace_back(name, std::vector<double>{}).second;
    if (value.is(Json::Kind::number)) numbers.push_back(value.number);
    for (const Json& entry : value.list) {
      numbers.push_back(entry.is(Json::Kind::number) ? entry.number
                                                     : std::numeric_limits<double>::quiet_NaN());
    }
  }
}

/// The next of the bytes, as many as the JSON says.
Expected<void> read(const Json& json, Bytes& to, std::string& bytes) {
  if (!(json.number >= 0 && json.number <= static_cast<double>(bytes.size())))
    return usage_error("there are fewer bytes than the request says");
  const auto size = static_cast<std::size_t>(json.number);
  std::string later = bytes.substr(size);
  bytes.resize(size);
  to.data = std::exchange(bytes, std::move(later));
  return {};
}

Expected<Answer> answered(Studio& studio, std::string input, std::size_t json_size) {
  const std::size_t begin = input.size() - std::min(json_size, input.size());
  auto json = parse_json(std::string_view(input).substr(begin));
  if (!json) return std::unexpected(json.error());
  input.resize(begin);
  const Json* const name = json->find("query");
  const std::string_view named = name != nullptr ? std::string_view(name->text) : "";
  const auto query =
      std::ranges::find(queries(), named, [](const Query& q) { return q.request->name; });
  if (query == queries().end())
    return usage_error(fmt::format("the engine answers no query \"{}\"", named));
  const auto request =
      std::ranges::find(json->members, "request", &std::pair<std::string, Json>::first);
  if (request == json->members.end()) return usage_error("the query has no request");
  Asked asked{std::move(request->second), std::move(input)};
  return ask(*query, studio, asked);
}

/// What of a value lies in memory: `"name":["Float32Array",1234,96]`.
std::string memory(std::string_view name, const Type& type, const void* value) {
  const auto at =
      reinterpret_cast<std::uintptr_t>(type.count(value) > 0 ? type.part(value) : nullptr);
  return fmt::format(R"("{}":["{}",{},{}])", name, type.name, at, type.count(value));
}

std::string written(const Answer& answer) {
  if (!answer.value) return "{\"answer\":" + answer.json + "}";
  const Type* type = answer.type;
  const void* value = answer.value.get();
  std::string places;
  const std::string json = to_json(*type, value, Absent::null);
  if (type->kind == Kind::optional && type->count(value) > 0) {
    value = type->part(value);
    type = type->element;
  }
  if (type->kind == Kind::opaque && type->count != nullptr) places = memory("", *type, value);
  for (const Field& field : type->fields) {
    if (field.type->kind != Kind::opaque) continue;
    places += (places.empty() ? "" : ",") + memory(field.name, *field.type, field.of(value));
  }
  return "{\"answer\":" + json + (places.empty() ? "}" : ",\"memory\":{" + places + "}}");
}

}  // namespace

Expected<void> read_request(Asked& asked, const Type& type, void* request) {
  const auto is_own = [](const Field& field) { return field.type->kind == Kind::opaque; };
  for (const Field& field : type.fields) {
    const bool missing = is_own(field) && asked.json.find(field.name) == nullptr;
    if (missing && field.presence == Presence::required)
      return input_error("the field is missing", field.name);
  }
  for (const auto& [name, json] : asked.json.members) {
    const Field* const field = type.find(name);
    if (field == nullptr || !is_own(*field)) continue;
    void* const member = field->of(request);
    Expected<void> status;
    if (field->type == &type_of<Commands>()) status = read(json, *static_cast<Commands*>(member));
    if (field->type == &type_of<Settings>()) read(json, *static_cast<Settings*>(member));
    if (field->type == &type_of<Bytes>())
      status = read(json, *static_cast<Bytes*>(member), asked.bytes);
    if (!status) return status;
  }
  Type others = type;
  std::erase_if(others.fields, is_own);
  std::erase_if(asked.json.members, [&](const auto& member) {
    const Field* const field = type.find(member.first);
    return field != nullptr && is_own(*field);
  });
  return read_record(asked.json, others, request);
}

Expected<Answer> written_answer(const Type& type, Expected<std::string> json) {
  if (!json) return std::unexpected(std::move(json.error()));
  Answer answer{.type = &type};
  answer.json = *std::move(json);
  return answer;
}

std::string call(Studio& studio, std::string input, std::size_t json_size, Answer& kept) {
  auto answer = answered(studio, std::move(input), json_size);
  if (!answer) {
    std::string text = error_json(answer.error());
    text.insert(text.size() - 1, fmt::format(R"(,"file":{},"line":{})",
                                             json_text(answer.error().file), answer.error().line));
    return text;
  }
  kept = *std::move(answer);
  return written(kept);
}

}  // namespace knead::studio
