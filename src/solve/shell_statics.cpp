#include "shell_statics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/decompositions.hpp"
#include "base/interruption.hpp"
#include "coordinate_map.hpp"

namespace knead {
namespace {

/// A Newton step shorter than this share of the structure's size ends the iteration: rounding is
/// all that is left.
constexpr double negligible_step = 1e-13;

using FlatMap = Eigen::Map<const Eigen::VectorXd>;

FlatMap flattened(const Points& x) { return {x.data(), x.size()}; }

Points points_of(const Eigen::VectorXd& x) {
  return Eigen::Map<const Points>(x.data(), x.size() / 3, 3);
}

std::unexpected<Error> moves_freely() {
  return numerical_error("the shell can move without strain", "constraints",
                         "hold it so that no rigid motion is left");
}

/// Dead forces, and moments that follow their edges.
struct Loads {
  const Points& dead;
  std::span<const EdgeMoment> moments;

  [[nodiscard]] Points forces(const Points& x) const {
    Points sum = dead;
    for (const EdgeMoment& moment : moments) sum += moment.forces(x);
    return sum;
  }
};

/// Newton's iteration towards one load.
///
/// Solves Tᵀ(f F(x) − ∇W(x)) = 0 for x = x₀ + T y, f the load factor: the tangent is ∇²W, with
/// geometric stresses σ(x) + σ'(x) d extrapolated from the place before instead of recomputed at
/// the new x (the mixed integration points of Magisano, Leonetti and Garcea, "How to improve
/// efficiency and robustness of the Newton method in geometrically non-linear structural problem
/// discretized via displacement-based finite elements", 2017), less f times that of the moments.
/// LDLᵀ instead of Cholesky, as equilibria beyond a limit point have an indefinite tangent, and no
/// line search, since the energy need not fall towards them.
class ShellNewton {
 public:
  ShellNewton(const ShellStructure& shell, const SparseMatrix& map, const Loads& loads,
              const ShellStaticsOptions& options, double extent)
      : shell_(shell), map_(map), loads_(loads), options_(options), extent_(extent) {}

  struct Outcome {
    bool converged = false, singular = false;
    int iterations = 0;
    double residual = 0;
  };

  /// Moves x to the equilibrium under `factor` times the load, or says that it was not reached.
  Outcome iterate(Points& x, double factor) {
    Outcome outcome;
    ShellStructure::Stress stress = shell_.stress(x);
    double scale = factor * (map_.transpose() * flattened(loads_.forces(x))).norm();
    while (true) {
      const Points imbalance = factor * loads_.forces(x) - shell_.gradient(x);
      const Eigen::VectorXd reduced = map_.transpose() * flattened(imbalance);
      // Without a load, as where values of constraints alone deform the shell, the first imbalance
      // is the unit.
      if (scale == 0) scale = reduced.norm();
      outcome.residual = scale > 0 ? reduced.norm() / scale : 0;
      if (!std::isfinite(outcome.residual) || Interruption::asked_for()) return outcome;
      outcome.converged = outcome.residual <= options_.tolerance;
      if (outcome.converged || outcome.iterations == options_.max_iterations) return outcome;
      SparseMatrix tangent = shell_.hessian(x, stress);
      for (const EdgeMoment& moment : loads_.moments) tangent -= factor * moment.stiffness(x);
      const SparseMatrix system = map_.transpose() * tangent * map_;
      outcome.singular =
          !solver_.factor(system) || !solver_.regular();  // a rigid motion, or a mechanism, is left
      if (outcome.singular) return outcome;
      const Points d = points_of(map_ * solver_.solve(reduced));
      ++outcome.iterations;
      if (!d.allFinite()) return outcome;
      stress = shell_.stress(x, d);
      x += d;
      if (d.cwiseAbs().maxCoeff() <= negligible_step * extent_) {
        outcome.converged = true;
        return outcome;
      }
    }
  }

 private:
  const ShellStructure& shell_;
  const SparseMatrix& map_;
  const Loads& loads_;
  const ShellStaticsOptions& options_;
  double extent_;
  detail::SparseLdlt solver_;
};

Expected<void> check(const ShellStructure& shell, const Points& rest, const Points& load,
                     const ShellStaticsOptions& options) {
  if (rest.rows() != shell.size() || load.rows() != shell.size()) {
    return input_error(fmt::format("{} control points and {} loads, but the shell has {}",
                                   rest.rows(), load.rows(), shell.size()),
                       "load", "give one row per control point");
  }
  if (!load.allFinite()) return input_error("a load is not finite", "load", "use finite numbers");
  if (options.increments < 1) {
    return input_error(fmt::format("{} is not a number of increments", options.increments),
                       "increments", "use 1 or more");
  }
  if (!(options.tolerance > 0) || options.max_iterations < 1 || options.max_halvings < 0) {
    return input_error("tolerance and iterations must be positive", "options", "use the defaults");
  }
  return {};
}

}  // namespace

// Load control: the share of the load grows by `part`, halved where Newton's iteration fails and
// doubled, up to the wanted one, where it succeeds. Each increment starts from the equilibrium
// before. A path that turns back in the load (snap-through) is not followed along the turn: the
// iteration jumps to an equilibrium beyond it or fails.
Expected<ShellEquilibrium> shell_equilibrium(const ShellStructure& shell, const Points& rest,
                                             std::span<const LinearConstraint> constraints,
                                             const Points& load, const ShellStaticsOptions& options,
                                             std::span<const EdgeMoment> moments) {
  if (auto ok = check(shell, rest, load, options); !ok) return std::unexpected(ok.error());
  const auto space = ConstraintSpace::create(shell.size(), constraints);
  if (!space) return std::unexpected(space.error());
  const SparseMatrix map = coordinate_map(*space);
  const double extent = (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm();
  const Loads loads{load, moments};
  ShellNewton newton(shell, map, loads, options, extent);
  ShellEquilibrium result;
  result.control_points = rest + space->feasible(Points::Zero(rest.rows(), 3));
  const double full = 1.0 / options.increments;
  double part = full;
  int spent = 0;
  while (result.load_factor < 1) {
    const double left = 1 - result.load_factor,
                 next = part > left * (1 - 1e-9) ? 1 : result.load_factor + part;
    Points x = result.control_points;
    const auto outcome = newton.iterate(x, next);
    if (Interruption::asked_for()) return interrupted_error();
    spent += outcome.iterations;
    if (outcome.converged) {
      result.control_points = std::move(x);
      result.load_factor = next;
      result.increments.push_back({next, spent, outcome.residual, result.control_points - rest});
      spent = 0;
      part = std::min(full, 2 * part);
      continue;
    }
    if (outcome.singular && result.increments.empty() && outcome.iterations == 0) {
      return moves_freely();
    }
    part /= 2;
    // Half a power of two below the smallest part allowed, so that rounding of `part` decides
    // nothing.
    if (part < full * std::exp2(-options.max_halvings - 0.5)) {
      result.converged = false;
      result.note =
          fmt::format("no equilibrium was found beyond {:.3g} of the load; use more increments",
                      result.load_factor);
      break;
    }
  }
  result.reactions = shell.gradient(result.control_points) -
                     result.load_factor * loads.forces(result.control_points);
  return result;
}

// u = d + T y with Tᵀ K T y = Tᵀ (load − K d), d the displacement that the constraints impose on
// dependent unknowns.
Expected<Points> linear_displacement(const ShellStructure& shell, const Points& rest,
                                     std::span<const LinearConstraint> constraints,
                                     const Points& load) {
  if (auto ok = check(shell, rest, load, {}); !ok) return std::unexpected(ok.error());
  const auto space = ConstraintSpace::create(shell.size(), constraints);
  if (!space) return std::unexpected(space.error());
  const SparseMatrix map = coordinate_map(*space), stiffness = shell.hessian(rest);
  const Points held = space->feasible(Points::Zero(rest.rows(), 3));
  detail::SparseLdlt factor;
  if (!factor.factor(map.transpose() * stiffness * map) || !factor.regular()) return moves_freely();
  const Eigen::VectorXd imbalance = flattened(load) - stiffness * flattened(held);
  return held + points_of(map * factor.solve(Eigen::VectorXd(map.transpose() * imbalance)));
}

}  // namespace knead
