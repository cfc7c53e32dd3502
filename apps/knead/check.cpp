#include <fmt/format.h>

#include <memory>
#include <utility>

#include "cad_input.hpp"
#include "check_text.hpp"
#include "cli.hpp"
#include "knead/brep/edge_measures.hpp"
#include "knead/exchange/file_info.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/source.hpp"
#include "outputs.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

struct CheckArguments {
  std::string file, against, edges, junit;
  EdgeCheckRequest check;
  bool json = false;
  UnpackOption unpack;
};

/// What is wrong with a threshold is wrong with the option of its name.
Error of_options(Error error) {
  if (error.kind != ErrorKind::usage) return error;
  error.where = "--" + error.where;
  return error;
}

/// The exit code.
Expected<int> run(const CheckArguments& options) {
  if (auto outputs = check_outputs({{"--junit", options.junit}},
                                   {{"FILE", options.file}, {"--against", options.against}});
      !outputs)
    return std::unexpected(outputs.error());
  const auto source = open_cad_file(options.file, options.unpack);
  if (!source) return std::unexpected(source.error());
  std::shared_ptr<const Source> old;
  if (!options.against.empty()) {
    auto opened = open_cad_file(options.against, options.unpack);
    if (!opened) return std::unexpected(opened.error());
    old = *std::move(opened);
  }
  EdgeCheckRequest check = options.check;
  check.edges = items_of(options.edges, ", ");
  const auto report = check_edges(**source, check, old.get());
  if (!report) return std::unexpected(of_options(report.error()));
  if (!options.junit.empty()) {
    if (auto written = write_output(options.junit, brep::check_junit(*report)); !written)
      return std::unexpected(written.error());
  }
  if (options.json) {
    say("{}\n", brep::check_json(*report));
  } else {
    say("{}", check_text(*report));
  }
  return report->passed ? 0 : 1;
}

}  // namespace

Action add_check(CLI::App& app) {
  auto options = std::make_shared<CheckArguments>();
  CLI::App* command = app.add_subcommand("check", "measure how the faces at edges meet, and judge");
  command->add_option("FILE", options->file, cad_file_help())->required()->type_name("");
  command->add_option("--against", options->against,
                      "an earlier version of FILE: only what is worse by more than the thresholds "
                      "counts");
  command->add_option("--gap", options->check.gap, "largest gap, in the file's units");
  command->add_option("--angle", options->check.angle,
                      "largest angle of edges that are meant to be smooth, degrees up to 5");
  command->add_option("--curvature", options->check.curvature,
                      "largest relative difference in curvature there, percent");
  command
      ->add_option("--class", options->check.grade,
                   "gap and angle of a class: a 0.01 mm and 0.1 degrees, b 0.02 mm and 0.2, c 0.05 "
                   "mm and 0.5")
      ->check(CLI::IsMember({"a", "b", "c"}));
  command->add_option("--edges", options->edges, "only these, by id: \"#1,#2\"");
  command->add_option(
      "--unit", options->check.unit,
      "what the file's coordinates are in, where it does not say so: " + list_of_length_units());
  command->add_flag("--json", options->json, "print JSON, with all edges (docs/check.md)");
  command->add_option("--junit", options->junit, "JUnit report to write, for build servers");
  options->unpack.add_to(*command);
  command->footer(
      "Of every edge: the gap between its faces, the angle between their normals, and the "
      "difference of their\n"
      "curvatures across it, each where it is largest. An edge is meant to be smooth if the angle "
      "is below 5 degrees\n"
      "all along; others have no threshold but the gap.\n"
      "Exit codes: 0 success, 1 a threshold is exceeded, 2 wrong usage, 3 bad input, 4 numerical "
      "failure.");
  return [options] { return run(*options); };
}

}  // namespace knead::cli
