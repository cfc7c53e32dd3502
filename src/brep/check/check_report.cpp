// The report on the edges of a file as JSON, its schema, and as a JUnit report.
#include "check_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "describe/record_json.hpp"
#include "describe/text.hpp"
#include "knead/base/printable.hpp"

namespace knead::brep {

static std::span<const Choice> choices(EdgeKind /*kind*/) {
  static constexpr Choice list[] = {
      {"unknown", EdgeKind::unknown, "its curve, or one of its faces, cannot be followed"},
      {"open", EdgeKind::open, "of one face"},
      {"seam", EdgeKind::seam, "of one face that is on both of its sides"},
      {"non-manifold", EdgeKind::non_manifold, "of more than two faces"},
      {"gap", EdgeKind::gap, "farther apart than the tolerance"},
      {"sharp", EdgeKind::sharp, "smooth nowhere"},
      {"partly smooth", EdgeKind::partly, "smooth on a part of it only"},
      {"G0", EdgeKind::g0, "meant to be smooth, with an angle above the tolerance"},
      {"G1", EdgeKind::g1, "tangent planes agree, curvatures across the edge do not"},
      {"G2", EdgeKind::g2, "curvatures agree too"}};
  return list;
}

static void describe(EdgePlace& p, Fields& fields) {
  fields.name("edge place", "A point of an edge and the nearest points of its faces.");
  fields.add("point", p.point, {.help = "of the curve of the edge", .unit = Unit::length});
  fields.add("parameters", p.parameters,
             {.help = "on each of the faces, of a seam on both sides: of B-spline surfaces "
                      "fractions of the domain"});
}

static void describe(EdgeFigure& f, Fields& fields) {
  fields.name("edge figure", "The largest value along an edge.");
  fields.add("value", f.value, {.presence = Presence::required});
  fields.add("at", f.at, {.help = "where it is taken", .presence = Presence::required});
}

static void describe(EdgeMeasures& e, Fields& fields) {
  fields.name("edge measures", "How the faces at an edge meet.");
  fields.add("id", e.id, {.presence = Presence::required});
  fields.add("faces", e.faces, {.help = "their ids, each once", .presence = Presence::required});
  fields.add("kind", e.kind, {.presence = Presence::required});
  fields.add("reason", e.reason, {.help = "why nothing is known", .omit_empty = true});
  fields.add("length", e.length, {.unit = Unit::length});
  fields.add("start", e.start, {.unit = Unit::length});
  fields.add("middle", e.middle, {.help = "at half its parameter", .unit = Unit::length});
  fields.add("end", e.end, {.unit = Unit::length});
  fields.add("gap", e.gap, {.help = "between the faces; of one face, from the curve"});
  fields.add("off_curve", e.off_curve, {.help = "between the curve and the faces"});
  fields.add("angle", e.angle, {.help = "between the normals, in degrees; 0 is smooth"});
  fields.add("least_angle", e.least_angle, {.help = "along the edge, in degrees"});
  fields.add("smooth_share", e.smooth_share,
             {.help = "of its length, on which the angle is within the tolerance",
              .unit = Unit::fraction});
  fields.add("curvature", e.curvature,
             {.help = "difference of the normal curvatures across the edge, 1/length"});
  fields.add("relative_curvature", e.relative_curvature,
             {.help = "difference over the sum of their sizes, percent"});
  fields.add("samples", e.samples, {.help = "points that were looked at"});
  fields.add("course", e.course,
             {.help = "points along it, for drawing", .unit = Unit::length, .omit_empty = true});
}

static void describe(EdgeThresholds& t, Fields& fields) {
  fields.name("edge thresholds", "Largest values that are accepted; null: not judged.");
  fields.add("gap", t.gap, {.unit = Unit::length});
  fields.add("angle", t.angle, {.help = "degrees"});
  fields.add("curvature", t.curvature, {.help = "percent"});
}

static void describe(EdgeFault& f, Fields& fields) {
  fields.name("edge fault", "A measure above its threshold.");
  fields.add("edge", f.edge, {.presence = Presence::required});
  fields.add("measure", f.measure,
             {.help = "gap, angle, curvature, or faces of an edge that has come open",
              .presence = Presence::required});
  fields.add("value", f.value, {.presence = Presence::required});
  fields.add("limit", f.limit, {.presence = Presence::required});
  fields.add("before", f.before, {.help = "in the file that it is compared with"});
}

static void describe(EdgeCount& c, Fields& fields) {
  fields.name("edge count", "");
  fields.add_all("kind", c.kind, "count", c.count);
}

void describe(EdgeCheckReport& r, Fields& fields) {
  fields.name("edge check", "The edges of a CAD file and what of them is above a threshold.");
  fields.add_all("file", r.file, "format", r.format);
  fields.add("unit", r.unit, {.help = "of lengths, as the file names it"});
  fields.add("against", r.against, {.help = "the file it is compared with", .omit_empty = true});
  fields.add("thresholds", r.thresholds, {.presence = Presence::required});
  fields.add("passed", r.passed, {.help = "nothing is above", .presence = Presence::required});
  fields.add("size", r.size, {.help = "diagonal of the box of all edges", .unit = Unit::length});
  fields.add("gap_tolerance", r.gap_tolerance, {.unit = Unit::length});
  fields.add("angle_tolerance", r.angle_tolerance, {.help = "degrees"});
  fields.add("curvature_tolerance", r.curvature_tolerance, {.help = "percent"});
  fields.add("counts", r.counts, {.help = "edges of each kind that there is"});
  fields.add("faults", r.faults, {.presence = Presence::required});
  fields.add("edges", r.edges, {.presence = Presence::required});
}

std::string_view name_of(EdgeKind kind) {
  return choices(kind)[static_cast<std::size_t>(kind)].name;
}

std::vector<EdgeCount> counts_of(std::span<const EdgeMeasures> edges) {
  std::vector<EdgeCount> result;
  for (const Choice& choice : choices(EdgeKind{})) {
    const auto kind = static_cast<EdgeKind>(choice.value);
    const auto count = std::ranges::count(edges, kind, &EdgeMeasures::kind);
    if (count > 0) result.push_back({kind, static_cast<int>(count)});
  }
  return result;
}

std::string check_json(const EdgeCheckReport& report) {
  return indented_json(
      to_json(type_of<EdgeCheckReport>(), &report, Absent::null, shortest_json_number));
}

std::string check_schema() {
  return R"({"$schema":"https://json-schema.org/draft/2020-12/schema",)" +
         schema_of(type_of<EdgeCheckReport>(), Absent::null).substr(1) + "\n";
}

namespace {

std::string sentence(const EdgeFault& fault) {
  if (fault.measure == "faces") return "it has come open";
  std::string text =
      fmt::format("{} {:.6g} is above {:.6g}", fault.measure, fault.value, fault.limit);
  if (fault.before)
    text = fmt::format("{} {:.6g}, {:.6g} before: more than {:.6g} worse", fault.measure,
                       fault.value, *fault.before, fault.limit);
  return text;
}

}  // namespace

std::string check_junit(const EdgeCheckReport& report) {
  std::string cases;
  std::size_t failed = 0, skipped = 0;
  auto fault = report.faults.begin();  // in the order of edges
  for (const EdgeMeasures& edge : report.edges) {
    std::string said;
    for (; fault != report.faults.end() && fault->edge == edge.id; ++fault)
      said += (said.empty() ? "" : "; ") + sentence(*fault);
    cases +=
        fmt::format("    <testcase classname=\"{}\" name=\"edge {} of {} ({})\"",
                    xml_text(report.file), xml_text(edge.id),
                    xml_text(fmt::format("{}", fmt::join(edge.faces, ", "))), name_of(edge.kind));
    if (!said.empty()) {
      ++failed;
      cases += fmt::format(">\n      <failure message=\"{}\"/>\n    </testcase>\n", xml_text(said));
    } else if (edge.kind == EdgeKind::unknown) {
      ++skipped;
      cases += fmt::format(">\n      <skipped message=\"{}\"/>\n    </testcase>\n",
                           xml_text(edge.reason));
    } else {
      cases += "/>\n";
    }
  }
  const std::string sums = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\"",
                                       report.edges.size(), failed, skipped);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {0}>\n  <testsuite name=\"knead "
      "check {1}\" {0}>\n{2}  </testsuite>\n</testsuites>\n",
      sums, xml_text(report.file), cases);
}

}  // namespace knead::brep
