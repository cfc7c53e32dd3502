#pragma once

#include "knead/base/error.hpp"

// One problem, solved by the models that thesis chapter 3 compares: a unit sheet with hinged
// borders, stretch α = 1 and bend β = 0.01, under the load whose answer is w(u, v) = sin πu sin πv.
namespace knead::examples {

/// Errors are max |S − w| over the surface, relative to max w; times in seconds.
struct Comparison {
  double spring_error = 0;   ///< at the masses themselves
  double surface_error = 0;  ///< of the surface interpolated through them
  double relax_time = 0;     ///< balance of the springs by explicit steps to 1e-8
  int relax_steps = 0;
  double direct_time = 0;         ///< balance of the springs by Cholesky, factor and solution
  double interpolation_time = 0;  ///< of one frame, the collocation matrix inverted before
  double exact_error = 0;         ///< of the active surface
  double exact_setup = 0;         ///< its matrices and factor, once
  double exact_step = 0;          ///< one frame
};

/// n × n masses against a cubic net of n × n control points; n >= 8. The surface through the masses
/// has averaged knots.
[[nodiscard]] Expected<Comparison> compare_models(int n);

/// How far the middle moves (n odd) when every mass is drawn to height 1 by a spring of the same
/// constant (which is what a tool that acts on points does), and when the surface is drawn by
/// springs of that constant per area.
struct Touch {
  double springs = 0, exact = 0;
};
[[nodiscard]] Expected<Touch> touch(int n, double spring);

/// Changes of a surface that nothing touches, relative to its size, after rounds of sampling at
/// Greville abscissae and global interpolation, n = 32, cubic. `cluster`: distance of three knots
/// in the middle, 0 for uniform knots.
[[nodiscard]] Expected<double> interpolation_drift(double cluster, int rounds);

/// A round dent of radius ¼ is pressed into flat masses; outside of it they stay at 0. The largest
/// height of the surface interpolated through them further than `distance` outside of the dent,
/// relative to its depth. On knots averaged from the masses' parameters, or on clamped uniform
/// knots as the surface may have come with.
[[nodiscard]] Expected<double> ripple(int n, double distance, bool averaged);

/// The largest movement of control points in a step of the active surface at rest: 0, bit for bit.
[[nodiscard]] Expected<double> movement_at_rest(int n);

}  // namespace knead::examples
