#include "knead/image/snake.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>

#include "cli.hpp"
#include "image_file.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/image/snake_script.hpp"
#include "knead/image/volume.hpp"
#include "knead/session/command_json.hpp"
#include "outputs.hpp"
#include "say.hpp"
#include "volume_snake.hpp"

namespace knead::cli {
namespace {

Expected<SnakeScript> script_in(const SnakeArguments& options) {
  const auto text = read_file(options.script);
  if (!text) return std::unexpected(text.error());
  auto script = parse_snake_script(*text);
  if (script) return script;
  return std::unexpected(error_of_script(script.error(), *text, options.script));
}

Expected<void> write_results(const std::vector<SnakeResult>& snakes, const SnakeArguments& options,
                             const Image& image) {
  if (!options.output.empty()) {
    const std::string ending = std::filesystem::path(options.output).extension().string();
    const std::string text = ending == ".csv" ? snakes_csv(snakes)
                             : ending == ".svg"
                                 ? snakes_svg(snakes, image.width, image.height)
                                 : snakes_json(snakes, options.image, image.width, image.height);
    if (auto status = write_output(options.output, text); !status) return status;
  }
  if (options.mask.empty()) return {};
  const auto bytes = png_of(snakes_mask(snakes, image.width, image.height));
  if (!bytes) return std::unexpected(bytes.error());
  return write_output(options.mask, *bytes);
}

Expected<void> run_image_snake(const SnakeArguments& options, std::string_view bytes) {
  const std::string ending = std::filesystem::path(options.output).extension().string();
  if (!options.output.empty() && ending != ".json" && ending != ".csv" && ending != ".svg") {
    return usage_error(fmt::format("\"{}\" is no kind of contour", ending), "--output",
                       "name it .json, .csv or .svg");
  }
  const std::string kind = std::filesystem::path(options.mask).extension().string();
  if (!options.mask.empty() && kind != ".png") {
    return usage_error(fmt::format("\"{}\" is no kind of mask", kind), "--mask", "name it .png");
  }
  if (auto checked = check_outputs({{"--output", options.output}, {"--mask", options.mask}},
                                   {{"IMAGE", options.image}, {"--script", options.script}});
      !checked) {
    return checked;
  }
  Expected<SnakeScript> script;
  if (!options.script.empty()) script = script_in(options);
  if (!script) return std::unexpected(script.error());
  const auto image = image_in(bytes, options.image, script->channel);
  if (!image) return std::unexpected(image.error());
  if (options.script.empty()) script = default_snake_script(*image);
  std::optional<Image> mask;
  if (!script->mask.empty()) {
    auto read = read_image(beside(options.script, script->mask));
    if (!read) return std::unexpected(read.error());
    mask = std::move(*read);
  }
  const std::clock_t begin = std::clock();
  const auto potential = ImagePotential::create(*image, script->image, mask);
  if (!potential) return std::unexpected(of_script(potential.error(), options));
  const std::clock_t made = std::clock();
  const auto snakes = run_image_snakes(*potential, *script, *image);
  if (!snakes) return std::unexpected(of_script(snakes.error(), options));
  const auto seconds = [](std::clock_t ticks) { return double(ticks) / CLOCKS_PER_SEC; };
  say("{:.4f} s for the energy of the image, {:.4f} s for the contours\n", seconds(made - begin),
      seconds(std::clock() - made));
  for (std::size_t k = 0; k < snakes->size(); ++k) {
    const SnakeResult& s = (*snakes)[k];
    const int crossed = crossings(s);
    say("snake {}: {} control points, {} iterations, {}{}\n", k,
        s.curve.size() - (s.closed ? s.curve.knots()[0].degree() : 0), s.iterations,
        s.converged ? "at rest" : "not at rest",
        crossed > 0 ? fmt::format(", crosses itself at {}",
                                  counted(static_cast<std::size_t>(crossed), "place", "places"))
                    : "");
  }
  return write_results(*snakes, options, *image);
}

/// What is read says what it is: a pipe cannot be opened a second time.
Expected<void> run(const SnakeArguments& options) {
  auto bytes = read_file(options.image);
  if (!bytes) return std::unexpected(bytes.error());
  if (is_nrrd(*bytes)) return run_volume_snake(options, *std::move(bytes));
  return run_image_snake(options, *bytes);
}

}  // namespace

Action add_snake(CLI::App& app) {
  auto options = std::make_shared<SnakeArguments>();
  CLI::App* command = app.add_subcommand(
      "snake", "find contours in an image, or surfaces in a volume, by active B-splines");
  command->add_option("IMAGE", options->image, "PNG or JPEG file; or a volume (raw NRRD)")
      ->required()
      ->type_name("");
  command->add_option("--script,-s", options->script,
                      "JSON: energies, settings and where snakes start (default: one around nearly "
                      "all of the image)");
  command->add_option(
      "--output,-o", options->output,
      "contours: .json, .csv or .svg; surfaces: .step, .json or triangles (.stl, .obj)");
  command->add_option(
      "--mask", options->mask,
      "PNG file for what is inside of closed contours, white on black; NRRD file in volumes");
  command->footer(
      "docs/snakes.md and docs/voxels.md explain the energies and the fields of a script.\n" +
      std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
