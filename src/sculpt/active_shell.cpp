#include "knead/sculpt/active_shell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "contact_rounds.hpp"
#include "shell_descent.hpp"
#include "solve/constraint_space.hpp"
#include "solve/coordinate_restriction.hpp"

namespace knead {
namespace {

constexpr double theta_of_dynamics = 0.55;
constexpr double interactive_imbalance = 1e-3;
constexpr double gained_energy = 1e-12;  // of the energies that are compared: rounding
constexpr int max_energy_rounds = 12;
constexpr int max_following_rounds = 60;
constexpr double followed = 1e-9;  // of the forces that follow

/// B of the scaled domain: patches along the diagonal.
Expected<SparseMatrix> domain_mass(const std::vector<Surface>& patches, std::span<const DomainScaling<2>> scalings) {
  std::vector<Eigen::Triplet<double>> entries;
  int first = 0;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const auto weight =
        Stiffness<2>::create(patches[k], on_scaled_domain<2>(mass_energy<2>(), scalings[k].factors), {});
    if (!weight) return std::unexpected(weight.error());
    const SparseMatrix block = weight->assemble();
    for (Eigen::Index row = 0; row < block.outerSize(); ++row) {
      for (SparseMatrix::InnerIterator it(block, row); it; ++it) {
        entries.emplace_back(first + static_cast<int>(row), first + static_cast<int>(it.col()), it.value());
      }
    }
    first += patches[k].size();
  }
  SparseMatrix mass(first, first);
  mass.setFromTriplets(entries.begin(), entries.end());
  return mass;
}

Expected<void> check(const std::vector<Surface>& patches, const ShellStructure& structure,
                     const ActiveShellSettings& settings) {
  if (patches.size() != structure.shells().size()) return usage_error("there must be one patch per shell");
  for (std::size_t k = 0; k < patches.size(); ++k) {
    if (patches[k].size() != structure.shells()[k].size()) return usage_error("a patch does not fit its shell");
  }
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
    return input_error(fmt::format("{} is not a damping", settings.damping), "damping", "use a finite number >= 0");
  }
  for (const ShellEnergy& shell : structure.shells()) {
    if (shell.mass_per_area() == 0) {
      return input_error("a shell without density has no dynamics", "density", "give its material a density");
    }
  }
  return {};
}

}  // namespace

/// What stays the same from step to step.
struct ActiveShell::Model {
  std::vector<Surface> patches;
  ShellStructure structure;
  ActiveShellSettings settings;
  std::vector<DomainScaling<2>> scalings = {};
  std::vector<ToolLoad<2>> loads = {};
  double length = 1, energy = 1, extent = 1;
  Point centre = Point::Zero();
  Points rest = {};
  SparseMatrix mass = {};  // of the step: λ B or M, normalised; empty: none
  ConstraintSpace space{0};
  std::optional<CoordinateRestriction> restriction = {};

  [[nodiscard]] ScaledStructure scaled() const { return {structure, centre, length, energy}; }
  [[nodiscard]] const std::vector<int>& rows() const { return structure.rows(); }
};

Expected<ActiveShell> ActiveShell::create(std::vector<Surface> patches, ShellStructure structure,
                                          ActiveShellSettings settings) {
  if (auto ok = check(patches, structure, settings); !ok) return std::unexpected(ok.error());
  auto model = std::make_shared<Model>(Model{std::move(patches), std::move(structure), std::move(settings)});
  Model& m = *model;
  m.rest.resize(m.structure.size(), 3);
  for (std::size_t k = 0; k < m.patches.size(); ++k) {
    const auto scaling = normalised_scaling<2>(m.patches[k]);
    if (!scaling) return std::unexpected(scaling.error());
    m.scalings.push_back(k == 0 ? *scaling : in_unit<2>(*scaling, m.scalings.front().length));
    const double detail = m.settings.detail > 0 ? m.settings.detail : std::numeric_limits<double>::infinity();
    auto load = ToolLoad<2>::create(m.patches[k], m.scalings[k], detail);
    if (!load) return std::unexpected(load.error());
    if (k < m.settings.visible.size() && m.settings.visible[k]) load->show(m.settings.visible[k]);
    m.loads.push_back(std::move(*load));
    m.rest.middleRows(m.rows()[k], m.patches[k].size()) = m.patches[k].control_points();
  }
  const Eigen::RowVector3d lower = m.rest.colwise().minCoeff(), upper = m.rest.colwise().maxCoeff();
  m.centre = (lower + 0.5 * (upper - lower)).transpose();
  m.length = m.scalings.front().length;
  m.extent = (upper - lower).norm() / m.length;
  m.energy = 2 * m.structure.stretching_scale();
  std::vector<LinearConstraint> constraints = m.settings.constraints;
  for (LinearConstraint& c : constraints) c.value /= m.length;
  auto space = ConstraintSpace::create(m.structure.size(), constraints, m.settings.held, true);
  if (!space) return std::unexpected(space.error());
  m.space = std::move(*space);
  m.restriction.emplace(m.space, m.structure.hessian(m.rest));
  if (m.settings.evolution == Evolution::dynamic) {
    m.mass = m.length * m.length / m.energy * m.structure.mass();
  } else if (m.settings.evolution == Evolution::acm && m.settings.lambda > 0) {
    auto mass = domain_mass(m.patches, m.scalings);
    if (!mass) return std::unexpected(mass.error());
    m.mass = m.settings.lambda * *mass;
  }
  return ActiveShell(std::move(model));
}

const ShellStructure& ActiveShell::structure() const { return model_->structure; }
double ActiveShell::length() const { return model_->length; }

/// One step.
struct ActiveShell::Run {
  Run(const Model& model, const ActiveState& from, std::span<const Tool> given_tools,
      const ActiveShellLoads& given_loads)
      : m(model),
        state(from),
        tools(given_tools),
        loads(given_loads),
        structure(model.scaled()),
        start((from.control_points.rowwise() - m.centre.transpose()) / m.length),
        displaced((from.control_points - m.rest) / m.length),
        potential(m.loads, m.rows(), scaled_tools()),
        rounds(potential, m.patches, m.rows(), summary, note) {
    velocity = from.velocity.rows() > 0 ? Points(from.velocity / m.length) : Points::Zero(start.rows(), 3);
    y = m.space.feasible(displaced) - displaced;
    if (from.guess.rows() > 0) y = from.guess / m.length;
    potential.grip(start, developed_slip);
    for (PointForce point : loads.points) {
      point.to = (point.to - m.centre) / m.length;
      point.core /= m.length;
      potential.add(std::move(point));
    }
    rounds.begin();
    const Points& original = loads.original.rows() > 0 ? loads.original : m.rest;
    limit_origin = (original.rowwise() - m.centre.transpose()) / m.length;
  }

  /// Forces that change with the shape, at these control points in units of the file, and all others.
  [[nodiscard]] Points forces_at(const Points& x) const {
    Points sum = loads.nodal.rows() > 0 ? loads.nodal : Points::Zero(x.rows(), 3);
    for (const EdgeMoment& moment : loads.moments) sum += moment.forces(x);
    if (loads.pressure != 0 || loads.wind != Point::Zero()) {
      for (std::size_t k = 0; k < m.patches.size(); ++k) {
        const int first = m.rows()[k], n = m.rows()[k + 1] - first;
        const Points moving = m.length * velocity.middleRows(first, n);
        sum.middleRows(first, n) +=
            m.structure.shells()[k].normal_load(x.middleRows(first, n), moving, loads.pressure, loads.wind);
      }
    }
    return sum;
  }
  [[nodiscard]] bool follows() const {
    return !loads.moments.empty() || loads.pressure != 0 || loads.wind != Point::Zero();
  }
  [[nodiscard]] Points place() const { return start + y; }
  [[nodiscard]] Points in_file() const { return structure.unscaled(place()); }

  /// The minimum under these normalised forces.
  void settle(const Points& b, const SparseMatrix& inertia, double theta) {
    const ShellStepProblem problem{structure,
                                   m.space,
                                   *m.restriction,
                                   start,
                                   theta,
                                   inertia,
                                   b,
                                   m.settings.accuracy == StepAccuracy::interactive ? interactive_imbalance : 1e-9};
    ShellDescent descent(problem, potential);
    contact = rounds.run(
        loads.limit / m.length, limit_origin, [&] { return descent.run(y, summary); }, [&] { return place(); });
    residual = descent.residual();
  }

  void balance() {
    const double to_model = m.length / m.energy;
    external = to_model * forces_at(state.control_points);
    if (m.settings.evolution == Evolution::dynamic) return move_on();
    settle(external, m.mass, 1);
    if (m.settings.evolution != Evolution::stationary || !follows()) return;
    for (int round = 0; round < max_following_rounds && summary.finite; ++round) {
      const Points next = to_model * forces_at(in_file());
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

  /// The same at one θ, with c found in some rounds. False: it did not converge, or the energy grew.
  [[nodiscard]] bool move_on(const Points& from, double theta, int rounds_left) {
    const double h = m.settings.time_step;
    const SparseMatrix inertia = (1 / (theta * h * h) + m.settings.damping / h) * m.mass;
    const Points b = external + m.mass * velocity / (theta * h);
    const double before = structure.value(start);
    y = from + m.space.feasible(displaced + h * velocity) - m.space.feasible(displaced);
    for (double kept = 0; rounds_left > 0; --rounds_left) {
      Points corrected = b;
      if (kept > 0) {  // c = kept · MΔ/(ΔᵀMΔ)
        const Points momentum = m.mass * y;
        corrected -= kept / dot(y, momentum) * momentum;
      }
      settle(corrected, inertia, theta);
      if (!summary.finite || !summary.converged) return false;
      const double now = structure.value(place()), work = dot(structure.gradient(start + theta * y), y);
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

  const Model& m;
  const ActiveState& state;
  std::span<const Tool> tools;
  const ActiveShellLoads& loads;
  ScaledStructure structure;
  Points start, displaced;  // positions and displacements at the beginning, normalised
  PatchPotential<2> potential;
  Points limit_origin, velocity, y, external;
  PotentialState contact;
  ContactSummary summary = {0, 0, true, true};
  std::string note;
  ContactRounds<2> rounds;
  double residual = 0;

 private:
  [[nodiscard]] std::vector<ModelTool> scaled_tools() const {
    std::vector<ModelTool> result;
    for (const Tool& tool : tools) result.emplace_back(tool, m.centre, m.length);
    return result;
  }
};

Expected<ActiveStep> ActiveShell::Run::accept() {
  if (!summary.finite || !y.allFinite()) {
    return numerical_error("the step gives no finite result and was refused", "step",
                           "hold something, use a larger lambda, a smaller stiffness or smaller loads");
  }
  if (const double largest = y.rowwise().norm().maxCoeff(); largest > run_away * std::max(m.extent, 1e-300)) {
    return numerical_error(
        fmt::format("the step runs away ({:.1e} sizes of the model) and was refused", largest / m.extent), "step",
        "hold something, use a larger lambda or a smaller time_step, or smaller loads");
  }
  ActiveStep result;
  result.control_points = state.control_points;
  for (Eigen::Index i = 0; i < y.rows(); ++i) {
    for (int c = 0; c < 3; ++c) {
      if (y(i, c) != 0) result.control_points(i, c) = state.control_points(i, c) + m.length * y(i, c);
    }
  }
  const ShellParts parts = m.structure.energy(result.control_points);
  result.stretch = parts.membrane;
  result.bend = parts.bending;
  result.energy = parts.sum();
  if (m.settings.evolution == Evolution::dynamic) {
    result.kinetic = 0.5 * m.energy * dot(velocity, m.mass * velocity);
    result.velocity = m.length * velocity;
  }
  result.contact = m.energy * contact.potential;
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
  result.violation = m.length * off;
  if (off > missed_constraint * std::max(m.extent, 1.0)) {
    result.converged = false;
    result.note = fmt::format("the constraint \"{}\" is missed by {:.2g}: what is held does not allow it",
                              m.space.constraints()[static_cast<std::size_t>(worst)].name, result.violation);
  }
  if (!result.converged && result.note.empty()) {
    result.note = fmt::format("the step ended {:.1e} from balance; use smaller motions, or several steps", residual);
  }
  return result;
}

Expected<ActiveStep> ActiveShell::step(const ActiveState& state, std::span<const Tool> tools,
                                       const ActiveShellLoads& loads) const {
  Run run(*model_, state, tools, loads);
  run.balance();
  return run.accept();
}

}  // namespace knead
