#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "active_run.hpp"
#include "base/interruption.hpp"
#include "energy/surface_forces.hpp"
#include "knead/base/error_code.hpp"
#include "solve/dissection.hpp"

namespace knead {
namespace {

std::vector<ModelTool> in_model_units(std::span<const Tool> tools, const Point& centre,
                                      double length) {
  std::vector<ModelTool> result;
  for (const Tool& tool : tools) result.emplace_back(tool, centre, length);
  return result;
}

}  // namespace

/// G: all forces except those of tools, in normalised units.
template <int D>
Expected<Points> ActiveSpline<D>::Model::load_of(const ActiveState& state,
                                                 const ActiveLoads& given) const {
  if (!given.moments.empty()) return usage_error("moments act on shells");
  Points g = Points::Zero(rest.rows(), 3);
  // Σ_j ∫ R_i R_j = ∫ R_i, since the basis sums to one: exact.
  const auto everywhere = [this](const Point& f) {
    return Points(f.transpose().replicate(rest.rows(), 1));
  };
  if (given.force != Point::Zero()) g += weight * everywhere(given.force);
  if (given.gravity != Point::Zero()) g += mass * everywhere(given.gravity);
  if (given.nodal.rows() > 0) g += given.nodal;
  if constexpr (D == 2) {
    if (given.pressure != 0 || given.wind != Point::Zero()) {
      for (std::size_t k = 0; k < patches.size(); ++k) {
        const int n = rows[k + 1] - rows[k];
        const Points points =
            (state.control_points.middleRows(rows[k], n).rowwise() - centre.transpose()) / length;
        const Points velocity = state.velocity.rows() > 0
                                    ? Points(state.velocity.middleRows(rows[k], n) / length)
                                    : Points(0, 3);
        const auto normal =
            normal_forces(patches[k], scalings[k], points, velocity, given.pressure, given.wind);
        if (!normal) return std::unexpected(normal.error());
        g.middleRows(rows[k], n) += *normal;
      }
    }
  } else if (given.pressure != 0 || given.wind != Point::Zero()) {
    return input_error("pressure and wind act on surfaces", "load", "use a force or gravity");
  }
  return g;
}

// The residual is |Tᵀ(F + G − K X)| over the sum of the norms of what meets there. K X is split
// into what comes from free control points and from held ones, since a held part that is far away
// is a force on the others and belongs in the sum.
template <int D>
void ActiveSpline<D>::Model::report(ActiveStep& result, const Points& x, const Points& external,
                                    const PotentialState& contact,
                                    std::span<const Tool> tools) const {
  const ConstraintSpace& space = inverse.space();
  // Forces on the free unknowns: from tools and loads, the free part of the net, and the held part.
  // K annihilates constants: without their mean the numbers are smaller, and so is the rounding.
  Points y = x.rowwise() - x.colwise().mean();
  Points from_free = stretch * y;
  result.stretch = std::max(0.0, dot(y, from_free));
  const Points bending = bend * y;
  result.bend = std::max(0.0, dot(y, bending));
  from_free += bending;
  bool held = false;
  for (int i = 0; i < space.size(); ++i) {
    if (space.is_determined(i)) {
      y.row(i) = x.row(i);
      held = held || !(x.row(i).array() == 0).all();
    } else {
      y.row(i).setZero();
    }
  }
  const Points from_held = held ? stiffness * y : y;
  from_free -= from_held;
  const double scale = contact.force.norm() + external.norm() + from_free.norm() + from_held.norm();
  y = contact.force + external - from_free - from_held;
  const double unbalanced =
      space.coupled() ? space.reduce(y).norm() : space.reduce_points(y).norm();
  result.residual = scale > 0 ? unbalanced / scale : 0;
  result.energy = result.stretch + result.bend;
  result.contact = contact.potential;
  result.gap = contact.entry;
  if (contact.entered >= 0) result.gap_tool = tools[static_cast<std::size_t>(contact.entered)].name;
  result.coarseness = contact.coarseness;
  result.energy_error = energy_error;
  const auto [worst, off] = space.worst(x);
  result.violation = length * off;
  if (off > missed_constraint * std::max(extent, 1.0)) {
    result.converged = false;
    result.note =
        fmt::format("the constraint \"{}\" is missed by {:.2g}: what is held does not allow it",
                    space.constraints()[static_cast<std::size_t>(worst)].name, result.violation);
  }
}

// The problem of `minimise_step` with X = X₀ + Y: K X = G + F gives A Y = G − K X₀ + F, so b = G −
// K X₀. `balanced` states have G = K X₀, so that nothing but tools moves them. The start Y brings
// X₀ to what constraints demand.
template <int D>
ActiveSpline<D>::Run::Run(const Model& model, const ActiveState& from,
                          std::span<const Tool> given_tools, const ActiveLoads& given_loads,
                          Points forces)
    : m(model),
      state(from),
      tools(given_tools),
      loads(given_loads),
      scaled(in_model_units(given_tools, m.centre, m.length)),
      file_origin(m.origin(from)),
      before((from.control_points - file_origin) / m.length),
      external(std::move(forces)),
      sprung(model.with_springs(given_loads.points)),
      problem{[a = sprung ? &sprung->a : &model.a](const Points& x) { return *a * x; },
              sprung ? *sprung->inverse : m.inverse,
              {},
              (file_origin.rowwise() - m.centre.transpose()) / m.length + before,
              0},
      source{[a = sprung ? &sprung->a : &model.a] { return a->assemble(); },
             [&model] { return grid_places<D>(model.patches); }},
      potential(m.loads, m.rows, scaled),
      limit(given_loads.limit / m.length),
      rounds(potential, m.patches, m.rows, summary, note) {
  const Points kx0 = m.stiffness * before;
  if (state.balanced) external = kx0;
  problem.b = external - kx0;
  problem.energy = 0.5 * dot(before, kx0);
  const Points& original = loads.original.rows() > 0 ? loads.original : m.rest;
  limit_origin = (original.rowwise() - m.centre.transpose()) / m.length;
  y = m.inverse.space().feasible(before) - before;
  if (state.balanced)
    y = state.guess.rows() > 0 ? Points(state.guess / m.length) : Points::Zero(before.rows(), 3);
  // Beyond the digits of A an exact step would look for what is not there.
  const bool exact = m.settings.accuracy == StepAccuracy::exact && !m.inverse.rounded();
  if (!exact) problem.accuracy = interactive_accuracy;
  problem.near = state.balanced && state.guess.rows() > 0;
  problem.source = &source;
  for (const PointForce& force : loads.points) {
    if (sprung && may_stand<D>(force, m.patches)) springs.push_back(scaled_force(force));
  }
  PotentialState at_start;
  at_start.force = Points::Zero(before.rows(), 3);
  // Springs in the matrix: k r(rᵀ(X₀ + Y) − to) has its Y-part in A and the rest, their force at Y
  // = 0, in b.
  add_springs(springs, problem.start, at_start);
  problem.b += at_start.force;
}

template <int D>
PointForce ActiveSpline<D>::Run::scaled_force(PointForce force) const {
  force.to = (force.to - m.centre) / m.length;
  force.core /= m.length;
  return force;
}

template <int D>
void ActiveSpline<D>::Run::touch() {
  potential.grip(problem.start, developed_slip);
  for (const PointForce& force : loads.points) {
    if (!sprung || !may_stand<D>(force, m.patches)) potential.add(scaled_force(force));
  }
  rounds.begin();
  if (!(limit > 0) && loads.reach > 0) {
    potential.limit(limit_origin, loads.reach / m.length, reach_stiffness * potential.stiffest());
  }
}

template <int D>
void ActiveSpline<D>::Run::balance() {
  if (m.settings.evolution == Evolution::dynamic) {
    balance_dynamic();
  } else {
    contact = settle(problem);
  }
}

/// The two stages of Alexander's method.
///
/// M Ẍ + D Ẋ + K X = G + F by Alexander's second-order SDIRK with γ = 1 − √½ (R. Alexander,
/// "Diagonally implicit Runge–Kutta methods for stiff O.D.E.'s", 1977). A stage of τ = γh from
/// position X₀ + advance with velocity v is one implicit Euler step:
///
///   V = (Y − advance)/τ,  (M/τ² + D/τ + K) Y = b + M (advance/τ² + v/τ) + D advance/τ.
///
/// The second starts at what the first stage's derivatives give at (1 − γ)h: advance = ((1 − γ)/γ)
/// Y₁ and v = V₀ + ((1 − γ)/γ)(V₁ − V₀). As the method is stiffly accurate, its result is the
/// step's; A is the same for both stages.
template <int D>
void ActiveSpline<D>::Run::balance_dynamic() {
  const double tau = dynamic_stage * m.settings.time_step;
  const Points b = problem.b;
  const Points v0 =
      state.velocity.rows() > 0 ? Points(state.velocity / m.length) : Points::Zero(y.rows(), 3);
  // The start of a stage: the beginning of the step, then a point further along the first stage.
  Points advance = Points::Zero(y.rows(), 3), v = v0;
  for (int k = 0; k < 2 && summary.finite; ++k) {
    problem.b =
        b + m.mass * Points(advance / (tau * tau) + v / tau) + m.damping * Points(advance / tau);
    contact = settle(problem);
    velocity = (y - advance) / tau;
    if (k == 0) {
      advance = (1 - dynamic_stage) / dynamic_stage * y;
      v = v0 + (1 - dynamic_stage) / dynamic_stage * (velocity - v0);
    }
  }
}

// Results are judged before they are taken: what is not finite, or further than `run_away` sizes of
// the model, is an error and changes nothing; constraints that what is held does not allow are a
// note, since the rest of the result is right.
template <int D>
Expected<ActiveStep> ActiveSpline<D>::Run::accept() {
  const bool dynamic = m.settings.evolution == Evolution::dynamic;
  if (!y.allFinite() || !summary.finite) {
    return numerical_error(
        "the step gives no finite result and was refused", "step",
        "use a larger lambda, a smaller stiffness, smaller loads or larger material coefficients",
        {ErrorCode::step_not_finite});
  }
  if (const double largest = y.rowwise().norm().maxCoeff();
      largest > run_away * std::max(m.extent, 1e-300)) {
    return numerical_error(
        fmt::format("the step runs away ({:.1e} sizes of the model) and was refused",
                    largest / m.extent),
        "step",
        dynamic ? "use a smaller time_step or smaller loads"
                : "hold something, use a larger lambda, or smaller loads",
        {ErrorCode::step_runs_away, {{"sizes", largest / m.extent}}});
  }
  const Points x = before + y;
  ActiveStep result;
  result.control_points = state.control_points;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    for (int c = 0; c < 3; ++c) {
      // What has not moved keeps the bits of the file, which a round trip through the model's units
      // would change.
      if (x(i, c) != before(i, c))
        result.control_points(i, c) = file_origin(i, c) + m.length * x(i, c);
    }
  }
  if (dynamic) {
    result.kinetic = 0.5 * dot(velocity, m.mass * velocity);
    result.velocity = m.length * velocity;
  }
  if (lagged.rows() > 0) external += lagged;
  add_springs(springs, problem.start + y, contact);
  result.converged = summary.converged;
  result.note = note;
  m.report(result, x, external, contact, tools);
  result.limited = contact.limited && limit > 0;
  result.iterations = summary.iterations;
  result.solves = summary.solves;
  return result;
}

template <int D>
Expected<ActiveStep> ActiveSpline<D>::step(const ActiveState& state, std::span<const Tool> tools,
                                           const ActiveLoads& loads) const {
  auto external = model_->load_of(state, loads);
  if (!external) return std::unexpected(external.error());
  Run run(*model_, state, tools, loads, std::move(*external));
  run.touch();
  run.balance();
  if (Interruption::asked_for()) return interrupted_error();
  return run.accept();
}

template Expected<ActiveStep> ActiveSpline<1>::step(const ActiveState&, std::span<const Tool>,
                                                    const ActiveLoads&) const;
template Expected<ActiveStep> ActiveSpline<2>::step(const ActiveState&, std::span<const Tool>,
                                                    const ActiveLoads&) const;
template Expected<ActiveStep> ActiveSpline<3>::step(const ActiveState&, std::span<const Tool>,
                                                    const ActiveLoads&) const;

}  // namespace knead
