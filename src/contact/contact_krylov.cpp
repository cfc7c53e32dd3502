#include "contact_krylov.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/interruption.hpp"
#include "contact_limits.hpp"

namespace knead {
namespace {

// Per minimisation: a step that needs more stops there and says so.
constexpr int max_cycles = 4000;
// Of what is enough, where nothing is in contact: one direction ends the step.
constexpr double free_share = 0.3;
constexpr double smallest_tolerance = 1e-13;

}  // namespace

KrylovMinimisation::KrylovMinimisation(const StepProblem& problem,
                                       const ConstrainedMultigrid& inverse, Potential& potential,
                                       Points& y)
    : problem_(problem),
      inverse_(inverse),
      potential_(potential),
      y_(y),
      ay_(product(y)),
      state_(potential.evaluate(problem.start + y)) {}

Points KrylovMinimisation::product(const Points& x) const {
  if ((x.array() == 0).all()) return Points::Zero(x.rows(), 3);
  return inverse_.product(x);
}

/// ½ YᵀAY − Yᵀb.
double KrylovMinimisation::quadratic() const { return 0.5 * dot(y_, ay_) - dot(y_, problem_.b); }

KrylovMinimisation::Residual KrylovMinimisation::residual() {
  Residual at;
  at.r = inverse_.space().lumped(problem_.b - ay_ + state_.force);
  at.image = inverse_.precondition(at.r);
  at.squared = dot(at.r, at.image);
  ++summary.solves;
  return at;
}

/// √(fᵀ B f) over the free unknowns.
double KrylovMinimisation::norm(const Points& force) {
  const Points on_free = inverse_.space().lumped(force);
  if ((on_free.array() == 0).all()) return 0;
  ++summary.solves;
  return std::sqrt(std::max(0.0, dot(on_free, inverse_.precondition(on_free))));
}

double KrylovMinimisation::norm_of_b() {
  if (norm_of_b_ < 0) norm_of_b_ = norm(problem_.b);
  return norm_of_b_;
}

double KrylovMinimisation::imbalance() {
  return std::sqrt(std::max(0.0, residual().squared)) / norm_of_b();
}

/// (A + H) d = r by conjugate gradients preconditioned with B, to `tolerance` of the first
/// preconditioned residual. If A + H turns out not to be positive, the result is the sum of the
/// steps so far, or B r: a descent direction in any case (Nocedal and Wright, Numerical
/// Optimization, Alg. 7.1).
///
/// No pairs of directions before, and no neighbourhood: with cycles the whole net is touched in
/// every iteration anyway.
KrylovMinimisation::ContactDirection KrylovMinimisation::direction(Residual at, double tolerance) {
  const Points first = at.r;
  ContactDirection to{Points::Zero(first.rows(), 3), Points::Zero(first.rows(), 3)};
  Points p = std::move(at.image), hp = Points::Zero(first.rows(), 3);
  double rs = at.squared;
  const double start = rs, target = tolerance * tolerance * rs;
  for (int iteration = 0; iteration < max_cg_iterations && rs > target && rs > 0; ++iteration) {
    if (Interruption::asked_for()) break;
    Points ap = inverse_.product(p);
    const double pap = dot(p, ap);
    double curvature = pap;
    if (!state_.contacts.empty()) {
      hp.setZero();
      potential_.apply_hessian(state_, p, hp);
      curvature += dot(p, hp);
    }
    if (curvature <= 1e-12 * pap) {
      if (iteration == 0) {
        to.d = std::move(p);
        to.ad = std::move(ap);
      }
      break;
    }
    const double step = rs / curvature;
    to.d += step * p;
    to.ad += step * ap;
    at.r -= step * inverse_.space().lumped(ap + hp);
    const Points s = inverse_.precondition(at.r);
    ++summary.solves;
    const double next = dot(at.r, s);
    if (!(next < 1e6 * start)) break;  // nothing but rounding is left
    p = s + next / rs * p;
    rs = next;
  }
  to.slope = -dot(first, to.d);
  return to;
}

/// Steps along the direction, halved until Φ decreases enough; a full step if values are not
/// decisive.
///
/// Φ(Y + t d) − Φ(Y) as a polynomial in t and a difference of Ψ, rather than as a difference of two
/// Φ, which would lose the digits that both have in common.
void KrylovMinimisation::advance(const ContactDirection& to, bool rounded) {
  const double along = dot(to.d, ay_ - problem_.b), bent = 0.5 * dot(to.d, to.ad),
               before = state_.potential;
  for (double t = 1;; t /= 2) {
    PotentialState state = potential_.evaluate(problem_.start + y_ + t * to.d);
    const double gain = t * along + t * t * bent + state.potential - before;
    if (!rounded && gain > sufficient_decrease * t * to.slope && t > 1e-10 &&
        !Interruption::asked_for())
      continue;
    y_ += t * to.d;
    ay_ += t * to.ad;
    fresh_ = false;
    state_ = std::move(state);
    return;
  }
}

// A Y is carried along by its steps, t A d, which drifts by rounding. An exact step that seems
// finished computes it anew and goes on if the decrement is then too large. Where one such
// measurement is more than half of that before, and below `rounded_tolerance`, what is left is the
// rounding of A Y.
void KrylovMinimisation::iterate(double tolerance, int max_iterations, bool certain) {
  summary.converged = false;
  double largest = std::max(norm_of_b(), norm(state_.force));
  double before = std::numeric_limits<double>::infinity();
  for (int iteration = 0, rounded_steps = 0; !Interruption::asked_for();) {
    Residual at = residual();
    const double decrement = std::sqrt(std::max(0.0, at.squared));
    largest = std::max(largest, decrement);
    double enough = tolerance * largest;
    if (problem_.accuracy > 0)
      enough = std::max(enough, problem_.accuracy * std::sqrt(std::max(0.0, dot(y_, ay_))));
    if (!(decrement > enough) || !std::isfinite(decrement)) {
      summary.converged = summary.finite = std::isfinite(decrement);
      if (!certain || problem_.accuracy > 0 || fresh_ || !summary.finite) return;
      ay_ = product(y_);
      fresh_ = true;
      continue;
    }
    if (fresh_) {
      if (decrement > 0.5 * before && decrement <= rounded_tolerance * largest) {
        summary.converged = true;  // the remainder is the rounding of AY
        return;
      }
      before = decrement;
    }
    if (iteration == max_iterations || summary.solves > max_cycles) return;
    summary.converged = false;
    ++iteration;
    ++summary.iterations;
    const double cg_tolerance =
        state_.contacts.empty()
            ? std::clamp(free_share * enough / decrement, smallest_tolerance, 1e-2)
            : direction_tolerance(decrement, enough, largest, problem_.accuracy > 0);
    const ContactDirection to = direction(std::move(at), cg_tolerance);
    const bool rounded =
        -to.slope <= rounding_of_potential * (problem_.energy + std::abs(quadratic()) +
                                              std::abs(state_.potential) + decrement * decrement);
    // A few full steps gain what the gradient can still resolve.
    if (rounded && ++rounded_steps > max_rounded_steps) {
      summary.converged = true;
      return;
    }
    advance(to, rounded);
    if (!y_.allFinite()) {
      summary.finite = false;
      return;
    }
  }
}

}  // namespace knead
