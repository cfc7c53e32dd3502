#include "check_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "cli.hpp"
#include "knead/base/printable.hpp"

namespace knead::cli {
namespace {

using brep::EdgeCheckReport;
using brep::EdgeFigure;
using brep::EdgeMeasures;

constexpr std::size_t most_worst = 10;

template <class... T>
void append(std::string& text, fmt::format_string<T...> line, T&&... values) {
  fmt::format_to(std::back_inserter(text), line, std::forward<T>(values)...);
}

using Member = std::optional<EdgeFigure> EdgeMeasures::*;

/// The largest of a measure above what rounding leaves.
void add_worst(std::string& text, const EdgeCheckReport& report, const char* title, Member member,
               const std::string& unit, double least) {
  std::vector<const EdgeMeasures*> worst;
  for (const EdgeMeasures& edge : report.edges) {
    if ((edge.*member) && (edge.*member)->value > least) worst.push_back(&edge);
  }
  std::ranges::stable_sort(worst, std::greater{},
                           [member](const EdgeMeasures* e) { return (e->*member)->value; });
  append(text, "  {}{}\n", title, worst.empty() ? ": none" : "");
  for (std::size_t k = 0; k < std::min(worst.size(), most_worst); ++k) {
    const EdgeFigure& figure = *(worst[k]->*member);
    const auto& [x, y, z] = figure.at.point;
    append(text, "    {:<8} {:<12.6g} {} at ({:.6g}, {:.6g}, {:.6g}), {}, {} {}\n", worst[k]->id,
           figure.value, unit, x, y, z, brep::name_of(worst[k]->kind),
           worst[k]->faces.size() == 1 ? "face" : "faces", fmt::join(worst[k]->faces, ", "));
  }
}

std::string limits_in_words(const EdgeCheckReport& report) {
  std::string text;
  const auto limit = [&](const char* name, const std::optional<double>& value,
                         const std::string& unit) {
    if (value) text += fmt::format("{}{} {:g} {}", text.empty() ? "" : ", ", name, *value, unit);
  };
  limit("gap", report.thresholds.gap, report.unit == "unknown" ? "units" : report.unit);
  limit("angle", report.thresholds.angle, "degrees");
  limit("curvature", report.thresholds.curvature, "percent");
  return text;
}

}  // namespace

std::string check_verdict(const EdgeCheckReport& report) {
  const std::string limits = limits_in_words(report);
  if (report.edges.empty()) return "no edges\n";
  if (limits.empty()) return "not judged: no thresholds are given\n";
  const std::string beside =
      report.against.empty() ? "" : " more than in " + printable(report.against);
  if (report.passed) return fmt::format("passed: no edge exceeds {}{}\n", limits, beside);
  std::vector<std::string> edges;
  for (const brep::EdgeFault& fault : report.faults) {
    if (edges.empty() || edges.back() != fault.edge) edges.push_back(fault.edge);
  }
  const std::size_t count = edges.size();
  if (count > most_worst) edges.resize(most_worst);
  return fmt::format("failed: {} {} {}{}: {}{}\n", counted(count, "edge", "edges"),
                     count == 1 ? "exceeds" : "exceed", limits, beside, fmt::join(edges, ", "),
                     count > most_worst ? ", …" : "");
}

std::string check_text(const EdgeCheckReport& report) {
  std::string text;
  append(text, "{}: {}, lengths in {}\n", printable(report.file),
         counted(report.edges.size(), "edge", "edges"),
         report.unit == "unknown" ? "an unknown unit" : report.unit);
  if (report.edges.empty()) return text + check_verdict(report);
  std::string kinds;
  for (const auto& [kind, count] : report.counts)
    kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", count, brep::name_of(kind));
  append(text, "  {}\n", kinds);
  append(text, "  tolerances: gap {:.3g}, angle {:g} degrees, curvature {:g} percent\n",
         report.gap_tolerance, report.angle_tolerance, report.curvature_tolerance);
  const std::string unit = report.unit == "unknown" ? "units" : report.unit;
  const double least = 1e-9 * report.size;
  add_worst(text, report, "largest gaps between faces", &EdgeMeasures::gap, unit, least);
  add_worst(text, report, "largest distances of curves from faces", &EdgeMeasures::off_curve, unit,
            least);
  add_worst(text, report, "largest angles", &EdgeMeasures::angle, "degrees", 1e-6);
  add_worst(text, report, "largest differences in curvature", &EdgeMeasures::curvature, "1/" + unit,
            0);
  add_worst(text, report, "largest relative differences in curvature",
            &EdgeMeasures::relative_curvature, "percent", 0);
  std::size_t unknown = 0;
  for (const EdgeMeasures& edge : report.edges) {
    if (edge.reason.empty()) continue;
    if (unknown++ < most_worst)
      append(text, "  unknown: {}: {}\n", edge.id, printable(edge.reason));
  }
  if (unknown > most_worst) append(text, "  and {} more are unknown\n", unknown - most_worst);
  return text + check_verdict(report);
}

}  // namespace knead::cli
