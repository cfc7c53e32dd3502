#pragma once

#include <cmath>
#include <deque>

#include "knead/spline/spline.hpp"

namespace knead {

/// How a snake moves, curve or surface: whether it rests, and how much its viscosity has grown.
///
/// A snake whose forces are no gradient, as those of regions and flow, has no energy that a line
/// search could lower: what is left to judge a step by is the motion itself.
class SnakeMotion {
 public:
  /// After an iteration that has brought the unknowns to c. It rests when all are within `rest` of
  /// one of ten earlier places, counted as if the viscosity had not grown.
  void went_to(const Points& c, double rest);
  /// Doubles the viscosity when much of the snake turns back, and halves it again, down to what is
  /// asked, while it goes on: whether it is another.
  [[nodiscard]] bool steadied(const Points& move);

  [[nodiscard]] bool resting() const { return resting_; }
  /// It is not to move.
  void stop() { resting_ = true; }
  /// How far it went between the places compared last.
  [[nodiscard]] double last() const { return last_; }
  /// γ as it has grown.
  [[nodiscard]] double viscosity(double gamma) const { return std::ldexp(gamma, level_); }

 private:
  std::deque<Points> before_ = {};
  Points move_ = {};  ///< the last one
  double last_ = 0;
  int level_ = 0;     ///< the viscosity is γ 2^level
  int steadily_ = 0;  ///< moves that went on as the one before
  bool resting_ = false;
};

/// Moves of which none is longer than `most`, each in its direction.
[[nodiscard]] Points limited(Points moves, double most);

}  // namespace knead
