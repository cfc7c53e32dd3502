#include "contact_newton.hpp"

#include <algorithm>
#include <cmath>

namespace knead {
namespace {

constexpr int max_newton_iterations = 60;
constexpr int max_cg_iterations = 400;
constexpr int max_solves = 1500;  // of one minimisation: a step that needs more ends where it is, and says so
// The Newton decrement sqrt(gᵀ A⁻¹ g) is an error in the energy norm of the step. It is compared with what the step
// weighs against each other, |F|, |K X₀| and the first imbalance in the same norm.
constexpr double relative_tolerance = 1e-11;
constexpr double sufficient_decrease = 1e-4;
constexpr double rounding = 1e-14;
constexpr int max_rounded_steps = 4;
// Stages of stiffness on the way to a stiff tool.
constexpr double soft_stiffness = 1e4;
constexpr double stiffening = 30;
constexpr double far_from_balance = 1e-2;
constexpr double stage_tolerance = 1e-4;
constexpr int max_stage_iterations = 20;

double dot(const Points& a, const Points& b) { return a.cwiseProduct(b).sum(); }

/// sqrt(bᵀ A⁻¹ b) over the free unknowns.
double dual_norm(const StepProblem& problem, const Points& b) {
  return std::sqrt(std::max(0.0, dot(b, problem.inverse.solve(b))));
}

/// Φ and what is known of it at one Y.
struct At {
  Points y, ay;
  PotentialState state;
  double quadratic = 0;
  [[nodiscard]] double value() const { return quadratic + state.potential; }
};

At at(const StepProblem& problem, const Potential& potential, Points y, Points ay) {
  PotentialState state = potential.evaluate(problem.start + y);
  At here{std::move(y), std::move(ay), std::move(state), 0};
  here.quadratic = 0.5 * dot(here.y, here.ay) - dot(here.y, problem.b);
  return here;
}

Points gradient(const StepProblem& problem, const At& here) {
  return problem.inverse.space().lumped(here.ay - problem.b - here.state.force);
}

/// (A + H) d = −g by conjugate gradients preconditioned with A⁻¹, to `tolerance` of the first preconditioned residual;
/// `z` = A⁻¹ g is known already. Where A + H turns out not to be positive the way gone so far is the answer, or −z: a
/// direction of descent in any case (Nocedal and Wright, Numerical Optimization, Alg. 7.1). Residuals are kept lumped:
/// what constraints bear does no work here, but its rounding would.
Points newton_direction(const StepProblem& problem, const Potential& potential, const PotentialState& state,
                        const Points& g, const Points& z, double tolerance, Points& a_direction, int& solves) {
  Points d = Points::Zero(g.rows(), 3), ad = d;
  Points r = -g, s = -z, p = s;
  double rs = dot(r, s);
  const double target = tolerance * tolerance * rs;
  for (int iteration = 0; iteration < max_cg_iterations && rs > target && rs > 0; ++iteration) {
    Points ap = problem.a * p;
    const Points hp = problem.inverse.space().lumped(ap + potential.apply_hessian(state, p));
    const double curvature = dot(p, hp);
    if (curvature <= 1e-12 * dot(p, ap)) {
      if (iteration > 0) break;
      d = p;
      ad = std::move(ap);
      break;
    }
    const double step = rs / curvature;
    d += step * p;
    ad += step * ap;
    r -= step * hp;
    s = problem.inverse.solve(r);
    ++solves;
    const double next = dot(r, s);
    if (!(next < 1e6 * target / (tolerance * tolerance))) break;  // nothing but rounding is left
    p = s + (next / rs) * p;
    rs = next;
  }
  a_direction = std::move(ad);
  return d;
}

/// Newton's iteration on Φ from `here` on, until the decrement is `tolerance` of what the step weighs against each
/// other.
void iterate(const StepProblem& problem, const Potential& potential, double tolerance, int max_iterations, At& here,
             ContactSummary& summary) {
  double largest = std::max(dual_norm(problem, problem.b), dual_norm(problem, here.state.force));
  summary.solves += 2;
  int rounded_steps = 0;
  summary.converged = false;
  for (int iteration = 0;; ++iteration) {
    const Points g = gradient(problem, here);
    const Points z = problem.inverse.solve(g);
    ++summary.solves;
    const double decrement = std::sqrt(std::max(0.0, dot(g, z)));
    largest = std::max(largest, decrement);
    if (decrement <= tolerance * largest || !std::isfinite(decrement)) {
      summary.converged = summary.finite = std::isfinite(decrement);
      return;
    }
    if (iteration == max_iterations || summary.solves > max_solves) return;
    ++summary.iterations;

    Points d, ad;
    if (here.state.contacts.empty()) {
      d = -z;
      ad = problem.a * d;
    } else {
      // Loose while far away, tight near the end, where a step must not undo what the one before it gained.
      // Never below what counts as converged: in what is left then there is rounding only, and directions made of it
      // leave the constraints.
      const double cg_tolerance =
          std::clamp(0.1 * decrement / largest, std::clamp(0.1 * tolerance * largest / decrement, 1e-8, 1e-2), 1e-2);
      d = newton_direction(problem, potential, here.state, g, z, cg_tolerance, ad, summary.solves);
    }
    const double slope = dot(g, d);
    At next = at(problem, potential, here.y + d, here.ay + ad);
    if (-slope <= rounding * (problem.energy + std::abs(here.quadratic) + std::abs(here.state.potential))) {
      // The gain left is below the rounding of Φ, so that comparing values decides nothing: a few full steps take what
      // the gradient still sees.
      if (++rounded_steps > max_rounded_steps) {
        summary.converged = true;
        return;
      }
    } else {
      double t = 1;
      while (next.value() > here.value() + sufficient_decrease * t * slope && t > 1e-10) {
        t /= 2;
        next = at(problem, potential, here.y + t * d, here.ay + t * ad);
      }
    }
    here = std::move(next);
  }
}

}  // namespace

ContactSummary minimise_step(const StepProblem& problem, Potential& potential, Points& y) {
  ContactSummary summary;
  At here = at(problem, potential, y, problem.a * y);

  // A very stiff tool is met by way of softer ones: from afar its springs would throw the surface about. A step that
  // starts near its balance, as most do, has nothing to gain from that.
  const double stiffest = potential.stiffest();
  const double imbalance = dual_norm(problem, gradient(problem, here));
  if (stiffest > soft_stiffness && imbalance > far_from_balance * dual_norm(problem, problem.b)) {
    for (double cap = soft_stiffness; cap < stiffest; cap *= stiffening) {
      potential.soften(cap);
      here = at(problem, potential, std::move(here.y), std::move(here.ay));
      iterate(problem, potential, stage_tolerance, max_stage_iterations, here, summary);
    }
    potential.soften(stiffest);
    here = at(problem, potential, std::move(here.y), std::move(here.ay));
  }
  iterate(problem, potential, relative_tolerance, max_newton_iterations, here, summary);
  y = std::move(here.y);
  return summary;
}

}  // namespace knead
