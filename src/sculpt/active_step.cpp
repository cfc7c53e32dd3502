#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "active_model.hpp"
#include "contact_newton.hpp"
#include "largest_displacement.hpp"
#include "patch_potential.hpp"
#include "surface_forces.hpp"

namespace knead {
namespace {

constexpr double run_away = 1e4;  // a step longer than this many sizes of the model is refused
constexpr double first_rigid_stiffness = 1e6;
constexpr double developed_slip = 1e-4;  // friction is fully developed after this way, in lengths of the model
constexpr double limit_stiffness = 1e8;
constexpr double limit_tolerance = 1e-6;
constexpr int max_limit_rounds = 12;
constexpr double missed_constraint = 1e-9;  // of the size of the model
constexpr int max_rigid_rounds = 16;
constexpr int max_route_passes = 60;
constexpr double route_tolerance = 1e-9;

}  // namespace

/// G: all forces but those of tools, in normalised units.
template <int D>
Expected<Points> ActiveSpline<D>::Model::load_of(const ActiveState& state, const ActiveLoads& given) const {
  Points g = Points::Zero(rest.rows(), 3);
  // Σ_j ∫ R_i R_j = ∫ R_i, since the basis sums to one: exact.
  const auto everywhere = [this](const Point& f) { return Points(f.transpose().replicate(rest.rows(), 1)); };
  if (given.force != Point::Zero()) g += weight * everywhere(given.force);
  if (given.gravity != Point::Zero()) g += mass * everywhere(given.gravity);
  if (given.nodal.rows() > 0) g += given.nodal;
  if constexpr (D == 2) {
    if (given.pressure != 0 || given.wind != Point::Zero()) {
      for (std::size_t k = 0; k < patches.size(); ++k) {
        const int n = rows[k + 1] - rows[k];
        const Points points = (state.control_points.middleRows(rows[k], n).rowwise() - centre.transpose()) / length;
        const Points velocity =
            state.velocity.rows() > 0 ? Points(state.velocity.middleRows(rows[k], n) / length) : Points(0, 3);
        const auto normal = normal_forces(patches[k], scalings[k], points, velocity, given.pressure, given.wind);
        if (!normal) return std::unexpected(normal.error());
        g.middleRows(rows[k], n) += *normal;
      }
    }
  } else if (given.pressure != 0 || given.wind != Point::Zero()) {
    return input_error("pressure and wind act on surfaces", "load", "use a force or gravity");
  }
  return g;
}

template <int D>
void ActiveSpline<D>::Model::report(ActiveStep& result, const Points& x, const Points& external,
                                    const PotentialState& contact, std::span<const Tool> tools) const {
  const ConstraintSpace& space = inverse.space();
  // Forces on what is free: of tools and loads, of the free part of the net, and of the part that is held. K
  // annihilates constants: without their mean the numbers are smaller, and so is the rounding.
  const Points y = x.rowwise() - x.colwise().mean();
  const Points stretching = stretch * y, bending = bend * y;
  Points held_part = Points::Zero(x.rows(), 3);
  for (int i = 0; i < space.size(); ++i) {
    if (space.is_determined(i)) held_part.row(i) = x.row(i);
  }
  const Points from_held = (held_part.array() == 0).all() ? held_part : Points(stiffness * held_part);
  const Points from_free = stretching + bending - from_held;
  const double scale = contact.force.norm() + external.norm() + from_free.norm() + from_held.norm();
  result.residual = scale > 0 ? space.reduce(contact.force + external - from_free - from_held).norm() / scale : 0;
  result.stretch = std::max(0.0, dot(y, stretching));
  result.bend = std::max(0.0, dot(y, bending));
  result.energy = result.stretch + result.bend;
  result.contact = contact.potential;
  result.gap = contact.entry;
  if (contact.entered >= 0) result.gap_tool = tools[static_cast<std::size_t>(contact.entered)].name;
  result.coarseness = contact.coarseness;
  const auto [worst, off] = space.worst(x);
  result.violation = length * off;
  if (off > missed_constraint * std::max(extent, 1.0)) {
    result.converged = false;
    result.note = fmt::format("the constraint \"{}\" is missed by {:.2g}: what is held does not allow it",
                              space.constraints()[static_cast<std::size_t>(worst)].name, result.violation);
  }
}

template <int D>
struct ActiveSpline<D>::Run {
  const Model& m;
  PatchPotential<D>& potential;
  ContactSummary summary = {0, 0, true, true};
  std::string note = {};
  Points lagged = {};  // what the analytic route adds to the forces of Gauss points

  PotentialState settle(const StepProblem& problem, Points& y, double limit, const Points& original,
                        std::span<const ModelTool> tools);

  /// One minimisation, with the stiffness of rigid tools raised until nothing enters them at Gauss points any more, and
  /// contact begun further out until nothing enters them in between.
  PotentialState minimise(const StepProblem& problem, Points& y) {
    for (int round = 0;; ++round) {
      const ContactSummary part = minimise_step(problem, potential, y);
      summary.iterations += part.iterations;
      summary.solves += part.solves;
      summary.finite = summary.finite && part.finite && y.allFinite();
      summary.converged = part.converged;
      if (!summary.finite) return {};
      PotentialState contact = potential.evaluate(problem.start + y);
      bool again = false, deeper = false;
      double gap = 0;
      int entered = -1;
      for (std::size_t t = 0; t < potential.tool_count(); ++t) {
        if (!potential.tool(t).rigid || !potential.tool(t).collides()) continue;
        const double size = potential.size(t), entry = potential.deepest_entry(t, problem.start + y) / size;
        deeper = deeper || static_cast<int>(t) == contact.entered;
        if (entry > gap) {
          gap = entry;
          entered = static_cast<int>(t);
        }
        if (entry <= rigid_gap) continue;
        if (round == max_rigid_rounds) {
          summary.converged = false;
          note = fmt::format(
              "tool {} stays entered by {:.2g} of its size: what is held lies inside it, or the net cannot give way",
              potential.tool(t).name, entry);
          continue;
        }
        again = true;
        if (contact.entry > rigid_gap && static_cast<int>(t) == contact.entered) {
          if (potential.stiffness(t) < max_tool_stiffness) {
            potential.set_stiffness(t, std::min(10 * potential.stiffness(t), max_tool_stiffness));
          } else {
            round = max_rigid_rounds - 1;  // the hardest springs give: once more, and it is said
          }
        } else {
          potential.set_offset(t, potential.offset(t) + (entry - 0.5 * rigid_gap) * size);
        }
      }
      if (deeper || gap > contact.entry) {
        contact.entry = gap;
        contact.entered = entered;
      }
      if (!again) return contact;
    }
  }

  /// The same under a limit: it is kept at Gauss points, so between them it is drawn in until it holds everywhere.
  PotentialState minimise(const StepProblem& problem, Points& y, double limit, const Points& original) {
    if (!(limit > 0)) return minimise(problem, y);
    double inner = limit * (1 - 0.5 * limit_tolerance);
    for (int round = 0;; ++round) {
      potential.limit(original, inner, limit_stiffness);
      PotentialState contact = minimise(problem, y);
      if (!summary.finite || !contact.limited) return contact;
      const double way = largest_way<D>(m.patches, m.rows, problem.start + y - original);
      if (way <= limit * (1 + limit_tolerance)) return contact;
      if (round == max_limit_rounds) {
        summary.converged = false;
        note = "the limit is exceeded between the points where it is kept; refine the net";
        return contact;
      }
      inner -= way - limit;
    }
  }
};

/// The forces of tools by the analytic route, as a correction that lags behind: F_analytic − F_Gauss at the last result
/// goes to the right side until it no longer changes it.
template <int D>
PotentialState ActiveSpline<D>::Run::settle(const StepProblem& problem, Points& y, double limit, const Points& original,
                                            std::span<const ModelTool> tools) {
  PotentialState contact = minimise(problem, y, limit, original);
  if (m.greville.empty() || tools.empty() || !summary.finite) return contact;
  StepProblem corrected = problem;
  double before = std::numeric_limits<double>::infinity();
  int stalled = 0;
  for (int pass = 0; pass < max_route_passes; ++pass) {
    const Points x = problem.start + y;
    PatchPotential<D> alone(m.loads, m.rows, {tools.begin(), tools.end()});
    for (std::size_t t = 0; t < tools.size(); ++t) alone.set_stiffness(t, potential.stiffness(t));
    Points difference = -alone.evaluate(x).force;
    for (std::size_t k = 0; k < m.greville.size(); ++k) {
      const int n = m.rows[k + 1] - m.rows[k];
      difference.middleRows(m.rows[k], n) +=
          m.greville[k].greville_force(x.middleRows(m.rows[k], n), [&](const Point& place) {
            Point sum = Point::Zero();
            for (std::size_t t = 0; t < tools.size(); ++t) {
              ModelTool tool = tools[t];
              tool.set_stiffness(potential.stiffness(t));
              sum += tool.action(place).force;
            }
            return sum;
          });
    }
    corrected.b = problem.b + difference;
    const Points last = y;
    contact = minimise(corrected, y, limit, original);
    if (!summary.finite) return contact;
    const double change = (y - last).cwiseAbs().maxCoeff();
    if (change <= route_tolerance * std::max(y.cwiseAbs().maxCoeff(), m.extent * route_tolerance)) {
      lagged = difference;
      return contact;
    }
    stalled = change > 0.9 * before ? stalled + 1 : 0;
    if (stalled == 3) break;
    before = change;
  }
  note = "the analytic force route does not settle at this stiffness on this net; the forces are those of Gauss points";
  return minimise(problem, y, limit, original);
}

template <int D>
Expected<ActiveStep> ActiveSpline<D>::step(const ActiveState& state, std::span<const Tool> tools,
                                           const ActiveLoads& loads) const {
  const Model& m = *model_;
  const bool dynamic = m.settings.evolution == Evolution::dynamic;
  std::vector<ModelTool> scaled;
  for (const Tool& tool : tools) scaled.emplace_back(tool, m.centre, m.length);
  const Points file_origin = m.origin(state);
  const Points before = (state.control_points - file_origin) / m.length;
  const Points origin = (file_origin.rowwise() - m.centre.transpose()) / m.length;
  auto external = m.load_of(state, loads);
  if (!external) return std::unexpected(external.error());

  const Points kx0 = m.stiffness * before;
  StepProblem problem{m.a, m.inverse, *external - kx0, origin + before, 0.5 * dot(before, kx0)};
  PatchPotential<D> potential(m.loads, m.rows, scaled);
  potential.grip(problem.start, developed_slip);
  for (PointForce point : loads.points) {
    point.to = (point.to - m.centre) / m.length;
    point.core /= m.length;
    potential.add(std::move(point));
  }
  for (std::size_t t = 0; t < tools.size(); ++t) {
    if (tools[t].rigid && tools[t].collides()) {
      potential.set_stiffness(t, std::max(tools[t].stiffness, first_rigid_stiffness));
    }
  }
  const Points& original = loads.original.rows() > 0 ? loads.original : m.rest;
  const Points limit_origin = (original.rowwise() - m.centre.transpose()) / m.length;

  Run run{m, potential};
  Points y = m.inverse.space().feasible(before) - before, after;
  PotentialState contact;
  if (!dynamic) {
    contact = run.settle(problem, y, loads.limit / m.length, limit_origin, scaled);
  } else {
    const double tau = dynamic_stage * m.settings.time_step;
    const Points b = problem.b;
    const Points v0 = state.velocity.rows() > 0 ? Points(state.velocity / m.length) : Points::Zero(y.rows(), 3);
    // What a stage starts from: the step's beginning, then further on along the first stage.
    Points way = Points::Zero(y.rows(), 3), v = v0;
    for (int k = 0; k < 2 && run.summary.finite; ++k) {
      problem.b = b + m.mass * (way / (tau * tau) + v / tau) + m.damping * (way / tau);
      contact = run.settle(problem, y, loads.limit / m.length, limit_origin, scaled);
      after = (y - way) / tau;
      if (k == 0) {
        way = (1 - dynamic_stage) / dynamic_stage * y;
        v = v0 + (1 - dynamic_stage) / dynamic_stage * (after - v0);
      }
    }
  }
  if (!y.allFinite() || !run.summary.finite) {
    return numerical_error("the step gives no finite result and was refused", "step",
                           "use a larger lambda, a smaller stiffness or larger material coefficients");
  }
  if (const double way = y.rowwise().norm().maxCoeff(); way > run_away * std::max(m.extent, 1e-300)) {
    return numerical_error(
        fmt::format("the step runs away ({:.1e} sizes of the model) and was refused", way / m.extent), "step",
        dynamic ? "use a smaller time_step or smaller loads" : "hold something, use a larger lambda, or smaller loads");
  }
  const Points x = before + y;
  ActiveStep result;
  result.control_points = state.control_points;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    for (int c = 0; c < 3; ++c) {
      if (x(i, c) != before(i, c)) result.control_points(i, c) = file_origin(i, c) + m.length * x(i, c);
    }
  }
  if (dynamic) {
    result.kinetic = 0.5 * dot(after, m.mass * after);
    result.velocity = m.length * after;
  }
  if (run.lagged.rows() > 0) *external += run.lagged;
  result.converged = run.summary.converged;
  result.note = run.note;
  m.report(result, x, *external, contact, tools);
  result.limited = contact.limited;
  result.iterations = run.summary.iterations;
  result.solves = run.summary.solves;
  return result;
}

template Expected<ActiveStep> ActiveSpline<1>::step(const ActiveState&, std::span<const Tool>,
                                                    const ActiveLoads&) const;
template Expected<ActiveStep> ActiveSpline<2>::step(const ActiveState&, std::span<const Tool>,
                                                    const ActiveLoads&) const;
template Expected<ActiveStep> ActiveSpline<3>::step(const ActiveState&, std::span<const Tool>,
                                                    const ActiveLoads&) const;

}  // namespace knead
