#include "morph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "exchange/fields/raw_numbers.hpp"
#include "session/acts/data_moving.hpp"

namespace knead {

void describe(MorphCommand& c, Fields& fields) {
  fields.name("morph", "move all faces so that they follow data, and stay closed");
  fields.add("space", c.request.space,
             {.help = "the displacement as three formulas of x, y, z: \"0; 0; 0.01*x^2\"; or "
                      "\"lattice:\" and a block of space as JSON (docs/morph.md); this, `vectors`, "
                      "`from` with `to`, or `scan`",
              .omit_empty = true});
  fields.add("vectors", c.vectors,
             {.help = "displacements: what such a file holds (lines of x y z dx dy dz, CSV, VTK, "
                      "VTU or VTP), as text, or bytes as base64 after \"base64:\"",
              .omit_empty = true});
  fields.add(
      "from", c.from,
      {.help = "likewise: a mesh (STL, OBJ, PLY, VTK, XYZ) where the file is", .omit_empty = true});
  fields.add("to", c.to, {.help = "the same mesh where it should go", .omit_empty = true});
  fields.add("scan", c.scan,
             {.help = "points or a mesh in which faces should lie", .omit_empty = true});
  describe_following(c.request, fields);
}

namespace {

/// The file that a field of the command holds; none if it is empty.
Expected<std::optional<MorphFile>> file_in(const std::string& text, const char* field) {
  constexpr std::string_view coded = "base64:";
  if (text.empty()) return std::nullopt;
  if (!text.starts_with(coded)) return MorphFile{text, field};
  auto bytes = fields::base64_decoded(std::string_view(text).substr(coded.size()), text.size());
  if (!bytes) {
    return input_error("this is no base64", field,
                       "after \"base64:\" come letters, digits, \"+\", \"/\" and \"=\" alone");
  }
  return MorphFile{*std::move(bytes), field};
}

Expected<MorphData> data_of(const MorphCommand& c) {
  MorphData data;
  const std::tuple<const std::string*, const char*, std::optional<MorphFile>*> files[] = {
      {&c.vectors, "vectors", &data.vectors},
      {&c.from, "from", &data.from},
      {&c.to, "to", &data.to},
      {&c.scan, "scan", &data.scan}};
  for (const auto& [text, field, file] : files) {
    auto read = file_in(*text, field);
    if (!read) return std::unexpected(read.error());
    *file = *std::move(read);
  }
  return data;
}

std::string summary(const MorphReport& report) {
  const std::string unit = report.unit == "unknown" ? "" : " " + report.unit;
  return fmt::format(
      "morph: {} of {} points followed, displacements up to {:.4g}{}; missing of them: rms {:.3g}, "
      "largest {:.3g}{}",
      report.used, report.points, report.before.largest, unit, report.after.rms,
      report.after.largest, unit);
}

}  // namespace

Expected<void> execute(const MorphCommand& c, Act& act) {
  auto data = data_of(c);
  if (!data) return std::unexpected(data.error());
  const auto report = move_after_data(act, *std::move(data), c.request);
  if (!report) return std::unexpected(report.error());
  act.state.notes.push_back(summary(*report));
  note_excess(act, *report, "morph");
  return {};
}

}  // namespace knead
