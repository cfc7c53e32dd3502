#pragma once

#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/shared_items.hpp"
#include "base/shared_list.hpp"
#include "brep/shared_edge.hpp"
#include "constraint.hpp"
#include "contact/plastic_history.hpp"
#include "elasticity.hpp"
#include "force.hpp"
#include "hold/edge_coupling.hpp"
#include "knead/brep/visible_region.hpp"
#include "knead/contact/active_spline.hpp"
#include "sculpt/brush.hpp"
#include "sculpt/tool_path.hpp"
#include "shape.hpp"

namespace knead {

// What is being sculpted, as plain values: no commands, no files, no computed data.

/// What `Load::vector` is counted by.
enum class LoadMeasure {
  parameters,  ///< the parameter domain, as the model scales it
  area,        ///< the area of the rest shape, in lengths of the model
};

/// Loads distributed over the selected surfaces.
struct Load {
  Vector3 vector = {0, 0, 0};           ///< force per measure
  std::optional<LoadMeasure> per = {};  ///< left out: area on shells, else parameters
  Vector3 gravity = {0, 0, 0};          ///< acceleration, multiplied by the mass
  double pressure = 0;                  ///< force per area along the normal S_u × S_v
  Vector3 wind = {0, 0, 0};             ///< velocity of the air
  /// Samples of a force per area on a grid over the domain, last direction fastest, linear in
  /// between.
  std::array<int, 2> counts = {0, 0};
  std::vector<Vector3> samples = {};  ///< empty: none
  /// A force per area as three formulas (`formula_field`), to a tolerance.
  std::optional<std::array<std::string, 3>> formula = {};
  std::optional<double> tolerance = {};

  /// Whether a part of it is not the same everywhere.
  [[nodiscard]] bool varies() const { return !samples.empty() || formula; }

  friend bool operator==(const Load&, const Load&) = default;
};

/// What a step does.
struct EvolutionPolicy {
  Evolution mode = Evolution::acm;
  double lambda = 1;
  double time_step = 0.02;
  StepWeight weight = StepWeight::mass;
  ForceRoute route = ForceRoute::gauss;
  StepAccuracy accuracy = StepAccuracy::exact;
  StepSolver solver = StepSolver::automatic;
  double energy_tolerance = default_rational_tolerance;

  friend bool operator==(const EvolutionPolicy&, const EvolutionPolicy&) = default;
};

/// How patches selected together are coupled.
struct SeamPolicy {
  bool couple = true;
  std::optional<double> tolerance = {};  ///< a length; left out: 1e-4 of the diagonal
  bool smooth = false;  ///< tangent planes stay common wherever they are, not only at a fixed ratio

  friend bool operator==(const SeamPolicy&, const SeamPolicy&) = default;
};

/// The units in which the model is computed.
enum class ScalingMode { normalised, raw };

/// Whether actions on a scene may refine nets, without changing shapes: always, never, or only to
/// leave something free between a tool and the held edges of a face.
enum class RefinePermission { automatic, never, trims };

/// A named point of a surface whose position reports give, wherever it moves.
struct Probe {
  std::string list;  ///< the list in the report to which it belongs
  std::string name;
  int surface = 0;  ///< index into the scene's surfaces
  Fractions at = {0.5, 0.5};

  friend bool operator==(const Probe&, const Probe&) = default;
};

/// A stroke whose tool is still down. Rows are the control points of the selected surfaces,
/// stacked.
struct OpenStroke {
  /// The shapes of one selected surface before the stroke, on the present net.
  struct Before {
    std::shared_ptr<const Surface> rest, current;
  };

  std::string tool;            ///< its name
  Point home = Point::Zero();  ///< where the tool goes when it is lifted
  ToolPath path;               ///< of the tool's centre
  double lambda = 1;           ///< of the bed that the surface is pressed against, normalised units
  double stiffness = 0;        ///< minimum stiffness of tools
  double tension = 0;          ///< added to α11 and α22, so that dents have no rim
  Plasticity plasticity;       ///< the yield in file units
  std::vector<Before> before;  ///< per selected surface
  Points history;              ///< largest displacement so far at the Chebyshev sites, file units
  Points last = {};            ///< displacement of the last place; empty: none
  double share = 1;  ///< of all this that is shown and stays: less where more would fold a face
};

/// A point of the path of a brush.
struct BrushPoint {
  int surface = 0;  ///< an index into the scene's surfaces
  Fractions at = {};
  PenHold pen = {};

  friend bool operator==(const BrushPoint&, const BrushPoint&) = default;
};

/// A stroke of a brush that may go on.
struct OpenBrush {
  Brush brush;
  std::vector<BrushImage> images;  ///< copies of the stroke, besides itself
  /// Length of the rope by which the pointer draws the brush, file units; 0: none.
  double rope = 0;
  SharedList<BrushPoint> path;             ///< all that it was given by
  std::vector<OpenStroke::Before> before;  ///< per selected surface
  std::vector<std::vector<double>> masks;  ///< likewise, from before the stroke
};

/// A block of space round surfaces as the hand has pulled it, which may be pulled on
/// (`lattice_to_pull_on`).
struct PulledLattice {
  std::array<int, 3> net = {}, degree = {};  ///< along x, y, z
  double margin = 0;                         ///< of the diagonal of what it was put round
  Points points;                             ///< its control points as pulled, file units
  std::vector<int> surfaces;                 ///< indices into the scene's surfaces
  /// Of each, what the block was put round, and what it has made of it.
  std::vector<std::shared_ptr<const Surface>> before, after;
};

/// The angle, in radians, that tangent planes at a smooth edge that follows may come to differ by;
/// and the one that is accepted where less would leave the edge too little freedom.
inline constexpr double asked_angle = 1e-3 * std::numbers::pi / 180,
                        accepted_angle = 0.05 * std::numbers::pi / 180;

/// An edge of faces that has followed them, or does.
struct FollowedEdge {
  std::string id;
  std::shared_ptr<const SharedEdge> course = {};  ///< null until first needed
};

/// Surfaces and bodies, what holds them and what acts on them.
struct Scene {
  std::optional<int> selected = {};  ///< the surface that commands act on
  std::vector<int> together = {};    ///< the others selected with it
  SharedItems<SceneSurface> surfaces = {};
  std::vector<Tool> tools = {};  ///< lengths in file units; oriented by `PlacedShape::placement`
  SharedItems<SceneForce> forces = {};
  Load load = {};
  /// No point may be further than this from the surface as opened, file units.
  std::optional<double> limit = {};
  EvolutionPolicy evolution = {};
  ScalingMode scaling = ScalingMode::normalised;
  SeamPolicy seams = {};
  RefinePermission permission = RefinePermission::trims;
  std::vector<Probe> probes = {};
  std::vector<FollowedEdge> followed = {};  ///< written anew where their faces have moved them
  CouplingTolerance coupling = {};          ///< at which they are coupled, as in `couple_edges`
  /// Radians by which smooth ones among them may open, up to `accepted_angle`.
  double bend = asked_angle;
  std::optional<OpenStroke> stroke =
      {};                               ///< a tool that is down; every other command lifts it first
  std::optional<OpenBrush> brush = {};  ///< a stroke of a brush; every other command ends it
  std::vector<SceneBody> bodies = {};   ///< curves and volumes
  std::optional<int> body = {};  ///< the one that commands act on; then no surface is selected
  std::optional<PulledLattice> lattice = {};  ///< the last one that was pulled by hand

  /// All selected surfaces, the first one first.
  [[nodiscard]] std::vector<int> selection() const;
  /// Selects these surfaces in place of others; none: no surface.
  void select(const std::vector<int>& chosen);
};

/// The surface of this id; null: there is none. \param likely an index at which it is looked for
/// first
[[nodiscard]] const SceneSurface* find_surface(const Scene& scene, const std::string& id,
                                               std::size_t likely = 0);

/// The selected shapes of so many directions, the first one first: surfaces, or the curve or
/// volume, or none.
template <int D>
[[nodiscard]] std::vector<const SceneShape<D>*> selected_shapes(const Scene& scene);

/// The tools of the scene, and their images in the mirror planes of the first selected surface.
/// Errors: those of `mirror_plane` and `mirrored`.
[[nodiscard]] Expected<std::vector<Tool>> tools_and_images(const Scene& scene);

/// The reading of a probe, lengths in file units.
struct ProbeReading {
  Point point = Point::Zero();         ///< S(u, v)
  Point displacement = Point::Zero();  ///< from the surface as opened
  Point normal = Point::Zero();        ///< unit normal S_u × S_v; zero where undefined
  /// Principal curvatures κ₁ >= κ₂, 1/length, positive where the surface bends towards the normal;
  /// none where the normal is undefined.
  std::optional<std::array<double, 2>> curvature = {};
};

/// Errors: a place outside the domain (input), a rational denominator that is not positive
/// (numerical).
[[nodiscard]] Expected<ProbeReading> read_probe(const Scene& scene, const Probe& probe);

}  // namespace knead
