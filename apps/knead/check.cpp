#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

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
  std::string file, against, edges, unit, junit, grade;
  std::optional<double> gap, angle, curvature;
  bool json = false;
  UnpackOption unpack;
};

/// What `--class` asks for: mm and degrees.
struct Grade {
  const char* name;
  double gap, angle;
};
constexpr Grade grades[] = {{"a", 0.01, 0.1}, {"b", 0.02, 0.2}, {"c", 0.05, 0.5}};

Expected<void> check_number(const std::optional<double>& value, const char* option, double most,
                            const char* remedy) {
  if (!value || (*value >= 0 && *value <= most && std::isfinite(*value))) return {};
  return usage_error(fmt::format("{} is no threshold", *value), option, remedy);
}

/// mm in a unit of the file.
Expected<double> millimetres_in(const std::string& unit, const CheckArguments& options) {
  const auto known = millimetres_of(unit);
  if (!options.unit.empty()) {
    if (known && options.unit != unit) {
      return usage_error(fmt::format("the file is in {}", unit), "--unit", "leave it out");
    }
    const auto given = millimetres_of(options.unit);
    if (given) return *given;
    return usage_error("there is no unit \"" + options.unit + "\"", "--unit",
                       "use " + list_of_length_units());
  }
  if (known) return *known;
  return usage_error(
      unit == "unknown" ? "the length unit of the file is unknown"
                        : fmt::format("the file has no single known length unit, but {}", unit),
      "--class", "say with --unit what its coordinates are in: " + list_of_length_units());
}

Expected<brep::EdgeThresholds> thresholds_of(const Source& source, const CheckArguments& options) {
  brep::EdgeThresholds thresholds{options.gap, options.angle, options.curvature};
  for (const Grade& grade : grades) {
    if (options.grade != grade.name) continue;
    const auto unit = millimetres_in(unit_of(source), options);
    if (!unit) return std::unexpected(unit.error());
    if (!thresholds.gap) thresholds.gap = grade.gap / *unit;
    if (!thresholds.angle) thresholds.angle = grade.angle;
  }
  return thresholds;
}

std::vector<std::string> ids_in(const std::string& list) {
  std::vector<std::string> ids;
  std::string id;
  for (const char c : list + ",") {
    if (c != ',' && c != ' ') {
      id += c;
    } else if (!id.empty()) {
      ids.push_back(std::exchange(id, {}));
    }
  }
  return ids;
}

Expected<brep::ModelMeasures> measures_of(const Source& source,
                                          const brep::EdgeTolerances& tolerances,
                                          const std::vector<std::string>& ids) {
  const auto model = source.model();
  if (!model) {
    if (!ids.empty())
      return usage_error(fmt::format("a {} file has no edges", source.format()), "--edges",
                         "leave it out");
    return brep::ModelMeasures{};
  }
  return of_option(brep::measure_edges(*model, tolerances, ids), "--edges");
}

Expected<void> check_options(const CheckArguments& options) {
  constexpr double any = std::numeric_limits<double>::max();
  if (auto right = check_number(options.gap, "--gap", any, "use a length from 0 on"); !right)
    return right;
  if (auto right = check_number(options.angle, "--angle", brep::meant_smooth,
                                "use degrees from 0 to 5: edges with larger angles are not meant "
                                "to be smooth");
      !right)
    return right;
  if (auto right = check_number(options.curvature, "--curvature", 100, "use percent from 0 to 100");
      !right)
    return right;
  const bool judged = options.gap || options.angle || options.curvature || !options.grade.empty();
  if (!options.against.empty() && !judged) {
    return usage_error("without thresholds nothing is worse", "--against",
                       "give --gap, --angle, --curvature or --class too");
  }
  if (!options.unit.empty() && options.grade.empty())
    return usage_error("thresholds of a class alone need it", "--unit", "give --class too");
  return check_outputs({{"--junit", options.junit}},
                       {{"FILE", options.file}, {"--against", options.against}});
}

/// The exit code.
Expected<int> run(const CheckArguments& options) {
  if (auto right = check_options(options); !right) return std::unexpected(right.error());
  const auto source = open_cad_file(options.file, options.unpack);
  if (!source) return std::unexpected(source.error());
  const auto thresholds = thresholds_of(**source, options);
  if (!thresholds) return std::unexpected(thresholds.error());
  brep::EdgeTolerances tolerances{.gap = thresholds->gap};
  if (thresholds->angle) tolerances.angle = *thresholds->angle;
  if (thresholds->curvature) tolerances.curvature = *thresholds->curvature;
  auto measures = measures_of(**source, tolerances, ids_in(options.edges));
  if (!measures) return std::unexpected(measures.error());
  brep::EdgeCheckReport report{.file = options.file,
                               .format = std::string((*source)->format()),
                               .unit = options.unit.empty() ? unit_of(**source) : options.unit,
                               .against = options.against,
                               .thresholds = *thresholds,
                               .size = measures->size,
                               .gap_tolerance = measures->gap_tolerance,
                               .angle_tolerance = tolerances.angle,
                               .curvature_tolerance = tolerances.curvature};
  if (options.against.empty()) {
    report.faults = brep::faults_of(*measures, *thresholds);
  } else {
    const auto old = open_cad_file(options.against, options.unpack);
    if (!old) return std::unexpected(old.error());
    const auto before = measures_of(**old, tolerances, {});
    if (!before) return std::unexpected(before.error());
    report.faults = brep::faults_against(*measures, *before, *thresholds);
  }
  report.edges = std::move(measures->edges);
  report.counts = brep::counts_of(report.edges);
  report.passed = report.faults.empty();
  if (!options.junit.empty()) {
    if (auto written = write_output(options.junit, brep::check_junit(report)); !written)
      return std::unexpected(written.error());
  }
  if (options.json) {
    say("{}\n", brep::check_json(report));
  } else {
    say("{}", check_text(report));
  }
  return report.passed ? 0 : 1;
}

}  // namespace

Action add_check(CLI::App& app) {
  auto options = std::make_shared<CheckArguments>();
  CLI::App* command = app.add_subcommand("check", "measure how the faces at edges meet, and judge");
  command->add_option("FILE", options->file, cad_file_help())->required()->type_name("");
  command->add_option("--against", options->against,
                      "an earlier version of FILE: only what is worse by more than the thresholds "
                      "counts");
  command->add_option("--gap", options->gap, "largest gap, in the file's units");
  command->add_option("--angle", options->angle,
                      "largest angle of edges that are meant to be smooth, degrees up to 5");
  command->add_option("--curvature", options->curvature,
                      "largest relative difference in curvature there, percent");
  command
      ->add_option("--class", options->grade,
                   "gap and angle of a class: a 0.01 mm and 0.1 degrees, b 0.02 mm and 0.2, c 0.05 "
                   "mm and 0.5")
      ->check(CLI::IsMember({"a", "b", "c"}));
  command->add_option("--edges", options->edges, "only these, by id: \"#1,#2\"");
  command->add_option(
      "--unit", options->unit,
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
