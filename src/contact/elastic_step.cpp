#include "elastic_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/interruption.hpp"
#include "elastic_descent.hpp"
#include "knead/base/error_code.hpp"
#include "solve/dissection.hpp"

namespace knead {
namespace {

// ½ is the midpoint rule, of second order but without damping of what the step does not resolve;
// 0.55 damps that a little, at the price of an error of first order, a tenth of implicit Euler's.
constexpr double theta_of_dynamics = 0.55;
constexpr double interactive_imbalance = 1e-3;
constexpr double gained_energy = 1e-12;  // of the energies that are compared: rounding
constexpr int max_energy_rounds = 12;
constexpr int max_following_rounds = 60;
constexpr double followed = 1e-9;  // of the forces that follow

/// B of the scaled domain: patches along the diagonal.
template <int D>
Expected<SparseMatrix> domain_mass(const std::vector<Spline<D>>& patches,
                                   std::span<const DomainScaling<D>> scalings) {
  std::vector<Eigen::Triplet<double>> entries;
  int first = 0;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const auto weight = Stiffness<D>::create(
        patches[k], on_scaled_domain<D>(mass_energy<D>(), scalings[k].factors), {});
    if (!weight) return std::unexpected(weight.error());
    const SparseMatrix block = weight->assemble();
    for (Eigen::Index row = 0; row < block.outerSize(); ++row) {
      for (SparseMatrix::InnerIterator it(block, row); it; ++it) {
        entries.emplace_back(first + static_cast<int>(row), first + static_cast<int>(it.col()),
                             it.value());
      }
    }
    first += patches[k].size();
  }
  SparseMatrix mass(first, first);
  mass.setFromTriplets(entries.begin(), entries.end());
  return mass;
}

Expected<void> check(const ActiveShellSettings& settings) {
  if (!std::isfinite(settings.lambda) || settings.lambda < 0) {
    return input_error(fmt::format("{} is not a step parameter", settings.lambda), "lambda",
                       "use a finite number >= 0");
  }
  if (settings.evolution != Evolution::dynamic) return {};
  if (!(std::isfinite(settings.time_step) && settings.time_step > 0)) {
    return input_error(fmt::format("{} is not a time step", settings.time_step), "time_step",
                       "use a finite number > 0");
  }
  if (!std::isfinite(settings.damping) || settings.damping < 0) {
    return input_error(fmt::format("{} is not a damping", settings.damping), "damping",
                       "use a finite number >= 0");
  }
  if (!std::isfinite(settings.mass) || settings.mass < 0) {
    return input_error(fmt::format("{} is not a mass", settings.mass), "mass",
                       "use a finite number >= 0");
  }
  return {};
}

/// One step.
///
/// The unknown is Y in x = start + Y, N × 3 in lengths of the model; `displaced` + Y is the
/// displacement from the rest shape, to which constraints apply. `balance` finds Y: one
/// equilibrium, a fixed point under forces that follow, or a dynamic step. Around each minimisation
/// `rounds` stiffens rigid tools and tightens the limit. `accept` judges the result and returns it
/// in units of the file.
template <int D>
struct ElasticRun {
  ElasticRun(const ElasticModel<D>& model, const ActiveState& from,
             std::span<const Tool> given_tools, const ActiveLoads& given_loads,
             const FollowingForces& given_following)
      : m(model),
        state(from),
        tools(given_tools),
        loads(given_loads),
        following(given_following),
        length(model.units.length),
        start((from.control_points.rowwise() - m.units.centre.transpose()) / length),
        displaced((from.control_points - m.rest) / length),
        potential(m.loads, m.rows, scaled_tools()),
        rounds(potential, m.patches, m.rows, summary, note) {
    velocity =
        from.velocity.rows() > 0 ? Points(from.velocity / length) : Points::Zero(start.rows(), 3);
    y = m.space.feasible(displaced) - displaced;
    if (from.guess.rows() > 0) y = from.guess / length;
    potential.grip(start, developed_slip);
    for (PointForce point : loads.points) {
      point.to = (point.to - m.units.centre) / length;
      point.core /= length;
      potential.add(std::move(point));
    }
    rounds.begin();
    const Points& original = loads.original.rows() > 0 ? loads.original : m.rest;
    limit_origin = (original.rowwise() - m.units.centre.transpose()) / length;
  }

  [[nodiscard]] Points forces_at(const Points& x) const {
    Points sum = loads.nodal.rows() > 0 ? loads.nodal : Points(Points::Zero(x.rows(), 3));
    if (following) following(x, length * velocity, sum);
    return length / m.units.energy * sum;
  }
  [[nodiscard]] Points place() const { return start + y; }
  [[nodiscard]] Points in_file() const { return m.energy->unscaled(place()); }

  /// The minimum under these normalised forces.
  void settle(const Points& b, const SparseMatrix& inertia, double theta) {
    const ElasticStepProblem problem{
        *m.energy,
        m.space,
        *m.restriction,
        start,
        theta,
        inertia,
        b,
        m.settings.accuracy == StepAccuracy::interactive ? interactive_imbalance : 1e-9};
    ElasticDescent descent(problem, potential);
    contact = rounds.run(
        loads.limit / length, limit_origin, [&] { return descent.run(y, summary); },
        [&] { return place(); });
    residual = descent.residual();
  }

  // Pressure and wind follow the surface and have no potential: a fixed-point iteration, each pass
  // an equilibrium under the forces at the one before. It converges where forces change less than
  // what they meet.
  void balance() {
    external = forces_at(state.control_points);
    if (m.settings.evolution == Evolution::dynamic) return move_on();
    settle(external, m.mass, 1);
    if (m.settings.evolution != Evolution::stationary || !following) return;
    for (int round = 0; round < max_following_rounds && summary.finite; ++round) {
      const Points next = forces_at(in_file());
      const double change = (next - external).norm();
      external = next;
      if (change <= followed * next.norm()) return;
      settle(external, m.mass, 1);
    }
    summary.converged = false;
    note = "pressure, wind or moments do not settle; use smaller ones, or the modes acm or dynamic";
  }

  /// A dynamic step: at θ, where that resolves the motion, else at 1.
  void move_on() {
    const Points from = y;
    if (move_on(from, theta_of_dynamics, 1)) return;
    summary.converged = summary.finite = true;
    note.clear();
    static_cast<void>(move_on(from, 1, max_energy_rounds));
  }

  /// The same at one θ, with c found in some rounds. False: it did not converge, or the energy
  /// grew.
  ///
  /// With Δ = Y: M (V₁ − V₀)/h + D V + ∇W(X_θ) + c = G, V = Δ/h, V₁ = (V − (1 − θ) V₀)/θ.
  /// Multiplied by Δ, energy gains W₁ − W₀ − ∇W·Δ, loses (θ − ½)|V₁ − V₀|²_M and what damping
  /// takes; where the gain is larger, c takes the difference as a force along the momentum. c
  /// changes the step, and with it the difference: hence the rounds.
  [[nodiscard]] bool move_on(const Points& from, double theta, int rounds_left) {
    const double h = m.settings.time_step;
    const SparseMatrix inertia = (1 / (theta * h * h) + m.settings.damping / h) * m.mass;
    const Points b = external + m.mass * velocity / (theta * h);
    const double before = m.energy->value(start);
    y = from + m.space.feasible(displaced + h * velocity) - m.space.feasible(displaced);
    for (double kept = 0; rounds_left > 0; --rounds_left) {
      Points corrected = b;
      if (kept > 0) {  // c = kept · MΔ/(ΔᵀMΔ)
        const Points momentum = m.mass * y;
        corrected -= kept / dot(y, momentum) * momentum;
      }
      settle(corrected, inertia, theta);
      if (!summary.finite || !summary.converged) return false;
      Points gradient;
      static_cast<void>(m.energy->value(start + theta * y, gradient));
      const double now = m.energy->value(place()), work = dot(gradient, y);
      const Points next = (y / h - (1 - theta) * velocity) / theta, change = next - velocity;
      const double lost = (theta - 0.5) * dot(change, m.mass * change);
      const double wanted = std::max(0.0, now - before - work - lost);
      const bool enough = wanted <= kept + gained_energy * (std::abs(now) + std::abs(before));
      if (enough || (theta == 1 && rounds_left == 1)) velocity = next;
      if (enough) return true;
      kept = wanted;
    }
    return false;
  }

  [[nodiscard]] Expected<ActiveStep> accept();

  /// Whether forces that nothing meets move the model as a whole along an axis.
  ///
  /// Equilibrium exists only if no admissible rigid displacement gains from the forces.
  /// Translations along the axes are tested.
  [[nodiscard]] bool drifts() const {
    constexpr double rounding = 1e-12;
    if (m.mass.rows() > 0 || following || !tools.empty() || !loads.points.empty() ||
        loads.limit > 0)
      return false;
    const Points forces = forces_at(state.control_points),
                 origin = m.space.feasible(Points::Zero(start.rows(), 3));
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (std::abs(forces.col(axis).sum()) <= rounding * forces.cwiseAbs().sum()) continue;
      Points all = Points::Zero(start.rows(), 3);
      all.col(axis).setOnes();
      if ((m.space.feasible(all) - origin - all).cwiseAbs().maxCoeff() <= rounding) return true;
    }
    return false;
  }

  const ElasticModel<D>& m;
  const ActiveState& state;
  std::span<const Tool> tools;
  const ActiveLoads& loads;
  const FollowingForces& following;
  double length;
  Points start, displaced;  // positions and displacements at the beginning, normalised
  PatchPotential<D> potential;
  Points limit_origin, velocity, y, external;
  PotentialState contact;
  ContactSummary summary = {0, 0, true, true};
  std::string note;
  ContactRounds<D> rounds;
  double residual = 0;

 private:
  [[nodiscard]] std::vector<ModelTool> scaled_tools() const {
    std::vector<ModelTool> result;
    for (const Tool& tool : tools) result.emplace_back(tool, m.units.centre, length);
    return result;
  }
};

// As for `ActiveSpline`: nothing is taken that is not finite or far away, and coordinates that have
// not moved keep the bits of the file.
template <int D>
Expected<ActiveStep> ElasticRun<D>::accept() {
  if (!summary.finite || !y.allFinite()) {
    return numerical_error(
        "the step gives no finite result and was refused", "step",
        "hold something, use a larger lambda, a smaller stiffness or smaller loads",
        {ErrorCode::step_not_finite});
  }
  if (const double largest = y.rowwise().norm().maxCoeff();
      largest > run_away * std::max(m.extent, 1e-300)) {
    return numerical_error(
        fmt::format("the step runs away ({:.1e} sizes of the model) and was refused",
                    largest / m.extent),
        "step", "hold something, use a larger lambda or a smaller time_step, or smaller loads",
        {ErrorCode::step_runs_away, {{"sizes", largest / m.extent}}});
  }
  ActiveStep result;
  result.control_points = state.control_points;
  for (Eigen::Index i = 0; i < y.rows(); ++i) {
    for (int c = 0; c < 3; ++c) {
      if (y(i, c) != 0) result.control_points(i, c) = state.control_points(i, c) + length * y(i, c);
    }
  }
  const ShellParts parts = m.energy->parts(result.control_points);
  result.stretch = parts.membrane;
  result.bend = parts.bending;
  result.energy = parts.sum();
  if (m.settings.evolution == Evolution::dynamic) {
    result.kinetic = 0.5 * m.units.energy * dot(velocity, m.mass * velocity);
    result.velocity = length * velocity;
  }
  result.contact = m.units.energy * contact.potential;
  result.residual = residual;
  result.gap = contact.entry;
  if (contact.entered >= 0) result.gap_tool = tools[static_cast<std::size_t>(contact.entered)].name;
  result.coarseness = contact.coarseness;
  result.limited = contact.limited;
  result.iterations = summary.iterations;
  result.solves = summary.solves;
  result.converged = summary.converged;
  result.note = note;
  const auto [worst, off] = m.space.worst(displaced + y);
  result.violation = length * off;
  if (off > missed_constraint * std::max(m.extent, 1.0)) {
    result.converged = false;
    result.note =
        fmt::format("the constraint \"{}\" is missed by {:.2g}: what is held does not allow it",
                    m.space.constraints()[static_cast<std::size_t>(worst)].name, result.violation);
  }
  if (!result.converged && result.note.empty()) {
    result.note = fmt::format(
        "the step ended {:.1e} from balance; use smaller motions, or several steps", residual);
  }
  return result;
}

}  // namespace

// Normalisation: x = (x_file − centre)/L, W = W_file/e with e = 2 · `stretching`. A membrane has
// then the stiffness of the linear model with α = 1, and all tolerances and constants of contact
// serve for both.
template <int D>
Expected<ElasticModel<D>> ElasticModel<D>::create(std::vector<Spline<D>> patches,
                                                  ActiveShellSettings settings, double stretching) {
  if (auto ok = check(settings); !ok) return std::unexpected(ok.error());
  ElasticModel m{std::move(patches), {0}, std::move(settings)};
  for (const Spline<D>& patch : m.patches) m.rows.push_back(m.rows.back() + patch.size());
  m.rest.resize(m.rows.back(), 3);
  for (std::size_t k = 0; k < m.patches.size(); ++k) {
    const auto scaling = normalised_scaling<D>(m.patches[k]);
    if (!scaling) return std::unexpected(scaling.error());
    m.scalings.push_back(k == 0 ? *scaling : in_unit<D>(*scaling, m.scalings.front().length));
    const double detail =
        m.settings.detail > 0 ? m.settings.detail : std::numeric_limits<double>::infinity();
    auto load = ToolGrids<D>::create(m.patches[k], m.scalings[k], detail);
    if (!load) return std::unexpected(load.error());
    if constexpr (D == 2) {
      if (k < m.settings.visible.size() && m.settings.visible[k]) load->show(m.settings.visible[k]);
    }
    m.loads.push_back(std::move(*load));
    m.rest.middleRows(m.rows[k], m.patches[k].size()) = m.patches[k].control_points();
  }
  const Eigen::RowVector3d lower = m.rest.colwise().minCoeff(), upper = m.rest.colwise().maxCoeff();
  m.units = {(lower + 0.5 * (upper - lower)).transpose(), m.scalings.front().length,
             2 * stretching};
  m.extent = (upper - lower).norm() / m.units.length;
  return m;
}

// Constraints are over coordinates even where none couples them, as ∇²W does. The pattern of the
// restriction is that of the Hessian at rest, which is that of any other. The mass is the shape's
// own where it has one (density), else a multiple of the scaled domain's, λ in the mode `acm`.
template <int D>
Expected<void> ElasticModel<D>::complete(std::shared_ptr<const ElasticEnergy> of,
                                         const SparseMatrix& own_mass) {
  energy = std::move(of);
  std::vector<LinearConstraint> constraints = settings.constraints;
  for (LinearConstraint& c : constraints) c.value /= units.length;
  auto made = ConstraintSpace::create(rows.back(), constraints, settings.held, true);
  if (!made) return std::unexpected(made.error());
  space = std::move(*made);
  const GridPlaces places = grid_places<D>(patches);
  restriction.emplace(space, energy->file_hessian(rest), &places);
  if (settings.evolution == Evolution::dynamic && own_mass.rows() > 0) {
    mass = units.length * units.length / units.energy * own_mass;
    return {};
  }
  const double weight = settings.evolution == Evolution::dynamic ? settings.mass
                        : settings.evolution == Evolution::acm   ? settings.lambda
                                                                 : 0;
  if (weight == 0) return {};
  auto of_domain = domain_mass<D>(patches, scalings);
  if (!of_domain) return std::unexpected(of_domain.error());
  mass = weight * *of_domain;
  return {};
}

template <int D>
Expected<ActiveStep> elastic_step(const ElasticModel<D>& model, const ActiveState& state,
                                  std::span<const Tool> tools, const ActiveLoads& loads,
                                  const FollowingForces& following) {
  if (loads.force != Point::Zero() || loads.gravity != Point::Zero()) {
    return usage_error("loads of a non-linear energy are forces on its control points");
  }
  ElasticRun<D> run(model, state, tools, loads, following);
  if (run.drifts()) {
    return numerical_error("nothing holds the shape against the forces", "constraints",
                           "hold a side or pin points, so that the forces cannot move all of it",
                           {ErrorCode::nothing_held});
  }
  run.balance();
  if (Interruption::asked_for()) return interrupted_error();
  return run.accept();
}

template struct ElasticModel<1>;
template struct ElasticModel<2>;
template struct ElasticModel<3>;
template Expected<ActiveStep> elastic_step<1>(const ElasticModel<1>&, const ActiveState&,
                                              std::span<const Tool>, const ActiveLoads&,
                                              const FollowingForces&);
template Expected<ActiveStep> elastic_step<2>(const ElasticModel<2>&, const ActiveState&,
                                              std::span<const Tool>, const ActiveLoads&,
                                              const FollowingForces&);
template Expected<ActiveStep> elastic_step<3>(const ElasticModel<3>&, const ActiveState&,
                                              std::span<const Tool>, const ActiveLoads&,
                                              const FollowingForces&);

}  // namespace knead
