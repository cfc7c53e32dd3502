// The edges of a file, judged by thresholds or against an earlier version of it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "knead/exchange/file_info.hpp"
#include "knead/exchange/format.hpp"

namespace knead {
namespace {

/// What a class asks for: mm and degrees.
struct Grade {
  const char* name;
  double gap, angle;
};
constexpr Grade grades[] = {{"a", 0.01, 0.1}, {"b", 0.02, 0.2}, {"c", 0.05, 0.5}};

Expected<void> check_number(const std::optional<double>& value, const char* name, double most,
                            const char* remedy) {
  if (!value || (*value >= 0 && *value <= most && std::isfinite(*value))) return {};
  return usage_error(fmt::format("{} is no threshold", *value), name, remedy);
}

Expected<void> check_request(const EdgeCheckRequest& check, bool compared) {
  constexpr double any = std::numeric_limits<double>::max();
  if (auto right = check_number(check.gap, "gap", any, "use a length from 0 on"); !right)
    return right;
  if (auto right = check_number(check.angle, "angle", brep::meant_smooth,
                                "use degrees from 0 to 5: edges with larger angles are not meant "
                                "to be smooth");
      !right)
    return right;
  if (auto right = check_number(check.curvature, "curvature", 100, "use percent from 0 to 100");
      !right)
    return right;
  const auto named = [&](const Grade& grade) { return check.grade == grade.name; };
  if (!check.grade.empty() && std::ranges::none_of(grades, named))
    return usage_error("\"" + check.grade + "\" is no class", "class", "use a, b or c");
  if (compared && !check.gap && !check.angle && !check.curvature && check.grade.empty()) {
    return usage_error("without thresholds nothing is worse", "against",
                       "give a threshold or a class too");
  }
  if (!check.unit.empty() && check.grade.empty())
    return usage_error("only the thresholds of a class need it", "unit", "give a class too");
  return {};
}

/// mm in a unit of the file.
Expected<double> millimetres_in(const std::string& unit, const EdgeCheckRequest& check) {
  const auto known = millimetres_of(unit);
  if (!check.unit.empty()) {
    if (known && check.unit != unit)
      return usage_error(fmt::format("the file is in {}", unit), "unit", "leave it out");
    const auto given = millimetres_of(check.unit);
    if (given) return *given;
    return usage_error("there is no unit \"" + check.unit + "\"", "unit",
                       "use " + list_of_length_units());
  }
  if (known) return *known;
  return usage_error(unit == "unknown"
                         ? "the length unit of the file is unknown"
                         : fmt::format("the file has no single known length unit, but {}", unit),
                     "unit", "say what its coordinates are in: " + list_of_length_units());
}

Expected<brep::EdgeThresholds> thresholds_of(const Source& source, const EdgeCheckRequest& check) {
  brep::EdgeThresholds thresholds{check.gap, check.angle, check.curvature};
  for (const Grade& grade : grades) {
    if (check.grade != grade.name) continue;
    const auto unit = millimetres_in(unit_of(source), check);
    if (!unit) return std::unexpected(unit.error());
    if (!thresholds.gap) thresholds.gap = grade.gap / *unit;
    if (!thresholds.angle) thresholds.angle = grade.angle;
  }
  return thresholds;
}

Expected<brep::ModelMeasures> measures_of(const Source& source,
                                          const brep::EdgeTolerances& tolerances,
                                          const std::vector<std::string>& ids) {
  const auto model = source.model();
  if (!model) {
    if (!ids.empty())
      return usage_error(fmt::format("a {} file has no edges", source.format()), "edges",
                         "leave it out");
    return brep::ModelMeasures{};
  }
  auto measures = brep::measure_edges(*model, tolerances, ids);
  if (measures || measures.error().kind == ErrorKind::numerical) return measures;
  Error error = measures.error().within("edges");
  error.kind = ErrorKind::usage;
  return std::unexpected(std::move(error));
}

}  // namespace

Expected<brep::EdgeCheckReport> check_edges(const Source& source, const EdgeCheckRequest& check,
                                            const Source* against) {
  if (auto right = check_request(check, against != nullptr); !right)
    return std::unexpected(right.error());
  const auto thresholds = thresholds_of(source, check);
  if (!thresholds) return std::unexpected(thresholds.error());
  brep::EdgeTolerances tolerances{.gap = thresholds->gap};
  if (thresholds->angle) tolerances.angle = *thresholds->angle;
  if (thresholds->curvature) tolerances.curvature = *thresholds->curvature;
  auto measures = measures_of(source, tolerances, check.edges);
  if (!measures) return std::unexpected(measures.error());
  brep::EdgeCheckReport report{.file = source.name(),
                               .format = std::string(source.format()),
                               .unit = check.unit.empty() ? unit_of(source) : check.unit,
                               .thresholds = *thresholds,
                               .size = measures->size,
                               .gap_tolerance = measures->gap_tolerance,
                               .angle_tolerance = tolerances.angle,
                               .curvature_tolerance = tolerances.curvature};
  if (against == nullptr) {
    report.faults = brep::faults_of(*measures, *thresholds);
  } else {
    report.against = against->name();
    const auto before = measures_of(*against, tolerances, {});
    if (!before) return std::unexpected(before.error());
    report.faults = brep::faults_against(*measures, *before, *thresholds);
  }
  report.edges = std::move(measures->edges);
  if (!check.courses) {
    for (brep::EdgeMeasures& edge : report.edges) edge.course.clear();
  }
  report.counts = brep::counts_of(report.edges);
  report.passed = report.faults.empty();
  return report;
}

}  // namespace knead
