#include "morph_fields.hpp"

#include <fmt/format.h>

#include <tuple>
#include <utility>

namespace knead {

static constexpr Choice directions[] = {{"normal", "along the normals of the faces"}};

/// In one order, with the fields that say how data are followed or without them.
static void describe_request(MorphRequest& request, Fields& fields, bool follows) {
  MorphSettings& s = request.settings;
  fields.add("align", s.align, {.help = "the scan is laid onto the model before, rigidly"});
  if (follows) {
    fields.add("noise", s.noise,
               {.help = "standard deviation of each coordinate of the data",
                .fallback = "none; of a scan it is estimated"});
    fields.add("scale", s.scale, {.help = "factor of the displacements: -1 compensates"});
    fields.add(
        "tolerance", s.tolerance,
        {.help = "largest residual wanted, in the file's unit", .fallback = "1e-5 of the size"});
  }
  fields.add("faces", s.faces, {.help = "only these move, by id of face or surface"});
  fields.add("keep", s.keep, {.help = "these stay"});
  fields.add("place", s.places,
             {.help = "of parts in several places: those that the data are about"});
  fields.add("convert", s.convert, {.help = "planes and the like become B-splines, to move"});
  if (follows) {
    fields.add("refine", s.refinement,
               {.help = "at most so many times the control points, after raising to degree 3",
                .range = between(1, 1000)});
  }
  fields.add(
      "reach", s.reach,
      {.help = "farthest that a point may be from a face", .fallback = "1 % of the model's box"});
  fields.add("along", request.along,
             {.help = "only this part of displacements", .choices = directions});
  fields.add("unit", s.unit,
             {.help = "of the data", .fallback = "that of the file", .omit_empty = true});
  fields.add("columns", s.columns,
             {.help = "of CSV: the names of point and displacement", .fallback = "x,y,z,dx,dy,dz"});
  fields.add("field", s.field,
             {.help = "of VTK: the name of the vector field at points", .omit_empty = true});
  if (!follows) return;
  fields.add("strict", request.strict, {.help = "fails where something is above what was wanted"});
}

void describe_partners(MorphRequest& request, Fields& fields) {
  describe_request(request, fields, false);
}

void describe_following(MorphRequest& request, Fields& fields) {
  describe_request(request, fields, true);
}

void describe_data(std::string& space, AskedData& data, Fields& fields) {
  fields.add("space", space,
             {.help = "the displacement as three formulas of x, y, z: \"0; 0; 0.01*x^2\"; or "
                      "\"lattice:\" and a block of space as JSON (docs/morph.md)",
              .omit_empty = true});
  fields.add("vectors", data.vectors,
             {.help = "displacements: lines of x y z dx dy dz, CSV, VTK, VTU or VTP"});
  fields.add("from", data.from, {.help = "a mesh (STL, OBJ, PLY, VTK, XYZ) where the file is"});
  fields.add("to", data.to, {.help = "the same mesh where it should go"});
  fields.add("scan", data.scan, {.help = "points or a mesh in which faces should lie"});
}

Expected<void> check_kinds(const MorphData& data) {
  if (data.from.has_value() != data.to.has_value())
    return usage_error("a pair of meshes is \"from\" and \"to\"", data.from ? "to" : "from",
                       "give both");
  const int kinds = (data.vectors ? 1 : 0) + (data.from ? 1 : 0) + (data.scan ? 1 : 0) +
                    (data.known_everywhere() ? 1 : 0);
  if (kinds != 1)
    return usage_error(kinds == 0 ? "nothing says where the surfaces should go"
                                  : "several data say where the surfaces should go",
                       "vectors", "give one of vectors, from with to, scan, and space");
  return {};
}

MorphData data_of(const AskedData& asked, const std::string& space) {
  MorphData data{.space = space};
  const std::tuple<const Bytes*, const char*, std::optional<MorphFile>*> files[] = {
      {&asked.vectors, "vectors", &data.vectors},
      {&asked.from, "from", &data.from},
      {&asked.to, "to", &data.to},
      {&asked.scan, "scan", &data.scan}};
  for (const auto& [bytes, field, file] : files) {
    if (!bytes->data.empty()) *file = MorphFile{bytes->data, field};
  }
  return data;
}

Expected<MorphedFile> follow_data(const std::shared_ptr<const Source>& source, MorphData data,
                                  const MorphRequest& request, const MorphTold& told) {
  data.space = request.space;
  if (auto right = check_kinds(data); !right) return std::unexpected(std::move(right.error()));
  MorphSettings settings = request.settings;
  settings.along_normal = request.along.has_value();
  auto morphed = detail::morph_file(source, data, settings, request.holds, told);
  if (!morphed) {
    Error error = std::move(morphed.error());
    if (error.where == "refinement") error.where = "refine";
    return std::unexpected(std::move(error));
  }
  if (request.strict && !morphed->report.above.empty()) {
    const MorphExcess& worst = morphed->report.above.front();
    return numerical_error(fmt::format("{} {:.4g} is above the {:.4g} that was wanted",
                                       worst.measure, worst.found, worst.wanted),
                           worst.edge.empty() ? worst.surface : worst.edge,
                           "allow more control points with \"refine\", or a larger tolerance");
  }
  return morphed;
}

}  // namespace knead
