#include "knead/exchange/file_info.hpp"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <optional>

#include "cad_input.hpp"
#include "cli.hpp"
#include "faces.hpp"
#include "knead/base/printable.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/session/session_info.hpp"
#include "knead_document.hpp"
#include "parts.hpp"
#include "progress.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

struct InfoArguments {
  std::string file;
  bool json = false, faces = false;
  UnpackOption unpack;
};

/// "\"name\", " where there is one.
std::string titled(const std::string& name) {
  return name.empty() ? "" : "\"" + printable(name) + "\", ";
}

std::string in_words(bool rational) { return rational ? "rational" : "polynomial"; }

void print_text(const FileInfo& info) {
  say("{}: {}{}, units {}, {}\n", info.file, info.format,
      info.schema.empty() ? "" : " " + printable(info.schema), info.units,
      counted(info.surfaces.size(), "B-spline surface", "B-spline surfaces"));
  for (const FileSurface& s : info.surfaces) {
    const auto& [lower, upper] = s.bounding_box;
    say("  {:<8} {}degree {} x {}, net {} x {}, {}{}{}{}\n", s.id, titled(s.name), s.degree[0],
        s.degree[1], s.net[0], s.net[1], in_words(s.rational), s.closed[0] ? ", closed in u" : "",
        s.closed[1] ? ", closed in v" : "", s.trimmed ? ", trimmed" : "");
    say("           from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})\n", lower[0],
        lower[1], lower[2], upper[0], upper[1], upper[2]);
  }
  for (const FileCurve& c : info.curves) {
    say("  {:<8} {}curve of degree {}, {}, {}\n", c.id, titled(c.name), c.degree,
        counted(static_cast<std::size_t>(c.control_points), "control point", "control points"),
        in_words(c.rational));
  }
  for (const FileTessellation& t : info.tessellated_items) {
    say("  {:<8} {}tessellated, {}\n", t.id, titled(t.name),
        counted(static_cast<std::size_t>(t.triangles), "triangle", "triangles"));
  }
  std::map<std::string, int> others;
  for (const FileOtherSurface& s : info.other_surfaces) ++others[s.form];
  if (!others.empty()) {
    std::string counts;
    for (const auto& [form, count] : others)
      counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, form);
    say("  other surfaces, to be converted before they are sculpted (--faces lists them): {}\n",
        counts);
  }
  if (!info.left_out.empty()) say("  left out:\n");
  for (const FileLeftOut& left : info.left_out) say("    {}\n", left.sentence);
  print_parts(info);
  for (const std::string& remark : info.remarks) say("  {}\n", printable(remark, 2000));
}

Expected<void> run(const InfoArguments& options) {
  std::optional<ProgressLine> line;
  announce_reading(line.emplace(), options.file);
  auto bytes = read_file(options.file);
  if (!bytes) return std::unexpected(bytes.error());
  if (is_knead_document(*bytes)) {
    line.reset();
    if (options.faces)
      return usage_error("a Knead document has no faces", "--faces", "leave it out");
    return show_knead_document(*bytes, options.file, options.json);
  }
  const auto source = open_source(*std::move(bytes), options.file, options.unpack.options());
  if (!source) return std::unexpected(source.error());
  if (options.faces && (*source)->model() == nullptr) {
    line.reset();
    return usage_error(fmt::format("a {} file has no faces", (*source)->format()), "--faces",
                       "leave it out");
  }
  const FileInfo info =
      file_info(**source, {.conversions = options.json,
                           .faces = options.faces,
                           .progress = [&line](std::size_t listed, std::size_t count) {
                             line->show("surface", listed, count);
                           }});
  line.reset();
  if (options.json) {
    say("{}\n", file_json(info));
    return {};
  }
  print_text(info);
  if (options.faces) print_faces(info);
  return {};
}

}  // namespace

Action add_info(CLI::App& app) {
  auto options = std::make_shared<InfoArguments>();
  CLI::App* command = app.add_subcommand("info", "list the B-spline surfaces of a CAD file");
  command->add_option("FILE", options->file, cad_file_help())->required()->type_name("");
  CLI::Option* json =
      command->add_flag("--json", options->json, "print JSON, with knots and assembly placements");
  command
      ->add_flag("--faces", options->faces,
                 "list the visible parts of the surfaces, and the edges of their faces")
      ->excludes(json);
  options->unpack.add_to(*command);
  command->footer(
      "Coordinates and boxes are in the surface's own frame and units; the box is that of the "
      "whole\n"
      "untrimmed surface; `net` counts control points; knots are listed with their "
      "multiplicity.\n" +
      std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
