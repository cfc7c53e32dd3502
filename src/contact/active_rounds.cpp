#include <algorithm>
#include <cmath>
#include <limits>

#include "active_run.hpp"
#include "base/interruption.hpp"

namespace knead {
namespace {

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

/// The minimum under rigid tools and the limit.
template <int D>
PotentialState ActiveSpline<D>::Run::keep_within_limit(const StepProblem& step) {
  return rounds.run(
      limit, limit_origin, [&] { return descend(step); }, [&] { return Points(step.start + y); });
}

/// F_analytic − F_Gauss of the tools at x. Tools alone, without friction and point forces, which
/// have no analytic route.
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

/// The minimum; on the analytic route with a lagged correction of the forces: F_analytic − F_Gauss
/// at the last result is added to the right side until the result stops changing.
///
/// F_analytic has no potential, as its derivative is not symmetric, so that it cannot stand in Φ.
/// As a lagged term it can: with y ↦ the minimum under b + (F_analytic − F_Gauss)(y), a fixed point
/// balances the analytic forces. It contracts where the difference of the two Hessians is small
/// against A; three passes in a row that shrink by less than a tenth end it, with the Gauss forces.
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
    if (!summary.finite || Interruption::asked_for()) return reached;
    const double change = (y - last).cwiseAbs().maxCoeff();
    if (change <= route_tolerance * std::max(y.cwiseAbs().maxCoeff(), m.extent * route_tolerance)) {
      lagged = difference;
      return reached;
    }
    stalled = change > 0.9 * change_before ? stalled + 1 : 0;
    if (stalled == 3) break;
    change_before = change;
  }
  note =
      "the analytic force route does not settle at this stiffness on this net; the forces are "
      "those of Gauss points";
  return keep_within_limit(step);
}

template PotentialState ActiveSpline<1>::Run::settle(const StepProblem&);
template PotentialState ActiveSpline<2>::Run::settle(const StepProblem&);
template PotentialState ActiveSpline<3>::Run::settle(const StepProblem&);

}  // namespace knead
