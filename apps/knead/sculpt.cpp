#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "cli.hpp"
#include "faces.hpp"
#include "knead/base/printable.hpp"
#include "knead/exchange/compression.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/save_faces.hpp"
#include "knead/scene/shell_fields.hpp"
#include "knead/sculpt/describe_shape.hpp"
#include "knead/session/command_json.hpp"
#include "knead/session/session.hpp"
#include "outputs.hpp"
#include "parts.hpp"
#include "picture.hpp"
#include "progress.hpp"
#include "run_script.hpp"

namespace knead::cli {
namespace {

struct SculptArguments {
  std::string file, output, script, report, picture, schema = "ap214";
  bool fresh = false, keep_partial = false;
  UnpackOption unpack;
  [[nodiscard]] const std::string& name() const { return fresh ? output : file; }
};

/// "box of sizes 10 x 20 x 5, rounding 2"
std::string in_words(const Shape& shape) {
  const Type& shapes = type_of<Shape>();
  const Type& type = *shapes.variants[shape.index()];
  std::string text(type.name), separator = " of ";
  for (const Field& field : type.fields) {
    if (!field.type->numeric()) continue;
    const auto* numbers = static_cast<const double*>(field.of(shapes.part(&shape)));
    const std::size_t count = field.type->kind == Kind::array ? field.type->length : 1;
    std::string values;
    for (std::size_t k = 0; k < count; ++k) {
      values += fmt::format("{}{:.4g}", k == 0 ? "" : " x ", numbers[k] * field.factor);
    }
    text += fmt::format("{}{} {}", std::exchange(separator, ", "), field.name, values);
  }
  return text;
}

struct Outcome {
  double time = 0, energy_before = 0, energy_after = 0, residual = 0, largest_displacement = 0, gap = 0;
  int moved = 0, surfaces = 0, bodies = 0;
  std::vector<RepeatedSurface> places;
  std::vector<std::string> notes;  ///< of the session, and on edges that are open
};

Outcome outcome_of(Session& session) {
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
    fmt::print(stderr, "knead: warning: there is no energy: {}\n", energy.error().message());
  }
  for (const StepRecord& s : state.steps) o.time += s.time;
  if (!state.steps.empty()) {
    o.residual = state.steps.back().residual;
    o.gap = state.steps.back().gap;
  }
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const int moved = session.moved_control_points(static_cast<int>(k));
    if (moved == 0) continue;
    o.moved += moved;
    ++o.surfaces;
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

std::string json_string(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

const char* continuity_name(SeamContinuity continuity) {
  constexpr const char* names[] = {"none", "C0", "G1", "periodic"};
  return names[static_cast<int>(continuity)];
}

std::string edge_of(const SessionState& state, const PatchEdge& edge) {
  return fmt::format("{} {}", state.surfaces[static_cast<std::size_t>(edge.patch)].id, edge_name(edge.edge));
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
                        json_string(edge_of(state, s.seam.a)), json_string(edge_of(state, s.seam.b)),
                        continuity_name(s.continuity), json_number(s.seam.gap), json_string(s.reason));
  }
  text += "],\n\"notes\":[";
  for (std::size_t k = 0; k < o.notes.size(); ++k) text += (k == 0 ? "\n " : ",\n ") + json_string(o.notes[k]);
  return text + "]" + modes_json(state) + probes + "}\n";
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

void print_tools(const SessionState& state) {
  for (const Tool& t : state.tools) {
    const Point& c = t.shape.placement().position;
    fmt::print("  tool {}: {} at ({:.6g}, {:.6g}, {:.6g}), {}, stiffness {:.4g}\n", printable(t.name),
               in_words(t.shape.shape()), c.x(), c.y(), c.z(),
               t.collides() ? (t.mode == ToolMode::imprint ? "imprint" : "collision")
                            : fmt::format("proximity within {:.4g}", t.range),
               t.stiffness);
  }
}

void print_summary(const SculptArguments& options, const Session& session, const Outcome& o) {
  const SessionState& state = session.state();
  const std::string& file = options.name();
  if (state.body) {
    const SceneBody& b = state.bodies[static_cast<std::size_t>(*state.body)];
    fmt::print("{}: {} {}{}, lengths in {}\n", file, kind_of(b), b.id,
               b.name.empty() ? "" : " \"" + printable(b.name) + "\"", b.unit);
    fmt::print("  degree {}, net {}\n", fmt::join(degrees_of(b), " x "), fmt::join(net_of(b), " x "));
    print_tools(state);
  } else if (!state.selected) {
    fmt::print("{}: no surface selected\n", file);
  } else {
    for (int index : state.selection()) {
      const SceneSurface& s = state.surfaces[static_cast<std::size_t>(index)];
      const auto [m, n] = s.current->net();
      fmt::print("{}: surface {}{}, lengths in {}\n", file, s.id,
                 s.name.empty() ? "" : " \"" + printable(s.name) + "\"", s.unit);
      fmt::print("  degree {} x {}, net {} x {}, {}\n", s.current->knots(0).degree(), s.current->knots(1).degree(), m,
                 n, s.current->rational() ? "rational" : "polynomial");
    }
    print_tools(state);
  }
  for (const std::string& note : o.notes) fmt::print("  {}\n", printable(note, 2000));
  print_edges(state);
  print_places(o.places);
  for (const SeamReport& s : state.seam_reports) {
    fmt::print("  seam {} - {}: {}{}{}\n", edge_of(state, s.seam.a), edge_of(state, s.seam.b),
               continuity_name(s.continuity), s.reason.empty() ? "" : ", ", s.reason);
  }
  if (!state.steps.empty()) {
    fmt::print("  {} step{}, {:.3g} ms each ({:.3g} s in all), residual {:.2g}\n", state.steps.size(),
               state.steps.size() == 1 ? "" : "s", 1e3 * o.time / static_cast<double>(state.steps.size()), o.time,
               o.residual);
    fmt::print("  largest displacement {:.6g}, {} control point{} moved\n", o.largest_displacement, o.moved,
               o.moved == 1 ? "" : "s");
    if (std::isfinite(o.energy_after)) {
      fmt::print("  energy {:.6g} before, {:.6g} after\n", o.energy_before, o.energy_after);
    }
    if (o.gap > 0) fmt::print("  deepest entry into a tool: {:.2g} of its size\n", o.gap);
    const StepRecord& last = state.steps.back();
    if (!last.note.empty()) {
      fmt::print(stderr, "knead: warning: {}\n", printable(last.note, 2000));
    } else if (!last.converged) {
      fmt::print(stderr,
                 "knead: warning: the last step stopped before its minimum was reached; use more steps or a "
                 "larger lambda\n");
    }
  }
}

/// The format of a new file that the output's name asks for: the input has another one, whose faces a new file holds if
/// it has some. Null: the output is the input, changed.
const Format* other_format(const SculptArguments& options, const Document& document) {
  const auto wanted = format_of_name(options.output, FormatContent::surfaces);
  if (!wanted || (*wanted)->save == nullptr) return nullptr;
  if (document.model() != nullptr && !holds_faces(**wanted)) return nullptr;
  return document.source() == nullptr || (*wanted)->name != document.source()->format() ? *wanted : nullptr;
}

/// The CAD file comes last: if it exists, everything requested has been written.
Expected<void> write_results(const SculptArguments& options, const Session& session, const Outcome& o) {
  const Format* other = other_format(options, session.document());
  SaveOptions how;
  how.schema = options.schema;
  const bool faces = other != nullptr && session.document().model() != nullptr;
  auto bytes = faces              ? bytes_of_faces(session, *other, how)
               : other != nullptr ? session.save_as(*other, how)
                                  : session.save();
  if (bytes) bytes = compressed_by_name(*std::move(bytes), options.output, options.file);
  if (!bytes) return std::unexpected(bytes.error());
  const auto& surfaces = session.document().surfaces();
  if (other != nullptr && !options.fresh && !surfaces.empty() && surfaces.front().unit == "unknown") {
    fmt::print("lengths are written as millimetres: {} does not say what they are\n", options.file);
  }
  std::string picture;
  if (!options.picture.empty()) {
    const SessionState& state = session.state();
    if (!state.selected) {
      return usage_error("there is no picture without a selected surface", "--picture", "leave it out");
    }
    const auto k = static_cast<std::size_t>(*state.selected);
    const SceneSurface& s = state.surfaces[k];
    auto svg =
        displacement_picture(*s.opened, *s.current, "Displacement of " + (s.name.empty() ? s.id : s.name), s.unit);
    if (!svg) return std::unexpected(svg.error());
    picture = std::move(*svg);
  }
  if (!options.report.empty()) {
    const auto probes = probes_json(session.state());
    if (!probes) return std::unexpected(probes.error());
    if (auto done = write_file_atomically(options.report, report_json(session.state(), o, *probes)); !done) return done;
    fmt::print("wrote {}\n", options.report);
  }
  if (!options.picture.empty()) {
    if (auto done = write_file_atomically(options.picture, picture); !done) return done;
    fmt::print("wrote {}\n", options.picture);
  }
  if (auto done = write_file_atomically(options.output, *bytes); !done) return done;
  fmt::print("wrote {} ({} surface{}{} changed)\n", options.output, o.surfaces, o.surfaces == 1 ? "" : "s",
             o.bodies == 0 ? ""
                           : fmt::format(", {} curve{} or volume{}", o.bodies, o.bodies == 1 ? "" : "s",
                                         o.bodies == 1 ? "" : "s"));
  return {};
}

/// Whether the name of the output promises what is written: it has no ending, that of the input, or one of a CAD
/// format.
Expected<void> check_ending(const SculptArguments& options, const Document& document) {
  const auto ending_of = [](const std::string& name) {
    return std::filesystem::path(uncompressed_name(name)).extension();
  };
  if (ending_of(options.output).empty() || ending_of(options.output) == ending_of(options.file)) return {};
  const auto wanted = format_of_name(options.output, FormatContent::surfaces);
  const std::string_view written = document.source() != nullptr ? document.source()->format() : "STEP";
  if (wanted && (*wanted)->name == written) return {};
  if (other_format(options, document) != nullptr) return {};
  std::string endings;
  for (const Format& format : formats()) {
    if (format.name != written) continue;
    for (const std::string_view e : format.endings) endings += (endings.empty() ? "" : ", ") + std::string(e);
  }
  return usage_error(fmt::format("\"{}\" is not the name of a {} file, and the result is one", options.output, written),
                     "--output",
                     fmt::format("use a name that ends in one of {}; `knead mesh` writes {}", endings,
                                 list_of_endings(FormatContent::triangles)));
}

Expected<void> run(const SculptArguments& options) {
  if (options.output.empty()) return usage_error("the name is empty", "--output", "name the file to write");
  const NamedFile file{"FILE", options.file}, script{"--script", options.script}, output{"--output", options.output};
  // The surface may be sculpted in place: only --output may name the input file.
  if (auto possible = check_outputs({output}, {script}); !possible) return possible;
  const NamedFile report{"--report", options.report}, picture{"--picture", options.picture};
  if (auto possible = check_outputs({report, picture}, {file, script, output}); !possible) return possible;
  if (auto one = check_source(options.file, options.fresh); !one) return one;
  const auto commands = read_script(options.script);
  if (!commands) return std::unexpected(commands.error());
  auto document = open_document(options.file, options.fresh, options.unpack);
  if (!document) return std::unexpected(document.error());
  if (auto possible = check_ending(options, *document); !possible) return possible;
  const Format* made = other_format(options, *document);
  if (options.schema != "ap214" && (made == nullptr || made->id != "step")) {
    return usage_error("this does not write a new STEP file", "--schema", "leave it out: a file keeps its schema");
  }

  Session session(std::move(*document));
  std::optional<Interrupt> interrupt;
  if (options.keep_partial) interrupt.emplace();
  const auto done = execute(session, *commands, options.keep_partial);
  if (!done) return std::unexpected(done.error());
  const Outcome outcome = outcome_of(session);
  print_summary(options, session, outcome);
  if (!done->complete) {
    const std::size_t implied = std::min(commands->implied, done->commands);
    fmt::print(stderr, "knead: stopped: {} of {} commands are done; what stands is written\n", done->commands - implied,
               commands->commands.size() - commands->implied);
  }
  auto written = write_results(options, session, outcome);
  if (written && !done->complete) {
    std::fflush(stdout);
    Interrupt::pass_on();
  }
  return written;
}

}  // namespace

Action add_sculpt(CLI::App& app) {
  auto options = std::make_shared<SculptArguments>();
  CLI::App* command = app.add_subcommand("sculpt", "run a script of sculpting commands on a CAD file");
  command->add_option("FILE", options->file, "STEP file to sculpt; it is not changed, unless --output names it too")
      ->type_name("");
  command->add_flag("--new", options->fresh, "start without a FILE: the script makes surfaces with the command new");
  command->add_option("-o,--output", options->output, "CAD file to write, completely or not at all")->required();
  command->add_option("--script", options->script, "JSON file with the commands")->required();
  command->add_option("--schema", options->schema, "of a new STEP file: ap214 or ap242")
      ->check(CLI::IsMember({"ap214", "ap242"}))
      ->capture_default_str();
  options->unpack.add_to(*command);
  command->add_flag("--keep-partial", options->keep_partial,
                    "at Ctrl+C write what the steps done so far have made; a second Ctrl+C writes nothing");
  command->add_option("--report", options->report, "JSON file for the report, see below");
  command->add_option("--picture", options->picture, "SVG file for a picture of the displacement over (u, v)");
  command->footer(
      R"(The script is {"knead": 2, "commands": [{"do": "...", ...}, ...]}. Lengths are in file units. The edges of faces are held;
a script of version 1 holds nothing by itself. The commands, and under each
its fields with their defaults (`knead commands NAME` explains them):

)" + command_help() +
      R"(
The report is {"steps": [{"time", "energy", "residual", "largest_displacement", "stretch", "bend", "kinetic", "contact",
"gap", "constraint_violation", "converged", "limited", "note", of shells "load_factor", "increments", of rational shapes
"energy_error"}, ...], "time",
"energy_before", "energy_after", "residual", "largest_displacement", "control_points_moved", "edges", "places", "seams",
"notes", and after modes and buckling "modes": [{"frequency", "residual"}], "buckling": [{"load_factor", "residual"}]}: times in
seconds, lengths in file units, gaps in sizes of the tool.
)" + std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
