#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "knead/image/image.hpp"
#include "knead/image/snake.hpp"
#include "snake_motion.hpp"
#include "snake_net.hpp"
#include "snake_settings.hpp"

namespace knead {

/// Σ over the area inside by Green's theorem.
struct Inside {
  double area = 0, intensity = 0;  ///< signed: positive where the normal (y', −x') points outwards
};

/// Grey values on both sides of a closed snake.
struct Sides {
  double inside = 0;                 ///< the mean
  std::vector<double> outside = {};  ///< what counts as outside at each Gauss point
  /// Whether Gauss points are in other snakes or beyond the image; empty: none.
  std::vector<char> beyond = {};
};

/// One snake on its way.
///
/// Iterated are semi-implicit steps (M. Kass, A. Witkin, D. Terzopoulos, 1988): stretch and bend at
/// the end of the step, the forces of the image at its beginning. The viscosity γ adapts between
/// them, so that the snake neither creeps nor swings across edges.
struct MovingSnake {
  SnakeSettings settings;
  SnakeNet net;
  Points c;  ///< its unknowns
  int iterations = 0;
  SnakeMotion motion = {};
  std::array<double, 2> end_pull = {};  ///< forces that draw free ends outwards

  [[nodiscard]] Inside inside(const ImagePotential& image) const;
  /// An iteration; `side` is 1 where the normal (y', −x') points outwards, else −1.
  [[nodiscard]] Expected<void> step(const ImagePotential& image, double side,
                                    const std::optional<Sides>& sides);

  /// v' at both ends of an open one.
  [[nodiscard]] std::array<Eigen::RowVector3d, 2> end_tangents() const;

  [[nodiscard]] bool ended() const {
    return motion.resting() || iterations >= settings.max_iterations;
  }

 private:
  /// What draws the ends of an open one outwards.
  [[nodiscard]] std::array<Eigen::RowVector3d, 2> pulls() const;
  /// Whether it is stretched more than twice as much in some places as in others.
  [[nodiscard]] bool uneven() const;
  /// Spreads it evenly along itself.
  [[nodiscard]] Expected<void> spread();
  /// γ v and the forces of the image, of pressure and of volcanoes at the Gauss points.
  [[nodiscard]] Points forces(const ImagePotential& image, double side,
                              const std::optional<Sides>& sides) const;
  [[nodiscard]] double viscosity() const { return motion.viscosity(settings.gamma); }
};

/// A snake that starts here. Errors (input): settings outside their ranges, other knots than those
/// of `curve_through`.
[[nodiscard]] Expected<MovingSnake> snake_on(const Curve& start, const SnakeSettings& settings);

/// The same snake on the net of these spans, with its iterations.
[[nodiscard]] Expected<MovingSnake> moved_to(const MovingSnake& snake,
                                             std::span<const double> breaks);

/// Breaks with those spans halved.
[[nodiscard]] std::vector<double> halved(const std::vector<double>& breaks,
                                         const std::vector<bool>& marked);

/// Spans in which the contour is elsewhere, across itself, on a net of half the spans.
[[nodiscard]] std::vector<bool> spans_that_differ(const MovingSnake& coarse,
                                                  const MovingSnake& fine);

}  // namespace knead
