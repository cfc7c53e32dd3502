#include <fmt/format.h>

#include <cctype>

#include "describe/text.hpp"
#include "queries.hpp"

namespace knead::studio {
namespace {

/// "face_edges" → FaceEdgesRequest
std::string request_name(std::string_view query) {
  std::string name;
  bool upper = true;
  for (const char c : query) {
    if (c != '_')
      name += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    upper = c == '_';
  }
  return name + "Request";
}

}  // namespace

void declare_queries(TypeScript& types) {
  std::string table;
  for (const Query& query : queries()) {
    const std::string name = request_name(query.request->name);
    types.declare(*query.request, name, "");
    table += fmt::format("  {}: {{ request: {}; answer: {} }};\n", query.request->name, name,
                         types.written(*query.answer, "Info", Absent::null));
  }
  types.text += "/** What the page can ask the engine for. */\nexport interface Queries {\n" +
                table + "}\n\n";
}

}  // namespace knead::studio
