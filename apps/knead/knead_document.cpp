#include "knead_document.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <nlohmann/json.hpp>

#include "cli.hpp"
#include "knead/base/printable.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int document_version = 3;

std::string compact(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Of what this text encodes in base64.
std::size_t bytes_in(const Json& text) {
  const auto& digits = text.get_ref<const std::string&>();
  std::size_t size = digits.size();
  while (size > 0 && digits[size - 1] == '=') --size;
  return size / 4 * 3 + size % 4 * 3 / 4;
}

/// A member that is text, or nothing.
std::string text_in(const Json& object, const char* member) {
  if (!object.is_object()) return {};
  const auto found = object.find(member);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// What the document holds, with numbers of bytes in the place of bytes.
Json summary(const Json& document, const std::string& file) {
  const auto has = [&](const char* member) {
    return document.contains(member) && !document[member].is_null();
  };
  Json source;
  if (has("source")) {
    const Json& given = document["source"];
    const bool bytes = given.is_object() && given.contains("bytes") && given["bytes"].is_string();
    source = {{"kind", text_in(given, "kind")},
              {"name", text_in(given, "name")},
              {"bytes", bytes ? Json(bytes_in(given["bytes"])) : Json()}};
  }
  Json views = Json::array();
  if (has("views") && document["views"].is_array()) {
    for (const Json& view : document["views"])
      views.push_back(view.is_object() ? text_in(view, "name") : "");
  }
  const bool snapshot = has("snapshot") && document["snapshot"].is_string();
  return {{"file", file},
          {"format", "Knead document"},
          {"version", document["knead"]},
          {"name", text_in(document, "name")},
          {"source", std::move(source)},
          {"commands", document["commands"]},
          {"views", std::move(views)},
          {"snapshot", snapshot ? Json(bytes_in(document["snapshot"])) : Json()}};
}

void print_document(const Json& about) {
  constexpr std::size_t most_listed = 20, longest = 160;
  const std::string name = about["name"];
  say("{}: Knead document of version {}{}\n", about["file"].get<std::string>(),
      compact(about["version"]), name.empty() ? "" : ", \"" + printable(name) + "\"");
  const Json& source = about["source"];
  if (source.is_null()) {
    say("  begins without a file\n");
  } else {
    say("  begins with the {} file \"{}\", {} bytes\n",
        source["kind"] == "rhino" ? "Rhino" : "STEP", printable(source["name"].get<std::string>()),
        compact(source["bytes"]));
  }
  const Json& commands = about["commands"];
  say("  {}{}\n", counted(commands.size(), "command", "commands"), commands.empty() ? "" : ":");
  for (std::size_t k = 0; k < commands.size() && k < most_listed; ++k) {
    say("    {}\n", printable(compact(commands[k]), longest));
  }
  if (commands.size() > most_listed)
    say("    and {} more (--json lists them)\n", commands.size() - most_listed);
  for (const Json& view : about["views"])
    say("  view \"{}\"\n", printable(view.get<std::string>()));
  if (!about["snapshot"].is_null()) say("  a snapshot of {} bytes\n", compact(about["snapshot"]));
}

}  // namespace

bool is_knead_document(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == bytes.npos || bytes[first] != '{') return false;
  constexpr std::size_t head = 4096;
  const std::string_view start = bytes.substr(first, head);
  return start.find("\"knead\"") != start.npos &&
         (start.find("\"name\"") != start.npos || start.find("\"source\"") != start.npos);
}

Expected<void> show_knead_document(std::string_view bytes, const std::string& name, bool as_json) {
  const Json document = Json::parse(bytes, nullptr, false);
  const bool complete = document.is_object() && document.contains("knead") &&
                        document.contains("commands") && document["commands"].is_array();
  if (!complete) {
    return std::unexpected(Error{ErrorKind::input,
                                 document.is_discarded()
                                     ? "this Knead document is not JSON"
                                     : "this Knead document has no version, or no list of commands",
                                 {},
                                 "save it again in the studio",
                                 name});
  }
  if (const Json& version = document["knead"]; version != document_version) {
    return std::unexpected(Error{
        ErrorKind::input,
        fmt::format("the Knead document is of version {}, not {}", compact(version),
                    document_version),
        "knead", "\"Scripts of version 1\" in docs/scripts.md says how its commands are translated",
        name});
  }
  const Json about = summary(document, name);
  if (as_json) {
    say("{}\n", about.dump(1, ' ', false, Json::error_handler_t::replace));
  } else {
    print_document(about);
  }
  return {};
}

}  // namespace knead::cli
