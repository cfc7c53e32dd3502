#include <fmt/format.h>

#include <memory>
#include <optional>
#include <ranges>

#include "cad_input.hpp"
#include "cli.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/save_model.hpp"
#include "knead/exchange/source.hpp"
#include "left_out_lines.hpp"
#include "outputs.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

struct ExportArguments {
  std::string file, output, unit;
  std::optional<std::string> schema;
  bool sets = false, convert = false;
  UnpackOption unpack;
};

/// The unit that is written: the one of the file or, where it has none, the one that is asked for.
Expected<std::string> unit_of(const std::string& unit, const ExportArguments& options) {
  const bool known = !unit.empty() && unit != "unknown";
  if (known && !options.unit.empty() && options.unit != unit) {
    return usage_error(
        fmt::format("{} is in {}, whose numbers are written as they are", options.file, unit),
        "--unit", "leave it out: it is for files that do not say what their lengths are");
  }
  if (known) return unit;
  if (!options.unit.empty()) return options.unit;
  say("lengths are written as millimetres: {} does not say what they are; --unit says so\n",
      options.file);
  return "mm";
}

/// The one unit of all surfaces and curves of the file.
Expected<std::string> unit_of(const Source& source, const ExportArguments& options) {
  std::string unit;
  const auto takes = [&](const std::string& shape_unit) -> Expected<void> {
    if (!unit.empty() && unit != shape_unit) {
      return input_error(fmt::format("its shapes are in {} and in {}, and a new file has one unit",
                                     unit, shape_unit),
                         {}, "give their lengths one unit in the program that made the file");
    }
    unit = shape_unit;
    return {};
  };
  for (const SourceSurface& s : source.surfaces()) {
    if (auto taken = takes(s.unit); !taken) return std::unexpected(taken.error());
  }
  for (const SourceCurve& c : source.curves()) {
    if (auto taken = takes(c.unit); !taken) return std::unexpected(taken.error());
  }
  return unit_of(unit, options);
}

Expected<void> write(const Format& format, std::string bytes, const ExportArguments& options,
                     const std::vector<LeftOut>& left_out, const std::string& content) {
  auto packed = compressed_by_name(std::move(bytes), options.output, options.file);
  if (!packed) return std::unexpected(std::move(packed.error()));
  if (auto status = write_output(options.output, *packed); !status) return status;
  warn_left_out(left_out);
  say("wrote {} ({}, {}, {} bytes)\n", options.output, format.name, content, packed->size());
  return {};
}

/// Why a new file could not be made: a unit that it does not know is the option's, all else the
/// file's.
std::unexpected<Error> failed(Error error, const ExportArguments& options) {
  if (error.where == "unit" && !options.unit.empty())
    return usage_error(error.what, "--unit", error.remedy);
  if (error.file.empty()) error.file = options.file;
  return std::unexpected(std::move(error));
}

/// Faces with their trims.
Expected<void> export_faces(const Source& source, const Format& format,
                            const ExportArguments& options) {
  const auto& assembly = source.model()->assembly;
  const auto unit = unit_of(assembly ? assembly->unit : source.model()->length_unit(), options);
  if (!unit) return std::unexpected(unit.error());
  SaveOptions how;
  if (options.schema) how.schema = *options.schema;
  how.unit = *unit;
  auto made = save_faces(source, format, how, options.convert);
  if (!made) return failed(std::move(made.error()), options);
  std::string content = counted(made->faces, "face", "faces");
  const auto add = [&](std::size_t count, const char* one, const char* many) {
    if (count > 0) content += ", " + counted(count, one, many);
  };
  add(made->solids, "solid", "solids");
  add(made->surfaces, "whole surface", "whole surfaces");
  add(made->curves, "curve", "curves");
  return write(format, std::move(made->bytes), options, made->left_out, content);
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
    return usage_error(
        fmt::format("new files with the name \"{}\" cannot be written", options.output), "--out",
        "use a name that ends in one of " + endings);
  }
  if (options.schema && (*format)->id != "step") {
    return usage_error("this does not write a STEP file", "--schema", "leave it out");
  }
  if (auto possible = check_outputs({{"--out", options.output}}, {{"FILE", options.file}});
      !possible)
    return possible;
  const auto source = open_cad_file(options.file, options.unpack);
  if (!source) return std::unexpected(source.error());
  const auto model = (*source)->model();
  const bool faces =
      !options.sets && holds_faces(**format) && model != nullptr && !model->faces.empty();
  if (faces) return export_faces(**source, **format, options);
  if (options.convert) {
    return usage_error("only faces are converted", "--convert",
                       options.sets ? "leave out --sets" : "leave it out: no faces are written");
  }

  const auto colours = (*source)->colours();
  std::vector<NamedSurface> surfaces;
  SaveOptions how;
  if (options.schema) how.schema = *options.schema;
  how.faces = !options.sets;
  for (const SourceSurface& s : (*source)->surfaces()) {
    NamedSurface& made =
        surfaces.emplace_back(NamedSurface{s.name.empty() ? s.id : s.name, *s.surface});
    if (const auto colour = colours.find(s.id); colour != colours.end())
      made.colour = colour->second;
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
      if (without_face.ids.size() < LeftOut::most_ids)
        without_face.ids.push_back((*source)->surfaces()[k].id);
    }
    for (const std::size_t k : std::views::reverse(*left))
      surfaces.erase(surfaces.begin() + static_cast<std::ptrdiff_t>(k));
  }
  auto bytes = save_surfaces(surfaces, **format, how);
  if (!bytes) return failed(std::move(bytes.error()), options);
  auto left_out = left_out_of_surfaces(**source, **format);
  if (without_face.count > 0) left_out.push_back(std::move(without_face));
  return write(**format, *std::move(bytes), options, left_out,
               counted(surfaces.size(), "surface", "surfaces"));
}

}  // namespace

Action add_export(CLI::App& app) {
  auto options = std::make_shared<ExportArguments>();
  CLI::App* command =
      app.add_subcommand("export", "write the faces of a CAD file as a new STEP or IGES file");
  command->add_option("FILE", options->file, cad_file_help())->required()->type_name("");
  command
      ->add_option(
          "-o,--out", options->output,
          "new file; the ending selects the format: STEP or IGES, compressed with .stpZ or .gz")
      ->required();
  command->add_option("--schema", options->schema, "of a STEP file: ap214 or ap242")
      ->check(CLI::IsMember({"ap214", "ap242"}))
      ->default_str("ap214");
  command->add_option("--unit", options->unit,
                      "of lengths, where FILE does not say it: mm, inch, …; without it mm");
  command->add_flag(
      "--convert", options->convert,
      "make planes, cylinders, cones, spheres, tori and swept surfaces B-spline surfaces, exactly");
  command->add_flag("--sets", options->sets,
                    "write bare B-spline surfaces, without faces, edges and shells");
  options->unpack.add_to(*command);
  command->footer(
      "Faces with their trims: surfaces, edges and vertices, which neighbours share; closed shells "
      "as solids with "
      "their\n"
      "hollows; parts of assemblies in their places; names and colours. Control points, knots and "
      "weights are the\n"
      "same bits. B-spline surfaces without faces become one each, on their natural bounds. What "
      "cannot be written\n"
      "is named with its reason; `knead sculpt` keeps everything else of a file.\n" +
      std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
