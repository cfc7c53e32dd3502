#include "sculpt_report.hpp"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include "cli.hpp"
#include "faces.hpp"
#include "knead/session/session_info.hpp"
#include "parts.hpp"
#include "picture.hpp"
#include "run_script.hpp"

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
std::string probes_json(std::span<const ProbeReport> probes) {
  const auto vector = [](const Point& p) {
    return fmt::format("[{},{},{}]", json_number(p[0]), json_number(p[1]), json_number(p[2]));
  };
  std::map<std::string, std::string> lists;
  for (const auto& [probe, surface, reading, shell] : probes) {
    std::string& list = lists[probe.list];
    list += fmt::format(
        R"({}{{"name":{},"surface":{},"at":[{},{}],"point":{},"displacement":{},"normal":{},"curvature":{})",
        list.empty() ? "\n " : ",\n ", json_string(probe.name), json_string(surface), json_number(probe.at[0]),
        json_number(probe.at[1]), vector(reading.point), vector(reading.displacement), vector(reading.normal),
        reading.curvature
            ? fmt::format("[{},{}]", json_number((*reading.curvature)[0]), json_number((*reading.curvature)[1]))
            : "null");
    if (shell) {
      const auto pair = [](const std::array<double, 2>& x) {
        return fmt::format("[{},{}]", json_number(x[0]), json_number(x[1]));
      };
      list += fmt::format(R"(,"von_mises":{},"membrane":{},"moment":{},"bending_strain":{})", pair(shell->von_mises),
                          pair(shell->membrane), pair(shell->moment), json_number(shell->bending_strain));
    }
    list += "}";
  }
  std::string text;
  for (const auto& [name, entries] : lists) text += fmt::format(",\n{}:[{}]", json_string(name), entries);
  return text;
}

}  // namespace

Expected<std::string> report_of(const SessionState& state, const Outcome& o) {
  const auto probes = report_probes(state);
  if (!probes) return std::unexpected(probes.error());
  return report_json(state, o, probes_json(*probes));
}

Expected<std::string> picture_of(const SessionState& state) {
  if (!state.selected) return input_error("no surface is selected, so there is nothing to draw", {}, "select one");
  const SceneSurface& s = state.surfaces[static_cast<std::size_t>(*state.selected)];
  return displacement_picture(*s.opened, *s.current, "Displacement of " + (s.name.empty() ? s.id : s.name), s.unit);
}

}  // namespace knead::cli
