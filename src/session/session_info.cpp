#include "knead/session/session_info.hpp"

#include <algorithm>
#include <cmath>

#include "commands.hpp"
#include "describe/text.hpp"
#include "described_state.hpp"
#include "diagnostic_info.hpp"
#include "info_values.hpp"
#include "restated.hpp"
#include "tool/describe_shape.hpp"

namespace knead {

// What is reported about each part of a session: plain values filled from the state, and their
// descriptions.

struct SurfaceInfo {
  std::string id, name, unit;
  std::array<int, 2> degree = {0, 0}, net = {0, 0};
  bool rational = false;
  Vector3 lower = {0, 0, 0}, upper = {0, 0, 0};
  std::array<std::optional<double>, 3> alpha, beta;
  double poisson = 0;
  std::optional<double> mass, damping;
  std::optional<MaterialPreset> preset;
  std::optional<ShellMaterial> shell;
  std::optional<FundamentalMaterial> fundamental;
  double plasticity = 0, yield = 0, locality = 0;
  LengthUnit lengths = LengthUnit::radii;
  RestMode rest = RestMode::shape;
  int faces = 0, hold = 0, pins = 0;
  bool locked = false, bare = false, masked = false;
  std::vector<std::array<int, 2>> pinned;
  std::vector<CommandVariant> constraints;
  int moved = 0;
};

static void describe(SurfaceInfo& s, Fields& fields) {
  fields.name("surface info", "A surface of the session.");
  fields.add("id", s.id);
  fields.add("name", s.name);
  fields.add("unit", s.unit, {.help = "of all lengths"});
  fields.add("degree", s.degree);
  fields.add("net", s.net, {.help = "control points [m, n]; (i, j) is number i n + j"});
  fields.add("rational", s.rational);
  fields.add("lower", s.lower,
             {.help = "corner of the control points' bounding box", .unit = Unit::length});
  fields.add("upper", s.upper, {.help = "the opposite corner", .unit = Unit::length});
  fields.add("alpha", s.alpha,
             {.help = "coefficients 11, 12, 22; null where one varies over the surface"});
  fields.add("beta", s.beta, {.help = "likewise"});
  fields.add("poisson", s.poisson, {.help = "of bending; that of a shell stands with it"});
  fields.add("mass", s.mass, {.help = "null where it varies"});
  fields.add("damping", s.damping, {.help = "null where it varies"});
  fields.add("preset", s.preset, {.help = "its named material, if it has one"});
  fields.add("shell", s.shell, {.help = "null where the model is another one"});
  fields.add("fundamental", s.fundamental, {.help = "likewise"});
  fields.add("plasticity", s.plasticity, {.help = "share of a displacement that strokes leave"});
  fields.add("yield", s.yield, {.help = "up to this displacement they leave nothing"});
  fields.add("locality", s.locality, {.help = "how far a dent is felt"});
  fields.add("lengths", s.lengths, {.help = "what `yield` and `locality` count"});
  fields.add("rest", s.rest);
  fields.add("faces", s.faces, {.help = "of the file that lie on it"});
  fields.add("locked", s.locked, {.help = "whether it can be selected only when it is unlocked"});
  fields.add(
      "bare", s.bare,
      {.help =
           "whether it is of the file and no face lies on it: its sides are held as edges are"});
  fields.add("hold", s.hold, {.help = "outer rows of control points that do not move"});
  fields.add("pins", s.pins, {.help = "number of pinned control points"});
  fields.add("pinned", s.pinned, {.help = "the pinned control points [i, j]"});
  fields.add("masked", s.masked, {.help = "whether any of it is masked"});
  fields.add("constraints", s.constraints, {.help = "the commands that restate what holds it"});
  fields.add("moved", s.moved, {.help = "number of control points that are not as opened"});
}

struct ToolInfo {
  Shape shape;
  std::string name;
  ToolMode mode = ToolMode::collision;
  double stiffness = 0, range = 0;
  bool rigid = false;
  double friction = 0, plasticity = 0;
  ToolDirection direction = ToolDirection::pull;
  Vector3 position = {0, 0, 0};
  std::array<double, 4> rotation = {0, 0, 0, 1};
  Vector3 scale = {1, 1, 1};
  std::optional<double> size;
};

static void describe(ToolInfo& t, Fields& fields) {
  fields.name("tool info",
              "A tool of the session: its shape's fields, how it acts and where it is.");
  fields.add_flat(t.shape);
  fields.add("name", t.name);
  fields.add("mode", t.mode);
  fields.add("stiffness", t.stiffness);
  fields.add("range", t.range, {.unit = Unit::length});
  fields.add("rigid", t.rigid);
  fields.add("friction", t.friction);
  fields.add("plasticity", t.plasticity, {.unit = Unit::fraction});
  fields.add("direction", t.direction);
  fields.add("position", t.position, {.help = "of the centre", .unit = Unit::length});
  fields.add("rotation", t.rotation, {.help = "a quaternion x, y, z, w"});
  fields.add("scale", t.scale, {.help = "along its own axes"});
  fields.add("size", t.size,
             {.help = "its smallest feature; null where it has none", .unit = Unit::length});
}

struct SeamInfo {
  SeamContinuity continuity = SeamContinuity::none;
  double gap = 0;
  std::string reason;
};

static void describe(SeamInfo& s, Fields& fields) {
  fields.name("seam info", "");
  fields.add("continuity", s.continuity);
  fields.add("gap", s.gap, {.unit = Unit::length});
  fields.add("reason", s.reason, {.help = "why the continuity is not higher"});
}

void describe(VibrationInfo& m, Fields& fields) {
  fields.name("vibration info", "A free vibration of the structure.");
  fields.add("frequency", m.frequency,
             {.help = "per unit of time; below 0 the structure is unstable"});
  fields.add("residual", m.residual, {.help = "relative"});
}

void describe(BucklingInfo& m, Fields& fields) {
  fields.name("buckling info", "A load at which a shell buckles.");
  fields.add("load_factor", m.load_factor, {.help = "by which the present loads are multiplied"});
  fields.add("residual", m.residual, {.help = "relative"});
}

// The commands that would restate them, hence with their names.
static std::string_view tag_of(const std::variant<LoadCommand>*) { return "do"; }
static std::string_view tag_of(const std::variant<EvolveCommand>*) { return "do"; }

struct SessionInfo {
  std::string name;
  bool fresh = false;
  std::vector<int> selection;
  std::vector<SurfaceInfo> surfaces;
  std::vector<BodyInfo> bodies;
  std::optional<int> body;
  std::vector<ToolInfo> tools;
  std::vector<CommandVariant> forces;
  std::variant<LoadCommand> load;
  std::variant<EvolveCommand> evolve;
  std::optional<double> limit;
  bool raw = false, coupled = true, smooth = false;
  RefinePermission refine = RefinePermission::never;
  std::vector<SeamInfo> seams;
  std::vector<ReadingInfo> readings;
  std::vector<NoteInfo> notes;
  int steps = 0;
  std::optional<StepRecord> last;
  std::vector<VibrationInfo> modes;
  std::vector<BucklingInfo> buckling;
  bool undo = false, redo = false;
};

static void describe(SessionInfo& s, Fields& fields) {
  fields.name("session info", "The session as it is reported.");
  fields.add("name", s.name, {.help = "of the document"});
  fields.add("fresh", s.fresh, {.help = "it began without a file"});
  fields.add("selection", s.selection,
             {.help = "numbers of the selected surfaces, the first one first"});
  fields.add("surfaces", s.surfaces);
  fields.add("bodies", s.bodies, {.help = "curves and volumes"});
  fields.add("body", s.body, {.help = "the number of the selected one, if no surface is selected"});
  fields.add("tools", s.tools);
  fields.add("forces", s.forces);
  fields.add("load", s.load);
  fields.add("evolve", s.evolve);
  fields.add("limit", s.limit, {.unit = Unit::length});
  fields.add("raw", s.raw, {.help = "the scaling is that of the equations"});
  fields.add("coupled", s.coupled, {.help = "along seams"});
  fields.add("smooth", s.smooth, {.help = "seams, even where their sides are in no fixed ratio"});
  fields.add("refine", s.refine);
  fields.add("seams", s.seams);
  fields.add("readings", s.readings, {.help = "of the points that `measure` names"});
  fields.add("notes", s.notes);
  fields.add("steps", s.steps, {.help = "their number"});
  fields.add("last", s.last, {.help = "the last step"});
  fields.add("modes", s.modes, {.help = "that the last command `modes` found, the lowest first"});
  fields.add("buckling", s.buckling, {.help = "likewise of `buckling`"});
  fields.add("undo", s.undo);
  fields.add("redo", s.redo);
}

template <>
const Type& type_of<SessionInfo>() {
  return make_type<SessionInfo>();
}

namespace {

std::optional<double> constant(const Coefficient<2>& c) {
  const double* value = std::get_if<double>(&c);
  return value ? std::optional(*value) : std::nullopt;
}

SurfaceInfo info_of(const Session& session, std::size_t index) {
  const SceneSurface& s = session.state().surfaces[index];
  const Points& points = s.current->control_points();
  SurfaceInfo info;
  info.id = s.id;
  info.name = s.name;
  info.unit = s.unit;
  info.degree = {s.current->knots(0).degree(), s.current->knots(1).degree()};
  info.net = s.current->net();
  info.rational = s.current->rational();
  info.lower = array_of(points.colwise().minCoeff().transpose());
  info.upper = array_of(points.colwise().maxCoeff().transpose());
  std::ranges::transform(s.material.alpha, info.alpha.begin(), constant);
  std::ranges::transform(s.material.beta, info.beta.begin(), constant);
  info.poisson = s.material.poisson;
  info.mass = constant(s.material.mass);
  info.damping = constant(s.material.damping);
  info.preset = preset_of(s);
  if (const auto* shell = std::get_if<ShellMaterial>(&s.elasticity)) info.shell = *shell;
  if (const auto* forms = std::get_if<FundamentalMaterial>(&s.elasticity))
    info.fundamental = *forms;
  info.plasticity = s.plastic.share;
  info.yield = s.plastic.yield;
  info.locality = s.plastic.locality;
  info.lengths = s.plastic.in_radii ? LengthUnit::radii : LengthUnit::file;
  info.rest = s.mode;
  if (const brep::Model* model = session.document().model()) {
    const brep::SplineSurface* in_file = model->find_surface(s.id);
    info.faces = in_file != nullptr ? in_file->faces : 0;
  }
  const auto& opened = session.document().surfaces();
  info.locked = s.locked;
  info.bare =
      info.faces == 0 && std::ranges::find(opened, s.id, &DocumentSurface::id) != opened.end();
  info.hold = s.hold_rows;
  info.masked = !s.mask.empty();
  info.pins = static_cast<int>(s.pins.size());
  info.pinned.assign(s.pins.begin(), s.pins.end());
  for (const KeptConstraint& kept : s.constraints)
    info.constraints.push_back(restated(kept.constraint).any().fields);
  info.moved = static_cast<int>(session.moved_control_points(static_cast<int>(index)));
  return info;
}

ToolInfo info_of(const Tool& tool) {
  const Placement& at = tool.shape.placement();
  ToolInfo info;
  info.shape = tool.shape.shape();
  info.name = tool.name;
  info.mode = tool.mode;
  info.stiffness = tool.stiffness;
  info.range = tool.range;
  info.rigid = tool.rigid;
  info.friction = tool.friction;
  info.plasticity = tool.plasticity;
  info.direction = tool.direction;
  info.position = array_of(at.position);
  info.rotation = {at.rotation.x(), at.rotation.y(), at.rotation.z(), at.rotation.w()};
  info.scale = at.scale;
  if (std::isfinite(tool.shape.size())) info.size = tool.shape.size();
  return info;
}

}  // namespace

std::string session_json(const Session& session) {
  const SessionState& state = session.state();
  SessionInfo info;
  info.name = session.document().name();
  info.fresh = session.document().is_fresh();
  info.selection = state.selection();
  for (std::size_t k = 0; k < state.surfaces.size(); ++k)
    info.surfaces.push_back(info_of(session, k));
  info.bodies = bodies_of(state);
  info.body = state.body;
  for (const Tool& tool : state.tools) info.tools.push_back(info_of(tool));
  for (const SceneForce& force : state.forces) info.forces.emplace_back(restated(force));
  info.load = LoadCommand{state.load};
  info.evolve = EvolveCommand{state.evolution};
  info.limit = state.limit;
  info.raw = state.scaling == ScalingMode::raw;
  info.coupled = state.seams.couple;
  info.smooth = state.seams.smooth;
  info.refine = state.permission;
  for (const SeamReport& seam : state.seam_reports)
    info.seams.push_back({seam.continuity, seam.seam.gap, seam.reason});
  info.readings = readings_of(state);
  for (const Note& note : state.notes) info.notes.push_back(info_of(note));
  info.steps = static_cast<int>(state.steps.size());
  if (!state.steps.empty()) info.last = state.steps.back();
  info.modes = infos_of<VibrationInfo>(state.modes);
  info.buckling = infos_of<BucklingInfo>(state.buckling);
  info.undo = session.can_undo();
  info.redo = session.can_redo();
  return json_of(info);
}

std::string steps_json(const Session& session, std::size_t first) {
  const auto& steps = session.state().steps;
  return json_of(std::vector<StepRecord>(
      steps.begin() + static_cast<std::ptrdiff_t>(std::min(first, steps.size())), steps.end()));
}

std::string session_typescript(void (*more)(TypeScript&)) {
  TypeScript types;
  types.declare(type_of<CommandVariant>(), "AnyCommand", "Command");
  types.declare(type_of<SessionInfo>(), "SessionInfo", "Info", Absent::null);
  types.declare(type_of<ErrorInfo>(), "EngineErrorInfo", "Info", Absent::null);
  if (more != nullptr) more(types);
  types.list(type_of<Shape>(), "shapes");
  types.text += "\nexport const materials = " + json_of(named_materials()) + " as const;\n";
  return "// Generated from the engine's descriptions; not to be edited. Lengths are in file "
         "units.\n\n" +
         std::move(types.text);
}

}  // namespace knead
