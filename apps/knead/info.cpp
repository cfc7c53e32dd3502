#include "knead/exchange/file_info.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "cad_input.hpp"
#include "cli.hpp"
#include "faces.hpp"
#include "info_text.hpp"
#include "knead/base/printable.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/session/session_info.hpp"
#include "knead_document.hpp"
#include "progress.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

struct InfoArguments {
  std::string file;
  bool json = false, faces = false;
  UnpackOption unpack;
};

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
  say("{}", info_text(info));
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
