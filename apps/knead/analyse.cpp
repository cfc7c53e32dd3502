#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cli.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/session/report.hpp"
#include "outputs.hpp"
#include "run_script.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

struct AnalyseArguments {
  std::string file, script, results, vtu;
  bool fresh = false;
  UnpackOption unpack;
  int samples = 41;
};

void print_summary(const AnalyseArguments& options, const Session& session,
                   std::span<const FieldGrid> grids) {
  for (const FieldGrid& grid : grids) {
    say("{}: surface {}\n", options.fresh ? options.script : options.file, grid.name);
    for (const GridField& field : grid.fields) {
      if (field.name != "von_mises") continue;
      say("  von Mises stress up to {:.6g}\n", *std::ranges::max_element(field.values));
    }
  }
  for (const ModeRecord& mode : session.modes()) say("  frequency {:.6g}\n", mode.value);
  for (const ModeRecord& mode : session.buckling())
    say("  buckles at {:.6g} times the load\n", mode.value);
}

Expected<void> run(const AnalyseArguments& options) {
  const NamedFile file{"FILE", options.file}, script{"--script", options.script};
  if (auto possible =
          check_outputs({{"--results", options.results}, {"--vtu", options.vtu}}, {file, script});
      !possible) {
    return possible;
  }
  if (auto fields = check_name({"--vtu", options.vtu}, ".vtu", "a VTU file"); !fields)
    return fields;
  if (auto one = check_source(options.file, options.fresh); !one) return one;
  if (options.samples < 2 || options.samples > 1000) {
    return usage_error(fmt::format("{} samples", options.samples), "--samples", "use 2 to 1000");
  }
  const auto commands = read_script(options.script);
  if (!commands) return std::unexpected(commands.error());
  auto document = open_document(options.file, options.fresh, options.unpack);
  if (!document) return std::unexpected(document.error());
  Session session(std::move(*document));
  if (auto status = execute(session, *commands); !status) return std::unexpected(status.error());
  if (session.selection().empty())
    return input_error("no surface is selected", options.script, "select one");
  const auto grids = result_grids(session, options.samples);
  if (!grids) return std::unexpected(grids.error());
  const auto json = analysis_json(session, *grids);
  if (!json) return std::unexpected(json.error());
  print_summary(options, session, *grids);
  if (!options.vtu.empty()) {
    if (auto status = write_output(options.vtu, vtu_text(*grids)); !status) return status;
    say("wrote {}\n", options.vtu);
  }
  if (auto status = write_output(options.results, *json); !status) return status;
  say("wrote {}\n", options.results);
  return {};
}

}  // namespace

Action add_analyse(CLI::App& app) {
  auto options = std::make_shared<AnalyseArguments>();
  CLI::App* command = app.add_subcommand(
      "analyse", "run a script and write stresses, reactions, modes and buckling loads");
  command->add_option("FILE", options->file, "CAD file to analyse; it is not changed")
      ->type_name("");
  command->add_flag("--new", options->fresh,
                    "start without a FILE: the script makes surfaces with the command new");
  command->add_option("--script", options->script, "JSON file with the commands, as for sculpt")
      ->required();
  command->add_option("--results", options->results, "JSON file for the results, see below")
      ->required();
  command->add_option("--vtu", options->vtu, "VTU file with the same fields, for ParaView");
  command->add_option("--samples", options->samples, "points per direction of each surface")
      ->capture_default_str();
  options->unpack.add_to(*command);
  command->footer(
      R"(The results, of the selected surfaces:
{"surfaces": [{"id", "counts", "points", "displacement",
               of shells "membrane", "moment", "von_mises", "bending_strain",
               after modes and buckling "mode_1", ..., "buckling_1", ...}],
 "reactions": [{"hold", "force"}], "modes": [{"frequency", "residual"}],
 "buckling": [{"load_factor", "residual"}]}
Fields are lists of numbers, point after point, the last direction fastest: displacements from
the rest shape, principal membrane forces and bending moments, von Mises stresses on both faces,
the largest strain that bending adds. Units are those of the script.
)" + std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
