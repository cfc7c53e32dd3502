#include "morph.hpp"

#include <fmt/format.h>

#include "exchange/morph/morph_report.hpp"
#include "session/session_state.hpp"

namespace knead {

static constexpr Choice directions[] = {{"normal", "along the normals of the faces"}};

void describe(MorphAnswer& a, Fields& fields) {
  fields.name("morph answer", "The file that has followed data, and the report of it.");
  fields.add("file", a.file);
  fields.add("report", a.report, {.help = "docs/morph.md"});
}

void describe(MorphQuery& q, Fields& fields) {
  fields.name(
      "morph",
      "The document as it would be saved with all its faces moved so that they follow data: "
      "displacements, a mesh before and after, a scan, or a map of space (docs/morph.md). The "
      "document itself stays.");
  MorphSettings& s = q.settings;
  fields.add("space", q.space,
             {.help = "the displacement as three formulas of x, y, z: \"0; 0; 0.01*x^2\"",
              .omit_empty = true});
  fields.add("vectors", q.vectors,
             {.help = "displacements: lines of x y z dx dy dz, CSV, VTK, VTU or VTP"});
  fields.add("from", q.from, {.help = "a mesh (STL, OBJ, PLY, VTK, XYZ) where the file is"});
  fields.add("to", q.to, {.help = "the same mesh where it should go"});
  fields.add("scan", q.scan, {.help = "points or a mesh in which faces should lie"});
  fields.add("align", s.align, {.help = "the scan is laid onto the model before, rigidly"});
  fields.add("noise", s.noise,
             {.help = "standard deviation of each coordinate of the data",
              .fallback = "none; of a scan it is estimated"});
  fields.add("scale", s.scale, {.help = "factor of the displacements: -1 compensates"});
  fields.add(
      "tolerance", s.tolerance,
      {.help = "largest residual wanted, in the file's unit", .fallback = "1e-5 of the size"});
  fields.add("faces", s.faces, {.help = "only these move, by id of face or surface"});
  fields.add("keep", s.keep, {.help = "these stay"});
  fields.add("place", s.places,
             {.help = "of parts in several places: those that the data are about"});
  fields.add("convert", s.convert, {.help = "planes and the like become B-splines, to move"});
  fields.add("refine", s.refinement,
             {.help = "at most so many times the control points, after raising to degree 3",
              .range = between(1, 1000)});
  fields.add(
      "reach", s.reach,
      {.help = "farthest that a point may be from a face", .fallback = "1 % of the model's box"});
  fields.add("along", q.along, {.help = "only this part of displacements", .choices = directions});
  fields.add("unit", s.unit,
             {.help = "of the data", .fallback = "that of the file", .omit_empty = true});
  fields.add("columns", s.columns,
             {.help = "of CSV: the names of point and displacement", .fallback = "x,y,z,dx,dy,dz"});
  fields.add("field", s.field,
             {.help = "of VTK: the name of the vector field at points", .omit_empty = true});
  fields.add("strict", q.strict, {.help = "fails where something is above what was wanted"});
}

namespace {

/// The fields' names of the settings.
Error of_fields(Error error) {
  if (error.where == "refinement") error.where = "refine";
  return error;
}

Expected<MorphData> data_of(const MorphQuery& q) {
  MorphData data{.space = q.space};
  const std::pair<const Bytes*, std::optional<MorphFile>*> files[] = {
      {&q.vectors, &data.vectors}, {&q.from, &data.from}, {&q.to, &data.to}, {&q.scan, &data.scan}};
  static constexpr const char* names[] = {"vectors", "from", "to", "scan"};
  for (std::size_t k = 0; k < std::size(files); ++k) {
    if (const Bytes& bytes = *files[k].first; !bytes.data.empty())
      *files[k].second = MorphFile{bytes.data, names[k]};
  }
  if (data.from.has_value() != data.to.has_value())
    return usage_error("a pair of meshes is \"from\" and \"to\"", data.from ? "to" : "from",
                       "give both");
  const int kinds = (data.vectors ? 1 : 0) + (data.from ? 1 : 0) + (data.scan ? 1 : 0) +
                    (q.space.empty() ? 0 : 1);
  if (kinds != 1)
    return usage_error(kinds == 0 ? "nothing says where the surfaces should go"
                                  : "several data say where the surfaces should go",
                       "vectors", "give one of vectors, from with to, scan, and space");
  return data;
}

}  // namespace

Expected<MorphAnswer> ask(const Session& session, const MorphQuery& q) {
  const auto data = data_of(q);
  if (!data) return std::unexpected(data.error());
  const auto source = saved_source(session);
  if (!source) return std::unexpected(source.error());
  MorphSettings settings = q.settings;
  settings.along_normal = q.along.has_value();
  auto morphed = morph_file(*source, *data, settings);
  if (!morphed) return std::unexpected(of_fields(std::move(morphed.error())));
  if (q.strict && !morphed->report.above.empty()) {
    const MorphExcess& worst = morphed->report.above.front();
    return numerical_error(fmt::format("{} {:.4g} is above the {:.4g} that was wanted",
                                       worst.measure, worst.found, worst.wanted),
                           worst.edge.empty() ? worst.surface : worst.edge,
                           "allow more control points with \"refine\", or a larger tolerance");
  }
  return MorphAnswer{{std::move(morphed->bytes)}, std::move(morphed->report)};
}

}  // namespace knead
