#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "cli.hpp"
#include "faces.hpp"
#include "knead/base/printable.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/save_model.hpp"
#include "knead/session/command_json.hpp"
#include "knead/session/report.hpp"
#include "knead/session/session.hpp"
#include "outputs.hpp"
#include "picture.hpp"
#include "progress.hpp"
#include "run_script.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

struct SculptArguments {
  std::string file, output, script, report, picture;
  std::optional<std::string> schema;
  bool fresh = false, keep_partial = false;
  UnpackOption unpack;
  [[nodiscard]] const std::string& name() const { return fresh ? output : file; }
};

void print_tools(const Session& session) {
  for (const Tool& t : session.tools()) {
    const Point& c = t.shape.placement().position;
    say("  tool {}: {} at ({:.6g}, {:.6g}, {:.6g}), {}, stiffness {:.4g}\n", printable(t.name),
        in_words(t.shape.shape()), c.x(), c.y(), c.z(),
        t.collides() ? (t.mode == ToolMode::imprint ? "imprint" : "collision")
                     : fmt::format("proximity within {:.4g}", t.range),
        t.stiffness);
  }
}

void print_summary(const SculptArguments& options, const Session& session, const Outcome& o) {
  const std::string& file = options.name();
  const std::vector<SessionSurface> surfaces = session.surfaces();
  const std::vector<int> selection = session.selection();
  if (const auto b = report_body(session)) {
    say("{}: {} {}{}, lengths in {}\n", file, b->kind, b->id,
        b->name.empty() ? "" : " \"" + printable(b->name) + "\"", b->unit);
    say("  degree {}, net {}\n", fmt::join(b->degrees, " x "), fmt::join(b->net, " x "));
    print_tools(session);
  } else if (selection.empty()) {
    say("{}: no surface selected\n", file);
  } else {
    for (int index : selection) {
      const SessionSurface& s = surfaces[static_cast<std::size_t>(index)];
      const auto [m, n] = s.current->net();
      say("{}: surface {}{}, lengths in {}\n", file, s.id,
          s.name.empty() ? "" : " \"" + printable(s.name) + "\"", s.unit);
      say("  degree {} x {}, net {} x {}, {}\n", s.current->knots(0).degree(),
          s.current->knots(1).degree(), m, n, s.current->rational() ? "rational" : "polynomial");
    }
    print_tools(session);
  }
  for (const std::string& note : o.notes) say("  {}\n", printable(note, 2000));
  print_edges(session);
  for (const RepeatedSurface& r : o.places) {
    say("  {}: its part \"{}\" stands in {} places of the assembly, and has changed in all of "
        "them\n",
        r.surface, printable(r.part), r.places);
  }
  for (const SeamSummary& s : report_seams(session)) {
    say("  seam {} - {}: {}{}{}\n", s.a, s.b, s.continuity, s.reason.empty() ? "" : ", ", s.reason);
  }
  if (const std::vector<StepRecord> steps = session.steps(); !steps.empty()) {
    say("  {} step{}, {:.3g} ms each ({:.3g} s in all), residual {:.2g}\n", steps.size(),
        steps.size() == 1 ? "" : "s", 1e3 * o.time / static_cast<double>(steps.size()), o.time,
        o.residual);
    say("  largest displacement {:.6g}, {} control point{} moved\n", o.largest_displacement,
        o.moved, o.moved == 1 ? "" : "s");
    if (std::isfinite(o.energy_after)) {
      say("  energy {:.6g} before, {:.6g} after\n", o.energy_before, o.energy_after);
    }
    if (o.gap > 0) say("  deepest entry into a tool: {:.2g} of its size\n", o.gap);
    const StepRecord& last = steps.back();
    if (!last.note.empty()) {
      say(stderr, "knead: warning: {}\n", printable(last.note, 2000));
    } else if (!last.converged) {
      say(stderr,
          "knead: warning: the last step stopped before its minimum was reached; use more steps or "
          "a larger lambda\n");
    }
  }
}

/// The format of a new file that the output's name asks for: the input has another one, whose faces
/// a new file holds if it has some. Null: the output is the input, changed.
const Format* other_format(const SculptArguments& options, const Document& document) {
  const auto wanted = format_of_name(options.output, FormatContent::surfaces);
  const bool plain = std::filesystem::path(uncompressed_name(options.output)).extension().empty();
  if (document.source() == nullptr && plain) return find_format("step");
  if (!wanted || (*wanted)->save == nullptr) return nullptr;
  if (document.model() != nullptr && !holds_faces(**wanted)) return nullptr;
  return document.source() == nullptr || (*wanted)->name != document.source()->format() ? *wanted
                                                                                        : nullptr;
}

/// What is made of the work beside the CAD file: if that cannot be, the work is written all the
/// same, and the error comes afterwards.
class Besides {
 public:
  void write(const std::string& path, const std::string& option,
             const Expected<std::string>& bytes) {
    auto result = bytes ? write_output(path, *bytes)
                        : Expected<void>(std::unexpected(bytes.error().within(option)));
    if (result) return say("wrote {}\n", path);
    if (result.error().kind == ErrorKind::usage) result.error().kind = ErrorKind::input;
    if (first) first = std::move(result);
  }
  Expected<void> first;  ///< error
};

Expected<std::string> picture_of(const Session& session) {
  const std::vector<int> selection = session.selection();
  if (selection.empty())
    return input_error("no surface is selected, so there is nothing to draw", {}, "select one");
  const SessionSurface s = session.surfaces()[static_cast<std::size_t>(selection.front())];
  return displacement_picture(*s.opened, *s.current,
                              "Displacement of " + (s.name.empty() ? s.id : s.name), s.unit);
}

/// The CAD file comes last, after what is asked for besides.
Expected<void> write_results(const SculptArguments& options, const Session& session,
                             const Outcome& o) {
  const Format* other = other_format(options, session.document());
  SaveOptions how;
  if (options.schema) how.schema = *options.schema;
  const bool faces = other != nullptr && session.document().model() != nullptr;
  auto bytes = faces              ? bytes_of_faces(session, *other, how)
               : other != nullptr ? session.save_as(*other, how)
                                  : session.save();
  if (bytes) bytes = compressed_by_name(*std::move(bytes), options.output, options.file);
  if (!bytes) {
    if (options.fresh && bytes.error().file.empty()) bytes.error().file = options.script;
    return std::unexpected(bytes.error());
  }
  const auto& surfaces = session.document().surfaces();
  if (other != nullptr && !options.fresh && !surfaces.empty() &&
      surfaces.front().unit == "unknown") {
    say("lengths are written as millimetres: {} does not say what they are\n", options.file);
  }
  Besides besides;
  if (!options.report.empty()) besides.write(options.report, "--report", report_json(session, o));
  if (!options.picture.empty()) besides.write(options.picture, "--picture", picture_of(session));
  if (auto result = write_output(options.output, *bytes); !result) return result;
  say("wrote {} ({} surface{}{} changed)\n", options.output, o.surfaces, o.surfaces == 1 ? "" : "s",
      o.bodies == 0 ? ""
                    : fmt::format(", {} curve{} or volume{}", o.bodies, o.bodies == 1 ? "" : "s",
                                  o.bodies == 1 ? "" : "s"));
  return besides.first;
}

/// Whether the name of the output promises what is written: it has no ending, that of the input, or
/// one of a CAD format.
Expected<void> check_ending(const SculptArguments& options, const Document& document) {
  const auto ending_of = [](const std::string& name) {
    return std::filesystem::path(uncompressed_name(name)).extension();
  };
  if (ending_of(options.output).empty() || ending_of(options.output) == ending_of(options.file))
    return {};
  const auto wanted = format_of_name(options.output, FormatContent::surfaces);
  const std::string_view written =
      document.source() != nullptr ? document.source()->format() : "STEP";
  if (wanted && (*wanted)->name == written) return {};
  if (other_format(options, document) != nullptr) return {};
  std::string endings;
  for (const Format& format : formats()) {
    if (format.name != written) continue;
    for (const std::string_view e : format.endings)
      endings += (endings.empty() ? "" : ", ") + std::string(e);
  }
  return usage_error(fmt::format("\"{}\" is not the name of a {} file, and the result is one",
                                 options.output, written),
                     "--output",
                     fmt::format("use a name that ends in one of {}; `knead mesh` writes {}",
                                 endings, list_of_endings(FormatContent::triangles)));
}

Expected<void> run(const SculptArguments& options) {
  if (options.output.empty())
    return usage_error("the name is empty", "--output", "name the file to write");
  const NamedFile file{"FILE", options.file}, script{"--script", options.script},
      output{"--output", options.output};
  // The surface may be sculpted in place: only --output may name the input file.
  if (auto possible = check_outputs({output}, {script}); !possible) return possible;
  const NamedFile report{"--report", options.report}, picture{"--picture", options.picture};
  if (auto possible = check_outputs({report, picture}, {file, script, output}); !possible)
    return possible;
  if (auto drawn = check_name(picture, ".svg", "an SVG file"); !drawn) return drawn;
  if (auto one = check_source(options.file, options.fresh); !one) return one;
  const auto commands = read_script(options.script);
  if (!commands) return std::unexpected(commands.error());
  auto document = open_document(options.file, options.fresh, options.unpack);
  if (!document) return std::unexpected(document.error());
  if (auto possible = check_ending(options, *document); !possible) return possible;
  const Format* made = other_format(options, *document);
  if (options.schema && (made == nullptr || made->id != "step")) {
    return usage_error("this does not write a new STEP file", "--schema",
                       "leave it out: a file keeps its schema");
  }

  const std::size_t opened = document->surfaces().size();
  Session session(std::move(*document));
  std::optional<Interrupt> interrupt;
  if (options.keep_partial) interrupt.emplace();
  const auto result = execute(session, *commands, options.keep_partial);
  if (!result) return std::unexpected(result.error());
  const Outcome outcome = outcome_of(session, opened);
  if (outcome.no_energy)
    say(stderr, "knead: warning: there is no energy: {}\n", outcome.no_energy->message());
  print_summary(options, session, outcome);
  if (!result->complete) {
    const std::size_t implied = std::min(commands->implied, result->commands);
    say(stderr, "knead: stopped: {} of {} commands are done; what stands is written\n",
        result->commands - implied, commands->commands.size() - commands->implied);
  }
  auto written = write_results(options, session, outcome);
  if (written && !result->complete) {
    std::fflush(stdout);
    Interrupt::pass_on();
  }
  return written;
}

}  // namespace

Action add_sculpt(CLI::App& app) {
  auto options = std::make_shared<SculptArguments>();
  CLI::App* command =
      app.add_subcommand("sculpt", "run a script of sculpting commands on a CAD file");
  command
      ->add_option("FILE", options->file,
                   "STEP file to sculpt; it is not changed, unless --output names it too")
      ->type_name("");
  command->add_flag("--new", options->fresh,
                    "start without a FILE: the script makes surfaces with the command new");
  command->add_option("-o,--output", options->output, "CAD file to write, completely or not at all")
      ->required();
  command->add_option("--script", options->script, "JSON file with the commands")->required();
  command->add_option("--schema", options->schema, "of a new STEP file: ap214 or ap242")
      ->check(CLI::IsMember({"ap214", "ap242"}))
      ->default_str("ap214");
  options->unpack.add_to(*command);
  command->add_flag(
      "--keep-partial", options->keep_partial,
      "at Ctrl+C write what the steps done so far have made; a second Ctrl+C writes nothing");
  command->add_option("--report", options->report, "JSON file for the report, see below");
  command->add_option("--picture", options->picture,
                      "SVG file for a picture of the displacement over (u, v)");
  command->footer(
      R"(The script is {"knead": 2, "commands": [{"do": "...", ...}, ...]}. Lengths are in file
units. The edges of faces are held. The commands, and under each its fields with their
defaults (`knead commands NAME` explains them):

)" + command_help() +
      R"(
The report:
{"steps": [{"time", "energy", "residual", "largest_displacement", "stretch", "bend", "kinetic",
            "contact", "gap", "gap_tool", "constraint_violation", "converged", "limited", "note",
            of shells "load_factor", "increments", of rational shapes "energy_error"}, ...],
 "time", "energy_before", "energy_after", "residual", "largest_displacement",
 "control_points_moved", "edges", "places", "seams", "notes",
 of notes for programs "coded_notes": [{"text", "code", "values", "fixes"}, ...],
 after modes and buckling "modes": [{"frequency", "residual"}],
                          "buckling": [{"load_factor", "residual"}]}
Times are in seconds, lengths in file units, gaps in sizes of the tool.
)" + std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
