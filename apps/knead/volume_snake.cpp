#include "volume_snake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/nrrd.hpp"
#include "knead/session/script_error.hpp"
#include "knead/session/volume_snake_script.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "outputs.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

/// The same surface with clamped ends, which every program reads: knots repeated where it closes.
Expected<Surface> clamped(const Surface& surface) {
  std::array<std::vector<double>, 2> ends;
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& knots = surface.knots()[d];
    if (knots.clamped()) continue;
    for (const double end : {knots.domain().lower, knots.domain().upper}) {
      ends[d].insert(ends[d].end(), static_cast<std::size_t>(knots.degree() + 1 - knots.multiplicity(end)), end);
    }
  }
  const auto inserted = insert_knots<2>(surface, ends);
  if (!inserted) return std::unexpected(inserted.error());
  // What lies outside of the domain has no support in it.
  std::array<KnotVector, 2> knots = inserted->knots();
  std::array<int, 2> first = {0, 0}, count = {0, 0};
  for (std::size_t d = 0; d < 2; ++d) {
    const auto all = inserted->knots()[d].knots();
    const Interval domain = surface.knots()[d].domain();
    std::vector<double> inside;
    for (const double x : all) {
      if (domain.contains(x)) inside.push_back(x);
    }
    first[d] = static_cast<int>(std::ranges::lower_bound(all, domain.lower) - all.begin());
    auto made = KnotVector::create(knots[d].degree(), std::move(inside));
    if (!made) return std::unexpected(made.error());
    knots[d] = std::move(*made);
    count[d] = knots[d].count();
  }
  Points points(count[0] * count[1], 3);
  for (int i = 0; i < count[0]; ++i) {
    points.middleRows(i * count[1], count[1]) =
        inserted->control_points().middleRows((i + first[0]) * inserted->net()[1] + first[1], count[1]);
  }
  return Surface::create(std::move(knots), std::move(points));
}

Expected<VolumeSnakeScript> script_of(const SnakeArguments& options, const VolumeImage& volume) {
  if (options.script.empty()) return default_volume_snake_script(volume);
  const auto text = read_file(options.script);
  if (!text) return std::unexpected(text.error());
  auto script = parse_volume_snake_script(*text);
  if (script) return script;
  return std::unexpected(error_of_script(script.error(), *text, options.script));
}

std::string list_of(std::span<const double> numbers) {
  std::string text;
  for (const double x : numbers) text += (text.empty() ? "" : ",") + json_number(x);
  return "[" + text + "]";
}

std::string json_of(const std::vector<SurfaceSnakeResult>& snakes, const SnakeArguments& options) {
  std::string text = fmt::format("{{\"volume\":{},\"snakes\":[", nlohmann::json(options.image).dump());
  for (std::size_t k = 0; k < snakes.size(); ++k) {
    const SurfaceSnakeResult& s = snakes[k];
    const Surface& surface = s.snake.surface;
    const SurfaceMeasure m = measure(s.snake);
    text += fmt::format("{}\n{{\"form\":\"{}\",\"degree\":[{},{}],\"iterations\":{},\"converged\":{},\"crossings\":{},",
                        k > 0 ? "," : "", s.snake.form == SurfaceForm::torus ? "torus" : "sphere",
                        surface.knots()[0].degree(), surface.knots()[1].degree(), s.iterations, s.converged,
                        crossings(closed_mesh(s.snake)));
    text += fmt::format("\"area\":{},\"volume\":{},\"knots\":[{},{}],\"net\":[{},{}],\"control_points\":[",
                        json_number(m.area), json_number(m.volume), list_of(surface.knots()[0].knots()),
                        list_of(surface.knots()[1].knots()), surface.net()[0], surface.net()[1]);
    for (Eigen::Index i = 0; i < surface.size(); ++i) {
      const std::array<double, 3> p = {surface.control_points()(i, 0), surface.control_points()(i, 1),
                                       surface.control_points()(i, 2)};
      text += (i > 0 ? "," : "") + list_of(p);
    }
    text += "]}";
  }
  return text + "]}\n";
}

/// The surfaces in any format that can be written anew, or their points as triangles.
Expected<std::string> surfaces_in(const std::vector<SurfaceSnakeResult>& snakes, const std::string& name) {
  auto format = format_of_name(name, FormatContent::surfaces);
  if (!format) format = format_of_name(name, FormatContent::triangles);
  if (!format) return std::unexpected(format.error());
  std::vector<NamedSurface> surfaces;
  for (std::size_t k = 0; k < snakes.size(); ++k) {
    auto surface = clamped(snakes[k].snake.surface);
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
      return usage_error(fmt::format("\"{}\" is no kind of surface to write", options.output), "--output",
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

Expected<void> write_results(const std::vector<SurfaceSnakeResult>& snakes, const SnakeArguments& options,
                             const NrrdFile& file) {
  if (!options.output.empty()) {
    const auto bytes =
        is_json(options.output) ? Expected<std::string>(json_of(snakes, options)) : surfaces_in(snakes, options.output);
    if (!bytes) return std::unexpected(bytes.error());
    if (auto done = write_output(options.output, *bytes); !done) return done;
  }
  if (options.mask.empty()) return {};
  VolumeImage all{file.volume.size, std::vector<double>(file.volume.values.size(), 0), file.volume.frame};
  for (const SurfaceSnakeResult& s : snakes) {
    const VolumeImage one = mask_of(closed_mesh(s.snake), all.size, all.frame);
    for (std::size_t k = 0; k < all.values.size(); ++k) all.values[k] = std::max(all.values[k], one.values[k]);
  }
  return write_output(options.mask, nrrd_bytes(all, file.header.space));
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
