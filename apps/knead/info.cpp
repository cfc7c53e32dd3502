#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "cad_input.hpp"
#include "cli.hpp"
#include "faces.hpp"
#include "knead/base/printable.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/brep/model.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/left_out.hpp"
#include "knead/spline/extremum.hpp"
#include "knead_document.hpp"
#include "left_out_lines.hpp"
#include "parts.hpp"
#include "progress.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InfoArguments {
  std::string file;
  bool json = false, faces = false;
  UnpackOption unpack;
};

Json to_json(const Point& p) { return {p.x(), p.y(), p.z()}; }

Json to_json(const brep::AxisPlacement& p) {
  return {{"origin", to_json(p.origin)}, {"axis", to_json(p.axis)}, {"ref_direction", to_json(p.ref_direction)}};
}

/// A surface of a file, of STEP or of another format.
struct Row {
  std::string id, name;
  const Surface* surface;
  std::array<bool, 2> closed = {};
  bool trimmed = false;
  int faces = -1;  ///< on it; -1: the format has none
};

std::vector<Row> rows_of(const Source& source) {
  std::vector<Row> rows;
  if (const auto model = source.model()) {
    for (const brep::SplineSurface& s : model->surfaces)
      rows.push_back({s.id, s.name, &s.surface, s.closed, s.trimmed, s.faces});
  } else {
    for (const SourceSurface& s : source.surfaces()) {
      rows.push_back({s.id, s.name, s.surface.get(), brep::closed_directions(*s.surface)});
    }
  }
  return rows;
}

Json to_json(const Row& s) {
  const Surface& surface = *s.surface;
  const BoundingBox box = bounding_box(surface);
  Json knots = Json::array();
  for (int d = 0; d < 2; ++d) {
    const auto values = surface.knots(d).knots();
    knots.push_back(std::vector<double>(values.begin(), values.end()));
  }
  Json weights;
  if (surface.rational()) {
    const auto [least, most] = std::ranges::minmax_element(surface.weights());
    weights = {*least, *most};
  }
  const KnotVector &u = surface.knots(0), &v = surface.knots(1);
  return {{"id", s.id},
          {"name", s.name},
          {"degree", {u.degree(), v.degree()}},
          {"net", surface.net()},
          {"rational", surface.rational()},
          {"weights", std::move(weights)},
          {"clamped", {u.clamped(), v.clamped()}},
          {"closed", s.closed},
          {"knots", std::move(knots)},
          {"max_interior_multiplicity", {u.max_interior_multiplicity(), v.max_interior_multiplicity()}},
          {"faces", s.faces < 0 ? Json() : Json(s.faces)},
          {"trimmed", s.trimmed},
          {"bounding_box", {to_json(box.lower), to_json(box.upper)}}};
}

Json to_json(const SourceCurve& c) {
  const KnotVector& knots = c.curve->knots(0);
  return {{"id", c.id},
          {"name", c.name},
          {"degree", knots.degree()},
          {"control_points", c.curve->size()},
          {"rational", c.curve->rational()},
          {"clamped", knots.clamped()},
          {"knots", std::vector<double>(knots.knots().begin(), knots.knots().end())}};
}

Json to_json(const brep::Instance& i) {
  return {{"id", i.id},
          {"name", i.name},
          {"parent", i.parent},
          {"child", i.child},
          {"placement", i.placement ? to_json(*i.placement) : Json()},
          {"frame", i.frame ? to_json(*i.frame) : Json()}};
}

std::vector<brep::OtherSurface> others_of(const Source& source) {
  const auto model = source.model();
  return model ? brep::other_surfaces(*model) : std::vector<brep::OtherSurface>();
}

std::span<const brep::TessellatedItem> tessellated_of(const brep::Model* model) {
  return model != nullptr ? std::span(model->tessellated.items) : std::span<const brep::TessellatedItem>();
}

/// Of the file as a whole; of other formats than STEP the geometry is read as STEP.
std::string unit_of(const Source& source) {
  const auto model = source.model();
  if (model != nullptr && (source.format() == "STEP" || source.surfaces().empty())) return model->length_unit();
  return source.surfaces().empty() ? "unknown" : source.surfaces().front().unit;
}

void print_text(const Source& source, bool faces) {
  const auto model = source.model();
  const auto rows = rows_of(source);
  say("{}: {}{}, units {}, {}\n", source.name(), source.format(),
      source.schema().empty() ? "" : " " + printable(source.schema()), unit_of(source),
      counted(rows.size(), "B-spline surface", "B-spline surfaces"));
  for (const Row& s : rows) {
    const Surface& surface = *s.surface;
    const auto [m, n] = surface.net();
    const BoundingBox box = bounding_box(surface);
    std::string traits = surface.rational() ? "rational" : "polynomial";
    if (s.closed[0]) traits += ", closed in u";
    if (s.closed[1]) traits += ", closed in v";
    if (s.trimmed) traits += ", trimmed";
    say("  {:<8} {}degree {} x {}, net {} x {}, {}\n", s.id, s.name.empty() ? "" : "\"" + printable(s.name) + "\", ",
        surface.knots(0).degree(), surface.knots(1).degree(), m, n, traits);
    say("           from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})\n", box.lower.x(), box.lower.y(),
        box.lower.z(), box.upper.x(), box.upper.y(), box.upper.z());
  }
  for (const SourceCurve& c : source.curves()) {
    say("  {:<8} {}curve of degree {}, {}, {}\n", c.id, c.name.empty() ? "" : "\"" + printable(c.name) + "\", ",
        c.curve->knots(0).degree(),
        counted(static_cast<std::size_t>(c.curve->size()), "control point", "control points"),
        c.curve->rational() ? "rational" : "polynomial");
  }
  for (const brep::TessellatedItem& item : tessellated_of(model.get())) {
    say("  {:<8} {}tessellated, {}\n", item.mesh.id, item.name.empty() ? "" : "\"" + printable(item.name) + "\", ",
        counted(item.mesh.triangles.size(), "triangle", "triangles"));
  }
  std::map<std::string, int> others;
  for (const brep::OtherSurface& s : others_of(source)) ++others[s.form];
  if (!others.empty()) {
    std::string counts;
    for (const auto& [form, count] : others) counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, form);
    say("  other surfaces, to be converted before they are sculpted (--faces lists them): {}\n", counts);
  }
  print_left_out(faces ? left_out_of_faces(source) : left_out_of_list(source));
  if (model != nullptr) print_parts(*model);
  for (const std::string& remark : source.remarks()) say("  {}\n", printable(remark, 2000));
}

Expected<void> run(const InfoArguments& options) {
  std::optional<ProgressLine> line;
  announce_reading(line.emplace(), options.file);
  auto bytes = read_file(options.file);
  if (!bytes) return std::unexpected(bytes.error());
  if (is_knead_document(*bytes)) {
    line.reset();
    if (options.faces) return usage_error("a Knead document has no faces", "--faces", "leave it out");
    return show_knead_document(*bytes, options.file, options.json);
  }
  const auto source = open_source(*std::move(bytes), options.file, options.unpack.options());
  if (!source) return std::unexpected(source.error());
  if (!options.json) line.reset();  // what is printed shows how far it is
  const auto model = (*source)->model();
  if (options.faces && model == nullptr) {
    return usage_error(fmt::format("a {} file has no faces", (*source)->format()), "--faces", "leave it out");
  }
  if (!options.json) {
    print_text(**source, options.faces);
    if (options.faces) print_faces(model);
    return {};
  }
  Json others = Json::array();
  const auto splines = model == nullptr ? std::vector<Expected<Surface>>() : brep::exact_splines(*model);
  for (const brep::OtherSurface& s : others_of(**source)) {
    const auto& made = splines[others.size()];
    const bool step = (*source)->format() == "STEP";
    others.push_back({{"id", s.id}, {"form", s.form}, {"faces", s.faces}, {"convertible", step && made}});
    if (!made || !step)
      others.back()["reason"] = made ? "only faces of a STEP file are converted" : made.error().message();
  }
  Json surfaces = Json::array(), unreadable = Json::array(), instances = Json::array();
  const auto rows = rows_of(**source);
  for (const Row& s : rows) {
    surfaces.push_back(to_json(s));
    line->show("surface", surfaces.size(), rows.size());
  }
  Json curves = Json::array();
  for (const SourceCurve& c : (*source)->curves()) curves.push_back(to_json(c));
  Json tessellated = Json::array();
  for (const brep::TessellatedItem& item : tessellated_of(model.get())) {
    tessellated.push_back(
        {{"id", item.mesh.id}, {"name", item.name}, {"unit", item.unit}, {"triangles", item.mesh.triangles.size()}});
  }
  for (const brep::UnreadableSurface& s : (*source)->unreadable()) {
    unreadable.push_back({{"id", s.id}, {"reason", s.reason.message()}});
  }
  if (model != nullptr) {
    for (const brep::Instance& i : model->instances) instances.push_back(to_json(i));
  }
  const Json info = {{"file", options.file},
                     {"format", (*source)->format()},
                     {"schema", (*source)->schema()},
                     {"units", unit_of(**source)},
                     {"surfaces", std::move(surfaces)},
                     {"unreadable_surfaces", std::move(unreadable)},
                     {"other_surfaces", std::move(others)},
                     {"curves", std::move(curves)},
                     {"tessellated_items", std::move(tessellated)},
                     {"instances", std::move(instances)},
                     {"assembly", model != nullptr ? parts_json(*model) : Json()},
                     {"left_out", left_out_json(left_out_of_list(**source))},
                     {"remarks", (*source)->remarks()}};
  line.reset();
  say("{}\n", info.dump(1, ' ', false, Json::error_handler_t::replace));
  return {};
}

}  // namespace

Action add_info(CLI::App& app) {
  auto options = std::make_shared<InfoArguments>();
  CLI::App* command = app.add_subcommand("info", "list the B-spline surfaces of a CAD file");
  command->add_option("FILE", options->file, cad_file_help())->required()->type_name("");
  CLI::Option* json = command->add_flag("--json", options->json, "print JSON, with knots and assembly placements");
  command->add_flag("--faces", options->faces, "list the visible parts of the surfaces, and the edges of their faces")
      ->excludes(json);
  options->unpack.add_to(*command);
  command->footer(
      "Coordinates and boxes are in the surface's own frame and units; the box is that of the whole\n"
      "untrimmed surface; `net` counts control points; knots are listed with their multiplicity.\n" +
      std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
