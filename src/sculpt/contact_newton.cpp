#include "contact_newton.hpp"

#include <algorithm>
#include <cmath>

namespace knead {
namespace {

constexpr int max_newton_iterations = 60;
constexpr int max_cg_iterations = 400;
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
double dual_norm(const ImplicitEuler& euler, const Points& b) {
  return std::sqrt(std::max(0.0, dot(b, euler.solve(b))));
}

/// The minimised function Φ and its gradient, X measured from X₀ (the matrix A = K + λW is kept, W is not needed):
/// Φ = ½ YᵀAY + YᵀKX₀ + Ψ(X₀ + Y) + const, ∇Φ = A Y + K X₀ − F(X₀ + Y).
struct Objective {
  const ImplicitEuler& euler;
  const SurfaceLoad& load;
  std::span<const Tool> tools;
  Points start;  // control points at X₀
  Points kx0;
  double energy;  // ½ X₀ᵀ K X₀, for the rounding of Φ

  struct At {
    Points y, ay;
    SurfaceLoad::State state;
    double quadratic = 0;
    [[nodiscard]] double value() const { return quadratic + state.potential(); }
  };

  [[nodiscard]] At at(Points y, Points ay) const {
    SurfaceLoad::State state = load.evaluate(start + y, tools);
    At here{std::move(y), std::move(ay), std::move(state), 0};
    here.quadratic = 0.5 * dot(here.y, here.ay) + dot(here.y, kx0);
    return here;
  }

  [[nodiscard]] Points gradient(const At& here) const {
    return euler.partition().free_part(here.ay + kx0 - here.state.force());
  }
};

/// (A + H) d = −g by conjugate gradients preconditioned with A⁻¹, to `tolerance` of the first preconditioned residual;
/// `z` = A⁻¹ g is known already. Where A + H turns out not to be positive the way gone so far is the answer, or −z: a
/// direction of descent in any case (Nocedal and Wright, Numerical Optimization, Alg. 7.1).
Points newton_direction(const Objective& objective, const SurfaceLoad::State& state, const Points& g, const Points& z,
                        double tolerance, Points& a_direction, int& solves) {
  const SparseMatrix& a = objective.euler.system();
  Points d = Points::Zero(g.rows(), 3), ad = d;
  Points r = -g, s = -z, p = s;
  double rs = dot(r, s);
  const double target = tolerance * tolerance * rs;
  for (int iteration = 0; iteration < max_cg_iterations && rs > target && rs > 0; ++iteration) {
    Points ap = a * p;
    const Points hp = objective.euler.partition().free_part(ap + objective.load.apply_hessian(state, p));
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
    s = objective.euler.solve(r);
    ++solves;
    const double next = dot(r, s);
    p = s + (next / rs) * p;
    rs = next;
  }
  a_direction = std::move(ad);
  return d;
}

/// Newton's iteration on Φ from `here` on, until the decrement is `tolerance` of what the step weighs against each
/// other.
void iterate(const Objective& objective, double tolerance, int max_iterations, Objective::At& here,
             ContactSummary& summary) {
  const ImplicitEuler& euler = objective.euler;
  double largest = std::max(dual_norm(euler, objective.kx0), dual_norm(euler, here.state.force()));
  summary.solves += 2;
  int rounded_steps = 0;
  summary.converged = false;
  for (int iteration = 0;; ++iteration) {
    const Points g = objective.gradient(here);
    const Points z = euler.solve(g);
    ++summary.solves;
    const double decrement = std::sqrt(std::max(0.0, dot(g, z)));
    largest = std::max(largest, decrement);
    if (decrement <= tolerance * largest || !std::isfinite(decrement)) {
      summary.converged = summary.finite = std::isfinite(decrement);
      return;
    }
    if (iteration == max_iterations) return;
    ++summary.iterations;

    Points d, ad;
    if (here.state.contacts() == 0) {
      d = -z;
      ad = euler.system() * d;
    } else {
      // Loose while far away, tight near the end, where a step must not undo what the one before it gained.
      const double cg_tolerance = std::clamp(0.1 * decrement / largest, 1e-8, 1e-2);
      d = newton_direction(objective, here.state, g, z, cg_tolerance, ad, summary.solves);
    }
    const double slope = dot(g, d);
    Objective::At next = objective.at(here.y + d, here.ay + ad);
    if (-slope <= rounding * (objective.energy + std::abs(here.quadratic) + std::abs(here.state.potential()))) {
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
        next = objective.at(here.y + t * d, here.ay + t * ad);
      }
    }
    here = std::move(next);
  }
}

/// The tools with no stiffness above `cap`.
std::vector<Tool> softened(std::span<const Tool> tools, double cap) {
  std::vector<Tool> result(tools.begin(), tools.end());
  for (Tool& tool : result) tool.stiffness = std::min(tool.stiffness, cap);
  return result;
}

}  // namespace

ContactSummary minimise_step(const ImplicitEuler& euler, const SurfaceLoad& load, std::span<const Tool> tools,
                             const Points& origin, Points& x) {
  ContactSummary summary;
  const Points x0 = x, kx0 = euler.k() * x0;
  double stiffest = 0;
  for (const Tool& tool : tools) stiffest = std::max(stiffest, tool.stiffness);
  Objective objective{euler, load, tools, origin + x0, kx0, 0.5 * dot(x0, kx0)};
  Objective::At here = objective.at(Points::Zero(x.rows(), 3), Points::Zero(x.rows(), 3));

  // A very stiff tool is met by way of softer ones: from afar its springs would throw the surface about. A step that
  // starts near its balance, as most do, has nothing to gain from that.
  const double imbalance = dual_norm(euler, objective.gradient(here));
  if (stiffest > soft_stiffness && imbalance > far_from_balance * dual_norm(euler, kx0)) {
    for (double cap = soft_stiffness; cap < stiffest; cap *= stiffening) {
      const std::vector<Tool> soft = softened(tools, cap);
      objective.tools = soft;
      here = objective.at(std::move(here.y), std::move(here.ay));
      iterate(objective, stage_tolerance, max_stage_iterations, here, summary);
    }
    objective.tools = tools;
    here = objective.at(std::move(here.y), std::move(here.ay));
  }
  iterate(objective, relative_tolerance, max_newton_iterations, here, summary);
  x = x0 + here.y;
  return summary;
}

}  // namespace knead
