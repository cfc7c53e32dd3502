#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/model/model.hpp"
#include "session/gestures/stroke_model.hpp"
#include "session/session_state.hpp"

namespace knead {

struct Act;

/// How much further than asked anything may move.
inline constexpr double law_tolerance = 0.05;

/// What one command asks of the selected surfaces, and whether that bounds how far they move
/// (docs/clay.md, "How far anything moves"). Where it does, each selected surface has a shape from
/// which its motion is measured.
class MotionLaw {
 public:
  /// Whether tools, grips and brushes are all that acts, and ask for some motion.
  [[nodiscard]] bool bounds() const { return !unruled_ && reach_ > 0; }

  /// What the tools and these grips ask: at first of the surfaces as they stand, beyond what moved
  /// them before; where the command goes on with others, of the shapes that motion is measured
  /// from, so that what one step moved too far does not count for the next. Errors: those of
  /// `tools_and_images`.
  [[nodiscard]] Expected<void> ask_of_steps(const Scene& scene, const EvolutionPolicy& evolution,
                                            const std::vector<PointForce>& grips);
  /// What the open stroke has left so far may stay, whatever places asked for it.
  void keep_what_stroke_left(const Scene& scene);
  /// What tools ask of the shapes from before the stroke, where they moved them so far: by no more
  /// than half the tolerance further than they stand in them, which is measured exactly only where
  /// they did.
  void ask_of_stroke(const OpenStroke& stroke, const StrokeModel& model, double moved,
                     std::span<const Tool> tools);
  /// Points that a brush asks to move this far, file units.
  void ask_of_brush(const OpenBrush& brush, double asked);

  /// Whether a step moves further than was asked for. Then `loads` keep the step, made again,
  /// within reach.
  [[nodiscard]] bool shortens(const Scene& scene, const ActiveStep& step, ActiveLoads& loads,
                              const Model& model);
  /// The share of the motion that may stay of what has moved by more than `law_tolerance` further
  /// than was asked, which is noted; none: all. A lever may move as far as the static solution of
  /// what acts on it, and how far is noted.
  [[nodiscard]] std::optional<double> share_allowed(SessionState& state);
  /// All that moved from there, made smaller alike: what is held is linear in displacements.
  [[nodiscard]] Expected<void> make_smaller(Scene& scene, double share) const;

 private:
  void count_standing();
  void measure_from_rest(const Scene& scene);
  [[nodiscard]] double motion(const Scene& scene, double enough) const;
  [[nodiscard]] double static_motion(Scene scene) const;
  [[nodiscard]] Points points_from(const Scene& scene) const;

  double reach_ = 0;  // how far tools, grips and brushes ask any point to move, file units
  std::vector<OpenStroke::Before>
      from_;                       // of each selected surface the shape from which that is measured
  std::vector<Tool> tools_;        // where they stood deepest
  std::vector<PointForce> grips_;  // that asked for most
  bool standing_ = false;          // `reach_` counts how far the tools stand in the shapes
  bool asked_ = false;             // of steps or strokes
  bool unruled_ = false;           // what acts has another law
};

/// The one door of all that moves surfaces: what has moved further than it was asked to is made
/// smaller, and noted. Forgets what was asked.
[[nodiscard]] Expected<void> keep_law(Act& act);

/// How deep the surface goes into the deepest of these tools, file units; 0: it touches none. Only
/// what is visible counts where `visible` is given. Sampled at an abscissa per control point,
/// between them where those are clear, and refined by a compass search to 1e-3 of the distance of
/// samples.
[[nodiscard]] double depth_in(const Surface& shape, std::span<const Tool> tools,
                              const VisibleRegion* visible);

/// How far tools stand in the surface: of each the shorter of two ways out, that of the points
/// inside it, each along its normal to the nearer side, of which the longest counts, and that of
/// the whole surface by one translation. Of a blade both are its height, of which `depth_in` knows
/// the thickness alone; a closed surface within a tool leaves it by a translation, and one within a
/// ring by the other. Sampled at four by four points of every span, at most 400 of those inside,
/// and refined by a compass search; translations along the tool's normal at the deepest point, and
/// along the surface's at eight. 0: none.
[[nodiscard]] double standing_in(const Surface& shape, std::span<const Tool> tools);

/// The larger of both, of the deepest of these tools in the deepest of these shapes.
[[nodiscard]] double depth_in_shapes(std::span<const OpenStroke::Before> shapes,
                                     std::span<const Tool> tools);

/// The largest |a − b|, an upper bound where that is below `enough`: distances of control points.
/// Of shapes on one basis it is sampled at (p + 3)(q + 3) points of every span that may go further.
[[nodiscard]] double largest_motion(const Surface& a, const Surface& b, double enough);

/// A displacement of a shape with what would go further than `reach` taken off: where it does,
/// control points lose their part of the mean excess around them, in at most 12 rounds. Control
/// points that do not move stay.
[[nodiscard]] Points within_reach(const Surface& shape, Points way, double reach);

/// Whether every side of every selected surface is held in position, joined or closed: what tools
/// press into it goes no further than they go. Else it is a lever.
[[nodiscard]] bool held_all_round(const Scene& scene, const std::vector<SeamReport>& seams);

/// Reports of the selected surfaces, by place in the selection, as reports by index into the scene.
[[nodiscard]] std::vector<SeamReport> seams_in_scene(std::span<const SeamReport> reports,
                                                     const Scene& scene);

/// Whether tools that collide are all that acts on the selected surfaces at rest, so that nothing
/// is drawn along, blown or swings.
[[nodiscard]] bool only_pressed(const Scene& scene, const EvolutionPolicy& evolution);

/// A share of the way from one shape to another on the same basis. Control points that do not move
/// keep their bits; where none does, it is `to` itself. Errors: those of `with_control_points`.
[[nodiscard]] Expected<std::shared_ptr<const Surface>> part_of_way(
    const Surface& from, const std::shared_ptr<const Surface>& to, double share);

}  // namespace knead
