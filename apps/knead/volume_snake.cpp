#include "volume_snake.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "cli.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/image/snake_script.hpp"
#include "knead/image/volume.hpp"
#include "knead/session/command_json.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "outputs.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

Expected<VolumeSnakeScript> script_of(const SnakeArguments& options, const VolumeImage& volume) {
  if (options.script.empty()) return default_volume_snake_script(volume);
  const auto text = read_file(options.script);
  if (!text) return std::unexpected(text.error());
  auto script = parse_volume_snake_script(*text);
  if (script) return script;
  return std::unexpected(error_of_script(script.error(), *text, options.script));
}

/// The surfaces in any format that can be written anew, or their points as triangles.
Expected<std::string> surfaces_in(const std::vector<SurfaceSnakeResult>& snakes,
                                  const std::string& name) {
  auto format = format_of_name(name, FormatContent::surfaces);
  if (!format) format = format_of_name(name, FormatContent::triangles);
  if (!format) return std::unexpected(format.error());
  std::vector<NamedSurface> surfaces;
  for (std::size_t k = 0; k < snakes.size(); ++k) {
    auto surface = with_clamped_ends(snakes[k].snake.surface);
    if (!surface) return std::unexpected(surface.error());
    surfaces.push_back({fmt::format("snake {}", k), std::move(*surface)});
  }
  return save_surfaces(surfaces, **format, {.unit = "mm", .title = "active surfaces"});
}

bool is_json(const std::string& name) { return std::filesystem::path(name).extension() == ".json"; }

Expected<void> check_arguments(const SnakeArguments& options) {
  if (!options.output.empty() && !is_json(options.output)) {
    auto format = format_of_name(options.output, FormatContent::surfaces);
    if (!format) format = format_of_name(options.output, FormatContent::triangles);
    if (!format || ((*format)->content == FormatContent::surfaces && (*format)->save == nullptr)) {
      return usage_error(fmt::format("\"{}\" is no kind of surface to write", options.output),
                         "--output",
                         "name it .step, .json, " + list_of_endings(FormatContent::triangles));
    }
  }
  const std::string kind = std::filesystem::path(options.mask).extension().string();
  if (!options.mask.empty() && kind != ".nrrd") {
    return usage_error(fmt::format("\"{}\" is no kind of mask", kind), "--mask", "name it .nrrd");
  }
  return check_outputs({{"--output", options.output}, {"--mask", options.mask}},
                       {{"IMAGE", options.image}, {"--script", options.script}});
}

Expected<void> write_results(const std::vector<SurfaceSnakeResult>& snakes,
                             const SnakeArguments& options, const NrrdFile& file) {
  if (!options.output.empty()) {
    const auto bytes = is_json(options.output)
                           ? Expected<std::string>(volume_snakes_json(snakes, options.image))
                           : surfaces_in(snakes, options.output);
    if (!bytes) return std::unexpected(bytes.error());
    if (auto status = write_output(options.output, *bytes); !status) return status;
  }
  if (options.mask.empty()) return {};
  return write_output(options.mask,
                      nrrd_bytes(volume_snakes_mask(snakes, file.volume), file.header.space));
}

}  // namespace

Error of_script(Error error, const SnakeArguments& options) {
  if (error.kind == ErrorKind::usage) error.kind = ErrorKind::input;
  if (error.file.empty()) error.file = options.script.empty() ? options.image : options.script;
  return error;
}

std::string beside(const std::string& script, const std::string& file) {
  return (std::filesystem::path(script).parent_path() / file).string();
}

Expected<void> run_volume_snake(const SnakeArguments& options, std::string bytes) {
  if (auto checked = check_arguments(options); !checked) return checked;
  const auto file = nrrd_file(std::move(bytes), options.image);
  if (!file) return std::unexpected(file.error());
  const auto script = script_of(options, file->volume);
  if (!script) return std::unexpected(script.error());
  std::optional<VolumeImage> mask;
  if (!script->mask.empty()) {
    auto read = read_nrrd(beside(options.script, script->mask));
    if (!read) return std::unexpected(read.error());
    mask = std::move(read->volume);
  }
  const auto snakes = run_volume_snakes(file->volume, *script, mask);
  if (!snakes) return std::unexpected(of_script(snakes.error(), options));
  for (std::size_t k = 0; k < snakes->size(); ++k) {
    const SurfaceSnakeResult& s = (*snakes)[k];
    const int p = s.snake.surface.knots()[0].degree(), crossed = crossings(closed_mesh(s.snake));
    const bool torus = s.snake.form == SurfaceForm::torus;
    const SurfaceMeasure m = measure(s.snake);
    say("snake {}: {} x {} control points, {} iterations, {}, area {:.6g}, volume {:.6g}{}\n", k,
        s.snake.surface.net()[0] - p, s.snake.surface.net()[1] - (torus ? p : 0), s.iterations,
        s.converged ? "at rest" : "not at rest", m.area, m.volume,
        crossed > 0 ? fmt::format(", crosses itself ({} of triangles)",
                                  counted(static_cast<std::size_t>(crossed), "pair", "pairs"))
                    : "");
  }
  return write_results(*snakes, options, *file);
}

}  // namespace knead::cli
