#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "active_run.hpp"
#include "largest_displacement.hpp"

namespace knead {
namespace {

constexpr double limit_stiffness = 1e8;
constexpr double limit_tolerance = 1e-6;
constexpr int max_limit_rounds = 12;
constexpr int max_rigid_rounds = 16;
constexpr int max_route_passes = 60;
constexpr double route_tolerance = 1e-9;

}  // namespace

/// One minimisation with the present tools; the potential there.
template <int D>
PotentialState ActiveSpline<D>::Run::descend(const StepProblem& step) {
  auto [part, reached] = minimise_step(step, potential, y);
  summary.iterations += part.iterations;
  summary.solves += part.solves;
  summary.finite = summary.finite && part.finite && y.allFinite();
  summary.converged = part.converged;
  return std::move(reached);
}

template <int D>
typename ActiveSpline<D>::Run::Entries ActiveSpline<D>::Run::entries(const Points& x) const {
  Entries found{std::vector<double>(potential.tool_count(), 0.0)};
  for (std::size_t t = 0; t < potential.tool_count(); ++t) {
    if (!is_rigid(t)) continue;
    const double entry = potential.deepest_entry(t, x) / potential.size(t);
    found.of_tool[t] = entry;
    if (entry > found.deepest) {
      found.deepest = entry;
      found.deepest_tool = static_cast<int>(t);
    }
  }
  return found;
}

/// Stiffens the rigid tool that is penetrated at Gauss points, and starts contact further out for those penetrated in
/// between. False if that tool is at its maximum stiffness: one more round will show what remains.
template <int D>
bool ActiveSpline<D>::Run::keep_out(const Entries& found, const PotentialState& at_gauss_points) {
  bool harder = true;
  for (std::size_t t = 0; t < found.of_tool.size(); ++t) {
    const double entry = found.of_tool[t];
    if (entry <= rigid_gap) continue;
    if (at_gauss_points.entry <= rigid_gap || static_cast<int>(t) != at_gauss_points.entered) {
      potential.set_offset(t, potential.offset(t) + (entry - 0.5 * rigid_gap) * potential.size(t));
    } else if (potential.stiffness(t) < max_tool_stiffness) {
      potential.set_stiffness(t, std::min(10 * potential.stiffness(t), max_tool_stiffness));
    } else {
      harder = false;
    }
  }
  return harder;
}

template <int D>
void ActiveSpline<D>::Run::tell_entered(const Entries& found) {
  for (std::size_t t = 0; t < found.of_tool.size(); ++t) {
    if (found.of_tool[t] <= rigid_gap) continue;
    summary.converged = false;
    note = fmt::format(
        "tool {} stays entered by {:.2g} of its size: what is held lies inside it, or the net cannot give way",
        potential.tool(t).name, found.of_tool[t]);
  }
}

/// The minimum without penetration of rigid tools, at and between Gauss points, in at most `max_rigid_rounds` rounds.
template <int D>
PotentialState ActiveSpline<D>::Run::touch_rigid(const StepProblem& step) {
  for (int rounds_left = max_rigid_rounds;;) {
    PotentialState reached = descend(step);
    if (!summary.finite) return {};
    const Entries found = entries(step.start + y);
    const bool over = found.deepest <= rigid_gap || rounds_left == 0;
    if (over) {
      tell_entered(found);
      const bool rigid_deepest = reached.entered >= 0 && is_rigid(static_cast<std::size_t>(reached.entered));
      if (rigid_deepest || found.deepest > reached.entry) {
        reached.entry = found.deepest;
        reached.entered = found.deepest_tool;
      }
      return reached;
    }
    rounds_left = keep_out(found, reached) ? rounds_left - 1 : 0;
  }
}

/// The same under the limit, which is enforced at Gauss points and tightened until it holds between them too.
template <int D>
PotentialState ActiveSpline<D>::Run::keep_within_limit(const StepProblem& step) {
  if (!(limit > 0)) return touch_rigid(step);
  double inner = limit * (1 - 0.5 * limit_tolerance);
  for (int round = 0;; ++round) {
    potential.limit(limit_origin, inner, limit_stiffness);
    PotentialState reached = touch_rigid(step);
    if (!summary.finite || !reached.limited) return reached;
    const double largest = largest_displacement<D>(m.patches, m.rows, step.start + y - limit_origin);
    if (largest <= limit * (1 + limit_tolerance)) return reached;
    if (round == max_limit_rounds) {
      summary.converged = false;
      note = "the limit is exceeded between the points where it is kept; refine the net";
      return reached;
    }
    inner -= largest - limit;
  }
}

/// F_analytic − F_Gauss of the tools at x.
template <int D>
Points ActiveSpline<D>::Run::greville_correction(const Points& x) const {
  PatchPotential<D> alone(m.loads, m.rows, scaled);
  for (std::size_t t = 0; t < scaled.size(); ++t) alone.set_stiffness(t, potential.stiffness(t));
  Points difference = -alone.evaluate(x).force;
  for (std::size_t k = 0; k < m.greville.size(); ++k) {
    const int n = m.rows[k + 1] - m.rows[k];
    difference.middleRows(m.rows[k], n) +=
        m.greville[k].greville_force(x.middleRows(m.rows[k], n), [&](const Point& place) {
          Point sum = Point::Zero();
          for (std::size_t t = 0; t < scaled.size(); ++t) {
            ModelTool tool = scaled[t];
            tool.set_stiffness(potential.stiffness(t));
            sum += tool.action(place).force;
          }
          return sum;
        });
  }
  return difference;
}

/// The minimum; on the analytic route with a lagged correction of the forces: F_analytic − F_Gauss at the last result
/// is added to the right side until the result stops changing.
template <int D>
PotentialState ActiveSpline<D>::Run::settle(const StepProblem& step) {
  PotentialState reached = keep_within_limit(step);
  if (m.greville.empty() || tools.empty() || !summary.finite) return reached;
  StepProblem corrected = step;
  double change_before = std::numeric_limits<double>::infinity();
  int stalled = 0;
  for (int pass = 0; pass < max_route_passes; ++pass) {
    const Points difference = greville_correction(step.start + y);
    corrected.b = step.b + difference;
    const Points last = y;
    reached = keep_within_limit(corrected);
    if (!summary.finite) return reached;
    const double change = (y - last).cwiseAbs().maxCoeff();
    if (change <= route_tolerance * std::max(y.cwiseAbs().maxCoeff(), m.extent * route_tolerance)) {
      lagged = difference;
      return reached;
    }
    stalled = change > 0.9 * change_before ? stalled + 1 : 0;
    if (stalled == 3) break;
    change_before = change;
  }
  note = "the analytic force route does not settle at this stiffness on this net; the forces are those of Gauss points";
  return keep_within_limit(step);
}

template PotentialState ActiveSpline<1>::Run::settle(const StepProblem&);
template PotentialState ActiveSpline<2>::Run::settle(const StepProblem&);
template PotentialState ActiveSpline<3>::Run::settle(const StepProblem&);

}  // namespace knead
