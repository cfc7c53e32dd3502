#include <fmt/format.h>

#include <memory>

#include "cli.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "outputs.hpp"

namespace knead::cli {
namespace {

struct MeshArguments {
  std::string file, output;
  int detail = SaveOptions{}.detail;
};

Expected<void> run(const MeshArguments& options) {
  const auto format = format_of_name(options.output, FormatContent::triangles);
  if (!format) {
    Error error = format.error().within("--out");
    error.kind = ErrorKind::usage;
    return std::unexpected(std::move(error));
  }
  if (auto possible = check_outputs({{"--out", options.output}}, {{"FILE", options.file}}); !possible) return possible;
  auto input = read_file(options.file);
  if (!input) return std::unexpected(input.error());
  const auto source = open_source(std::move(*input), options.file);
  if (!source) return std::unexpected(source.error());
  std::vector<NamedSurface> surfaces;
  SaveOptions mesh;
  mesh.detail = options.detail;
  for (const SourceSurface& s : (*source)->surfaces()) {
    surfaces.push_back({s.name.empty() ? s.id : s.name, *s.surface});
    mesh.unit = s.unit;
  }
  const auto bytes = save_surfaces(surfaces, **format, mesh);
  if (!bytes) {
    Error error = bytes.error();
    if (error.where == "detail") {
      error.where = "--detail";
      error.kind = ErrorKind::usage;
    } else {
      error.file = options.file;
    }
    return std::unexpected(std::move(error));
  }
  if (auto done = write_file_atomically(options.output, *bytes); !done) return done;
  fmt::print("wrote {} ({} surface{}, {} bytes)\n", options.output, surfaces.size(), surfaces.size() == 1 ? "" : "s",
             bytes->size());
  return {};
}

}  // namespace

Action add_mesh(CLI::App& app) {
  auto options = std::make_shared<MeshArguments>();
  CLI::App* command = app.add_subcommand("mesh", "write the B-spline surfaces of a CAD file as triangles");
  command->add_option("FILE", options->file, "CAD file: " + list_of_endings(FormatContent::surfaces, true))
      ->required()
      ->type_name("");
  command
      ->add_option("-o,--out", options->output,
                   "mesh to write; the ending selects the format: " + list_of_endings(FormatContent::triangles))
      ->required();
  command->add_option("--detail", options->detail, "grid lines per direction of each surface, 1 to 2000")
      ->capture_default_str();
  command->footer(
      "The mesh approximates the exact surfaces, each whole and untrimmed, in the file's units: a grid whose "
      "points\n"
      "lie on the surface, every knot line among its lines, counterclockwise seen from where S_u x S_v points. It "
      "need\n"
      "not be watertight. STL, PLY and glTF are binary; glTF is turned to y up and scaled to metres by its root "
      "node.\n" +
      std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
