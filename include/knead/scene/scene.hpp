#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "knead/scene/constraint.hpp"
#include "knead/sculpt/active_spline.hpp"
#include "knead/sculpt/plastic_history.hpp"
#include "knead/sculpt/tool_path.hpp"
#include "knead/sculpt/visible_region.hpp"

namespace knead {

// What is being sculpted, as plain values: no commands, no files, nothing that was computed.

enum class PointForceKind { spring, volcano };

/// A force on one point of a surface, there until it is removed (thesis Eq. 4.24).
struct SceneForce {
  std::string name = "force";
  int surface = 0;  ///< index into the scene's surfaces
  PointForceKind kind = PointForceKind::spring;
  Fractions at = {0.5, 0.5};
  Vector3 to = {0, 0, 0};
  double strength = 10;
  double core = 0.1;  ///< volcano: within this length it no longer grows

  friend bool operator==(const SceneForce&, const SceneForce&) = default;
};

/// Loads everywhere on the selected surfaces.
struct Load {
  Vector3 vector = {0, 0, 0};   ///< force per area
  Vector3 gravity = {0, 0, 0};  ///< acceleration, times the mass
  double pressure = 0;          ///< force per area along the normal S_u × S_v
  Vector3 wind = {0, 0, 0};     ///< velocity of the air
  /// Samples of a force per area on a grid over the domain, last direction fastest, each linear in between.
  std::array<int, 2> counts = {0, 0};
  std::vector<Vector3> samples = {};  ///< empty: none

  friend bool operator==(const Load&, const Load&) = default;
};

/// What a step does.
struct EvolutionPolicy {
  Evolution mode = Evolution::acm;
  double lambda = 1;
  double time_step = 0.02;
  StepWeight weight = StepWeight::mass;
  ForceRoute route = ForceRoute::gauss;

  friend bool operator==(const EvolutionPolicy&, const EvolutionPolicy&) = default;
};

/// How patches that are selected together are coupled.
struct SeamPolicy {
  bool couple = true;
  std::optional<double> tolerance = {};  ///< a length; left out: 1e-4 of the diagonal

  friend bool operator==(const SeamPolicy&, const SeamPolicy&) = default;
};

/// Which units the model is computed in.
enum class ScalingMode { normalised, raw };

/// Whether what acts on a scene may refine nets exactly as it needs: always, never, or only so that something is left
/// free between a tool and the edges of a face that are held.
enum class RefinePermission { automatic, never, trims };

/// A named point of a surface that reports tell about, wherever it goes.
struct Probe {
  std::string list;  ///< the list of the report that it belongs to
  std::string name;
  int surface = 0;  ///< index into the scene's surfaces
  Fractions at = {0.5, 0.5};

  friend bool operator==(const Probe&, const Probe&) = default;
};

/// What tools leave in a surface that they are led over.
struct PlasticPolicy {
  bool along = false;    ///< strokes leave their groove as they go; else what is there when the tool is lifted stays
  double share = 1;      ///< of a displacement beyond the yield that stays
  double yield = 0;      ///< up to this displacement nothing stays
  double locality = 0;   ///< how far a dent is felt; 0: as far as the evolution lets it
  bool in_radii = true;  ///< yield and locality count sizes of the tool; false: file units

  friend bool operator==(const PlasticPolicy&, const PlasticPolicy&) = default;
};

/// A stroke whose tool is still down. Rows are control points of the selected surfaces, one below the other.
struct OpenStroke {
  /// The shapes of one selected surface before the stroke, on the present net.
  struct Before {
    std::shared_ptr<const Surface> rest, current;
  };

  std::string tool;              ///< its name
  Point home = Point::Zero();    ///< where the tool goes when it is lifted
  ToolPath path;                 ///< of the tool's centre
  double lambda = 1;             ///< of the bed that the surface is pressed against, normalised units
  double stiffness = 0;          ///< the least that tools have
  double tension = 0;            ///< added to α11 and α22, so that dents have no rim
  Plasticity plasticity;         ///< the yield in file units
  std::vector<Before> before;    ///< per selected surface
  Points history;                ///< largest displacement so far at the Greville abscissae, file units
  Points last = {}, older = {};  ///< displacements of the last two places; empty: none
};

/// One surface of a scene. `reference`, `rest` and `current` share their knots and weights, and `opened` shares them
/// too unless they were edited since; the domain is always the same.
struct SceneSurface {
  std::string id, name, unit;
  std::shared_ptr<const Surface> opened;     ///< as it came, on the present net if it has the present basis
  std::shared_ptr<const Surface> reference;  ///< what the units of the model are taken from
  std::shared_ptr<const Surface> rest;       ///< what displacements are measured from
  std::shared_ptr<const Surface> current;
  Points velocity = {};  ///< of a dynamic evolution, a spline on the present net; empty: at rest
  RestMode mode = RestMode::shape;
  MaterialFieldOf<2> material = {};
  int hold_rows = 0;  ///< outer rows of control points that do not move
  std::set<std::array<int, 2>> pins = {};
  std::vector<KeptConstraint> constraints = {};
  bool smooth_knot_lines = true, smooth_poles = true;
  PlasticPolicy plastic = {};
  /// What faces show of it, in fractions of its domain; null until something asks for it.
  std::shared_ptr<const VisibleRegion> visible = {};
};

/// Surfaces, what holds them and what acts on them.
struct Scene {
  std::optional<int> selected = {};  ///< the surface that commands act on
  std::vector<int> together = {};    ///< the others that were selected with it
  std::vector<SceneSurface> surfaces = {};
  std::vector<Tool> tools = {};  ///< lengths in file units; their orientation is that of `PlacedShape::placement`
  std::vector<SceneForce> forces = {};
  Load load = {};
  std::optional<double> limit = {};  ///< no point may be further than this from the surface as opened, file units
  EvolutionPolicy evolution = {};
  ScalingMode scaling = ScalingMode::normalised;
  SeamPolicy seams = {};
  RefinePermission permission = RefinePermission::trims;
  std::vector<Probe> probes = {};
  std::optional<OpenStroke> stroke = {};  ///< a tool that is down; every other command lifts it first

  /// All selected surfaces, the first one first.
  [[nodiscard]] std::vector<int> selection() const;
};

/// The tools of the scene, and their images in the planes of mirror symmetry of the first selected surface.
/// Errors: those of `mirror_plane` and `mirrored`.
[[nodiscard]] Expected<std::vector<Tool>> tools_and_images(const Scene& scene);

/// What a probe finds, lengths in file units.
struct ProbeReading {
  Point point = Point::Zero();         ///< S(u, v)
  Point displacement = Point::Zero();  ///< from the surface as opened
  Point normal = Point::Zero();        ///< S_u × S_v, of length 1; zero where there is none
};

/// Errors: a place outside the domain (input), a rational denominator that is not positive (numerical).
[[nodiscard]] Expected<ProbeReading> read_probe(const Scene& scene, const Probe& probe);

}  // namespace knead
