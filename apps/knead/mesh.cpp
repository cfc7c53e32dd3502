#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "cad_input.hpp"
#include "cli.hpp"
#include "knead/brep/model.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/save_model.hpp"
#include "knead/exchange/source.hpp"
#include "left_out_lines.hpp"
#include "outputs.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

struct MeshArguments {
  std::string file, output;
  std::optional<double> tolerance;
  bool untrimmed = false;
  int detail = SaveOptions{}.detail;
  UnpackOption unpack;
};

/// An error of an option in the words of the command line; others are the file's.
std::unexpected<Error> in_options(Error error, const MeshArguments& options) {
  if (error.where == "detail" || error.where == "tolerance") {
    error.where = "--" + error.where;
    error.kind = ErrorKind::usage;
  } else {
    error.file = options.file;
  }
  return std::unexpected(std::move(error));
}

/// The trimmed faces of a file; says what was left out.
Expected<void> write_model(const Source& source, const Format& format,
                           const MeshArguments& options) {
  const auto model = save_model(source, format, options.tolerance.value_or(0));
  if (!model) return in_options(model.error(), options);
  if (auto status = write_output(options.output, model->bytes); !status) return status;
  for (const std::string& warning : model->warnings) say(stderr, "knead: warning: {}\n", warning);
  warn_left_out(left_out_of_mesh(source, model->skipped));
  const std::size_t exact = model->faces - model->tessellated;
  std::string what = exact > 0 || model->tessellated == 0 ? counted(exact, "face", "faces") : "";
  if (model->tessellated > 0)
    what += (what.empty() ? "" : ", ") +
            counted(model->tessellated, "tessellated item", "tessellated items");
  say("wrote {} ({}, {}, {}, {} bytes)\n", options.output, what,
      counted(model->triangles, "triangle", "triangles"),
      model->open_sides == 0
          ? "closed"
          : "open along " + counted(model->open_sides, "side", "sides") + " of triangles",
      model->bytes.size());
  return {};
}

/// The surfaces of any file, whole.
Expected<void> write_surfaces(const Source& source, const Format& format,
                              const MeshArguments& options) {
  std::vector<NamedSurface> surfaces;
  SaveOptions mesh;
  mesh.detail = options.detail;
  for (const SourceSurface& s : source.surfaces()) {
    surfaces.push_back({s.name.empty() ? s.id : s.name, *s.surface});
    mesh.unit = s.unit;
  }
  const auto bytes = save_surfaces(surfaces, format, mesh);
  if (!bytes) return in_options(bytes.error(), options);
  if (auto status = write_output(options.output, *bytes); !status) return status;
  warn_left_out(left_out_of_surfaces(source, format));
  say("wrote {} ({}, {} bytes)\n", options.output, counted(surfaces.size(), "surface", "surfaces"),
      bytes->size());
  return {};
}

Expected<void> run(const MeshArguments& options) {
  const auto format = format_of_name(options.output, FormatContent::triangles);
  if (!format) {
    Error error = format.error().within("--out");
    error.kind = ErrorKind::usage;
    return std::unexpected(std::move(error));
  }
  if (options.tolerance && !(*options.tolerance > 0 && std::isfinite(*options.tolerance))) {
    return usage_error(fmt::format("{} is no distance", *options.tolerance), "--tolerance",
                       "use a length above 0, in the units of the file");
  }
  if (auto possible = check_outputs({{"--out", options.output}}, {{"FILE", options.file}});
      !possible)
    return possible;
  const auto source = open_cad_file(options.file, options.unpack);
  if (!source) return std::unexpected(source.error());
  if (options.untrimmed || !(*source)->model()) return write_surfaces(**source, **format, options);
  auto status = write_model(**source, **format, options);
  // Why a surface cannot be read says more than that faces on it are not drawn.
  if (!status && status.error().kind == ErrorKind::input && (*source)->surfaces().empty() &&
      !(*source)->unreadable().empty()) {
    return std::unexpected((*source)->unreadable().front().reason);
  }
  return status;
}

}  // namespace

Action add_mesh(CLI::App& app) {
  auto options = std::make_shared<MeshArguments>();
  CLI::App* command = app.add_subcommand("mesh", "write the faces of a CAD file as triangles");
  command->add_option("FILE", options->file, cad_file_help())->required()->type_name("");
  command
      ->add_option("-o,--out", options->output,
                   "mesh to write; the ending selects the format: " +
                       list_of_endings(FormatContent::triangles))
      ->required();
  CLI::Option* tolerance = command->add_option("--tolerance", options->tolerance,
                                               "distance of the triangles from the faces, in the "
                                               "file's units; a two-thousandth of the model's "
                                               "diagonal unless given");
  CLI::Option* untrimmed = command->add_flag(
      "--untrimmed", options->untrimmed, "write whole B-spline surfaces, not the faces on them");
  tolerance->excludes(untrimmed);
  command
      ->add_option("--detail", options->detail,
                   "with --untrimmed: grid lines per direction of each surface, 1 to 2000")
      ->capture_default_str()
      ->needs(untrimmed);
  options->unpack.add_to(*command);
  command->footer(
      "Every face of the model, cut along its edges, within the tolerance and in the file's units; "
      "parts of an\n"
      "assembly stand where it puts them, as often as they are used. Faces meet in\n"
      "the same points along their edges, so that a closed solid gives a closed mesh. Triangles "
      "run\n"
      "counterclockwise as seen from outside. STL, PLY and glTF are binary; glTF is turned to y up "
      "and scaled to\n"
      "metres by its root node. With --untrimmed each surface is a grid with every knot line among "
      "its lines, and\n"
      "need not meet its neighbours.\n" +
      std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
