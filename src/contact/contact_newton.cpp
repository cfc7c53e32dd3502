#include "contact_newton.hpp"

#include "contact_krylov.hpp"
#include "contact_limits.hpp"
#include "contact_minimisation.hpp"

namespace knead {
namespace {

// Stages of increasing stiffness towards a stiff tool.
constexpr double soft_stiffness = 1e4;
constexpr double stiffening = 30;
constexpr double far_from_balance = 1e-2;
constexpr double stage_tolerance = 1e-2;
// From further away a limit on displacements takes long.
constexpr double limited_stage_tolerance = 1e-4;
constexpr int max_stage_iterations = 20;

// Continuation in the stiffness (a homotopy): minima for k = 1e4, 3e5, 9e6, … , the last one to the
// tolerance of the step. The contact set of a soft tool is close to that of one 30 times stiffer;
// from far away the stiff one would take many iterations with a small step each. Stages are loose,
// as only the set of points in contact is used of them.
template <class M>
Minimum minimise(const StepProblem& problem, Potential& potential, M minimisation) {
  // A very stiff tool is approached through softer ones: from afar its springs would throw the
  // surface about. A step that starts near equilibrium, as most do, gains nothing from that.
  const double stiffest = potential.stiffest();
  if (!problem.near && stiffest > soft_stiffness && minimisation.imbalance() > far_from_balance) {
    const double tolerance = potential.limits() ? limited_stage_tolerance : stage_tolerance;
    for (double cap = soft_stiffness; cap < stiffest; cap *= stiffening) {
      potential.soften(cap);
      minimisation.renew();
      minimisation.iterate(tolerance, max_stage_iterations, false);
    }
    potential.soften(stiffest);
    minimisation.renew();
  }
  minimisation.iterate(problem.near ? followed_tolerance : relative_tolerance,
                       max_newton_iterations, true);
  return {minimisation.summary, minimisation.take_state()};
}

}  // namespace

Minimum minimise_step(const StepProblem& problem, Potential& potential, Points& y) {
  if (const ConstrainedMultigrid* multigrid = problem.inverse.multigrid())
    return minimise(problem, potential, KrylovMinimisation(problem, *multigrid, potential, y));
  return minimise(problem, potential,
                  Minimisation(problem, *problem.inverse.factor(), potential, y));
}

}  // namespace knead
