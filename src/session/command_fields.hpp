#pragma once

#include <span>
#include <string_view>

#include "knead/session/command.hpp"

namespace knead {

/// A name of an enumeration's value in JSON.
template <class E>
struct Choice {
  std::string_view name;
  E value;
};

/// Whether a field may be left out.
enum class Presence { required, optional };

// One description per command serves parsing, writing and help. `visit_fields(command, visitor)` calls
//   visitor.field(name, presence, member, help)
//   visitor.choice(name, member, choices, help)
// for every field; all choices are optional.

inline constexpr Choice<RestMode> rest_modes[] = {{"shape", RestMode::shape}, {"none", RestMode::none}};
inline constexpr Choice<ScalingMode> scaling_modes[] = {{"normalised", ScalingMode::normalised},
                                                        {"raw", ScalingMode::raw}};
inline constexpr Choice<ToolMode> tool_modes[] = {
    {"collision", ToolMode::collision}, {"proximity", ToolMode::proximity}, {"imprint", ToolMode::imprint}};
inline constexpr Choice<ToolDirection> tool_directions[] = {{"pull", ToolDirection::pull},
                                                            {"push", ToolDirection::push}};
inline constexpr Choice<StepWeight> step_weights[] = {{"mass", StepWeight::mass}, {"identity", StepWeight::identity}};
inline constexpr Choice<ForceRoute> force_routes[] = {{"gauss", ForceRoute::gauss}, {"analytic", ForceRoute::analytic}};
inline constexpr Choice<Evolution> evolutions[] = {
    {"acm", Evolution::acm}, {"static", Evolution::stationary}, {"dynamic", Evolution::dynamic}};
inline constexpr Choice<EdgeChoice> edge_choices[] = {{"all", EdgeChoice::all},
                                                      {"u0", EdgeChoice::u0},
                                                      {"u1", EdgeChoice::u1},
                                                      {"v0", EdgeChoice::v0},
                                                      {"v1", EdgeChoice::v1}};
inline constexpr Choice<EdgeHold> edge_holds[] = {{"position", EdgeHold::position},
                                                  {"clamped", EdgeHold::clamped},
                                                  {"curvature", EdgeHold::curvature},
                                                  {"free", EdgeHold::free}};
inline constexpr Choice<PointForceKind> point_force_kinds[] = {{"spring", PointForceKind::spring},
                                                               {"volcano", PointForceKind::volcano}};
inline constexpr Choice<RefinePermission> refine_permissions[] = {{"auto", RefinePermission::automatic},
                                                                  {"never", RefinePermission::never}};

template <class C>
struct CommandInfo;

#define KNEAD_COMMAND(Type, command_name, command_help_text)         \
  template <>                                                        \
  struct CommandInfo<Type> {                                         \
    static constexpr std::string_view name = command_name;           \
    static constexpr std::string_view help = command_help_text;      \
    template <class C, class V>                                      \
    static void visit([[maybe_unused]] C& c, [[maybe_unused]] V& v); \
  };                                                                 \
  template <class C, class V>                                        \
  void CommandInfo<Type>::visit([[maybe_unused]] C& c, [[maybe_unused]] V& v)

/// The fields that say which control points are meant.
template <class P, class V>
void visit_points(P& p, V& v) {
  v.field("which", Presence::optional, p.which, "numbers i n + j of control points, from 0; and:");
  v.field("rows_u", Presence::optional, p.rows_u, "[i, …]: all control points (i, ·); and:");
  v.field("rows_v", Presence::optional, p.rows_v, "[j, …]: all control points (·, j)");
}

KNEAD_COMMAND(NewCommand, "new", "make a surface, in a document without a file, and select it") {
  v.field("shape", Presence::optional, c.shape, "plane, cylinder, sphere, torus or revolution; about z");
  v.field("size", Presence::optional, c.size, "of a plane: [width, height]");
  v.field("radius", Presence::optional, c.radius, "of cylinder, sphere and torus; default: 0.5");
  v.field("height", Presence::optional, c.height, "of a cylinder; default: twice the radius");
  v.field("minor", Presence::optional, c.minor, "tube radius of a torus; default: a quarter of the radius");
  v.field("profile", Presence::optional, c.profile, "of a revolution: [[r, z], …], control points of degree q");
  v.field("degree", Presence::optional, c.degree, "[p, q]");
  v.field("net", Presence::optional, c.net, "control points [m, n]; with knots they follow from those");
  v.field("knots_u", Presence::optional, c.knots_u, "knot vector of u; default: clamped, uniform on [0, 1]");
  v.field("knots_v", Presence::optional, c.knots_v, "knot vector of v");
  v.field("points", Presence::optional, c.points, "instead of a shape: all control points [x, y, z], along v first");
  v.field("weights", Presence::optional, c.weights, "one > 0 for each control point (of a revolution: of the profile)");
  v.field("position", Presence::optional, c.position, "[x, y, z] where the shape's origin goes");
  v.field("unit", Presence::optional, c.unit, "um, mm, cm, m, km, inch or foot; default: as before, at first mm");
  v.field("name", Presence::optional, c.name, "its label in the file; default: what it is");
}
KNEAD_COMMAND(SelectCommand, "select", "choose the surfaces that the following commands act on") {
  v.field("surface", Presence::optional, c.surface, "entity id as `knead info` lists it, \"#123\"");
  v.field("surfaces", Presence::optional, c.surfaces, "several, which move together, coupled along their seams");
  v.field("connected", Presence::optional, c.connected, "and all surfaces that seams connect with these");
}
KNEAD_COMMAND(MaterialCommand, "material", "resistance to stretch and bend, in the order 11, 12, 22") {
  v.field("alpha", Presence::optional, c.material.alpha, "stretch; alpha12² <= alpha11 alpha22");
  v.field("beta", Presence::optional, c.material.beta, "bend; none negative");
  v.field("mass", Presence::optional, c.mass, "per area, for `evolve` dynamic; default: as it was, at first 1");
  v.field("damping", Presence::optional, c.damping, "force per velocity and area; default: as it was, at first 0.5");
  v.field("region", Presence::optional, c.region, "[[s0, s1], [t0, t1]]: only there, in fractions of the domain");
  v.field("falloff", Presence::optional, c.falloff, "width of the border of the region, in fractions");
  v.field("coefficient", Presence::optional, c.coefficient,
          "alpha11, alpha12, alpha22, beta11, beta12, beta22, mass or damping: that one alone, by samples");
  v.field("counts", Presence::optional, c.counts, "[m, n] samples over the domain, at least 2 each");
  v.field("samples", Presence::optional, c.samples, "m n numbers, along v first; linear in between");
}
KNEAD_COMMAND(RestCommand, "rest", "make the present shape the rest shape; what the energy acts on") {
  v.choice("mode", c.mode, std::span<const Choice<RestMode>>(rest_modes),
           "shape: displacement from it; none: the shape itself");
}
KNEAD_COMMAND(ScalingCommand, "scaling", "the units that the numbers are in") {
  v.choice("mode", c.mode, std::span<const Choice<ScalingMode>>(scaling_modes),
           "normalised: the same feel at every size; raw: those of the equations on the knots as they are");
}
KNEAD_COMMAND(HoldCommand, "hold", "hold the outer rows of control points on every side") {
  v.field("rows", Presence::optional, c.rows, "how many; 0 holds none");
}
KNEAD_COMMAND(PinCommand, "pin", "hold control points or a surface point, in addition to those held already") {
  v.field("control_points", Presence::optional, c.control_points, "list of [i, j], counted from 0");
  v.field("at", Presence::optional, c.at, "[s, t]: a surface point, at fractions of its domain");
  v.field("to", Presence::optional, c.to, "[x, y, z] where that point goes; default: where it is");
}
KNEAD_COMMAND(EdgeCommand, "edge", "hold edges of the selected surfaces") {
  v.choice("which", c.which, std::span<const Choice<EdgeChoice>>(edge_choices), "");
  v.choice("hold", c.hold, std::span<const Choice<EdgeHold>>(edge_holds),
           "clamped: with tangent planes; curvature: with curvatures too; free: no longer");
}
KNEAD_COMMAND(FreezeCommand, "freeze", "hold a region, rounded outward to whole knot spans") {
  v.field("region", Presence::required, c.region, "[[s0, s1], [t0, t1]], fractions of the domain");
}
KNEAD_COMMAND(KeepCommand, "keep", "hold a curve of the surface") {
  v.field("u", Presence::optional, c.u, "the line u = const at this fraction of the domain; or:");
  v.field("v", Presence::optional, c.v, "the line v = const; or:");
  v.field("curve", Presence::optional, c.curve, "[[s, t], …]: a polyline in the domain");
  v.field("tolerance", Presence::optional, c.tolerance, "of a polyline, as a share of the motion around it");
}
KNEAD_COMMAND(SymmetryCommand, "symmetry", "keep a symmetry") {
  v.field("edge", Presence::optional, c.edge,
          "u0, u1, v0 or v1: stays in a plane, the surface perpendicular to it; or:");
  v.field("mirror", Presence::optional, c.mirror,
          "u or v: the surface stays its own mirror image along that direction");
  v.field("point", Presence::optional, c.point, "[x, y, z] of the plane; default for `mirror`: the best plane");
  v.field("normal", Presence::optional, c.normal, "[x, y, z] of the plane");
}
KNEAD_COMMAND(SmoothCommand, "smooth", "keep what is smooth smooth; on unless switched off") {
  v.field("knot_lines", Presence::optional, c.knot_lines, "no creases at knots of full multiplicity");
  v.field("poles", Presence::optional, c.poles, "edges that are a point keep their tangent plane");
}
KNEAD_COMMAND(SeamsCommand, "seams", "couple selected surfaces, and each with itself, along shared edges") {
  v.field("couple", Presence::optional, c.couple, "false: they may tear apart");
  v.field("tolerance", Presence::optional, c.tolerance,
          "length; default: 1e-4 of the diagonal of the selected surfaces");
}
KNEAD_COMMAND(ReleaseCommand, "release", "free all that is held, pinned, frozen or kept") {}
KNEAD_COMMAND(ToolCommand, "tool", "put a tool into the scene, or replace the one of that name") {
  v.field("name", Presence::optional, c.name, "what `move` and `remove` call it");
  v.field("shape", Presence::optional, c.shape,
          "sphere, ellipsoid, box, cylinder, cone, capsule, torus, plane, bowl, superellipsoid, supertoroid, surface");
  v.field("radius", Presence::optional, c.radius, "length; default: 0.1 of the surface's bounding-box diagonal");
  v.field("minor", Presence::optional, c.minor, "tube radius of torus and supertoroid; default: a quarter of radius");
  v.field("height", Presence::optional, c.height, "of cylinder, cone and capsule; default: twice the radius");
  v.field("top_radius", Presence::optional, c.top_radius, "of a cone; default: 0");
  v.field("thickness", Presence::optional, c.thickness, "wall of a bowl; default: a tenth of the radius");
  v.field("rounding", Presence::optional, c.rounding, "edge radius of a box; default: 0");
  v.field("sizes", Presence::optional, c.sizes, "[a, b, c] semi-axes or half sizes; default: radius each");
  v.field("exponents", Presence::optional, c.exponents, "[e1, e2] of superellipsoid and supertoroid; default: [1, 1]");
  v.field("surface", Presence::optional, c.surface, "id of the surface that is the tool");
  v.field("axis", Presence::optional, c.axis, "[x, y, z] where its own z axis points; default: [0, 0, 1]");
  v.field("scale", Presence::optional, c.scale, "[a, b, c] factors along its own axes; default: 1 each");
  v.field("position", Presence::optional, c.position, "[x, y, z] of the centre; this or `at` is needed");
  v.field("at", Presence::optional, c.at, "[s, t]: centre on the surface, at fractions 0 to 1 of its domain");
  v.choice("mode", c.mode, std::span<const Choice<ToolMode>>(tool_modes),
           "collision pushes out what has entered; proximity draws near; imprint presses for good");
  v.field("stiffness", Presence::optional, c.stiffness,
          "spring constant k >= 0; default: 1e4 for collision, 100 for proximity");
  v.field("range", Presence::optional, c.range, "reach of proximity, a length; default: half the size");
  v.choice("direction", c.direction, std::span<const Choice<ToolDirection>>(tool_directions), "of proximity");
  v.field("rigid", Presence::optional, c.rigid, "raise k until nothing enters by more than 1e-4 of the tool's size");
  v.field("friction", Presence::optional, c.friction, "Coulomb's coefficient");
  v.field("plasticity", Presence::optional, c.plasticity, "0 springs back on `remove`, 1 keeps the shape");
  v.field("relative", Presence::optional, c.relative,
          "lengths and position are fractions of the surface's bounding-box diagonal");
}
KNEAD_COMMAND(RemoveCommand, "remove", "take a tool or force out of the scene; its plasticity stays") {
  v.field("tool", Presence::optional, c.tool, "its name; default: the only one");
}
KNEAD_COMMAND(MoveCommand, "move", "move a tool") {
  v.field("tool", Presence::optional, c.tool, "its name; default: the only tool");
  v.field("by", Presence::required, c.by, "[dx, dy, dz]");
  v.field("relative", Presence::optional, c.relative, "fractions of the surface's bounding-box diagonal, not lengths");
}
KNEAD_COMMAND(TurnCommand, "turn", "turn a tool about its centre") {
  v.field("tool", Presence::optional, c.tool, "its name; default: the only tool");
  v.field("axis", Presence::optional, c.axis, "[x, y, z]");
  v.field("angle", Presence::required, c.angle, "degrees");
}
KNEAD_COMMAND(ScaleCommand, "scale", "scale a tool along its own axes") {
  v.field("tool", Presence::optional, c.tool, "its name; default: the only tool");
  v.field("by", Presence::required, c.by, "[a, b, c], factors > 0");
}
KNEAD_COMMAND(ForceCommand, "force", "a force on one surface point, until `remove`") {
  v.field("name", Presence::optional, c.name, "what `remove` calls it");
  v.choice("kind", c.kind, std::span<const Choice<PointForceKind>>(point_force_kinds),
           "spring draws the point to `to`; volcano drives it away from there");
  v.field("at", Presence::required, c.at, "[s, t]: the surface point, at fractions of its domain");
  v.field("to", Presence::required, c.to, "[x, y, z]");
  v.field("strength", Presence::optional, c.strength, "spring constant, or k of the volcano's k/r²");
  v.field("core", Presence::optional, c.core, "length within which a volcano no longer grows");
}
KNEAD_COMMAND(LoadCommand, "load", "loads everywhere on the selected surfaces; replaces those before") {
  v.field("vector", Presence::optional, c.vector, "[x, y, z] force per area");
  v.field("gravity", Presence::optional, c.gravity, "[x, y, z] acceleration, times the mass");
  v.field("pressure", Presence::optional, c.pressure, "force per area along the normal S_u x S_v");
  v.field("wind", Presence::optional, c.wind, "[x, y, z] velocity of the air");
  v.field("counts", Presence::optional, c.counts, "[m, n] samples of a force over the domain, at least 2 each");
  v.field("samples", Presence::optional, c.samples, "m n forces [x, y, z] per area, along v first; linear in between");
}
KNEAD_COMMAND(LimitCommand, "limit", "no point moves further from the surface as opened") {
  v.field("distance", Presence::optional, c.distance, "length; left out: no limit");
  v.field("relative", Presence::optional, c.relative,
          "a fraction of the surface's bounding-box diagonal, not a length");
}
KNEAD_COMMAND(EvolveCommand, "evolve", "what steps do; static solves at once") {
  v.choice("mode", c.mode, std::span<const Choice<Evolution>>(evolutions),
           "acm sinks to the balance, static is the balance, dynamic swings");
  v.field("lambda", Presence::optional, c.lambda, "acm: inverse step size >= 0");
  v.field("time_step", Presence::optional, c.time_step, "dynamic: time per step");
  v.choice("weight", c.weight, std::span<const Choice<StepWeight>>(step_weights),
           "acm: W of the step: mass matrix, or identity as in the thesis");
  v.choice("route", c.route, std::span<const Choice<ForceRoute>>(force_routes),
           "how tool forces are integrated: Gauss points, or Greville abscissae and exact mass matrices");
}
KNEAD_COMMAND(StepCommand, "step", "let the selected surfaces evolve under the tools") {
  v.field("count", Presence::optional, c.count, "number of steps");
  v.field("lambda", Presence::optional, c.lambda, "acm: inverse step size >= 0; default: that of `evolve`, at first 1");
  v.choice("weight", c.weight, std::span<const Choice<StepWeight>>(step_weights),
           "acm: default: that of `evolve`, at first mass");
}
KNEAD_COMMAND(StrokeCommand, "stroke", "press a tool along a path and take it back, as one command") {
  v.field("tool", Presence::optional, c.tool, "its name; default: the only tool");
  v.field("path", Presence::required, c.path, "[[x, y, z], …] positions of its centre");
  v.field("steps", Presence::optional, c.steps, "steps at each position");
  v.field("plasticity", Presence::optional, c.plasticity, "share of the result that stays, 0 to 1");
  v.field("relative", Presence::optional, c.relative,
          "the path is measured from where the tool is, in fractions of the bounding-box diagonal");
}
KNEAD_COMMAND(DragCommand, "drag", "take hold of a surface point, drag it and let go, as one command") {
  v.field("at", Presence::required, c.at, "[s, t]: the surface point, at fractions of its domain");
  v.field("by", Presence::required, c.by, "[dx, dy, dz]");
  v.field("radius", Presence::optional, c.radius, "of the footprint, a length; default: 0.1 of the diagonal");
  v.field("strength", Presence::optional, c.strength, "spring constant of the grip");
  v.field("steps", Presence::optional, c.steps, "steps on the way");
  v.field("plasticity", Presence::optional, c.plasticity, "share of the result that stays, 0 to 1");
  v.field("relative", Presence::optional, c.relative, "`by` and radius are fractions of the bounding-box diagonal");
}
KNEAD_COMMAND(RelaxCommand, "relax", "smooth the surface around a point") {
  v.field("at", Presence::required, c.at, "[s, t]: the surface point, at fractions of its domain");
  v.field("radius", Presence::optional, c.radius, "how far it reaches, a length; default: 0.1 of the diagonal");
  v.field("strength", Presence::optional, c.strength, "share of a bump of that size that goes, > 0, up to 1");
  v.field("relative", Presence::optional, c.relative, "radius is a fraction of the bounding-box diagonal");
}
KNEAD_COMMAND(LatticeCommand, "lattice", "deform the surfaces with an elastic block of space that the tools act on") {
  v.field("net", Presence::optional, c.net, "control points of the block along x, y, z");
  v.field("degree", Presence::optional, c.degree, "along x, y, z");
  v.field("margin", Presence::optional, c.margin, "how far it reaches beyond the surfaces, of their diagonal");
  v.field("steps", Presence::optional, c.steps, "number of steps");
  v.field("lambda", Presence::optional, c.lambda, "inverse step size");
  v.field("hold", Presence::optional, c.hold, "faces that stay: u0, u1 (along x), v0, v1, w0, w1");
}
KNEAD_COMMAND(PointsCommand, "points", "move control points of the selected surface by hand, for good") {
  visit_points(c.points, v);
  v.field("by", Presence::optional, c.by, "[dx, dy, dz] for all of them; or:");
  v.field("to", Presence::optional, c.to, "[[x, y, z], …]: a place for each, in the order they are named");
  v.field("relative", Presence::optional, c.relative, "`by` is in fractions of the bounding-box diagonal");
}
KNEAD_COMMAND(WeightsCommand, "weights", "other weights: control points stay, the shape changes for good") {
  visit_points(c.points, v);
  v.field("weight", Presence::optional, c.weight, "what each weighs, > 0; 1 where nothing was said; or:");
  v.field("by", Presence::optional, c.by, "a factor > 0 for the weight of each");
}
KNEAD_COMMAND(KnotsCommand, "knots", "other knots for the same control points: the shape changes for good") {
  v.field("direction", Presence::required, c.direction, "u or v");
  v.field("knots", Presence::required, c.knots, "the whole knot vector, as long as before, on the same domain");
}
KNEAD_COMMAND(RefineCommand, "refine", "a finer net of the same shape") {
  v.field("region", Presence::optional, c.region, "[[s0, s1], [t0, t1]]: halve the spans there; or:");
  v.field("under", Presence::optional, c.under, "name of a tool: halve the spans that it reaches; or:");
  v.field("knots_u", Presence::optional, c.knots_u, "knots to insert in u, parameters of the file");
  v.field("knots_v", Presence::optional, c.knots_v, "knots to insert in v");
  v.choice("permission", c.permission, std::span<const Choice<RefinePermission>>(refine_permissions),
           "whether other commands may refine what they need refined; never unless said");
}
KNEAD_COMMAND(ElevateCommand, "elevate", "raise the degree, the same shape") {
  v.field("by", Presence::optional, c.by, "[in u, in v]");
}
KNEAD_COMMAND(CoarsenCommand, "coarsen", "remove knots where the shape changes by no more than a tolerance") {
  v.field("tolerance", Presence::required, c.tolerance, "length");
}
KNEAD_COMMAND(UndoCommand, "undo", "take back the last command") {}
KNEAD_COMMAND(RedoCommand, "redo", "do again what was taken back last") {}

#undef KNEAD_COMMAND

}  // namespace knead
