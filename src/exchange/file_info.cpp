#include "knead/exchange/file_info.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "convertible.hpp"
#include "describe/record_json.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/brep/face_edges.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {

static void describe(FileSurface& s, Fields& fields) {
  fields.name("file surface", "A B-spline surface of a file.");
  fields.add_all("id", s.id, "name", s.name, "degree", s.degree, "net", s.net, "rational",
                 s.rational, "weights", s.weights, "clamped", s.clamped, "closed", s.closed,
                 "knots", s.knots, "max_interior_multiplicity", s.max_interior_multiplicity,
                 "faces", s.faces, "trimmed", s.trimmed, "bounding_box", s.bounding_box);
}

static void describe(FileUnreadable& s, Fields& fields) {
  fields.name("file unreadable", "");
  fields.add_all("id", s.id, "reason", s.reason);
}

static void describe(FileOtherSurface& s, Fields& fields) {
  fields.name("file other surface", "A surface of another form, on which faces lie.");
  fields.add_all("id", s.id, "form", s.form, "faces", s.faces, "convertible", s.convertible);
  fields.add("reason", s.reason, {.help = "why not", .omit_empty = true});
}

static void describe(FileCurve& c, Fields& fields) {
  fields.name("file curve", "");
  fields.add_all("id", c.id, "name", c.name, "degree", c.degree, "control_points", c.control_points,
                 "rational", c.rational, "clamped", c.clamped, "knots", c.knots);
}

static void describe(FileTessellation& t, Fields& fields) {
  fields.name("file tessellation", "");
  fields.add_all("id", t.id, "name", t.name, "unit", t.unit, "triangles", t.triangles);
}

static void describe(FilePlacement& p, Fields& fields) {
  fields.name("file placement", "Directions as the file gives them.");
  fields.add_all("origin", p.origin, "axis", p.axis, "ref_direction", p.ref_direction);
}

static void describe(FileInstance& i, Fields& fields) {
  fields.name("file instance", "A placement of a component in an assembly.");
  fields.add_all("id", i.id, "name", i.name, "parent", i.parent, "child", i.child, "placement",
                 i.placement, "frame", i.frame);
}

static void describe(FilePlace& p, Fields& fields) {
  fields.name("file place", "");
  fields.add_all("path", p.path, "matrix", p.matrix);
}

static void describe(FilePart& p, Fields& fields) {
  fields.name("file part", "Geometry with coordinates of its own.");
  fields.add_all("name", p.name, "unit", p.unit, "surfaces", p.surfaces, "faces", p.faces, "curves",
                 p.curves, "places", p.places);
}

static void describe(FileAssembly& a, Fields& fields) {
  fields.name("file assembly", "The parts of a file and where they stand.");
  fields.add("reason", a.reason,
             {.help = "why it cannot be followed; then the rest is missing", .omit_empty = true});
  fields.add("unit", a.unit, {.omit_empty = true});
  fields.add("parts", a.parts, {.omit_empty = true});
  fields.add("warnings", a.warnings, {.omit_empty = true});
}

static void describe(FileLeftOut& l, Fields& fields) {
  fields.name("file left out", "What is not listed, and why.");
  fields.add_all("what", l.what, "count", l.count, "reason", l.reason, "remedy", l.remedy, "ids",
                 l.ids);
}

static void describe(FileVisibleEdge& e, Fields& fields) {
  fields.name("file visible edge", "");
  fields.add_all("id", e.id, "from", e.from, "to", e.to, "faces", e.faces, "seam", e.seam);
}

static void describe(FileVisible& v, Fields& fields) {
  fields.name("file visible", "What faces show of a surface.");
  fields.add("surface", v.surface, {.help = "its id"});
  fields.add("reason", v.reason, {.help = "why its edges cannot be followed", .omit_empty = true});
  fields.add("in_shell", v.in_shell);
  fields.add("extent", v.extent, {.help = "two corners", .unit = Unit::fraction});
  fields.add("box", v.box, {.help = "of the edges", .unit = Unit::length});
  fields.add("middle", v.middle,
             {.help = "the visible point farthest from all edges", .unit = Unit::fraction});
  fields.add("distance", v.distance,
             {.help = "of the middle from the nearest edge", .unit = Unit::length});
  fields.add("edges", v.edges);
}

static void describe(FileInfo& f, Fields& fields) {
  fields.name("file info", "What is in a CAD file.");
  fields.add_all("file", f.file, "format", f.format, "schema", f.schema, "units", f.units,
                 "surfaces", f.surfaces, "unreadable_surfaces", f.unreadable_surfaces,
                 "other_surfaces", f.other_surfaces, "curves", f.curves, "tessellated_items",
                 f.tessellated_items, "instances", f.instances, "assembly", f.assembly, "left_out",
                 f.left_out, "remarks", f.remarks);
  fields.add("visible", f.visible,
             {.help = "what faces show of the surfaces, if asked for", .omit_empty = true});
}

namespace {

Corner corner_of(const Point& p) { return {p.x(), p.y(), p.z()}; }
std::array<double, 2> pair_of(const Eigen::Vector2d& p) { return {p.x(), p.y()}; }

std::array<int, 2> degrees(const Surface& surface) {
  return {surface.knots(0).degree(), surface.knots(1).degree()};
}

std::vector<double> values_of(const KnotVector& knots) {
  return {knots.knots().begin(), knots.knots().end()};
}

FileSurface info_of(std::string id, std::string name, const Surface& surface) {
  FileSurface info{.id = std::move(id),
                   .name = std::move(name),
                   .degree = degrees(surface),
                   .net = surface.net()};
  info.rational = surface.rational();
  if (info.rational) {
    const auto [least, most] = std::ranges::minmax_element(surface.weights());
    info.weights = {*least, *most};
  }
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& knots = surface.knots()[d];
    info.clamped[d] = knots.clamped();
    info.knots[d] = values_of(knots);
    info.max_interior_multiplicity[d] = knots.max_interior_multiplicity();
  }
  const BoundingBox box = bounding_box(surface);
  info.bounding_box = {corner_of(box.lower), corner_of(box.upper)};
  return info;
}

std::vector<FileSurface> surfaces_of(const Source& source, const brep::Model* model,
                                     const FileInfoOptions& options) {
  std::vector<FileSurface> list;
  const std::size_t count = model != nullptr ? model->surfaces.size() : source.surfaces().size();
  for (std::size_t k = 0; k < count; ++k) {
    if (model != nullptr) {
      const brep::SplineSurface& s = model->surfaces[k];
      FileSurface& info = list.emplace_back(info_of(s.id, s.name, s.surface));
      info.closed = s.closed;
      info.trimmed = s.trimmed;
      info.faces = s.faces;
    } else {
      const SourceSurface& s = source.surfaces()[k];
      list.push_back(info_of(s.id, s.name, *s.surface));
      list.back().closed = brep::closed_directions(*s.surface);
    }
    if (options.progress) options.progress(k + 1, count);
  }
  return list;
}

/// Why the file refuses to convert a surface whose spline is known; empty: it does not. All are
/// tried at once first.
std::vector<std::string> refusals(const Source& source, std::span<const brep::OtherSurface> others,
                                  std::span<const Expected<Surface>> splines) {
  std::vector<std::string> result(others.size()), ids;
  for (std::size_t k = 0; k < others.size(); ++k) {
    if (splines[k]) ids.push_back(others[k].id);
  }
  if (ids.empty() || source.with_splines(ids)) return result;
  for (std::size_t k = 0; k < others.size(); ++k) {
    if (!splines[k]) continue;
    const auto alone = source.with_splines({&others[k].id, 1});
    if (!alone) result[k] = alone.error().message();
  }
  return result;
}

std::vector<FileOtherSurface> others_of(const Source& source, const brep::Model& model,
                                        bool conversions) {
  std::vector<FileOtherSurface> list;
  const auto splines = conversions ? brep::exact_splines(model) : std::vector<Expected<Surface>>();
  std::vector<brep::OtherSurface> others = brep::other_surfaces(model);
  const bool converts = converts_surfaces(source);
  std::vector<std::string> refused(others.size(),
                                   "only faces of STEP and IGES files are converted");
  if (conversions && converts) refused = refusals(source, others, splines);
  for (std::size_t k = 0; k < others.size(); ++k) {
    brep::OtherSurface& s = others[k];
    FileOtherSurface& info = list.emplace_back(FileOtherSurface{s.id, s.form, std::move(s.faces)});
    if (!conversions) continue;
    const auto& made = splines[k];
    info.convertible = made && refused[k].empty();
    if (!info.convertible) info.reason = made ? refused[k] : made.error().message();
    if (made) {
      info.spline = std::array{degrees(*made), made->net()};
    } else {
      info.spline = std::unexpected(made.error());
    }
  }
  return list;
}

std::optional<FilePlacement> placement_of(const std::optional<brep::AxisPlacement>& p) {
  if (!p) return std::nullopt;
  return FilePlacement{corner_of(p->origin), corner_of(p->axis), corner_of(p->ref_direction)};
}

FileAssembly assembly_of(const brep::Model& model) {
  const auto& assembly = model.assembly;
  if (!assembly) return {.reason = assembly.error().message()};
  FileAssembly info{.unit = assembly->unit, .parts = {{}}, .warnings = assembly->warnings};
  for (const brep::Part& part : assembly->parts) {
    FilePart& made = info.parts->emplace_back(
        FilePart{part.name, part.unit, part.surfaces, part.faces, part.curves, {}});
    for (const brep::PartPlace& place : part.places) {
      FilePlace& at = made.places.emplace_back(FilePlace{place.path});
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 4; ++j) {
          at.matrix[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
              place.to_model.matrix()(i, j);
        }
      }
    }
  }
  return info;
}

FileVisible visible_of(const brep::SplineSurface& s, const VisibleRegion& region) {
  FileVisible info{.surface = s.id, .in_shell = region.in_shell};
  const auto extent = region.extent();
  info.extent = {pair_of(extent[0]), pair_of(extent[1])};
  Eigen::AlignedBox3d box;
  for (const TrimEdge& edge : region.edges) {
    for (const Point& p : edge.points) box.extend(p);
    info.edges.push_back({edge.id, pair_of(edge.course.front()), pair_of(edge.course.back()),
                          edge.neighbours, edge.seam});
  }
  info.box = {corner_of(box.min()), corner_of(box.max())};
  if (const auto middle = visible_middle(s.surface, region)) {
    info.middle = pair_of(middle->at);
    info.distance = middle->distance;
  }
  return info;
}

std::vector<FileVisible> visible_parts(const std::shared_ptr<const brep::Model>& model) {
  std::vector<FileVisible> list;
  const VisibleRegions regions(model);
  for (const brep::SplineSurface& s : model->surfaces) {
    const auto region = regions.of(s.id);
    if (!region) {
      list.push_back({.surface = s.id, .reason = region.error().message()});
    } else if (!region->edges.empty()) {
      list.push_back(visible_of(s, *region));
    }
  }
  return list;
}

}  // namespace

std::string unit_of(const Source& source) {
  const auto model = source.model();
  if (model != nullptr && (source.format() == "STEP" || source.surfaces().empty()))
    return model->length_unit();
  return source.surfaces().empty() ? "unknown" : source.surfaces().front().unit;
}

FileInfo file_info(const Source& source, const FileInfoOptions& options) {
  const auto model = source.model();
  FileInfo info;
  info.file = source.name();
  info.format = source.format();
  info.schema = source.schema();
  info.units = unit_of(source);
  info.surfaces = surfaces_of(source, model.get(), options);
  for (const brep::UnreadableSurface& s : source.unreadable()) {
    info.unreadable_surfaces.push_back({s.id, s.reason.message()});
  }
  for (const SourceCurve& c : source.curves()) {
    const KnotVector& knots = c.curve->knots(0);
    info.curves.push_back({c.id, c.name, knots.degree(), static_cast<int>(c.curve->size()),
                           c.curve->rational(), knots.clamped(), values_of(knots)});
  }
  for (const LeftOut& left : options.faces ? left_out_of_faces(source) : left_out_of_list(source)) {
    info.left_out.push_back({left.many, static_cast<int>(left.count), left.reason,
                             left.remedy.empty() ? std::nullopt : std::optional(left.remedy),
                             left.ids, sentence(left)});
  }
  info.remarks = source.remarks();
  if (model == nullptr) return info;
  info.other_surfaces = others_of(source, *model, options.conversions || options.faces);
  for (const brep::TessellatedItem& item : model->tessellated.items) {
    info.tessellated_items.push_back(
        {item.mesh.id, item.name, item.unit, static_cast<int>(item.mesh.triangles.size())});
  }
  for (const brep::Instance& i : model->instances) {
    info.instances.push_back(
        {i.id, i.name, i.parent, i.child, placement_of(i.placement), placement_of(i.frame)});
  }
  info.assembly = assembly_of(*model);
  if (options.faces) info.visible = visible_parts(model);
  return info;
}

std::string file_json(const FileInfo& info) {
  return indented_json(to_json(type_of<FileInfo>(), &info, Absent::null, shortest_json_number));
}

}  // namespace knead
