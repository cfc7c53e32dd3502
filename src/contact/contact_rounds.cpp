#include "contact_rounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "base/interruption.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {
namespace {

// A spring of stiffness k is entered by about f/k under a force per area f: penalties grow tenfold
// from here to `max_tool_stiffness` until `rigid_gap` is met. Beginning at the largest would cost
// conjugate gradients and digits where a softer spring does.
constexpr double first_rigid_stiffness = 1e6;
// Of the penalty that keeps points within the limit at Gauss points, and how far the largest
// displacement may exceed it anywhere, as a share of it.
constexpr double limit_stiffness = 1e8;
constexpr double limit_tolerance = 1e-6;
constexpr int max_limit_rounds = 12;
constexpr int max_rigid_rounds = 16;

/// The largest |S| of a displacement field. For volumes at samples only, 2p + 3 per span.
template <int D>
double largest_of(const Spline<D>& field) {
  if constexpr (D == 2) return largest_norm(field).value;
  if constexpr (D == 1) {  // as a ruled surface that is constant along its rulings
    Points twice(2 * field.size(), 3);
    std::vector<double> weights;
    for (int i = 0; i < field.size(); ++i) {
      twice.row(2 * i) = twice.row(2 * i + 1) = field.control_points().row(i);
      if (field.rational())
        weights.insert(weights.end(), 2, field.weights()[static_cast<std::size_t>(i)]);
    }
    const auto surface =
        Surface::create({field.knots(0), *KnotVector::clamped_uniform(1, 2)}, twice, weights);
    return surface ? largest_norm(*surface).value : 0;
  }
  if constexpr (D == 3) {
    std::array<std::vector<double>, D> parameters;
    std::array<std::span<const double>, D> spans;
    for (std::size_t d = 0; d < D; ++d) {
      const KnotVector& knots = field.knots()[d];
      const int steps = 2 * knots.degree() + 3;
      for (int span : knots.spans()) {
        const double a = knots[span], b = knots[span + 1];
        for (int k = 0; k <= steps; ++k)
          parameters[d].push_back(k == steps ? b : a + (b - a) * k / steps);
      }
      spans[d] = parameters[d];
    }
    const auto grid = evaluate_grid<D>(field, spans);
    return grid ? grid->points().rowwise().norm().maxCoeff() : 0;
  }
}

/// The largest |S − S_original| over all patches, for control points that differ by `displacement`.
///
/// With rational patches a displacement of control points has the weights of the patch, so that it
/// is a spline of the same kind and is S − S_original itself.
template <int D>
double largest_displacement(std::span<const Spline<D>> patches, std::span<const int> rows,
                            const Points& displacement) {
  double largest = 0;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const auto field =
        patches[k].with_control_points(displacement.middleRows(rows[k], rows[k + 1] - rows[k]));
    if (field) largest = std::max(largest, largest_of<D>(*field));
  }
  return largest;
}

}  // namespace

template <int D>
void ContactRounds<D>::begin() {
  for (std::size_t t = 0; t < potential_.tool_count(); ++t) {
    if (is_rigid(t))
      potential_.set_stiffness(t, std::max(potential_.tool(t).stiffness, first_rigid_stiffness));
  }
}

template <int D>
typename ContactRounds<D>::Entries ContactRounds<D>::entries(const Points& x) const {
  Entries found{std::vector<double>(potential_.tool_count(), 0.0)};
  for (std::size_t t = 0; t < potential_.tool_count(); ++t) {
    if (!is_rigid(t)) continue;
    const double entry = potential_.deepest_entry(t, x) / potential_.size(t);
    found.of_tool[t] = entry;
    if (entry > found.deepest) {
      found.deepest = entry;
      found.deepest_tool = static_cast<int>(t);
    }
  }
  return found;
}

/// Stiffens the rigid tool that is penetrated at Gauss points, and starts contact further out for
/// those penetrated in between. False if that tool is at its maximum stiffness: one more round will
/// show what remains.
///
/// Two faults with two remedies. Entered at a Gauss point, a tool's spring is too soft: ten times
/// stiffer. Entered between Gauss points only, no stiffness would help, as the potential does not
/// see it: contact begins further out by the entry, less half the gap allowed, so that offsets do
/// not overshoot.
template <int D>
bool ContactRounds<D>::keep_out(const Entries& found, const PotentialState& at_gauss_points) {
  bool harder = true;
  for (std::size_t t = 0; t < found.of_tool.size(); ++t) {
    const double entry = found.of_tool[t];
    if (entry <= rigid_gap) continue;
    if (at_gauss_points.entry <= rigid_gap || static_cast<int>(t) != at_gauss_points.entered) {
      potential_.set_offset(t,
                            potential_.offset(t) + (entry - 0.5 * rigid_gap) * potential_.size(t));
    } else if (potential_.stiffness(t) < max_tool_stiffness) {
      potential_.set_stiffness(t, std::min(10 * potential_.stiffness(t), max_tool_stiffness));
    } else {
      harder = false;
    }
  }
  return harder;
}

template <int D>
void ContactRounds<D>::tell_entered(const Entries& found) {
  for (std::size_t t = 0; t < found.of_tool.size(); ++t) {
    if (found.of_tool[t] <= rigid_gap) continue;
    summary_.converged = false;
    note_ = fmt::format(
        "tool {} stays entered by {:.2g} of its size: what is held lies inside it, or the net "
        "cannot give way",
        potential_.tool(t).name, found.of_tool[t]);
  }
}

/// The minimum without penetration of rigid tools, at and between Gauss points, in at most
/// `max_rigid_rounds` rounds.
///
/// Each round begins at the minimum before, which is near the next. 16 rounds leave room for four
/// decades of stiffness and a dozen offsets; what is then still entered is reported.
template <int D>
PotentialState ContactRounds<D>::touch_rigid(const Descend& descend, const Place& place) {
  for (int rounds_left = max_rigid_rounds;;) {
    PotentialState reached = descend();
    if (!summary_.finite || Interruption::asked_for()) return {};
    const Entries found = entries(place());
    const bool over = found.deepest <= rigid_gap || rounds_left == 0;
    if (over) {
      tell_entered(found);
      const bool rigid_deepest =
          reached.entered >= 0 && is_rigid(static_cast<std::size_t>(reached.entered));
      if (rigid_deepest || found.deepest > reached.entry) {
        reached.entry = found.deepest;
        reached.entered = found.deepest_tool;
      }
      return reached;
    }
    rounds_left = keep_out(found, reached) ? rounds_left - 1 : 0;
  }
}

/// The same under the limit, which is enforced at Gauss points and tightened until it holds between
/// them too.
///
/// The limit at Gauss points is lowered by the excess found elsewhere. The displacement between
/// Gauss points differs from that at them by a share that hardly changes from round to round, so
/// that the excess falls fast; a net whose spans are long against it may still fail, and says so.
template <int D>
PotentialState ContactRounds<D>::run(double limit, const Points& limit_origin,
                                     const Descend& descend, const Place& place) {
  if (!(limit > 0)) return touch_rigid(descend, place);
  double inner = limit * (1 - 0.5 * limit_tolerance);
  for (int round = 0;; ++round) {
    potential_.limit(limit_origin, inner, limit_stiffness);
    PotentialState reached = touch_rigid(descend, place);
    if (!summary_.finite || !reached.limited || Interruption::asked_for()) return reached;
    const double largest = largest_displacement<D>(patches_, rows_, place() - limit_origin);
    if (largest <= limit * (1 + limit_tolerance)) return reached;
    if (round == max_limit_rounds ||
        largest - limit >= inner) {  // it would be tightened to less than nothing
      summary_.converged = false;
      note_ = "the limit is exceeded between the points where it is kept; refine the net";
      return reached;
    }
    inner -= largest - limit;
  }
}

template class ContactRounds<1>;
template class ContactRounds<2>;
template class ContactRounds<3>;

}  // namespace knead
