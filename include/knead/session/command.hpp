#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "knead/sculpt/active_spline.hpp"

namespace knead {

// What a user can do, as values. Every command has a JSON form {"do": name, field: value, …} (see command_json.hpp);
// fields that are `optional` here, or have a default, may be left out. Lengths are in file units unless a command says
// `relative`; (s, t) are fractions 0 to 1 of the parameter domain.

using Vector3 = std::array<double, 3>;
using Fractions = std::array<double, 2>;

/// Makes a surface in a document without a file, and selects it: a flat sheet, a surface of revolution about z, or any
/// control points.
struct NewCommand {
  std::string shape = "plane";
  std::array<double, 2> size = {1, 1};
  std::optional<double> radius;    ///< of cylinder, sphere and torus; default: 0.5
  std::optional<double> height;    ///< of a cylinder; default: twice the radius
  std::optional<double> minor;     ///< tube radius of a torus; default: a quarter of the radius
  std::vector<Fractions> profile;  ///< of a revolution: control points (r, z)
  std::array<int, 2> degree = {3, 3};
  std::array<int, 2> net = {8, 8};
  std::vector<double> knots_u, knots_v;  ///< empty: clamped, uniform on [0, 1]
  std::vector<Vector3> points;           ///< instead of a shape: all control points, (i, j) at i n + j
  std::vector<double> weights;           ///< one for each; empty: none
  Vector3 position = {0, 0, 0};          ///< where the origin of the shape goes
  std::optional<std::string> unit;       ///< default: that of the surfaces there are, at first mm
  std::optional<std::string> name;       ///< default: what it is
};

/// Chooses the surfaces that the following commands act on. A document with one surface has it selected already.
struct SelectCommand {
  std::optional<std::string> surface;                ///< id of the entity, "#123"
  std::optional<std::vector<std::string>> surfaces;  ///< several, which then move together
  bool connected = false;                            ///< and all that seams connect with these
};

/// Sets the stretch and bend coefficients of the selected surfaces, everywhere or in a region.
struct MaterialCommand {
  Material material;
  std::optional<double> mass, damping;
  std::optional<std::array<Fractions, 2>> region;  ///< [[s0, s1], [t0, t1]]
  double falloff = 0.1;                            ///< width of the way from old to new, in fractions
  /// One coefficient alone ("alpha11" … "beta22", "mass", "damping") by samples on a grid over the domain.
  std::optional<std::string> coefficient;
  std::array<int, 2> counts = {0, 0};
  std::vector<double> samples;  ///< last direction fastest, linear in between
};

/// Makes the present shape of the selected surfaces their rest shape, and says what the energy acts on.
struct RestCommand {
  RestMode mode = RestMode::shape;
};

/// Which units the model is computed in.
enum class ScalingMode { normalised, raw };
struct ScalingCommand {
  ScalingMode mode = ScalingMode::normalised;
};

/// Holds the outer `rows` rows of control points on every side; 0 holds none. Replaces an earlier hold.
struct HoldCommand {
  int rows = 2;
};

/// Pins control points (i, j), or a surface point, in addition to what is pinned already.
struct PinCommand {
  std::vector<std::array<int, 2>> control_points;
  std::optional<Fractions> at;
  std::optional<Vector3> to;  ///< default: where it is

  friend bool operator==(const PinCommand&, const PinCommand&) = default;
};

enum class EdgeChoice { all, u0, u1, v0, v1 };
enum class EdgeHold { position, clamped, curvature, free };
/// Holds edges, with the first or the first two derivatives across them.
struct EdgeCommand {
  EdgeChoice which = EdgeChoice::all;
  EdgeHold hold = EdgeHold::position;

  friend bool operator==(const EdgeCommand&, const EdgeCommand&) = default;
};

/// Freezes a region of the parameter domain, rounded outward to whole spans.
struct FreezeCommand {
  std::array<Fractions, 2> region = {{{0, 1}, {0, 1}}};

  friend bool operator==(const FreezeCommand&, const FreezeCommand&) = default;
};

/// Keeps a curve of the surface where it is: an isoparametric line, or a polyline of (s, t).
struct KeepCommand {
  std::optional<double> u, v;  ///< the line at this fraction of the domain
  std::vector<Fractions> curve;
  double tolerance = 1e-6;

  friend bool operator==(const KeepCommand&, const KeepCommand&) = default;
};

/// Half a symmetric model: an edge stays in a plane and the surface perpendicular to it; or a whole surface that stays
/// its own mirror image.
struct SymmetryCommand {
  std::optional<EdgeChoice> edge;
  std::optional<std::string> mirror;  ///< "u" or "v"
  std::optional<Vector3> point, normal;

  friend bool operator==(const SymmetryCommand&, const SymmetryCommand&) = default;
};

/// Whether knot lines of full multiplicity are kept from bending, and poles from tearing.
struct SmoothCommand {
  bool knot_lines = true;
  bool poles = true;
};

/// How patches that are selected together are coupled.
struct SeamsCommand {
  bool couple = true;
  std::optional<double> tolerance;  ///< a length; default: 1e-4 of the diagonal

  friend bool operator==(const SeamsCommand&, const SeamsCommand&) = default;
};

/// Frees all that is held, pinned, frozen or kept of the selected surfaces.
struct ReleaseCommand {};

/// Puts a tool into the scene, or replaces the one of that name.
struct ToolCommand {
  std::string name = "tool";
  std::string shape = "sphere";
  std::optional<double> radius;  ///< default: a tenth of the surface's bounding-box diagonal
  std::optional<double> minor, height, rounding, thickness, top_radius;
  std::optional<Vector3> sizes;  ///< semi-axes or half sizes
  std::optional<std::array<double, 2>> exponents;
  std::optional<std::string> surface;  ///< of shape "surface": its id
  std::optional<Vector3> axis;         ///< where the tool's own z points
  std::optional<Vector3> scale;        ///< along its own axes
  std::optional<Vector3> position;     ///< of the centre; or:
  std::optional<Fractions> at;         ///< centre on the surface
  ToolMode mode = ToolMode::collision;
  std::optional<double> stiffness;  ///< default: 1e4 for collision, 100 for proximity
  std::optional<double> range;      ///< default: half the size
  ToolDirection direction = ToolDirection::pull;
  bool rigid = false;
  double friction = 0;
  double plasticity = 0;
  bool relative = false;  ///< lengths and position are fractions of the bounding-box diagonal
};

/// Takes a tool out of the scene; of what it did, its plasticity stays.
struct RemoveCommand {
  std::optional<std::string> tool;  ///< default: the only tool
};

struct MoveCommand {
  std::optional<std::string> tool;  ///< default: the only tool
  Vector3 by = {0, 0, 0};
  bool relative = false;  ///< `by` is in fractions of the bounding-box diagonal
};

/// Turns a tool about its centre.
struct TurnCommand {
  std::optional<std::string> tool;
  Vector3 axis = {0, 0, 1};
  double angle = 0;  ///< degrees
};

/// Scales a tool along its own axes.
struct ScaleCommand {
  std::optional<std::string> tool;
  Vector3 by = {1, 1, 1};
};

enum class PointForceKind { spring, volcano };
/// A force on one surface point, there until it is removed (thesis Eq. 4.24).
struct ForceCommand {
  std::string name = "force";
  PointForceKind kind = PointForceKind::spring;
  Fractions at = {0.5, 0.5};
  Vector3 to = {0, 0, 0};
  double strength = 10;
  double core = 0.1;  ///< volcano: within this length it no longer grows
};

/// Loads on the selected surfaces; each command replaces the loads before it.
struct LoadCommand {
  Vector3 vector = {0, 0, 0};
  Vector3 gravity = {0, 0, 0};
  double pressure = 0;
  Vector3 wind = {0, 0, 0};
  std::array<int, 2> counts = {
      0, 0};                     ///< of samples of a force per area on a grid over the domain, each linear in between
  std::vector<Vector3> samples;  ///< last direction fastest; empty: none

  friend bool operator==(const LoadCommand&, const LoadCommand&) = default;
};

/// No point may be further than this from the surface as opened.
struct LimitCommand {
  std::optional<double> distance;  ///< left out: no limit
  bool relative = false;
};

/// What steps do; "static" solves at once.
struct EvolveCommand {
  Evolution mode = Evolution::acm;
  double lambda = 1;
  double time_step = 0.02;
  StepWeight weight = StepWeight::mass;
  ForceRoute route = ForceRoute::gauss;

  friend bool operator==(const EvolveCommand&, const EvolveCommand&) = default;
};

/// Lets the selected surfaces evolve under the tools.
struct StepCommand {
  int count = 1;
  std::optional<double> lambda;  ///< default: that of `evolve`
  std::optional<StepWeight> weight;
};

/// Moves a tool along a path, stepping on the way, and takes it back: press, drag and release as one.
struct StrokeCommand {
  std::optional<std::string> tool;
  std::vector<Vector3> path;  ///< positions of the tool's centre
  int steps = 2;              ///< at each of them
  double plasticity = 1;
  bool relative = false;  ///< the path is measured from where the tool is, in fractions of the diagonal
};

/// Takes hold of a surface point with a footprint, drags it and lets go.
struct DragCommand {
  Fractions at = {0.5, 0.5};
  Vector3 by = {0, 0, 0};
  std::optional<double> radius;  ///< default: a tenth of the diagonal
  double strength = 1e4;
  int steps = 4;
  double plasticity = 1;
  bool relative = false;
};

/// Smooths the surface around a point: one step of a plate under tension that has no rest shape, all else held.
/// `strength` is the share of a bump of that radius which goes.
struct RelaxCommand {
  Fractions at = {0.5, 0.5};
  std::optional<double> radius;  ///< default: a tenth of the diagonal
  double strength = 0.5;
  bool relative = false;
};

/// Deforms the selected surfaces with a block of space round them, on which the tools act, as one command (thesis 5.7).
struct LatticeCommand {
  std::array<int, 3> net = {6, 6, 6};
  std::array<int, 3> degree = {3, 3, 3};
  double margin = 0.05;  ///< of the diagonal
  int steps = 4;
  double lambda = 1;
  std::vector<std::string> hold;  ///< faces: "u0" … "w1", u along x, v along y, w along z
};

/// Control points of the one selected surface: by numbers i n + j of a net m × n, and by whole rows. In this order,
/// each once; together at least one.
struct NamedPoints {
  std::vector<int> which;
  std::vector<int> rows_u;  ///< all (i, ·) for these i
  std::vector<int> rows_v;  ///< all (·, j) for these j
};

/// Moves control points by hand. The shape that comes is clay: it stays.
struct PointsCommand {
  NamedPoints points;
  std::optional<Vector3> by;  ///< all alike; or:
  std::vector<Vector3> to;    ///< one place for each
  bool relative = false;      ///< `by` is in fractions of the bounding-box diagonal
};

/// Other weights for control points, which stay: the shape changes, for good.
struct WeightsCommand {
  NamedPoints points;
  std::optional<double> weight;  ///< > 0; or:
  std::optional<double> by;      ///< a factor > 0
};

/// Other knots for the same control points: the shape changes, for good.
struct KnotsCommand {
  std::string direction;      ///< "u" or "v"
  std::vector<double> knots;  ///< the whole vector, as many as before, on the same domain
};

enum class RefinePermission { automatic, never };
/// Finer nets, the same shape: halves spans in a region or under a tool, or inserts knots.
struct RefineCommand {
  std::optional<std::array<Fractions, 2>> region;
  std::optional<std::string> under;  ///< name of a tool
  std::vector<double> knots_u, knots_v;
  std::optional<RefinePermission> permission;  ///< whether other commands may refine exactly what they need
};

/// Raises the degree, the same shape.
struct ElevateCommand {
  std::array<int, 2> by = {1, 1};
};

/// Removes knots while the shape changes by no more than a length.
struct CoarsenCommand {
  double tolerance = 0;
};

/// Takes back the last command that was not taken back yet.
struct UndoCommand {};

/// Does again what was taken back last.
struct RedoCommand {};

using Command = std::variant<NewCommand, SelectCommand, MaterialCommand, RestCommand, ScalingCommand, HoldCommand,
                             PinCommand, EdgeCommand, FreezeCommand, KeepCommand, SymmetryCommand, SmoothCommand,
                             SeamsCommand, ReleaseCommand, ToolCommand, RemoveCommand, MoveCommand, TurnCommand,
                             ScaleCommand, ForceCommand, LoadCommand, LimitCommand, EvolveCommand, StepCommand,
                             StrokeCommand, DragCommand, RelaxCommand, LatticeCommand, PointsCommand, WeightsCommand,
                             KnotsCommand, RefineCommand, ElevateCommand, CoarsenCommand, UndoCommand, RedoCommand>;

}  // namespace knead
