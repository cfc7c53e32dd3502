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
  fields.add("space", q.request.space,
             {.help = "the displacement as three formulas of x, y, z: \"0; 0; 0.01*x^2\"; or "
                      "\"lattice:\" and a block of space as JSON (docs/morph.md)",
              .omit_empty = true});
  fields.add("vectors", q.vectors,
             {.help = "displacements: lines of x y z dx dy dz, CSV, VTK, VTU or VTP"});
  fields.add("from", q.from, {.help = "a mesh (STL, OBJ, PLY, VTK, XYZ) where the file is"});
  fields.add("to", q.to, {.help = "the same mesh where it should go"});
  fields.add("scan", q.scan, {.help = "points or a mesh in which faces should lie"});
  describe_following(q.request, fields);
}

Expected<MorphAnswer> ask(const Session& session, const MorphQuery& q) {
  MorphData data;
  const std::pair<const Bytes*, std::optional<MorphFile>*> files[] = {
      {&q.vectors, &data.vectors}, {&q.from, &data.from}, {&q.to, &data.to}, {&q.scan, &data.scan}};
  static constexpr const char* names[] = {"vectors", "from", "to", "scan"};
  for (std::size_t k = 0; k < std::size(files); ++k) {
    if (const Bytes& bytes = *files[k].first; !bytes.data.empty())
      *files[k].second = MorphFile{bytes.data, names[k]};
  }
  const auto source = saved_source(session);
  if (!source) return std::unexpected(source.error());
  auto morphed = follow_data(*source, std::move(data), q.request);
  if (!morphed) return std::unexpected(std::move(morphed.error()));
  std::string page = morph_page(morphed->report);
  return MorphAnswer{{std::move(morphed->bytes)}, std::move(morphed->report), std::move(page)};
}

}  // namespace knead
