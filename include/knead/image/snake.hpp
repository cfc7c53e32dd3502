#pragma once

#include <array>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "knead/image/image.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// A place in the image of a curve (D = 1), pixels, or in the space of a surface (D = 2).
template <int D>
using SnakePlace = std::conditional_t<D == 1, std::array<double, 2>, Point>;
template <int D>
[[nodiscard]] SnakePlace<D> snake_origin() {
  if constexpr (D == 1) return {};
  if constexpr (D == 2) return Point::Zero();
}

/// The control points that a snake has by default: 40 around a curve; 24 around a surface and 14
/// from pole to pole.
template <int D>
[[nodiscard]] constexpr auto usual_snake_net() {
  if constexpr (D == 1) return 40;
  if constexpr (D == 2) return std::array{24, 14};
}

/// Forces of the user's hand on a snake of D parameters (Kass, Witkin and Terzopoulos; thesis
/// Fig. 2.24).
template <int D>
struct SnakeSpringOf {
  std::conditional_t<D == 1, double, std::array<double, 2>> at =
      {};                                ///< which point: fractions of its parameters
  SnakePlace<D> to = snake_origin<D>();  ///< where it is drawn
  double strength = 1;                   ///< force per distance
};
template <int D>
struct SnakeVolcanoOf {
  SnakePlace<D> at = snake_origin<D>();  ///< from where the snake is pushed away
  double strength = 1;  ///< force at the radius; it falls with the square of the distance
  double radius = 1;    ///< within which it grows no more
};

/// How a snake is made and moves: a curve in an image (D = 1) or a closed surface in a volume (D =
/// 2). The energy is ½ ∫ α |∇v|² + β |Δv|² ds − ∫ Q(v) ds (thesis Eqs. 2.26 to 2.30, 2.33, 2.34,
/// with the factor ½ of Kass, Witkin and Terzopoulos) over what the parameters are of: a line or
/// circle, counted in `units`; a round sphere or a flat torus. Lengths are pixels in images, those
/// of space in volumes.
template <int D>
struct SnakeSettingsOf {
  bool closed = true;  ///< of curves; surfaces are
  int degree = 3;      ///< 2 to 7
  /// Those that differ of a closed curve; in u those of a surface that differ, in v from pole to
  /// pole, or that differ.
  std::conditional_t<D == 1, int, std::array<int, 2>> control_points = usual_snake_net<D>();
  /// Length of the parameter, of surfaces the way around in u; 0: that of the start (for an
  /// ellipsoid of a sphere of its mean radius). From pole to pole it is half of that; around the
  /// tube of a torus as much less as the start's tube is.
  double units = 0;
  double alpha = D == 1 ? 0.015 : 0.01, beta = D == 1 ? 10 : 0.1;
  double gamma = D == 1 ? 0.001 : 0.1;  ///< viscosity: force per velocity, length per iteration
  /// Width of the outside that the region term compares with; 0: all of the image, by its mean. Of
  /// curves the median of what is so near the snake and in no other; the insides of others and what
  /// is beyond the image push it back.
  double band = 0;
  /// Of curves the share of the outside, with a band, that is taken along the normal of each place
  /// alone: the darkest grey value on the way outwards to the end of the band or the next snake
  /// (the brightest, where the inside is darker than the band). A snake does not flow through a
  /// bridge between two bright places that is darker than both.
  double local = 0.5;
  /// Every so many iterations a closed snake that is driven along its normal, by regions, flow or
  /// pressure, and has no springs is spread evenly within itself where its length is stretched more
  /// than twice, its area more than four times as much in some places as in others; 0: never.
  int redistribute = 10;
  /// Pressure along the outward normal of a closed snake, force per length or area.
  double balloon = 0;
  bool hold_ends = true;  ///< of an open curve
  /// Free ends of a curve are pulled outwards along it by this share of the stretch at the start, α
  /// |v'|. With 0 they obey the natural conditions of the energy, v'' = 0 and β v''' = α v', and an
  /// open snake contracts; with 1 it keeps its length but for what the image does.
  double end_tension = 0;
  /// That a control point moves in an iteration at most: |d| becomes m tanh(|d| / m).
  double max_move = 1;
  int max_iterations = 2500;
  /// Ends when no control point is farther from one of ten earlier places, in |dx| + |dy| + |dz|.
  double motion = D == 1 ? 0.1 : 0.01;
  /// Halves spans of a curve where a finer net would change it by more, all of a surface where that
  /// would move it by more, across itself; 0: never.
  double refine = 0;
  int max_control_points = D == 1 ? 1000 : 4000;  ///< up to which spans are halved
  std::vector<SnakeSpringOf<D>> springs = {};
  std::vector<SnakeVolcanoOf<D>> volcanoes = {};
};
using SnakeSpring = SnakeSpringOf<1>;
using SnakeVolcano = SnakeVolcanoOf<1>;
using SnakeSettings = SnakeSettingsOf<1>;

/// A contour in an image: a B-spline curve in the plane z = 0, x to the right and y down, in
/// pixels.
struct SnakeResult {
  Curve curve;  ///< a closed one on unclamped knots, its first p control points repeated at the end
  bool closed = true;
  int iterations = 0;
  bool converged = false;  ///< whether it came to rest before the iterations ended
  double last_motion = 0;  ///< pixels
};

/// A curve near points in their order, by least squares over the chord length: what a snake starts
/// from. Errors (input): fewer than three points (two of an open one), points that are not finite,
/// the same point throughout; a degree outside 2 to 7, too few control points for it.
[[nodiscard]] Expected<Curve> curve_through(std::span<const std::array<double, 2>> points,
                                            const SnakeSettings& settings);

/// Active contours in an image, several at once: each by implicit steps (γ M + α G11 + β G22) c⁺ =
/// γ M c + F(c) on the exact Gramians of its basis, F by p + 2 Gauss points per span, until it
/// rests. The matrix is factored once per net.
///
/// Several snakes do not see each other but for the region term, whose outside is outside of all. A
/// snake does not change its topology: it neither splits nor merges nor crosses out parts of itself
/// (`crossings` tells). When much of a snake turns back its viscosity doubles, and it halves again
/// while it goes on, down to γ: steep edges, at which an explicit force overshoots, do not keep it
/// from resting. Cost of an iteration: O(control points · p²) and the image's spline at each Gauss
/// point.
///
/// They run a few iterations at a time; between, they can be looked at, and drawn by hand.
class Snakes {
 public:
  /// From curves of `curve_through`, each with its settings. Errors: settings outside their ranges,
  /// other knots (input); a matrix that is not positive definite (numerical).
  [[nodiscard]] static Expected<Snakes> create(const ImagePotential& potential,
                                               const std::vector<Curve>& starts,
                                               const std::vector<SnakeSettings>& settings);
  /// Copies go on independently, from the same state.
  Snakes(const Snakes&);
  Snakes& operator=(const Snakes&);
  Snakes(Snakes&&) noexcept;
  Snakes& operator=(Snakes&&) noexcept;
  ~Snakes();

  [[nodiscard]] int count() const;
  /// Whether all rest, on nets that follow the image, or have made their iterations.
  [[nodiscard]] bool ended() const;
  /// Makes so many iterations, fewer if all end: how many. In one, each snake that has not ended
  /// makes a step.
  [[nodiscard]] Expected<int> advance(int iterations);

  /// Where it is. While a finer net is tried it stays where it was.
  [[nodiscard]] Expected<SnakeResult> result(int snake) const;
  /// Of all of them.
  [[nodiscard]] Expected<std::vector<SnakeResult>> results() const;
  [[nodiscard]] const SnakeSettings& settings(int snake) const;
  /// Other settings, say springs that follow the pointer, for a snake where it is: it wakes, and
  /// counts its iterations anew. `control_points` and `units` are those of its net. Errors: those
  /// of `create`; there is no such snake (input).
  [[nodiscard]] Expected<void> change(int snake, const SnakeSettings& settings);
  /// The same from another curve.
  [[nodiscard]] Expected<void> replace(int snake, const Curve& curve,
                                       const SnakeSettings& settings);

 private:
  struct State;
  explicit Snakes(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// `Snakes` from their starts until all have ended. Errors: theirs.
[[nodiscard]] Expected<std::vector<SnakeResult>> run_snakes(
    const ImagePotential& potential, const std::vector<Curve>& starts,
    const std::vector<SnakeSettings>& settings);

/// Points of the contour, `per_span` for each span at equal parameters; of an open one with its
/// end.
[[nodiscard]] std::vector<std::array<double, 2>> polyline(const SnakeResult& snake,
                                                          int per_span = 16);

/// How often the polyline with 16 points per span crosses itself. Cost: O(points²).
[[nodiscard]] int crossings(const SnakeResult& snake);

/// 1 at pixels whose centres are inside a closed contour (even-odd rule, of its polyline with 16
/// points per span), else 0.
[[nodiscard]] Image mask_of(const SnakeResult& snake, int width, int height);

}  // namespace knead
