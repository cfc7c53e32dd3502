#include "knead/exchange/morph.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cad_input.hpp"
#include "cli.hpp"
#include "image_file.hpp"
#include "knead/exchange/file_io.hpp"
#include "outputs.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

struct MorphArguments {
  std::string file, output, vectors, from, to, space, scan, report, page;
  std::string scales = "1", faces, keep, places, columns, along;
  std::optional<double> tolerance, reach, noise;
  bool no_convert = false, strict = false;
  MorphSettings settings;
  UnpackOption unpack;
};

/// The settings' names on the command line.
Error in_options(Error error) {
  static constexpr std::pair<std::string_view, std::string_view> options[] = {
      {"scale", "--scale"},       {"tolerance", "--tolerance"}, {"reach", "--reach"},
      {"refinement", "--refine"}, {"unit", "--unit"},           {"columns", "--columns"},
      {"faces", "--faces"},       {"place", "--place"},         {"keep", "--keep"},
      {"noise", "--noise"},       {"align", "--align"}};
  for (const auto& [setting, option] : options) {
    if (error.where != setting) continue;
    error.where = option;
    error.kind = ErrorKind::usage;
    return error;
  }
  if (error.where == "space" || error.where.starts_with("space:")) {
    error.where.insert(0, "--");
    error.kind = ErrorKind::usage;
  }
  return error;
}

/// "part_0.5.step" of "part.step": an output for each of several scales.
std::string output_of(const std::string& output, double scale, std::size_t count) {
  if (count == 1 || output.empty()) return output;
  const std::filesystem::path path(uncompressed_name(output));
  const std::string packed = output.substr(path.string().size());
  return (path.parent_path() /
          fmt::format("{}_{}{}", path.stem().string(), scale, path.extension().string()))
             .string() +
         packed;
}

/// The directory of the page, "made" of "made/".
std::string page_of(const MorphArguments& options, double scale, std::size_t count) {
  std::string path = options.page;
  while (path.size() > 1 && path.ends_with('/')) path.pop_back();
  return count == 1 || path.empty() ? path : fmt::format("{}_{}", path, scale);
}

constexpr std::string_view page_mark = "<!-- knead morph -->\n";
constexpr std::string_view page_name = "README.md";

/// Whether a page can be written there: what stands under its name has to be one.
Expected<void> check_page(const std::string& directory) {
  if (auto possible = check_directory({"--page", directory}); !possible) return possible;
  const auto there = std::filesystem::path(directory) / page_name;
  std::error_code ignored;
  if (!std::filesystem::exists(there, ignored)) return {};
  if (auto possible = check_writable(there); !possible) return possible;
  const auto bytes = read_file(there);
  if (bytes && bytes->starts_with(page_mark)) return {};
  return input_error(there.string() + " is there, and no page of this command", "--page",
                     "name another directory");
}

Expected<void> write_page(const std::string& directory, const Source& source,
                          const MorphedFile& morphed) {
  auto page = illustrated_page(source, morphed);
  if (!page) return std::unexpected(page.error().within("--page"));
  std::vector<std::pair<std::string, std::string>> files = std::move(page->drawings);
  for (const MorphPicture& picture : page->pictures) {
    auto png = png_of(picture.width, picture.height, picture.colours);
    if (!png) return std::unexpected(png.error().within("--page"));
    files.emplace_back(picture.name, *std::move(png));
  }
  files.emplace_back(page_name, std::string(page_mark) + page->text);
  return write_together({"--page", directory}, files);
}

Expected<MorphData> data_of(const MorphArguments& options) {
  const int kinds = (options.vectors.empty() ? 0 : 1) + (options.space.empty() ? 0 : 1) +
                    (options.from.empty() && options.to.empty() ? 0 : 1) +
                    (options.scan.empty() ? 0 : 1);
  if (kinds != 1)
    return usage_error(kinds == 0 ? "nothing says where the surfaces should go"
                                  : "several data say where the surfaces should go",
                       "--vectors", "give one of --vectors, --from with --to, --scan, and --space");
  if (options.from.empty() != options.to.empty())
    return usage_error("a pair of meshes is --from and --to",
                       options.from.empty() ? "--from" : "--to", "give the other one too");
  if (options.vectors.empty() && !(options.columns.empty() && options.settings.field.empty()))
    return usage_error("only --vectors has columns and fields",
                       options.columns.empty() ? "--field" : "--columns", "leave it out");
  MorphData data{.space = options.space};
  const std::pair<const std::string*, std::optional<MorphFile>*> files[] = {
      {&options.vectors, &data.vectors},
      {&options.from, &data.from},
      {&options.to, &data.to},
      {&options.scan, &data.scan}};
  for (const auto& [name, file] : files) {
    if (name->empty()) continue;
    auto bytes = read_file(*name);
    if (!bytes) return std::unexpected(std::move(bytes.error()));
    *file = MorphFile{*std::move(bytes), *name};
  }
  if (constexpr std::string_view block = "lattice:"; data.space.starts_with(block)) {
    auto bytes = read_file(data.space.substr(block.size()));
    if (!bytes) return std::unexpected(std::move(bytes.error()));
    data.space.replace(block.size(), std::string::npos, *bytes);
  }
  return data;
}

std::string line_of(const MorphExcess& excess) {
  return fmt::format("{} {:.4g}, {:.4g} wanted, {} at ({:.6g}, {:.6g}, {:.6g})", excess.measure,
                     excess.found, excess.wanted,
                     excess.edge.empty() ? "surface " + excess.surface : "edge " + excess.edge,
                     excess.place[0], excess.place[1], excess.place[2]);
}

void tell_scan(const MorphScan& scan, const std::string& unit) {
  if (const auto& laid = scan.alignment) {
    say("  aligned: turned by {:.4g} degrees, shifted by ({:.6g}, {:.6g}, {:.6g}){}, rms distance "
        "{:.4g} -> {:.4g}\n",
        laid->angle, laid->shift[0], laid->shift[1], laid->shift[2], unit, laid->rms_before,
        laid->rms_after);
  }
  say("  scan: noise {:.3g}{}{}; rms distance {:.4g} -> {:.4g} in {}\n", scan.noise, unit,
      scan.noise_estimated ? " (estimated)" : "", scan.rms_before, scan.rms_after,
      counted(static_cast<std::size_t>(scan.turns), "turn", "turns"));
  say("  without partner: {} beside the model, {} turned away, {} outliers\n", scan.beyond_border,
      scan.turned_away, scan.outliers);
}

void tell(const MorphReport& report) {
  constexpr std::size_t most = 5;
  const std::string unit = report.unit == "unknown" ? "" : " " + report.unit;
  say("  {} of {} points used; {} farther than {:.4g}{} from every face\n", report.used,
      report.points, report.left_out, report.reach, unit);
  for (std::size_t k = 0; k < std::min(most, report.listed.size()); ++k) {
    const MorphLeftOut& point = report.listed[k];
    say("    point {} at ({:.6g}, {:.6g}, {:.6g}): {}\n", point.number, point.place[0],
        point.place[1], point.place[2],
        point.distance ? fmt::format("{:.4g} away", *point.distance) : "far away");
  }
  if (report.scan) tell_scan(*report.scan, unit);
  say("  displacements wanted: mean {:.4g}, rms {:.4g}, largest {:.4g}{}\n", report.before.mean,
      report.before.rms, report.before.largest, unit);
  say("  missing of them: mean {:.3g}, rms {:.3g}, 95 % {:.3g}, 99 % {:.3g}, largest {:.3g}{}\n",
      report.after.mean, report.after.rms, report.after.of_95, report.after.of_99,
      report.after.largest, unit);
  say("  control points {} -> {}; {} converted to B-splines; {} with other figures\n",
      report.control_points_before, report.control_points_after,
      counted(report.converted.size(), "surface", "surfaces"),
      counted(report.edges.size(), "edge", "edges"));
  for (const MorphException& fixed : report.fixed)
    say(stderr, "knead: warning: surface {} stays: {}\n", fixed.id, fixed.reason);
  std::vector<MorphExcess> others;
  std::size_t contradicting = 0;
  const MorphExcess* worst = nullptr;
  for (const MorphExcess& excess : report.above) {
    if (excess.measure != "contradiction") {
      others.push_back(excess);
      continue;
    }
    contradicting += static_cast<std::size_t>(excess.count);
    if (worst == nullptr || excess.found > worst->found) worst = &excess;
  }
  if (worst != nullptr) {
    say(stderr, "knead: warning: {} what stays, and fade out beside it; the worst: {}\n",
        counted(contradicting, "point contradicts", "points contradict"), line_of(*worst));
  }
  if (others.empty()) return;
  say(stderr,
      "knead: warning: {} above what was wanted; the first: {}; a larger --refine or "
      "--tolerance may help\n",
      counted(others.size(), "measure is", "measures are"), line_of(others.front()));
}

Expected<void> write_one(const MorphArguments& options, const std::shared_ptr<const Source>& source,
                         const MorphData& data, const MorphSettings& settings, std::size_t count,
                         std::string& reports) {
  auto morphed = morph_file(source, data, settings);
  if (!morphed) return std::unexpected(in_options(std::move(morphed.error())));
  const MorphReport& report = morphed->report;
  if (options.strict && !report.above.empty())
    return numerical_error("it is above what was wanted: " + line_of(report.above.front()),
                           "--strict",
                           "allow more control points with --refine, or a larger "
                           "--tolerance");
  const std::string output = output_of(options.output, settings.scale, count);
  auto bytes = settings.scale == 0
                   ? Expected<std::string>(std::move(morphed->bytes))
                   : compressed_by_name(std::move(morphed->bytes), output, options.file);
  if (!bytes) return std::unexpected(std::move(bytes.error()));
  if (auto written = write_output(output, *bytes); !written) return written;
  say("wrote {} ({} bytes, scale {})\n", output, bytes->size(), settings.scale);
  tell(report);
  reports += (reports.empty() ? "" : ",\n") + morph_json(report);
  if (const std::string page = page_of(options, settings.scale, count); !page.empty())
    return write_page(page, *source, *morphed);
  return {};
}

Expected<void> run(MorphArguments& options) {
  auto scales = parse_numbers(options.scales, "--scale");
  if (!scales) return std::unexpected(scales.error());
  if (scales->empty()) return usage_error("there is no factor", "--scale", "leave it out for 1");
  MorphSettings& settings = options.settings;
  settings.tolerance = options.tolerance;
  settings.reach = options.reach;
  settings.noise = options.noise;
  settings.convert = !options.no_convert;
  settings.faces = items_of(options.faces);
  settings.keep = items_of(options.keep);
  settings.places = items_of(options.places);
  settings.columns = items_of(options.columns);
  settings.along_normal = options.along == "normal";
  std::vector<NamedFile> outputs = {{"--report", options.report}};
  for (const double scale : *scales)
    outputs.push_back({"-o", output_of(options.output, scale, scales->size())});
  if (auto right = check_outputs(outputs, {{"FILE", options.file},
                                           {"--vectors", options.vectors},
                                           {"--from", options.from},
                                           {"--to", options.to},
                                           {"--scan", options.scan}});
      !right)
    return right;
  for (const double scale : *scales) {
    if (options.page.empty()) break;
    if (auto possible = check_page(page_of(options, scale, scales->size())); !possible)
      return possible;
  }
  const auto data = data_of(options);
  if (!data) return std::unexpected(data.error());
  const auto source = open_cad_file(options.file, options.unpack);
  if (!source) return std::unexpected(source.error());
  std::string reports;
  for (const double scale : *scales) {
    settings.scale = scale;
    if (auto done = write_one(options, *source, *data, settings, scales->size(), reports); !done)
      return done;
  }
  if (options.report.empty()) return {};
  return write_output(options.report, scales->size() == 1 ? reports + "\n" : "[" + reports + "]\n");
}

void add_options(CLI::App& command, MorphArguments& options) {
  MorphSettings& settings = options.settings;
  command.add_option("FILE", options.file, cad_file_help())->required()->type_name("");
  command.add_option("-o,--output", options.output, "CAD file to write")->required();
  command.add_option("--vectors", options.vectors,
                     "displacements: lines `x y z dx dy dz`, CSV, VTK, VTU or VTP");
  command.add_option("--from", options.from,
                     "a mesh (STL, OBJ, PLY, VTK, XYZ) where the file is ...");
  command.add_option("--to", options.to, "... and the same mesh where it should go");
  command.add_option(
      "--scan", options.scan,
      "a scan: points or a mesh (STL, OBJ, PLY, VTK, XYZ) in which faces should lie");
  command.add_flag("--align", settings.align,
                   "the scan is laid onto the model before, by a rigid motion");
  command.add_option("--noise", options.noise,
                     "standard deviation of each coordinate of the data, in the file's unit; of a "
                     "scan it is estimated, other data are exact");
  command.add_option("--space", options.space,
                     "the displacement as three formulas of x, y, z: \"0; 0; 0.01*x^2\"; or "
                     "\"lattice:FILE.json\", a block of space of which control points are moved");
  command
      .add_option("--scale", options.scales,
                  "factors of the displacements: -1 compensates; of several each gets a file, with "
                  "the factor before its ending")
      ->capture_default_str();
  command.add_option("--tolerance", options.tolerance,
                     "largest residual wanted, in the file's unit; default 1e-5 of the size");
  command.add_option("--faces", options.faces, "only these move, by id: \"#1,#2\"");
  command.add_option("--keep", options.keep, "these stay");
  command.add_option("--place", options.places,
                     "of parts in several places: which one the data are about, \"engine/valve\"");
  command.add_flag("--no-convert", options.no_convert,
                   "planes, cylinders and the like stay, instead of becoming B-splines");
  command
      .add_option("--refine", settings.refinement,
                  "at most so many times the control points, after raising to degree 3")
      ->capture_default_str();
  command.add_option("--reach", options.reach,
                     "farthest that a point may be from a face; default 1 % of the model's box");
  command
      .add_option("--along", options.along,
                  "normal: only the part of displacements along the normals of the faces")
      ->check(CLI::IsMember({"normal"}));
  command.add_option("--unit", settings.unit, "of the data; default that of the file");
  command.add_option("--columns", options.columns,
                     "of CSV: the names of point and displacement; default x,y,z,dx,dy,dz");
  command.add_option("--field", settings.field, "of VTK: the name of the vector field at points");
  command.add_flag("--strict", options.strict,
                   "write nothing, and fail, where something is above what was wanted");
  command.add_option("--report", options.report, "JSON report to write (docs/morph.md)");
  command.add_option("--page", options.page,
                     "directory for the report as a page: README.md in Markdown, with pictures");
  options.unpack.add_to(command);
}

}  // namespace

Action add_morph(CLI::App& app) {
  auto options = std::make_shared<MorphArguments>();
  CLI::App* command = app.add_subcommand(
      "morph",
      "move all faces so that they follow displacements, a mesh, a scan or a map of space");
  add_options(*command, *options);
  command->footer(
      "Every face follows, faces stay together at their edges, smooth where they were, and every "
      "edge and vertex is\n"
      "written anew; all else keeps its bytes. An edge that would come open is an error, and "
      "nothing is written.\n" +
      std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
