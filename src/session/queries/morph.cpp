#include "morph.hpp"

#include <utility>

#include "exchange/morph/morph_report.hpp"
#include "session/session_state.hpp"

namespace knead {

void describe(MorphAnswer& a, Fields& fields) {
  fields.name("morphed answer", "The file that has followed data, and the report of it.");
  fields.add("file", a.file);
  fields.add("report", a.report, {.help = "docs/morph.md"});
  fields.add("page", a.page, {.help = "the report for people, as Markdown"});
}

void describe(MorphQuery& q, Fields& fields) {
  fields.name(
      "morphed",
      "The document as it would be saved with all its faces moved so that they follow data: "
      "displacements, a mesh before and after, a scan, or a map of space (docs/morph.md). The "
      "document itself stays: `morph` moves it.");
  describe_data(q.request.space, q.data, fields);
  describe_following(q.request, fields);
}

Expected<MorphAnswer> ask(const Session& session, const MorphQuery& q) {
  const auto source = saved_source(session);
  if (!source) return std::unexpected(source.error());
  auto morphed = follow_data(*source, data_of(q.data, q.request.space), q.request);
  if (!morphed) return std::unexpected(std::move(morphed.error()));
  std::string page = morph_page(morphed->report);
  return MorphAnswer{{std::move(morphed->bytes)}, std::move(morphed->report), std::move(page)};
}

}  // namespace knead
