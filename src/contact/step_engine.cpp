#include "step_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/decompositions.hpp"
#include "base/interruption.hpp"
#include "knead/base/error_code.hpp"
#include "nested_nets.hpp"
#include "solve/dissection.hpp"

namespace knead {
namespace {

constexpr int coarsest_points = 4500;  // of the net whose matrix is factored
constexpr int highest_degree = 5;      // above it cycles smooth too little
constexpr int few_iterations = 40;     // more of them, and a factor is cheaper
// On cubic nets that are about even, for which `direct_points` was found.
constexpr int usual_iterations = 12;

template <int D>
int highest_of(std::span<const Spline<D>> patches) {
  int degree = 0;
  for (const Spline<D>& patch : patches) {
    for (int d = 0; d < D; ++d) degree = std::max(degree, patch.knots(d).degree());
  }
  return degree;
}

template <int D>
int highest_sum_of(std::span<const Spline<D>> patches) {
  int most = 0;
  for (const Spline<D>& patch : patches) {
    int sum = 0;
    for (int d = 0; d < D; ++d) sum += patch.knots(d).degree();
    most = std::max(most, sum);
  }
  return most;
}

/// Whether anything forbids a displacement of the whole model.
///
/// A constraint whose coefficients sum to s ≠ 0 forbids a common displacement of all its points:
/// altogether where it is one on points, along its normal otherwise. Three independent normals are
/// needed. Rotations are not looked at: where stretch resists, K vanishes on translations alone;
/// where bend alone does, on all linear maps, which the factorisation then finds.
bool holds_in_place(const ConstraintSpace& space, const std::vector<bool>& held) {
  if (std::ranges::find(held, true) != held.end()) return true;
  // Directions in which it would violate a condition.
  Eigen::Matrix3d forbidden = Eigen::Matrix3d::Zero();
  for (const LinearConstraint& c : space.constraints()) {
    double sum = 0;
    for (const auto& [unknown, coefficient] : c.terms) sum += coefficient;
    if (std::abs(sum) <= 1e-12) continue;
    if (!c.normal) return true;
    const Point n = c.normal->normalized();
    forbidden += n * n.transpose();
  }
  return detail::rank_of(forbidden) == 3;
}

/// Of a matrix that is positive definite, but for the rounding of its entries. The condition of
/// products of B-splines grows as 4^(p + q): from about 4^26 on there are combinations of them, of
/// control points that alternate by as much as they may and show next to nothing, whose energy is
/// less than that rounding. Each diagonal entry is raised by the least share of itself that makes
/// them resist; of what shows that changes as small a share.
Expected<StepInverse> inverse_of_rounded(const SparseMatrix& a, const ConstraintSpace& space,
                                         const GridPlaces& places) {
  constexpr double first_share = 1e-14, last_share = 1e-9;
  auto inverse = ConstrainedCholesky::factor(SparseMatrix(a), space, &places);
  if (inverse) return StepInverse(std::move(*inverse));
  for (double share = first_share; !inverse && share < 2 * last_share; share *= 10) {
    if (inverse.error().kind != ErrorKind::numerical || Interruption::asked_for()) break;
    SparseMatrix raised = a;
    for (Eigen::Index k = 0; k < a.rows(); ++k) raised.coeffRef(k, k) *= 1 + share;
    inverse = ConstrainedCholesky::factor(std::move(raised), space, &places);
  }
  if (!inverse) return std::unexpected(inverse.error());
  return StepInverse(std::move(*inverse), true);
}

Expected<StepInverse> factored(SparseMatrix&& a, ConstraintSpace space, const GridPlaces& places,
                               bool undamped, int degrees) {
  constexpr int lose_digits = 20;  // sums of degrees
  if (!undamped && degrees >= lose_digits) return inverse_of_rounded(a, space, places);
  auto inverse = ConstrainedCholesky::factor(std::move(a), std::move(space), &places);
  if (inverse) return StepInverse(std::move(*inverse));
  if (!undamped || inverse.error().kind != ErrorKind::numerical)
    return std::unexpected(inverse.error());
  Error error = inverse.error();
  error.remedy =
      "what is held leaves the model free to move or tilt: hold more, or use another mode or a "
      "positive lambda";
  return std::unexpected(error);
}

/// Cycles over nested nets, or why there are none.
template <int D>
Expected<ConstrainedMultigrid> nested(const NetOperator<D>& a, const ConstraintSpace& space,
                                      std::span<const Spline<D>> patches,
                                      std::span<const DomainScaling<D>> scalings) {
  if (space.coupled()) return input_error("constraints couple the coordinates of points", "solver");
  if (space.free_count() == 0) return input_error("nothing is free to move", "solver");
  const int degree = highest_of<D>(patches);
  if (degree > highest_degree)
    return input_error(
        fmt::format("the degree is {}, at most {} is iterated", degree, highest_degree), "solver");
  const int enough = std::min(coarsest_points, space.size() / 2);
  const auto prolongations = nested_prolongations<D>(patches, scalings, enough);
  if (prolongations.empty()) {
    return input_error(
        fmt::format("there are no coarser nets of at most {} control points", enough), "solver");
  }
  return ConstrainedMultigrid::create(
      a.assemble(), [a](const Points& x) { return a * x; }, space, prolongations);
}

}  // namespace

// A factor costs n^1.5 once and about n log n a step, cycles n for each iteration of a step: the
// number of iterations at which both are even grows with n.
template <int D>
int most_iterations(int points, int degree) {
  if (D == 3 || degree > 3) return few_iterations;
  const double share = static_cast<double>(points) / direct_points<D>;
  return static_cast<int>(
      std::min<double>(few_iterations, usual_iterations * std::max(1.0, share)));
}

template int most_iterations<1>(int, int);
template int most_iterations<2>(int, int);
template int most_iterations<3>(int, int);

// Iterated only where it is asked for or the net is large, and then only where a known displacement
// shows that cycles converge fast enough: the choice is made by counts and by that trial, never by
// time, so that results repeat. Where cycles fail, unasked for, the factor is made after all, and
// the reason goes into the report.
template <int D>
Expected<ChosenInverse> invert(const NetOperator<D>& a, ConstraintSpace space,
                               std::span<const Spline<D>> patches,
                               std::span<const DomainScaling<D>> scalings,
                               const ActiveSettings<D>& settings) {
  const bool undamped = settings.evolution == Evolution::stationary ||
                        (settings.evolution == Evolution::acm && settings.lambda == 0);
  // Such a displacement costs no energy: there would be no equilibrium.
  if (undamped && space.free_count() > 0 && !holds_in_place(space, settings.held)) {
    return numerical_error("nothing holds the model in place, so it has no position of balance",
                           "evolve",
                           "hold an edge or pin points, or use another mode or a positive lambda",
                           {ErrorCode::nothing_held});
  }
  const std::string points = fmt::format("{} control points", space.size());
  StepEngine engine{false, true, "asked for"};
  if (settings.solver == StepSolver::iterative ||
      (settings.solver == StepSolver::automatic && space.size() > direct_points<D>)) {
    engine.usual = false;
    auto multigrid = nested<D>(a, space, patches, scalings);
    if (Interruption::asked_for()) return interrupted_error();
    const bool asked = settings.solver == StepSolver::iterative;
    if (multigrid && (asked || multigrid->iterations() <=
                                   most_iterations<D>(space.size(), highest_of<D>(patches)))) {
      engine.iterative = true;
      engine.reason = fmt::format("{}, {} iterations for eight digits",
                                  asked ? "asked for" : points, multigrid->iterations());
      return ChosenInverse{StepInverse(std::move(*multigrid)), std::move(engine)};
    }
    if (asked) {
      Error error = multigrid.error();
      error.remedy = R"(use "solver": "automatic")";
      return std::unexpected(error);
    }
    engine.reason = fmt::format(
        "{}, but {}", points,
        multigrid ? fmt::format("{} iterations for eight digits", multigrid->iterations())
                  : multigrid.error().what);
  } else if (settings.solver == StepSolver::automatic) {
    engine.reason = fmt::format("{}, at most {}", points, direct_points<D>);
  }
  auto inverse = factored(a.assemble(), std::move(space), grid_places<D>(patches), undamped,
                          highest_sum_of<D>(patches));
  if (!inverse) return std::unexpected(inverse.error());
  return ChosenInverse{std::move(*inverse), std::move(engine)};
}

template Expected<ChosenInverse> invert(const NetOperator<1>&, ConstraintSpace,
                                        std::span<const Spline<1>>,
                                        std::span<const DomainScaling<1>>,
                                        const ActiveSettings<1>&);
template Expected<ChosenInverse> invert(const NetOperator<2>&, ConstraintSpace,
                                        std::span<const Spline<2>>,
                                        std::span<const DomainScaling<2>>,
                                        const ActiveSettings<2>&);
template Expected<ChosenInverse> invert(const NetOperator<3>&, ConstraintSpace,
                                        std::span<const Spline<3>>,
                                        std::span<const DomainScaling<3>>,
                                        const ActiveSettings<3>&);

}  // namespace knead
