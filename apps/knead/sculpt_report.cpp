#include "sculpt_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "cli.hpp"
#include "faces.hpp"
#include "knead/scene/shell_fields.hpp"
#include "knead/session/session_info.hpp"
#include "picture.hpp"
#include "run_script.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

std::string json_string(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// What programs read of notes: of those that have a code.
std::string coded_notes_json(const std::vector<Note>& notes) {
  std::string text;
  for (const Note& note : notes) {
    if (note.diagnostic) text += (text.empty() ? "\n " : ",\n ") + note_json(note);
  }
  return text.empty() ? text : ",\n\"coded_notes\":[" + text + "]";
}

std::string report_json(const SessionState& state, const Outcome& o, const std::string& probes) {
  std::string text = "{\"steps\":[";
  for (std::size_t k = 0; k < state.steps.size(); ++k) {
    const StepRecord& s = state.steps[k];
    text += fmt::format(
        "{}\n {{\"time\":{},\"energy\":{},\"residual\":{},\"largest_displacement\":{},\"stretch\":{},\"bend\":{},"
        "\"kinetic\":{},\"contact\":{},\"gap\":{},\"constraint_violation\":{},\"converged\":{},\"limited\":{}",
        k == 0 ? "" : ",", json_number(s.time), json_number(s.energy), json_number(s.residual),
        json_number(s.largest_displacement), json_number(s.stretch), json_number(s.bend), json_number(s.kinetic),
        json_number(s.contact), json_number(s.gap), json_number(s.violation), s.converged, s.limited);
    if (s.load_factor) {
      text += fmt::format(",\"load_factor\":{},\"increments\":[{}]", json_number(*s.load_factor),
                          fmt::join(s.increments, ","));
    }
    if (s.energy_error) text += fmt::format(",\"energy_error\":{}", json_number(*s.energy_error));
    if (!s.note.empty()) text += ",\"note\":" + json_string(s.note);
    text += "}";
  }
  text += fmt::format(
      "],\n\"time\":{},\"energy_before\":{},\"energy_after\":{},\"residual\":{},"
      "\"largest_displacement\":{},\"control_points_moved\":{}",
      json_number(o.time), json_number(o.energy_before), json_number(o.energy_after), json_number(o.residual),
      json_number(o.largest_displacement), o.moved);
  text += ",\n\"edges\":" + edges_json(state);
  text += ",\n\"places\":" + places_json(o.places).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  text += ",\n\"seams\":[";
  for (std::size_t k = 0; k < state.seam_reports.size(); ++k) {
    const SeamReport& s = state.seam_reports[k];
    text += fmt::format("{}\n {{\"a\":{},\"b\":{},\"continuity\":\"{}\",\"gap\":{},\"reason\":{}}}", k == 0 ? "" : ",",
                        json_string(name_of(state, s.seam.a)), json_string(name_of(state, s.seam.b)),
                        name_of(s.continuity), json_number(s.seam.gap), json_string(s.reason));
  }
  text += "],\n\"notes\":[";
  for (std::size_t k = 0; k < o.notes.size(); ++k) text += (k == 0 ? "\n " : ",\n ") + json_string(o.notes[k]);
  return text + "]" + coded_notes_json(o.notes) + modes_json(state) + probes + "}\n";
}

/// The readings of the scene's probes: the entries of each list.
Expected<std::string> probes_json(const SessionState& state) {
  const auto vector = [](const Point& p) {
    return fmt::format("[{},{},{}]", json_number(p[0]), json_number(p[1]), json_number(p[2]));
  };
  std::map<std::string, std::string> lists;
  for (const Probe& probe : state.probes) {
    const auto reading = read_probe(state, probe);
    if (!reading) return std::unexpected(reading.error());
    std::string& list = lists[probe.list];
    list += fmt::format(
        R"({}{{"name":{},"surface":{},"at":[{},{}],"point":{},"displacement":{},"normal":{},"curvature":{})",
        list.empty() ? "\n " : ",\n ", json_string(probe.name),
        json_string(state.surfaces[static_cast<std::size_t>(probe.surface)].id), json_number(probe.at[0]),
        json_number(probe.at[1]), vector(reading->point), vector(reading->displacement), vector(reading->normal),
        reading->curvature
            ? fmt::format("[{},{}]", json_number((*reading->curvature)[0]), json_number((*reading->curvature)[1]))
            : "null");
    const auto shell = read_shell(state, probe.surface, probe.at);
    if (!shell) return std::unexpected(shell.error());
    if (*shell) {
      const auto pair = [](const std::array<double, 2>& x) {
        return fmt::format("[{},{}]", json_number(x[0]), json_number(x[1]));
      };
      list += fmt::format(R"(,"von_mises":{},"membrane":{},"moment":{},"bending_strain":{})", pair((*shell)->von_mises),
                          pair((*shell)->membrane), pair((*shell)->moment), json_number((*shell)->bending_strain));
    }
    list += "}";
  }
  std::string text;
  for (const auto& [name, entries] : lists) text += fmt::format(",\n{}:[{}]", json_string(name), entries);
  return text;
}

}  // namespace

const char* name_of(SeamContinuity continuity) {
  constexpr const char* names[] = {"none", "C0", "G1", "periodic"};
  return names[static_cast<int>(continuity)];
}

std::string name_of(const SessionState& state, const PatchEdge& edge) {
  return fmt::format("{} {}", state.surfaces[static_cast<std::size_t>(edge.patch)].id, edge_name(edge.edge));
}

Outcome outcome_of(Session& session, std::size_t opened) {
  const SessionState& state = session.state();
  Outcome o;
  o.places = repeated_surfaces(session);
  o.notes = state.notes;
  const std::vector<std::string> open = notes_on_open_edges(session);
  o.notes.insert(o.notes.end(), open.begin(), open.end());
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  // Finished work is written even if its energy cannot be computed.
  if (const auto energy = session.energy()) {
    o.energy_after = *energy;
    o.energy_before = state.energy_before.value_or(*energy);
  } else {
    o.energy_after = unknown;
    o.energy_before = state.energy_before.value_or(unknown);
    say(stderr, "knead: warning: there is no energy: {}\n", energy.error().message());
  }
  for (const StepRecord& s : state.steps) o.time += s.time;
  if (!state.steps.empty()) {
    o.residual = state.steps.back().residual;
    o.gap = state.steps.back().gap;
  }
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const int moved = session.moved_control_points(static_cast<int>(k));
    const bool converted = !session.document().is_fresh() && k >= opened;
    if (moved > 0 || converted) ++o.surfaces;
    if (moved == 0) continue;
    o.moved += moved;
    o.largest_displacement = std::max(o.largest_displacement, session.largest_displacement(static_cast<int>(k)));
  }
  for (const SceneBody& body : state.bodies) {
    const int moved = moved_control_points(body);
    if (moved == 0) continue;
    o.moved += moved;
    ++o.bodies;
    o.largest_displacement = std::max(o.largest_displacement, largest_displacement(body));
  }
  return o;
}

Expected<std::string> report_of(const SessionState& state, const Outcome& o) {
  const auto probes = probes_json(state);
  if (!probes) return std::unexpected(probes.error());
  return report_json(state, o, *probes);
}

Expected<std::string> picture_of(const SessionState& state) {
  if (!state.selected) return input_error("no surface is selected, so there is nothing to draw", {}, "select one");
  const SceneSurface& s = state.surfaces[static_cast<std::size_t>(*state.selected)];
  return displacement_picture(*s.opened, *s.current, "Displacement of " + (s.name.empty() ? s.id : s.name), s.unit);
}

}  // namespace knead::cli
