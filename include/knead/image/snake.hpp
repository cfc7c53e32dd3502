#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "knead/image/image_potential.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// A force of the user's hand on a snake (Kass, Witkin and Terzopoulos; thesis Fig. 2.24).
struct SnakeSpring {
  double at = 0;                  ///< which point of the snake: the fraction of its parameter, 0 to 1
  std::array<double, 2> to = {};  ///< where it is drawn, pixels
  double strength = 1;            ///< force per distance
};
struct SnakeVolcano {
  std::array<double, 2> at = {};  ///< from where the snake is pushed away, pixels
  double strength = 1;            ///< force at the radius; it falls with the square of the distance
  double radius = 1;              ///< within which it grows no more, pixels
};

/// How a snake is made and moves. The energy is ½ ∫ α |v'|² + β |v''|² ds − ∫ Q(v) ds (thesis Eqs. 2.26 to 2.30, with
/// the factor ½ of Kass, Witkin and Terzopoulos), s counted in `units`.
struct SnakeSettings {
  bool closed = true;
  int degree = 3;
  int control_points = 40;  ///< of a closed snake those that are different
  double units = 0;         ///< length of the parameter s; 0: the length of the start in pixels
  double alpha = 0.015, beta = 10;
  double gamma = 0.001;  ///< viscosity: force per velocity, pixels per iteration
  /// Width of the outside that the region term compares with, pixels: the median of what is so near the snake and in no
  /// other. The insides of others and what is beyond the image push it back. 0: all of the image, by its mean.
  double band = 0;
  /// Share of the outside, with a band, that is taken along the normal of each place alone: the darkest grey value on
  /// the way outwards to the end of the band or the next snake (the brightest, where the inside is darker than the
  /// band). A snake does not flow through a bridge between two bright places that is darker than both.
  double local = 0.5;
  /// Every so many iterations a closed snake that is driven along its normal, by regions or pressure, and has no
  /// springs is spread evenly where it is stretched more than twice as much in some places as in others; 0: never.
  int redistribute = 10;
  double balloon = 0;     ///< pressure along the outward normal of a closed snake, force per length
  bool hold_ends = true;  ///< of an open snake
  /// Free ends are pulled outwards along the snake by this share of the stretch at the start, α |v'|. With 0 they obey
  /// the natural conditions of the energy, v'' = 0 and β v''' = α v', and an open snake contracts; with 1 it keeps its
  /// length but for what the image does.
  double end_tension = 0;
  double max_move = 1;  ///< pixels that a control point moves in an iteration at most: |d| becomes m tanh(|d| / m)
  int max_iterations = 2500;
  double motion =
      0.1;            ///< ends when no control point is farther from one of ten earlier places, in |dx| + |dy|, pixels
  double refine = 0;  ///< halves spans where a finer net would change the contour by more, pixels; 0: never
  int max_control_points = 1000;  ///< up to which spans are halved
  std::vector<SnakeSpring> springs = {};
  std::vector<SnakeVolcano> volcanoes = {};
};

/// A contour in an image: a B-spline curve in the plane z = 0, x to the right and y down, in pixels.
struct SnakeResult {
  Curve curve;  ///< a closed one on unclamped knots, its first p control points repeated at the end
  bool closed = true;
  int iterations = 0;
  bool converged = false;  ///< whether it came to rest before the iterations ended
  double last_motion = 0;  ///< pixels
};

/// A curve near points in their order, by least squares over the chord length: what a snake starts from. Errors
/// (input): fewer than three points (two of an open one), points that are not finite, the same point throughout; a
/// degree outside 2 to 7, too few control points for it.
[[nodiscard]] Expected<Curve> curve_through(std::span<const std::array<double, 2>> points,
                                            const SnakeSettings& settings);

/// Active contours in an image, several at once: each by implicit steps (γ M + α G11 + β G22) c⁺ = γ M c + F(c) on the
/// exact Gramians of its basis, F by p + 2 Gauss points per span, until it rests. The matrix is factored once per net.
///
/// Several snakes do not see each other but for the region term, whose outside is outside of all. A snake does not
/// change its topology: it neither splits nor merges nor crosses out parts of itself (`crossings` tells). When much
/// of a snake turns back its viscosity doubles, and it halves again while it goes on, down to γ: steep edges, at which
/// an explicit force overshoots, do not keep it from resting. Cost of an iteration: O(control points · p²) and the
/// image's spline at each Gauss point.
///
/// They run a few iterations at a time; between, they can be looked at, and drawn by hand.
class Snakes {
 public:
  /// From curves of `curve_through`, each with its settings. Errors: settings outside their ranges, other knots
  /// (input); a matrix that is not positive definite (numerical).
  [[nodiscard]] static Expected<Snakes> create(const ImagePotential& potential, const std::vector<Curve>& starts,
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
  /// Makes so many iterations, fewer if all end: how many. In one, each snake that has not ended makes a step.
  [[nodiscard]] Expected<int> advance(int iterations);

  /// Where it is. While a finer net is tried it stays where it was.
  [[nodiscard]] Expected<SnakeResult> result(int snake) const;
  [[nodiscard]] const SnakeSettings& settings(int snake) const;
  /// Other settings, say springs that follow the pointer, for a snake where it is: it wakes, and counts its iterations
  /// anew. `control_points` and `units` are those of its net. Errors: those of `create`; there is no such snake
  /// (input).
  [[nodiscard]] Expected<void> change(int snake, const SnakeSettings& settings);
  /// The same from another curve.
  [[nodiscard]] Expected<void> replace(int snake, const Curve& curve, const SnakeSettings& settings);

 private:
  struct State;
  explicit Snakes(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// `Snakes` from their starts until all have ended. Errors: theirs.
[[nodiscard]] Expected<std::vector<SnakeResult>> run_snakes(const ImagePotential& potential,
                                                            const std::vector<Curve>& starts,
                                                            const std::vector<SnakeSettings>& settings);

/// Points of the contour, `per_span` for each span at equal parameters; of an open one with its end.
[[nodiscard]] std::vector<std::array<double, 2>> polyline(const SnakeResult& snake, int per_span = 16);

/// How often the polyline with 16 points per span crosses itself. Cost: O(points²).
[[nodiscard]] int crossings(const SnakeResult& snake);

/// 1 at pixels whose centres are inside a closed contour (even-odd rule, of its polyline with 16 points per span), else
/// 0.
[[nodiscard]] Image mask_of(const SnakeResult& snake, int width, int height);

}  // namespace knead
