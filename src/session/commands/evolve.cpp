#include "evolve.hpp"

#include <fmt/format.h>

#include <cmath>

#include "session/acts/stepping.hpp"

namespace knead {

std::span<const Choice> choices(StepWeight) {
  static constexpr Choice list[] = {
      {"mass", StepWeight::mass, "refining the net does not change the evolution"},
      {"identity", StepWeight::identity, "the thesis' step, which depends on the net"}};
  return list;
}

std::span<const Choice> choices(ForceRoute) {
  static constexpr Choice list[] = {{"gauss", ForceRoute::gauss, "at Gauss points"},
                                    {"analytic", ForceRoute::analytic,
                                     "interpolated at Greville abscissae, then exact mass matrices "
                                     "([materials-and-loads.md](materials-and-loads.md))"}};
  return list;
}

std::span<const Choice> choices(Evolution) {
  static constexpr Choice list[] = {
      {"acm", Evolution::acm, "moves towards equilibrium"},
      {"static", Evolution::stationary,
       "goes to equilibrium at once; an error (exit code 4) if nothing holds the surface"},
      {"dynamic", Evolution::dynamic, "has mass and oscillates"}};
  return list;
}

std::span<const Choice> choices(StepAccuracy) {
  static constexpr Choice list[] = {{"exact", StepAccuracy::exact, "to 1e-11 of the forces"},
                                    {"interactive", StepAccuracy::interactive,
                                     "to 1e-6 of each step's displacement, faster "
                                     "([kernels](design/kernels.md#interactive-accuracy))"}};
  return list;
}

std::span<const Choice> choices(StepSolver) {
  static constexpr Choice list[] = {
      {"automatic", StepSolver::automatic,
       "by the number of control points, and by whether iteration converges fast"},
      {"direct", StepSolver::direct, "with a factor of the matrix"},
      {"iterative", StepSolver::iterative,
       "by iteration over nested nets, with less memory ([multigrid.md](multigrid.md))"}};
  return list;
}

void describe(EvolveCommand& c, Fields& fields) {
  fields.name("evolve", "what steps do; static solves at once");
  fields.add("mode", c.evolution.mode, {.help = "what a step solves"});
  fields.add("lambda", c.evolution.lambda,
             {.help = "acm: λ, inverse step size: small goes straight to equilibrium, large "
                      "creeps. 0 requires that something is held",
              .range = at_least(0)});
  fields.add("time_step", c.evolution.time_step,
             {.help = "dynamic: time per step", .range = above(0)});
  fields.add("weight", c.evolution.weight, {.help = "acm: the weights of a step"});
  fields.add("route", c.evolution.route, {.help = "how tool forces are integrated"});
  fields.add("accuracy", c.evolution.accuracy, {.help = "how exactly steps in contact are solved"});
  fields.add("solver", c.evolution.solver, {.help = "how the systems of steps are solved"});
  fields.add("energy_tolerance", c.evolution.energy_tolerance,
             {.help = "rational shapes: the largest error of an entry of the energy's matrix, "
                      "relative to its diagonal",
              .range = between(1e-14, 0.1)});
}

Expected<void> execute(const EvolveCommand& c, Act& act) {
  if (c.evolution.mode == Evolution::stationary) {
    if (auto made = run(act, {.evolution = c.evolution}); !made)
      return std::unexpected(made.error());
  }
  act.state.evolution = c.evolution;
  return {};
}

}  // namespace knead
