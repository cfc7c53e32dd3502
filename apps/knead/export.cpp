#include <fmt/format.h>

#include <memory>
#include <ranges>

#include "cad_input.hpp"
#include "cli.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/left_out.hpp"
#include "left_out_lines.hpp"
#include "outputs.hpp"

namespace knead::cli {
namespace {

struct ExportArguments {
  std::string file, output, schema = "ap214", unit;
  bool sets = false;
  UnpackOption unpack;
};

/// The unit of what is written: the one of all shapes of the file or, where it has none, the one that is asked for.
Expected<std::string> unit_of(const Source& source, const ExportArguments& options) {
  std::string unit;
  const auto takes = [&](const std::string& own) -> Expected<void> {
    if (!unit.empty() && unit != own) {
      return input_error(fmt::format("its shapes are in {} and in {}, and a new file has one unit", unit, own), {},
                         "give their lengths one unit in the program that made the file");
    }
    unit = own;
    return {};
  };
  for (const SourceSurface& s : source.surfaces()) {
    if (auto taken = takes(s.unit); !taken) return std::unexpected(taken.error());
  }
  for (const SourceCurve& c : source.curves()) {
    if (auto taken = takes(c.unit); !taken) return std::unexpected(taken.error());
  }
  const bool known = !unit.empty() && unit != "unknown";
  if (known && !options.unit.empty() && options.unit != unit) {
    return usage_error(fmt::format("{} is in {}, whose numbers are written as they are", options.file, unit), "--unit",
                       "leave it out: it is for files that do not say what their lengths are");
  }
  if (known) return unit;
  if (!options.unit.empty()) return options.unit;
  fmt::print("lengths are written as millimetres: {} does not say what they are; --unit says so\n", options.file);
  return "mm";
}

Expected<void> run(const ExportArguments& options) {
  const auto format = format_of_name(options.output, FormatContent::surfaces);
  if (!format || (*format)->save == nullptr) {
    std::string endings;
    for (const Format& known : formats()) {
      if (known.save == nullptr) continue;
      for (const std::string_view ending : known.endings)
        endings += (endings.empty() ? "" : ", ") + std::string(ending);
    }
    return usage_error(fmt::format("new files with the name \"{}\" cannot be written", options.output), "--out",
                       "use a name that ends in one of " + endings);
  }
  if (auto possible = check_outputs({{"--out", options.output}}, {{"FILE", options.file}}); !possible) return possible;
  const auto source = open_cad_file(options.file, options.unpack);
  if (!source) return std::unexpected(source.error());

  const auto colours = (*source)->colours();
  std::vector<NamedSurface> surfaces;
  SaveOptions how;
  how.schema = options.schema;
  how.faces = !options.sets;
  for (const SourceSurface& s : (*source)->surfaces()) {
    NamedSurface& made = surfaces.emplace_back(NamedSurface{s.name.empty() ? s.id : s.name, *s.surface});
    if (const auto colour = colours.find(s.id); colour != colours.end()) made.colour = colour->second;
  }
  for (const SourceCurve& c : (*source)->curves()) {
    how.curves.push_back({c.name.empty() ? c.id : c.name, *c.curve});
  }
  auto unit = unit_of(**source, options);
  if (!unit) {
    if (unit.error().kind != ErrorKind::usage) unit.error().file = options.file;
    return std::unexpected(std::move(unit.error()));
  }
  how.unit = *std::move(unit);
  LeftOut without_face{"surface", "surfaces", 0, "all its sides are points, so that it has no face",
                       "write it bare, with --sets"};
  if (how.faces) {
    const auto left = without_faces(surfaces);
    if (!left) return std::unexpected(left.error());
    for (const std::size_t k : *left) {
      ++without_face.count;
      if (without_face.ids.size() < LeftOut::most_ids) without_face.ids.push_back((*source)->surfaces()[k].id);
    }
    for (const std::size_t k : std::views::reverse(*left))
      surfaces.erase(surfaces.begin() + static_cast<std::ptrdiff_t>(k));
  }
  auto bytes = save_surfaces(surfaces, **format, how);
  if (!bytes) {
    bytes.error().file = options.file;
    return std::unexpected(std::move(bytes.error()));
  }
  bytes = compressed_by_name(*std::move(bytes), options.output, options.file);
  if (!bytes) return std::unexpected(std::move(bytes.error()));
  if (auto done = write_file_atomically(options.output, *bytes); !done) return done;
  auto left_out = left_out_of_surfaces(**source, **format);
  if (without_face.count > 0) left_out.push_back(std::move(without_face));
  warn_left_out(left_out);
  fmt::print("wrote {} ({}, {}, {} bytes)\n", options.output, (*format)->name,
             counted(surfaces.size(), "surface", "surfaces"), bytes->size());
  return {};
}

}  // namespace

Action add_export(CLI::App& app) {
  auto options = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", "write the surfaces of a CAD file as a new STEP or IGES file");
  command->add_option("FILE", options->file, cad_file_help())->required()->type_name("");
  command
      ->add_option("-o,--out", options->output,
                   "new file; the ending selects the format: STEP or IGES, compressed with .stpZ or .gz")
      ->required();
  command->add_option("--schema", options->schema, "of a STEP file: ap214 or ap242")
      ->check(CLI::IsMember({"ap214", "ap242"}))
      ->capture_default_str();
  command->add_option("--unit", options->unit, "of lengths, where FILE does not say it: mm, inch, …; without it mm");
  command->add_flag("--sets", options->sets, "write bare surfaces, without faces, edges and shells");
  options->unpack.add_to(*command);
  command->footer(
      "Every B-spline surface, whole, as a face on its natural bounds with its name and colour; sides that are the\n"
      "same curve become one edge, and faces that share edges a shell. Control points, knots and weights are the\n"
      "same bits. Faces that cut a surface, other surfaces, assemblies and everything else are not written, which\n"
      "warnings say: `knead sculpt` keeps them.\n" +
      std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
