#include "knead/session/command_json.hpp"

#include <fmt/format.h>

#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"

namespace knead {
namespace {

/// What the bytes of a file are where they are known to be no script: "a STEP file".
std::string kind_of_file(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.find_first_not_of(" \t\r\n") == bytes.npos) return "an empty file";
  if (bytes.starts_with("\x89PNG"sv) || bytes.starts_with("\xFF\xD8\xFF"sv)) return "an image";
  if (bytes.starts_with("NRRD")) return "an NRRD file";
  if (compression_of(bytes) != Compression::none) return "a compressed file";
  if (bytes[0] == '{' || bytes[0] == '[') return {};
  for (const Format& format : formats()) {
    if (format.recognises == nullptr || !format.recognises(bytes)) continue;
    const bool vowel = std::string_view("AEIO").find(format.name.front()) != std::string_view::npos;
    return fmt::format("{} {} file", vowel ? "an" : "a", format.name);
  }
  return {};
}

}  // namespace

Error error_of_script(Error error, std::string_view text, const std::string& script) {
  if (const std::string kind = kind_of_file(text); !kind.empty()) {
    error = {ErrorKind::input,
             "this is " + kind + ", not a script",
             {},
             R"(write JSON: {"knead": 2, "commands": [...]}; `knead commands` explains them)"};
  }
  if (error.kind == ErrorKind::usage) error.kind = ErrorKind::input;
  error.file = script;
  return error;
}

Error error_at_command(Error error, const Document& document, const std::string& script,
                       std::optional<std::size_t> k) {
  if (error.file.empty() && error.where.starts_with('#') && !document.is_fresh())
    error.file = document.name();
  if (!error.file.empty() && error.file != script) {
    const std::string line = error.line > 0 ? fmt::format(":{}", error.line) : "";
    error.where = error.file + line + (error.where.empty() ? "" : ": " + error.where);
  }
  error.file = script;
  error.line = 0;
  if (error.kind == ErrorKind::usage) error.kind = ErrorKind::input;
  return k ? error.within(fmt::format("commands[{}]", *k)) : error;
}

}  // namespace knead
