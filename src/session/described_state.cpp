// What a state consists of: the descriptions of the scene and of the record, by which snapshots are
// written and read.
#include "described_state.hpp"

#include "kept_forms.hpp"

namespace knead {

// --- shapes
// -----------------------------------------------------------------------------------------------

static std::string_view tag_of(const SceneBody*) { return "kind"; }
static std::string_view tag_of(const Elasticity<1>*) { return "elasticity"; }
static std::string_view tag_of(const Elasticity<2>*) { return "elasticity"; }

static void describe(LinearElasticity&, Fields& fields) { fields.name("linear", ""); }

static void describe(FormWeights& w, Fields& fields) {
  fields.name("forms", "");
  fields.add_all("w1", w.w1, "w2", w.w2);
}

void describe(ShellMaterial& m, Fields& fields) {
  fields.name("shell info", "The material of a shell, in units of the file.");
  fields.add("young", m.young, {.help = "its mean where it varies"});
  fields.add("poisson", m.poisson);
  fields.add("thickness", m.thickness, {.help = "its mean where it varies", .unit = Unit::length});
  fields.add_all("density", m.density, "young_field", m.young_field, "thickness_field",
                 m.thickness_field);
}

void describe(FundamentalMaterial& m, Fields& fields) {
  fields.name("fundamental info", "The weights of the fundamental forms, in the order 11, 12, 22.");
  fields.add_all("w1", m.w1, "w2", m.w2);
}

template <int D>
void describe(KeptConstraintOf<D>& c, Fields& fields) {
  fields.add_all("constraint", c.constraint, "where", c.where);
}

static void describe(PlasticPolicy& p, Fields& fields) {
  fields.add_all("along", p.along, "share", p.share, "yield", p.yield, "locality", p.locality,
                 "in_radii", p.in_radii);
}

static void describe_own(SurfaceOwn& s, Fields& fields) {
  fields.add_all("locked", s.locked, "smooth_knot_lines", s.smooth_knot_lines, "smooth_poles",
                 s.smooth_poles, "plastic", s.plastic, "mask", s.mask);
}

template <int D>
void describe(SceneShape<D>& s, Fields& fields) {
  fields.name(kind_of(D), "");
  fields.add_all("id", s.id, "name", s.name, "unit", s.unit, "velocity", s.velocity, "mode", s.mode,
                 "hold_rows", s.hold_rows, "opened", s.opened, "reference", s.reference, "rest",
                 s.rest, "current", s.current, "alpha", s.material.alpha, "beta", s.material.beta,
                 "poisson", s.material.poisson, "mass", s.material.mass, "damping",
                 s.material.damping, "elasticity", s.elasticity, "pins", s.pins, "constraints",
                 s.constraints);
  if constexpr (D == 2) describe_own(s, fields);
}

// --- what acts on them
// -----------------------------------------------------------------------------------------------

static void describe(Tool& t, Fields& fields) {
  fields.add_all("name", t.name, "shape", t.shape, "mode", t.mode, "stiffness", t.stiffness,
                 "range", t.range, "rigid", t.rigid, "friction", t.friction, "plasticity",
                 t.plasticity, "direction", t.direction, "touches", t.touches);
}

static void describe(Probe& p, Fields& fields) {
  fields.add_all("list", p.list, "name", p.name, "surface", p.surface, "at", p.at);
}

static void describe(FollowedEdge& e, Fields& fields) { fields.add("id", e.id); }

static void describe(OpenStroke::Before& b, Fields& fields) {
  fields.add_all("rest", b.rest, "current", b.current);
}

static void describe(OpenStroke& s, Fields& fields) {
  fields.add_all("tool", s.tool, "home", s.home, "spacing", s.path.spacing, "way", s.path.rest,
                 "end", s.path.end, "begun", s.path.begun, "lambda", s.lambda, "stiffness",
                 s.stiffness, "tension", s.tension, "plastic_share", s.plasticity.share, "yield",
                 s.plasticity.yield, "before", s.before, "history", s.history, "last", s.last,
                 "share", s.share);
}

static void describe(BrushImage& i, Fields& fields) {
  fields.add_all("linear", i.linear, "offset", i.offset);
}

static void describe(BrushPoint& p, Fields& fields) {
  fields.add_all("surface", p.surface, "at", p.at, "pressure", p.pen.pressure, "axis", p.pen.axis);
}

static void describe(OpenBrush& b, Fields& fields) {
  fields.add_all("kind", b.brush.kind, "radius", b.brush.radius, "height", b.brush.height,
                 "strength", b.brush.strength, "core", b.brush.core, "by", b.brush.by, "angle",
                 b.brush.angle, "factor", b.brush.factor, "columns", b.brush.pattern.columns,
                 "heights", b.brush.pattern.heights, "presses", b.brush.pressure, "images",
                 b.images, "rope", b.rope, "path", b.path, "before", b.before, "masks", b.masks);
}

static void describe(PulledLattice& l, Fields& fields) {
  fields.add_all("net", l.net, "degree", l.degree, "margin", l.margin, "points", l.points,
                 "surfaces", l.surfaces, "before", l.before, "after", l.after);
}

// --- the record
// -----------------------------------------------------------------------------------------------

void describe_figures(StepRecord& s, Fields& fields) {
  fields.add("time", s.time, {.help = "seconds"});
  fields.add("energy", s.energy, {.help = "stretch + bend, in normalised units"});
  fields.add("residual", s.residual, {.help = "relative imbalance of forces"});
  fields.add("largest_displacement", s.largest_displacement,
             {.help = "from the surface as opened", .unit = Unit::length});
  fields.add("stretch", s.stretch, {.help = "part of the energy"});
  fields.add("bend", s.bend, {.help = "part of the energy"});
  fields.add("kinetic", s.kinetic, {.help = "½ mass times velocity², of a dynamic evolution"});
  fields.add("contact", s.contact, {.help = "potential of tools, friction and limit"});
  fields.add("gap", s.gap, {.help = "deepest entry into a tool, in sizes of that tool"});
  fields.add("gap_tool", s.gap_tool, {.help = "the name of that tool", .omit_empty = true});
  fields.add("constraint_violation", s.violation,
             {.help = "largest error of a constraint", .unit = Unit::length});
  fields.add("converged", s.converged,
             {.help = "the step reached its minimum, and rigid tools their gap"});
  fields.add("limited", s.limited, {.help = "the limit restricts the displacement"});
  fields.add("load_factor", s.load_factor,
             {.help = "of a shell: the share of the load that is balanced", .omit_empty = true});
  fields.add(
      "increments", s.increments,
      {.help = "of a shell: Newton iterations of each part of the load", .omit_empty = true});
  fields.add("energy_error", s.energy_error,
             {.help = "of rational shapes: the largest error of an entry of the energy's matrix, "
                      "relative to its diagonal",
              .omit_empty = true});
  fields.add("note", s.note, {.help = "what went wrong, and the remedy", .omit_empty = true});
}

void describe(StepRecord& s, Fields& fields) {
  fields.name("step info", "What one step did.");
  fields.add("surface", s.surface, {.help = "number of the first one selected; -1: of a body"});
  describe_figures(s, fields);
  fields.add("iterations", s.iterations, {.help = "of Newton's method"});
}

static void describe(ModeRecord& m, Fields& fields) {
  fields.add_all("value", m.value, "residual", m.residual, "shape", m.shape);
}

std::span<const Choice> choices(SeamContinuity) {
  static constexpr Choice list[] = {{"none", SeamContinuity::none},
                                    {"C0", SeamContinuity::c0},
                                    {"G1", SeamContinuity::g1},
                                    {"periodic", SeamContinuity::periodic}};
  return list;
}
static std::span<const Choice> choices(SeamKind) {
  static constexpr Choice list[] = {{"whole", SeamKind::whole},
                                    {"reparametrised", SeamKind::reparametrised},
                                    {"partial", SeamKind::partial}};
  return list;
}
static std::span<const Choice> choices(SurfaceEdge) {
  static constexpr Choice list[] = {{"u0", SurfaceEdge::u0},
                                    {"u1", SurfaceEdge::u1},
                                    {"v0", SurfaceEdge::v0},
                                    {"v1", SurfaceEdge::v1}};
  return list;
}

static void describe(PatchEdge& e, Fields& fields) {
  fields.add_all("patch", e.patch, "edge", e.edge);
}

static void describe(SeamReport& s, Fields& fields) {
  fields.add_all("a", s.seam.a, "b", s.seam.b, "reversed", s.seam.reversed, "kind", s.seam.kind,
                 "gap", s.seam.gap, "continuity", s.continuity, "reason", s.reason, "rigid",
                 s.rigid, "restricted", s.restricted, "mismatch", s.mismatch, "angle", s.angle,
                 "ratio", s.ratio, "deviation", s.deviation, "constraints", s.constraints);
}

static void describe(Scene& s, Fields& fields) {
  fields.add_all("selected", s.selected, "together", s.together, "surfaces", s.surfaces, "tools",
                 s.tools, "forces", s.forces, "load", s.load, "limit", s.limit, "evolution",
                 s.evolution, "scaling", s.scaling, "seams", s.seams, "permission", s.permission,
                 "probes", s.probes, "followed", s.followed, "coupling_position",
                 s.coupling.position, "coupling_tangent", s.coupling.tangent, "bend", s.bend,
                 "stroke", s.stroke, "brush", s.brush, "bodies", s.bodies, "body", s.body,
                 "lattice", s.lattice);
}

static void describe(SessionState& s, Fields& fields) {
  describe(static_cast<Scene&>(s), fields);
  fields.add_all("steps", s.steps, "seam_reports", s.seam_reports, "notes", s.notes,
                 "energy_before", s.energy_before, "modes", s.modes, "buckling", s.buckling);
}

template <>
const Type& type_of<Scene>() {
  return make_type<Scene>();
}
template <>
const Type& type_of<SessionState>() {
  return make_type<SessionState>();
}
template <>
const Type& type_of<StepRecord>() {
  return make_type<StepRecord>();
}

}  // namespace knead
