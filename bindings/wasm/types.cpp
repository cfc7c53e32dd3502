// What the build of the page needs of the session, and the page itself does not: the types of what
// it says.
#include <fmt/format.h>

#include <string>

#include "describe/text.hpp"
#include "knead/exchange/format.hpp"
#include "knead/session/session_info.hpp"
#include "queries.hpp"

#define KNEAD_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace {

std::string& text() {
  static std::string value;
  return value;
}

}  // namespace

/// The text becomes a TypeScript module with the types of the session's answers, the queries and
/// the file formats.
KNEAD_EXPORT(knead_types) int knead_types() {
  text() = knead::session_typescript([](knead::TypeScript& types) {
             knead::studio::declare_commands(types);
             knead::studio::declare_queries(types);
           }) +
           "\nexport const fileFormats = " + knead::format_json() + " as const;\n";
  return 1;
}

KNEAD_EXPORT(knead_text) const char* knead_text() { return text().data(); }
KNEAD_EXPORT(knead_text_size) std::size_t knead_text_size() { return text().size(); }
