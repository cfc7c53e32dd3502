#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/interruption.hpp"
#include "contact_directions.hpp"
#include "contact_factor.hpp"
#include "contact_limits.hpp"
#include "contact_newton.hpp"

namespace knead {

// Per minimisation: a step that needs more stops there and says so.
inline constexpr int max_solves = 1500;
inline constexpr int many_substitutions = 60;  // for one direction: from there on A + H is factored
inline constexpr double cancellation = 1e-12;
// Of the decrement: what a step leaves where what touches changes little.
inline constexpr double settled_share = 0.2;

/// Newton's iteration on Φ(Y) = ½ YᵀAY − Yᵀb + Ψ(x₀ + Y), on a net of which a tool touches little.
///
/// A round starts from an anchor Y₀ at which everything is known exactly: with A = LLᵀ on the free
/// unknowns, z = L⁻¹r for r = b − AY₀ + F, F = −∇Ψ. Everything that follows is kept relative to it,
///   A (Y − Y₀) = β r + E e,
/// e of the few control points near what touches (the neighbourhood E): tools change forces there
/// and nowhere else, so that an iteration costs a few substitutions in the part of L that those
/// points reach, and not a sweep over the whole net. Φ, its slope and the decrement √(rᵀA⁻¹r) are
/// sums over e and the squares known at the anchor (`Combination`, `Residual`).
///
/// A direction solves (A + H) d = r, H the Hessian of Ψ, of the rank of what touches: conjugate
/// gradients preconditioned by A⁻¹ need about as many iterations as H has distinct eigenvalues
/// beside those of A (`ContactDirections`), and where they need many, A + H is factored
/// (`ContactFactor`). H is positive semidefinite for convex tools; where it is not, what the search
/// along d accepts must still lower Φ. So every accepted iterate lowers Φ, which is bounded below
/// where A is positive definite, and near the minimum the steps are Newton's: quadratic convergence
/// until rounding.
///
/// What comes into contact outside the neighbourhood ends a round: the neighbourhood grows, and the
/// next round goes on from there, or from the anchor where Φ would have risen. Values relative to
/// an anchor lose digits as r shrinks (β r and E e cancel): a round that this blurs ends, and the
/// next is measured from its own anchor.
class Minimisation {
 public:
  Minimisation(const StepProblem& problem, const ConstrainedCholesky& inverse, Potential& potential,
               Points& y)
      : problem_(problem),
        inverse_(inverse),
        potential_(potential),
        y_(y),
        x_(problem.start + y),
        state_(potential.evaluate(x_)),
        may_factor_(ContactFactor::is_possible(problem)) {}

  ContactSummary summary;

  [[nodiscard]] PotentialState take_state() { return std::move(state_); }

  /// Call after the potential has changed.
  void renew() {
    state_ = potential_.evaluate(x_);
    kept_.reset();
  }

  /// The imbalance of forces, as a share of the norm of b.
  double imbalance() {
    View here = view();
    const double share =
        std::sqrt(std::max(0.0, here.from.rs)) / norm_of_b(here, norm_of_force(here));
    kept_.emplace(std::move(here));
    return share;
  }

  /// Iterates until the decrement is `tolerance` of the terms that the step balances. With
  /// `certain` the result is measured again from its own anchor, with all forces recomputed.
  void iterate(double tolerance, int max_iterations, bool certain) {
    summary.converged = false;
    Progress progress{tolerance, max_iterations};
    double before = std::numeric_limits<double>::infinity();
    while (!Interruption::asked_for()) {
      View here = kept_ ? std::move(*kept_) : view();
      kept_.reset();
      if (progress.largest < 0) progress.largest = first_scale(here);
      const double decrement = std::sqrt(std::max(0.0, here.from.rs));
      if (finished(decrement, here, progress)) return;
      if (decrement > 0.5 * before && decrement <= rounded_tolerance * progress.largest) {
        summary.converged =
            true;  // the remainder is the rounding of AY: another round would find the same
        return;
      }
      before = decrement;
      summary.converged = false;
      const Round round = descend(here, progress);
      if (round == Round::over || (round == Round::small && (!certain || problem_.accuracy > 0)))
        return;
    }
  }

 private:
  /// Why a round ended: the decrement is small enough; it is too small relative to β r to be
  /// resolved from this anchor; or no further progress is possible.
  enum class Round { small, blurred, over };

  /// The progress of one call of `iterate`.
  struct Progress {
    double tolerance;
    int max_iterations;
    double largest = -1;  // of the terms that the step balances; -1: not known yet
    double enough = 0;    // a decrement this small ends the iteration
    int iteration = 0;
    int rounded_steps = 0;  // steps taken where the gain is below rounding
    bool settled = false;   // the last step shows that what touches changes little
  };

  /// The present iterate Y₀ + u relative to an anchor.
  struct View {
    Anchor from;
    ContactNeighbourhood near;
    Combination au;    // A u
    Points u;          // in the neighbourhood
    double quadratic;  // ½ YᵀAY − Yᵀb
    ContactDirections directions;

    /// The same at another u.
    [[nodiscard]] double quadratic_at(const Combination& au_there, const Points& u_there) const {
      return from.quadratic - au_there.with_r(from) + dot(u_there, from.force_here) +
             0.5 * au_there.norm(from, u_there);
    }
  };

  const StepProblem& problem_;
  const ConstrainedCholesky& inverse_;
  Potential& potential_;
  Points& y_;
  Points x_;              // start + Y, while a round lasts in its neighbourhood only
  PotentialState state_;  // at the present iterate
  std::optional<View> kept_;
  double norm_of_b_ = -1;
  bool may_factor_;
  // Once conjugate gradients have taken many substitutions for one direction.
  bool factors_ = false;

  /// From the present Y, where `state_` is complete.
  View view() {
    Anchor a{y_, {}, 0, 0, 0, {}, {}, {}};
    Points r = problem_.b;
    if (!(y_.array() == 0).all()) {
      const Points ay = problem_.a(y_);
      a.squared = dot(y_, ay);
      a.quadratic = 0.5 * a.squared - dot(y_, problem_.b);
      r -= ay;
    }
    r += state_.force;
    a.z = inverse_.forward(inverse_.space().lumped(r));
    ++summary.solves;
    a.rs = a.z.squared_norm;
    // Exact steps under the stiffest springs end before they converge: then every bit of a
    // direction shows.
    View here{std::move(a),
              ContactNeighbourhood(inverse_, potential_),
              {},
              {},
              0,
              ContactDirections(problem_.accuracy > 0)};
    here.quadratic = here.from.quadratic;
    here.au.e = here.u = here.from.force_here = Points(0, 3);
    take_in(here, state_);
    here.from.force_here = here.near.gather(state_.force);
    return here;
  }

  /// Extends the neighbourhood by the contacts of a state, if it is to be. Forces of the anchor
  /// beyond it are zero.
  bool take_in(View& view, const PotentialState& state) {
    if (!view.near.extend(state)) return false;
    view.directions.forget();
    view.from.s_here = inverse_.backward_within(view.near.subset(), view.from.z);
    view.from.x_here = view.near.gather(problem_.start) + view.near.gather(view.from.y);
    view.from.force_here = view.near.grown(view.from.force_here);
    if (view.u.rows() > 0 || view.au.beta != 0) {
      view.au.e = view.near.grown(view.au.e);
      view.u = view.au.image(view.from, view.near);
      ++summary.solves;
    } else {
      view.au.e = view.u = Points::Zero(view.near.size(), 3);
    }
    return true;
  }

  /// sqrt(bᵀ A⁻¹ b) over the free unknowns.
  /// \param force sqrt(Fᵀ A⁻¹ F)
  double norm_of_b(const View& here, double force) {
    if (norm_of_b_ >= 0) return norm_of_b_;
    if ((y_.array() == 0).all()) {  // r is b + F
      const double both = dot(here.from.force_here, here.from.s_here);
      norm_of_b_ = std::sqrt(std::max(0.0, here.from.rs - 2 * both + force * force));
    } else {
      norm_of_b_ = std::sqrt(inverse_.forward(problem_.b).squared_norm);
      ++summary.solves;
    }
    return norm_of_b_;
  }

  /// Of the terms that a step balances. Of a step that an error of the displacement ends, they need
  /// not be known: what they may lose by rounding is known from the energy, whose root is no less
  /// than that of KX₀.
  double first_scale(const View& here) {
    if (problem_.accuracy > 0 && !problem_.near) return 0;
    const double force = norm_of_force(here);
    return std::max(norm_of_b(here, force), force);
  }

  double norm_of_force(const View& here) {
    if (state_.contacts.empty()) return 0;
    ++summary.solves;
    return std::sqrt(
        std::max(0.0, dot(here.from.force_here, here.near.inverse(here.from.force_here))));
  }

  /// Whether to stop here, and with which outcome.
  bool finished(double decrement, const View& view, Progress& progress) {
    progress.largest = std::max(progress.largest, decrement);
    progress.enough = progress.tolerance * progress.largest;
    if (problem_.accuracy > 0) {  // of √(YᵀAY), at the anchor if that is not zero
      const double squared =
          view.from.squared > 0 ? view.from.squared : view.au.norm(view.from, view.u);
      progress.enough = std::max(
          {progress.enough, relative_tolerance * std::sqrt(2 * std::max(0.0, problem_.energy)),
           problem_.accuracy * std::sqrt(std::max(0.0, squared))});
    }
    if (decrement > progress.enough && std::isfinite(decrement)) return false;
    summary.converged = summary.finite = std::isfinite(decrement);
    return true;
  }

  /// r = b − AY + F at the present iterate.
  void update(const View& view, Residual& at) {
    at.r.beta = 1 - view.au.beta;
    at.r.e = view.near.gather(state_.force) - view.from.force_here - view.au.e;
    at.measure(view.from, view.near);
    ++summary.solves;
  }

  // Without contact (A + H) is A, and r's image is the whole direction: one solve ends the step.
  ContactDirection direction(View& view, const Residual& at, const Progress& progress) {
    ContactDirection to;
    if (state_.contacts.empty()) {
      to = {at.r, at.image};
    } else {
      const double tolerance = direction_tolerance(at.decrement(), progress.enough,
                                                   progress.largest, problem_.accuracy > 0);
      if (directly(view, at, progress.settled, tolerance, to)) return to;
      to = view.directions.find(state_, view.from, view.near, at.r, at.image,
                                {tolerance, progress.settled}, summary.solves);
    }
    to.slope = slope(view, at, to);
    return to;
  }

  // dΦ/dt at t = 0: −rᵀd, with rᵀd = rᵀA⁻¹(A d) for the part β r₀ of r.
  static double slope(const View& view, const Residual& at, const ContactDirection& to) {
    return -at.r.beta * to.ad.with_r(view.from) - dot(at.r.e, to.d);
  }

  /// A direction of descent where a factor of A + H may be needed: by conjugate gradients as long
  /// as these need few substitutions, and from then on by the factor. False: there is none.
  bool directly(View& view, const Residual& at, bool settled, double tolerance,
                ContactDirection& to) {
    if (!may_factor_) return false;
    if (!factors_) {
      const int before = summary.solves;
      to = view.directions.find(state_, view.from, view.near, at.r, at.image,
                                {tolerance, settled, many_substitutions}, summary.solves);
      to.slope = slope(view, at, to);
      if (summary.solves - before < many_substitutions) return true;
      factors_ = true;
      if (!problem_.source->last)
        problem_.source->last = std::make_shared<ContactFactor>(problem_, potential_);
    }
    may_factor_ = problem_.source->last->find(state_, view.from, view.near, at, tolerance, to,
                                              summary.solves);
    to.slope = slope(view, at, to);
    may_factor_ = may_factor_ && to.slope < 0;
    return may_factor_;
  }

  /// Whether the gain left is below the rounding of Φ, whose parts include rᵀA⁻¹r (see
  /// `View::quadratic_at`).
  [[nodiscard]] bool is_rounded(const View& view, const ContactDirection& to) const {
    return -to.slope <= rounding_of_potential * (problem_.energy + std::abs(view.quadratic) +
                                                 std::abs(state_.potential) + view.from.rs);
  }

  /// The potential at Y₀ + u, of contacts inside.
  PotentialState evaluate_inside(const View& view, const Points& u) {
    view.near.scatter(view.from.x_here + u, x_);
    return potential_.evaluate(x_, &view.near.watched());
  }

  /// Steps along the direction, halved until Φ decreases enough; a full step if values are not
  /// decisive. Returns the share of the direction.
  ///
  /// Armijo's rule with 1e-4 of the slope; the quadratic part of Φ is exact at every t from squares
  /// and products with the anchor, so that a trial costs Ψ inside and no substitution.
  double advance(View& view, const ContactDirection& to, bool rounded) {
    const double here = view.quadratic + state_.potential;
    double t = 1;
    for (;; t /= 2) {
      Points u = view.u + t * to.d;
      Combination au = view.au;
      au.add(t, to.ad);
      PotentialState state = evaluate_inside(view, u);
      const double next = view.quadratic_at(au, u);
      if (!rounded && next + state.potential > here + sufficient_decrease * t * to.slope &&
          t > 1e-10 && !Interruption::asked_for()) {
        continue;
      }
      view.u = std::move(u);
      view.au = std::move(au);
      view.quadratic = next;
      state_ = std::move(state);
      break;
    }
    // What is watched from now on may touch already: the next direction has to reckon with it.
    while (take_in(view, state_) && !Interruption::asked_for())
      state_ = evaluate_inside(view, view.u);
    return t;
  }

  /// Iterates inside the neighbourhood.
  Round iterate_inside(View& view, Progress& progress) {
    Residual at;
    update(view, at);
    while (true) {
      if (progress.iteration == progress.max_iterations || summary.solves > max_solves)
        return Round::over;
      if (Interruption::asked_for()) return Round::over;
      ++summary.iterations;
      const ContactDirection to = direction(view, at, progress);
      const bool rounded = is_rounded(view, to);
      // A few full steps gain what the gradient can still resolve.
      if (rounded && ++progress.rounded_steps > max_rounded_steps) {
        summary.converged = true;
        return Round::over;
      }
      const Residual before = std::move(at);
      const double step = advance(view, to, rounded);
      ++progress.iteration;
      update(view, at);
      progress.settled = at.decrement() <= settled_share * before.decrement();
      view.directions.take(step, to, view.from, before, at);
      if (finished(at.decrement(), view, progress)) {
        return std::isfinite(at.decrement()) ? Round::small : Round::over;
      }
      // β r and E e cancel, and so do the squares under the root of the decrement.
      if (at.squared < cancellation * at.r.beta * at.r.beta * view.from.rs) return Round::blurred;
    }
  }

  /// Iterates from one anchor until no contact is outside the neighbourhood.
  ///
  /// The second half of the solve is made once per round, which is where the rest of the net learns
  /// of the displacement.
  Round descend(View& view, Progress& progress) {
    const double before = view.quadratic + state_.potential;
    while (true) {
      const Round round = iterate_inside(view, progress);
      y_ =
          view.from.y + inverse_.backward(view.from.z, view.au.beta, view.near.subset(), view.au.e);
      ++summary.solves;
      x_ = problem_.start + y_;
      // What acts inside is known already, but for the rounding of Y.
      if (problem_.accuracy > 0 && y_.allFinite() &&
          !potential_.acts_beyond(view.near.watched(), x_))
        return round;
      state_ = potential_.evaluate(x_);
      if (view.near.contains(state_) || !y_.allFinite() ||
          progress.iteration >= progress.max_iterations)
        return round;
      summary.converged = false;
      if (Interruption::asked_for()) return Round::over;
      const bool lower = view.quadratic + state_.potential <= before;
      take_in(view, state_);
      if (lower) continue;
      // What came into contact outside was not reckoned with: once more, watching it.
      y_ = view.from.y;
      x_ = problem_.start + y_;
      view.au = {0, Points::Zero(view.near.size(), 3)};
      view.u = view.au.e;
      view.quadratic = view.from.quadratic;
      state_ = potential_.evaluate(x_);
    }
  }
};

}  // namespace knead
