#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <memory>

#include "cli.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/session/command_json.hpp"
#include "knead/session/session.hpp"
#include "outputs.hpp"
#include "picture.hpp"

namespace knead::cli {
namespace {

struct Options {
  std::string file, output, script, report, picture;
};

/// "step 12 of 60" on standard error, when that is a terminal and the work has taken more than a second.
class ProgressLine {
 public:
  void show(int done, int total) {
    const auto now = std::chrono::steady_clock::now();
    if (!terminal_ || now - start_ < std::chrono::seconds(1) || now - shown_ < std::chrono::milliseconds(100)) return;
    shown_ = now;
    fmt::print(stderr, "\rstep {} of {} ", done, total);
    std::fflush(stderr);
  }
  ~ProgressLine() {
    if (shown_ > start_) fmt::print(stderr, "\r\x1b[K");
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), shown_ = start_;
};

struct Outcome {
  double time = 0, energy_before = 0, energy_after = 0, residual = 0, largest_displacement = 0;
  int moved = 0, surfaces = 0;
};

Expected<Outcome> outcome_of(Session& session) {
  const SessionState& state = session.state();
  Outcome o;
  const auto energy = session.energy();
  if (!energy) return std::unexpected(energy.error());
  o.energy_after = *energy;
  o.energy_before = state.energy_before.value_or(*energy);
  for (const StepRecord& s : state.steps) o.time += s.time;
  if (!state.steps.empty()) o.residual = state.steps.back().residual;
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const int moved = session.moved_control_points(static_cast<int>(k));
    if (moved == 0) continue;
    o.moved += moved;
    ++o.surfaces;
    o.largest_displacement = std::max(o.largest_displacement, session.largest_displacement(static_cast<int>(k)));
  }
  return o;
}

std::string report_json(const SessionState& state, const Outcome& o) {
  std::string text = "{\"steps\":[";
  for (std::size_t k = 0; k < state.steps.size(); ++k) {
    const StepRecord& s = state.steps[k];
    text += fmt::format("{}\n {{\"time\":{},\"energy\":{},\"residual\":{},\"largest_displacement\":{}}}",
                        k == 0 ? "" : ",", json_number(s.time), json_number(s.energy), json_number(s.residual),
                        json_number(s.largest_displacement));
  }
  return text + fmt::format(
                    "],\n\"time\":{},\"energy_before\":{},\"energy_after\":{},\"residual\":{},"
                    "\"largest_displacement\":{},\"control_points_moved\":{}}}\n",
                    json_number(o.time), json_number(o.energy_before), json_number(o.energy_after),
                    json_number(o.residual), json_number(o.largest_displacement), o.moved);
}

void print_summary(const Options& options, const Session& session, const Outcome& o) {
  const SessionState& state = session.state();
  const std::string& file = options.file;
  if (!state.selected) {
    fmt::print("{}: no surface selected\n", file);
  } else {
    const DocumentSurface& s = session.document().surfaces()[static_cast<std::size_t>(*state.selected)];
    const auto [m, n] = s.surface->net();
    fmt::print("{}: surface {}{}, lengths in {}\n", file, s.id, s.name.empty() ? "" : " \"" + s.name + "\"", s.unit);
    fmt::print("  degree {} x {}, net {} x {}, {}\n", s.surface->knots(0).degree(), s.surface->knots(1).degree(), m, n,
               s.surface->rational() ? "rational" : "polynomial");
    for (const Tool& t : state.tools) {
      const Point& c = t.shape.centre;
      fmt::print("  tool {}: sphere of radius {:.4g} at ({:.6g}, {:.6g}, {:.6g}), {}, stiffness {:.4g}\n", t.name,
                 t.shape.radius, c.x(), c.y(), c.z(),
                 t.mode == ToolMode::collision ? "collision" : fmt::format("proximity within {:.4g}", t.range),
                 t.stiffness);
    }
  }
  if (!state.steps.empty()) {
    fmt::print("  {} steps, {:.3g} ms each ({:.3g} s in all), residual {:.2g}\n", state.steps.size(),
               1e3 * o.time / static_cast<double>(state.steps.size()), o.time, o.residual);
    fmt::print("  largest displacement {:.6g}, {} control point{} moved\n", o.largest_displacement, o.moved,
               o.moved == 1 ? "" : "s");
    fmt::print("  energy {:.6g} before, {:.6g} after\n", o.energy_before, o.energy_after);
    if (!state.steps.back().converged) {
      fmt::print(stderr,
                 "knead: warning: the last step stopped before its minimum was reached; use more steps or a "
                 "larger lambda\n");
    }
  }
}

/// The CAD file comes last: where it stands, everything that was asked for does.
Expected<void> write_results(const Options& options, const Session& session, const Outcome& o) {
  auto bytes = session.save();
  if (!bytes) return std::unexpected(bytes.error());
  std::string picture;
  if (!options.picture.empty()) {
    const SessionState& state = session.state();
    if (!state.selected) {
      return usage_error("there is no picture without a selected surface", "--picture", "leave it out");
    }
    const auto k = static_cast<std::size_t>(*state.selected);
    const DocumentSurface& s = session.document().surfaces()[k];
    auto svg = displacement_picture(*s.surface, *state.surfaces[k].current,
                                    "Displacement of " + (s.name.empty() ? s.id : s.name), s.unit);
    if (!svg) return std::unexpected(svg.error());
    picture = std::move(*svg);
  }
  if (!options.report.empty()) {
    if (auto done = write_file_atomically(options.report, report_json(session.state(), o)); !done) return done;
    fmt::print("wrote {}\n", options.report);
  }
  if (!options.picture.empty()) {
    if (auto done = write_file_atomically(options.picture, picture); !done) return done;
    fmt::print("wrote {}\n", options.picture);
  }
  if (auto done = write_file_atomically(options.output, *bytes); !done) return done;
  fmt::print("wrote {} ({} surface{} changed)\n", options.output, o.surfaces, o.surfaces == 1 ? "" : "s");
  return {};
}

Expected<void> run(const Options& options) {
  if (options.output.empty()) return usage_error("the name is empty", "--output", "name the STEP file to write");
  const NamedFile file{"FILE", options.file}, script{"--script", options.script}, output{"--output", options.output};
  // The surface may be sculpted in place: only --output may name the file that is read.
  if (auto possible = check_outputs({output}, {script}); !possible) return possible;
  const NamedFile report{"--report", options.report}, picture{"--picture", options.picture};
  if (auto possible = check_outputs({report, picture}, {file, script, output}); !possible) return possible;
  const auto text = read_file(options.script);
  if (!text) return std::unexpected(text.error());
  const auto commands = parse_script(*text, options.script);
  if (!commands) return std::unexpected(commands.error());
  auto document = Document::open(options.file);
  if (!document) return std::unexpected(document.error());

  Session session(std::move(*document));
  {
    ProgressLine line;
    for (std::size_t k = 0; k < commands->size(); ++k) {
      auto done = session.execute((*commands)[k], [&line](int step, int total) { line.show(step, total); });
      if (!done) {
        Error error = done.error().within(fmt::format("commands[{}]", k));
        error.file = options.script;
        return std::unexpected(error);
      }
    }
  }
  const auto outcome = outcome_of(session);
  if (!outcome) return std::unexpected(outcome.error());
  print_summary(options, session, *outcome);
  return write_results(options, session, *outcome);
}

}  // namespace

Action add_sculpt(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("sculpt", "run a script of sculpting commands on a CAD file");
  command->add_option("FILE", options->file, "STEP file to sculpt; it is not changed, unless --output names it too")
      ->required()
      ->type_name("");
  command->add_option("-o,--output", options->output, "STEP file to write; it appears whole or not at all")->required();
  command->add_option("--script", options->script, "JSON file with the commands")->required();
  command->add_option("--report", options->report, "JSON file to write what every step did to, see below");
  command->add_option("--picture", options->picture, "SVG file to draw the displacement over (u, v) to");
  command->footer(
      R"(The script is {"knead": 1, "commands": [{"do": "...", ...}, ...]}. Lengths are in file units. The commands:

)" + command_help() +
      R"(
The report is {"steps": [{"time", "energy", "residual", "largest_displacement"}, ...], "time", "energy_before",
"energy_after", "residual", "largest_displacement", "control_points_moved"}: times in seconds, lengths in file units.
)" + std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
