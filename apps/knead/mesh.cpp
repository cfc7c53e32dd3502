#include <fmt/format.h>

#include <memory>

#include "cli.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/mesh_writer.hpp"
#include "knead/exchange/step_file.hpp"
#include "outputs.hpp"

namespace knead::cli {
namespace {

struct Options {
  std::string file, output;
  int detail = MeshOptions{}.detail;
};

Expected<void> run(const Options& options) {
  const auto format = mesh_format(options.output);
  if (!format) {
    Error error = format.error().within("--out");
    error.kind = ErrorKind::usage;
    return std::unexpected(std::move(error));
  }
  if (auto possible = check_outputs({{"--out", options.output}}, {{"FILE", options.file}}); !possible) return possible;
  const auto file = step::File::read(options.file);
  if (!file) return std::unexpected(file.error());
  std::vector<MeshSurface> surfaces;
  for (const step::SurfaceEntity& s : file->surfaces()) surfaces.push_back({s.name.empty() ? s.id : s.name, s.surface});
  MeshOptions mesh;
  mesh.detail = options.detail;
  mesh.unit = file->length_unit();
  const auto bytes = mesh_file(surfaces, *format, mesh);
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
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("mesh", "write the B-spline surfaces of a CAD file as triangles");
  command->add_option("FILE", options->file, "STEP file")->required()->type_name("");
  command->add_option("-o,--out", options->output, "mesh to write: name.stl, name.obj or name.ply")->required();
  command->add_option("--detail", options->detail, "grid lines per direction of each surface, 1 to 2000")
      ->capture_default_str();
  command->footer(
      "The mesh is a picture of the exact surfaces, each whole and untrimmed, in the file's units: a grid whose "
      "points\n"
      "lie on the surface, every knot line among its lines, counterclockwise seen from where S_u x S_v points. It "
      "need\n"
      "not be watertight. STL and PLY are binary.\n" +
      std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
