#include "contact_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact_neighbourhood.hpp"

namespace knead {
namespace {

constexpr int max_newton_iterations = 60;
constexpr int max_cg_iterations = 400;
constexpr int max_solves = 1500;  // per minimisation: a step that needs more stops there and says so
// The Newton decrement sqrt(gᵀ A⁻¹ g) is an error in the energy norm of the step. It is compared with the terms that
// the step balances, |F|, |K X₀| and the first imbalance, in the same norm.
constexpr double relative_tolerance = 1e-11;
constexpr double followed_tolerance = 1e-8;  // for a tool followed along a path in many small steps
constexpr double rounded_tolerance = 1e-9;   // where the rounding of recomputed forces does not allow more
constexpr double cancellation = 1e-12;
constexpr double sufficient_decrease = 1e-4;
constexpr double rounding_of_potential = 1e-14;
constexpr int max_rounded_steps = 4;
// Stages of increasing stiffness towards a stiff tool.
constexpr double soft_stiffness = 1e4;
constexpr double stiffening = 30;
constexpr double far_from_balance = 1e-2;
constexpr double stage_tolerance = 1e-4;
constexpr int max_stage_iterations = 20;

/// Contacts affect few control points, and the minimum is sought within their neighbourhood. Let r be the imbalance of
/// forces b − AY + F at some Y₀, the anchor, and s = A⁻¹r: computed once on the whole net. From then on all directions,
/// and so all residuals, are combinations β r + E e, with forces e in the neighbourhood (E embeds them) whose images
/// A⁻¹E e are needed only there as well. Only a new Y is again needed everywhere.
struct Anchor {
  Points y, r, s;
  double rs;         // rᵀ A⁻¹ r
  double quadratic;  // ½ YᵀAY − Yᵀb
  Points s_here, force_here;
};

/// β r + E e.
struct Combination {
  double beta = 0;
  Points e;

  /// (β r + E e)ᵀ A⁻¹ (β r + E e), given its image under A⁻¹ in the neighbourhood.
  [[nodiscard]] double norm(const Anchor& anchor, const Points& image) const {
    return beta * (beta * anchor.rs + dot(anchor.s_here, e)) + dot(e, image);
  }
  [[nodiscard]] Points image(const Anchor& anchor, const ContactNeighbourhood& near) const {
    return beta * anchor.s_here + near.inverse(e);
  }
  void add(double t, const Combination& other) {
    beta += t * other.beta;
    e += t * other.e;
  }
};

/// (A + H) d = r by conjugate gradients preconditioned with A⁻¹, to `tolerance` of the first preconditioned residual;
/// returns A d. If A + H turns out not to be positive, the result is the sum of the steps so far, or A⁻¹r: a descent
/// direction in any case (Nocedal and Wright, Numerical Optimization, Alg. 7.1). \param image of r.
Combination newton_direction(const Potential& potential, const PotentialState& state, const Anchor& anchor,
                             const ContactNeighbourhood& near, Combination r, const Points& image, double tolerance,
                             int& solves) {
  Combination ad{0, Points::Zero(near.size(), 3)}, ap = r;
  Points p = image;
  double rs = r.norm(anchor, image);
  const double target = tolerance * tolerance * rs;
  for (int iteration = 0; iteration < max_cg_iterations && rs > target && rs > 0; ++iteration) {
    const Points hp = near.gather(potential.apply_hessian(state, near.scatter(p)));
    const double pap = ap.norm(anchor, p), curvature = pap + dot(p, hp);
    if (curvature <= 1e-12 * pap) {
      if (iteration == 0) ad = std::move(ap);
      break;
    }
    const double step = rs / curvature;
    ad.add(step, ap);
    r.add(-step, ap);
    r.e -= step * hp;
    const Points s = r.image(anchor, near);
    ++solves;
    const double next = r.norm(anchor, s);
    if (!(next < 1e6 * target / (tolerance * tolerance))) break;  // nothing but rounding is left
    const double share = next / rs;
    ap.beta = r.beta + share * ap.beta;
    ap.e = r.e + share * ap.e;
    p = s + share * p;
    rs = next;
  }
  return ad;
}

/// Newton's iteration on Φ.
class Minimisation {
 public:
  Minimisation(const StepProblem& problem, Potential& potential, Points& y)
      : problem_(problem), potential_(potential), y_(y), state_(potential.evaluate(problem.start + y)) {}

  ContactSummary summary;

  /// Call after the potential has changed.
  void renew() { state_ = potential_.evaluate(problem_.start + y_); }

  /// The imbalance of forces, as a share of the norm of b.
  double imbalance() {
    const Anchor here = anchor();
    return std::sqrt(std::max(0.0, here.rs)) / norm_of_b(here, norm_of_force());
  }

  /// Iterates until the decrement is `tolerance` of the terms that the step balances. With `certain` the result is
  /// measured again from its own anchor, with all forces recomputed.
  void iterate(double tolerance, int max_iterations, bool certain) {
    summary.converged = false;
    Progress progress{tolerance, max_iterations};
    double before = std::numeric_limits<double>::infinity();
    while (true) {
      Anchor from = anchor();
      if (progress.largest < 0) {
        const double force = norm_of_force();
        progress.largest = std::max(norm_of_b(from, force), force);
      }
      const double decrement = std::sqrt(std::max(0.0, from.rs));
      if (finished(decrement, from.quadratic, progress)) return;
      if (decrement > 0.5 * before && decrement <= rounded_tolerance * progress.largest) {
        summary.converged = true;  // the remainder is the rounding of AY: another round would find the same
        return;
      }
      before = decrement;
      summary.converged = false;
      const Round round = descend(from, progress);
      if (round == Round::over || (round == Round::small && (!certain || problem_.accuracy > 0))) return;
    }
  }

 private:
  const StepProblem& problem_;
  Potential& potential_;
  Points& y_;
  PotentialState state_;
  double norm_of_b_ = -1;

  /// Why a round ended: the decrement is small enough; it is too small relative to β r to be resolved from this anchor;
  /// or no further progress is possible.
  enum class Round { small, blurred, over };

  /// The progress of one call of `iterate`.
  struct Progress {
    double tolerance;
    int max_iterations;
    double largest = -1;  // of the terms that the step balances; -1: not known yet
    double enough = 0;    // a decrement this small ends the iteration
    int iteration = 0;
    int rounded_steps = 0;  // steps taken where the gain is below rounding
  };

  /// The present iterate relative to an anchor.
  struct View {
    Anchor& from;
    ContactNeighbourhood& near;
    Combination left;  // b − AY
    double quadratic;  // ½ YᵀAY − Yᵀb

    /// The same at another Y = Y₀ + u, where b − AY is known, so that no product with A is needed.
    [[nodiscard]] double quadratic_at(const Points& y, const Combination& left_there) const {
      const Points u = y - from.y;
      return from.quadratic -
             0.5 * ((1 + left_there.beta) * dot(u, from.r) + dot(near.gather(u), left_there.e - from.force_here));
    }
  };

  /// The imbalance of forces r, A⁻¹ r in the neighbourhood, and rᵀA⁻¹r.
  struct Residual {
    Combination r;
    Points image;
    double rs = 0;

    [[nodiscard]] double decrement() const { return std::sqrt(std::max(0.0, rs)); }
  };

  /// A displacement d, A d, and the slope of Φ along d.
  struct Direction {
    Combination ad;
    Points d;
    double slope;
  };

  Anchor anchor() {
    Anchor a{y_, problem_.b, {}, 0, 0, {}, {}};
    if (!(y_.array() == 0).all()) {
      const Points ay = problem_.a * y_;
      a.quadratic = 0.5 * dot(y_, ay) - dot(y_, problem_.b);
      a.r -= ay;
    }
    a.r = problem_.inverse.space().lumped(a.r + state_.force);
    a.s = problem_.inverse.solve(a.r);
    ++summary.solves;
    a.rs = dot(a.r, a.s);
    return a;
  }

  void take_in(ContactNeighbourhood& near, Anchor& from) const {
    std::vector<char> marks(static_cast<std::size_t>(y_.rows()), 0);
    potential_.mark(state_, marks);
    near.extend(marks);
    from.s_here = near.gather(from.s);
    from.force_here = near.grown(from.force_here);
  }

  /// sqrt(bᵀ A⁻¹ b) over the free unknowns. \param force sqrt(Fᵀ A⁻¹ F)
  double norm_of_b(const Anchor& from, double force) {
    if (norm_of_b_ >= 0) return norm_of_b_;
    if ((y_.array() == 0).all()) {  // r is b + F
      norm_of_b_ = std::sqrt(std::max(0.0, from.rs - 2 * dot(state_.force, from.s) + force * force));
    } else {
      norm_of_b_ = std::sqrt(std::max(0.0, dot(problem_.b, problem_.inverse.solve(problem_.b))));
      ++summary.solves;
    }
    return norm_of_b_;
  }

  double norm_of_force() {
    if (state_.contacts.empty()) return 0;
    ContactNeighbourhood near(problem_.inverse);
    std::vector<char> marks(static_cast<std::size_t>(y_.rows()), 0);
    potential_.mark(state_, marks);
    near.extend(marks);
    const Points force = near.gather(state_.force);
    ++summary.solves;
    return std::sqrt(std::max(0.0, dot(force, near.inverse(force))));
  }

  /// Whether to stop here, and with which outcome. \param quadratic ½ YᵀAY − Yᵀb
  bool finished(double decrement, double quadratic, Progress& progress) {
    progress.largest = std::max(progress.largest, decrement);
    progress.enough = progress.tolerance * progress.largest;
    if (problem_.accuracy > 0) {
      const double displacement = std::sqrt(std::max(0.0, 2 * (quadratic + dot(y_, problem_.b))));  // √(YᵀAY)
      progress.enough = std::max(progress.enough, problem_.accuracy * displacement);
    }
    if (decrement > progress.enough && std::isfinite(decrement)) return false;
    summary.converged = summary.finite = std::isfinite(decrement);
    return true;
  }

  /// r = b − AY + F at the present iterate.
  void update(const View& view, Residual& at) {
    at.r = view.left;
    at.r.e += view.near.gather(state_.force);
    at.image = at.r.image(view.from, view.near);
    at.rs = at.r.norm(view.from, at.image);
    ++summary.solves;
  }

  Direction direction(const View& view, const Residual& at, const Progress& progress) {
    Direction to{at.r, {}, 0};
    if (!state_.contacts.empty()) {
      // Loose while far away, tight near the end, where a step must not undo the gain of the previous one. Never below
      // the convergence tolerance: the remainder is then only rounding, and directions made from it violate the
      // constraints.
      const double decrement = at.decrement();
      const double cg_tolerance = std::clamp(0.1 * decrement / progress.largest,
                                             std::clamp(0.1 * progress.enough / decrement, 1e-8, 1e-2), 1e-2);
      to.ad = newton_direction(potential_, state_, view.from, view.near, at.r, at.image, cg_tolerance, summary.solves);
    }
    to.d = to.ad.beta * view.from.s;
    if (!(to.ad.e.array() == 0).all()) {
      to.d += view.near.inverse_everywhere(to.ad.e);
      ++summary.solves;
    }
    to.slope = -at.r.beta * dot(view.from.r, to.d) - dot(at.r.e, view.near.gather(to.d));
    return to;
  }

  /// Whether the gain left is below the rounding of Φ, whose parts include rᵀA⁻¹r (see `View::quadratic_at`).
  [[nodiscard]] bool is_rounded(const View& view, const Direction& to) const {
    return -to.slope <= rounding_of_potential *
                            (problem_.energy + std::abs(view.quadratic) + std::abs(state_.potential) + view.from.rs);
  }

  /// Steps along the direction, halved until Φ decreases enough; a full step if values are not decisive.
  void advance(View& view, const Direction& to, bool rounded) {
    const double here = view.quadratic + state_.potential;
    for (double t = 1;; t /= 2) {
      Points y = y_ + t * to.d;
      PotentialState state = potential_.evaluate(problem_.start + y);
      Combination left = view.left;
      left.add(-t, to.ad);
      const double next = view.quadratic_at(y, left);
      if (!rounded && next + state.potential > here + sufficient_decrease * t * to.slope && t > 1e-10) continue;
      y_ = std::move(y);
      state_ = std::move(state);
      view.left = std::move(left);
      view.quadratic = next;
      break;
    }
    take_in(view.near, view.from);
    view.left.e = view.near.grown(view.left.e);
  }

  /// Iterates from one anchor.
  Round descend(Anchor& from, Progress& progress) {
    ContactNeighbourhood near(problem_.inverse);
    from.force_here.resize(0, 3);
    take_in(near, from);
    from.force_here = near.gather(state_.force);
    View view{from, near, {1, -from.force_here}, from.quadratic};
    Residual at;
    at.r = {1, Points::Zero(near.size(), 3)};
    at.image = from.s_here;
    at.rs = from.rs;
    while (true) {
      if (progress.iteration == progress.max_iterations || summary.solves > max_solves) return Round::over;
      ++summary.iterations;
      const Direction to = direction(view, at, progress);
      const bool rounded = is_rounded(view, to);
      // A few full steps gain what the gradient can still resolve.
      if (rounded && ++progress.rounded_steps > max_rounded_steps) {
        summary.converged = true;
        return Round::over;
      }
      advance(view, to, rounded);
      ++progress.iteration;
      update(view, at);
      if (finished(at.decrement(), view.quadratic, progress))
        return std::isfinite(at.decrement()) ? Round::small : Round::over;
      // β r and E e cancel, and so do the squares under the root of the decrement.
      if (at.rs < cancellation * at.r.beta * at.r.beta * from.rs) return Round::blurred;
    }
  }
};

}  // namespace

ContactSummary minimise_step(const StepProblem& problem, Potential& potential, Points& y) {
  Minimisation minimisation(problem, potential, y);
  // A very stiff tool is approached through softer ones: from afar its springs would throw the surface about. A step
  // that starts near equilibrium, as most do, gains nothing from that.
  const double stiffest = potential.stiffest();
  if (!problem.near && stiffest > soft_stiffness && minimisation.imbalance() > far_from_balance) {
    for (double cap = soft_stiffness; cap < stiffest; cap *= stiffening) {
      potential.soften(cap);
      minimisation.renew();
      minimisation.iterate(stage_tolerance, max_stage_iterations, false);
    }
    potential.soften(stiffest);
    minimisation.renew();
  }
  minimisation.iterate(problem.near ? followed_tolerance : relative_tolerance, max_newton_iterations, true);
  return minimisation.summary;
}

}  // namespace knead
