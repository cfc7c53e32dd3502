#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "diagnostic_info.hpp"
#include "info_values.hpp"
#include "knead/session/report.hpp"
#include "knead/session/session_info.hpp"
#include "scene/shell_fields.hpp"
#include "session_state.hpp"

namespace knead {

// What reports say, as records: a figure is written because its record describes it.

struct ReportedStep {
  StepRecord step;
};
static void describe(ReportedStep& s, Fields& fields) { describe_figures(s.step, fields); }

static void describe(Outcome& o, Fields& fields) {
  fields.add_all("time", o.time, "energy_before", o.energy_before, "energy_after", o.energy_after,
                 "residual", o.residual, "largest_displacement", o.largest_displacement,
                 "control_points_moved", o.moved);
}

static void describe(RepeatedSurface& r, Fields& fields) {
  fields.add_all("surface", r.surface, "part", r.part, "places", r.places);
}

struct ReportedEdge {
  std::string id, hold;
  bool along_lines = true;
  int control_points = 0;
  double deviation = 0;
  std::vector<std::string> faces;
  std::optional<double> angle = {}, angle_before = {};
};
static void describe(ReportedEdge& e, Fields& fields) {
  fields.add_all("id", e.id, "hold", e.hold, "along_lines", e.along_lines, "control_points",
                 e.control_points, "deviation", e.deviation, "faces", e.faces, "angle", e.angle,
                 "angle_before", e.angle_before);
}

struct ReportedEdges {
  std::string surface;
  std::array<int, 2> net = {};
  int free = 0, visible = 0;
  double largest_gap = 0;
  int samples = 0;
  std::vector<ReportedEdge> edges = {};
};
static void describe(ReportedEdges& e, Fields& fields) {
  fields.add_all("surface", e.surface, "net", e.net, "free", e.free, "visible", e.visible,
                 "largest_gap", e.largest_gap, "samples", e.samples, "edges", e.edges);
}

static void describe(SeamSummary& s, Fields& fields) {
  fields.add_all("a", s.a, "b", s.b, "continuity", s.continuity, "gap", s.gap, "reason", s.reason);
}

struct ReportedProbe {
  std::string surface;  ///< its id
  ReadingInfo reading;
};
static void describe(ReportedProbe& p, Fields& fields) {
  fields.add_all("name", p.reading.name, "surface", p.surface);
  describe_measures(p.reading, fields);
}

static void describe(HoldReaction& r, Fields& fields) {
  fields.add_all("hold", r.hold, "force", r.force);
}

namespace {

/// A list with an entry in each line.
template <class T>
std::string rows(const std::vector<T>& list) {
  std::string text;
  for (const T& entry : list) text += (text.empty() ? "\n " : ",\n ") + json_of(entry);
  return "[" + text + "]";
}

template <class T>
std::string rows_unless_empty(std::string_view name, const std::vector<T>& list) {
  return list.empty() ? "" : fmt::format(",\n{}:{}", json_text(name), rows(list));
}

std::string modes_json(const SessionState& state) {
  return rows_unless_empty("modes", infos_of<VibrationInfo>(state.modes)) +
         rows_unless_empty("buckling", infos_of<BucklingInfo>(state.buckling));
}

std::vector<ReportedEdges> reported_edges(const Session& session) {
  constexpr double degrees = 180 / std::numbers::pi;
  std::vector<ReportedEdges> list;
  const std::vector<FollowedReport> followed = report_followed(session);
  for (const EdgesReport& r : report_edges(session)) {
    const std::string& id = session.state().surfaces[static_cast<std::size_t>(r.surface)].id;
    ReportedEdges& info =
        list.emplace_back(ReportedEdges{id, r.net, r.free, r.visible, r.largest_gap, r.samples});
    for (const EdgeReport& edge : r.edges) {
      info.edges.push_back({edge.id, std::string(edge.hold), edge.along_lines, edge.control_points,
                            edge.deviation, edge.faces});
      const auto angles = std::ranges::find(followed, edge.id, &FollowedReport::id);
      if (edge.hold != "follow" || angles == followed.end()) continue;
      info.edges.back().angle = angles->angle * degrees;
      info.edges.back().angle_before = angles->angle_before * degrees;
    }
  }
  return list;
}

}  // namespace

Expected<std::string> report_json(const Session& session, const Outcome& outcome) {
  const SessionState& state = session.state();
  std::vector<ReportedStep> steps;
  for (const StepRecord& step : state.steps) steps.push_back({step});
  std::vector<std::string> notes(outcome.notes.begin(), outcome.notes.end());
  std::vector<NoteInfo> coded;
  for (const Note& note : outcome.notes) {
    if (note.diagnostic) coded.push_back(info_of(note));
  }
  std::map<std::string, std::vector<ReportedProbe>> probes;
  for (const Probe& probe : state.probes) {
    auto reading = reading_of(state, probe);
    if (!reading) return std::unexpected(reading.error());
    probes[probe.list].push_back(
        {state.surfaces[static_cast<std::size_t>(probe.surface)].id, *std::move(reading)});
  }
  const std::vector<ReportedEdges> edges = reported_edges(session);
  std::string text = "{\"steps\":" + rows(steps) + ",\n" + json_of(outcome).substr(1);
  text.back() = ',';  // the outcome's figures stand among the others
  text += "\n\"edges\":" + to_json(type_of<std::vector<ReportedEdges>>(), &edges, Absent::left_out,
                                   shortest_json_number);
  text +=
      ",\n\"places\":" + json_of(outcome.places) + ",\n\"seams\":" + rows(report_seams(session));
  text +=
      ",\n\"notes\":" + rows(notes) + rows_unless_empty("coded_notes", coded) + modes_json(state);
  for (const auto& [name, readings] : probes) text += rows_unless_empty(name, readings);
  return text + "}\n";
}

Expected<std::string> analysis_json(const Session& session, std::span<const FieldGrid> grids) {
  const SessionState& state = session.state();
  std::string text;
  for (const FieldGrid& grid : grids) {
    text += fmt::format(
        "{}\n {{\"id\":{},\"counts\":{},\n  \"points\":{}", text.empty() ? "" : ",",
        json_text(grid.name), json_of(grid.counts),
        json_of(std::vector<double>(grid.points.data(), grid.points.data() + grid.points.size())));
    for (const GridField& field : grid.fields)
      text += fmt::format(",\n  \"{}\":{}", field.name, json_of(field.values));
    text += "}";
  }
  text = "{\"surfaces\":[" + text + "]";
  if (state.selected &&
      is_nonlinear(state.surfaces[static_cast<std::size_t>(*state.selected)].elasticity)) {
    const auto reactions = hold_reactions(state);
    if (!reactions) return std::unexpected(reactions.error());
    text += ",\n\"reactions\":" + rows(*reactions);
  }
  return text + modes_json(state) + "}\n";
}

}  // namespace knead
