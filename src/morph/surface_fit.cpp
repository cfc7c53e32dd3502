#include "surface_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit_problem.hpp"
#include "fit_refinement.hpp"
#include "hold_fading.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::morph {
namespace {

constexpr double exact_lambda = 1e-7, first_lambda = 1e-2, least_lambda = 1e-8;
// From `late` on joints do not wait for residuals; after `most_solves` only their weights grow, and
// those that data have gained fall.
constexpr int most_rounds = 30, most_solves = 9, late = 5, solves_for_joints = 5;
// Weights are raised for what is above this share of what is wanted, in one solve and altogether by
// these factors; of joints once the residuals are within `settling` times what is wanted.
constexpr double near_wanted = 0.7, most_raise = 16, most_share = 4096, settling = 2;
// Of joints in the last fits: data that no net can follow have the most weight by then.
constexpr double most_share_late = 64 * most_share;
// Joints of usual weights ask for finer nets above this multiple of what is wanted, others above 1.
constexpr double light_joint = 3;
constexpr double again = 16;  // times the λ of the nets before
constexpr double never = std::numeric_limits<double>::infinity();
constexpr double helped = 0.8;    // refinement that leaves more has not
constexpr double eased = 0.9;     // more weight that leaves more has not helped,
constexpr double in_vain = 16;    // and after so many times the weight is not given any more
constexpr double stalled = 0.97;  // a solve that leaves more than this is the last one

/// The joints of the nets as they are.
Expected<std::vector<Joint>> joints_of(const FitProblem& problem) {
  std::vector<Joint> joints = joints_of_edges(problem.edges, problem.nets);
  if (problem.settings.displacement) {
    // What is fitted is what the affine part leaves.
    const auto left = [&](const Point& at) -> Expected<Point> {
      auto displacement = problem.settings.displacement(at);
      if (displacement) *displacement -= problem.affine.at(at);
      return displacement;
    };
    if (auto done = part_joints(joints, problem.nets, problem.parting, left); !done)
      return std::unexpected(done.error());
  }
  auto lines = joints_of_lines(problem.nets);
  if (!lines) return lines;
  for (Joint& line : *lines) joints.push_back(std::move(line));
  std::erase_if(joints, [&](const Joint& joint) {
    return problem.nets.stays(joint.surfaces[0]) && problem.nets.stays(joint.surfaces[1]);
  });
  return joints;
}

/// A fit on the nets as they are.
struct Fit {
  std::vector<Joint> joints;
  FitSystem system;
  FitState state;
  double lambda = 0;
  std::vector<Surface> surfaces = {};
  std::vector<JointAngle> angles = {};  ///< of each joint, 0 where it is not smooth
};

Expected<FitState> solve_exact(const FitProblem& problem, const FitSystem& system, double lambda) {
  FitState before;
  return system.solve(lambda, [&](const FitState& state) {
    if (problem.settings.rounds) return state.rounds >= *problem.settings.rounds;
    if (problem.satisfied(state) || state.rounds >= most_rounds) return true;
    const bool little = state.rounds > 1 && state.rms_residual > stalled * before.rms_residual &&
                        state.largest_parting > stalled * before.largest_parting &&
                        state.largest_slope > stalled * before.largest_slope;
    before = state;
    return little;
  });
}

/// The λ of a sequence from which on residuals are of the size of the noise (V. Morozov's
/// discrepancy principle): rms² <= 3 σ² (1 − freedom / data), since a fit takes up that share of
/// the noise.
Expected<FitState> solve_noisy(const FitProblem& problem, const FitSystem& system, double& lambda) {
  const auto data = static_cast<double>(problem.points.size());
  for (;; lambda /= 4) {
    auto state = system.solve(
        lambda,
        [&](const FitState& now) { return now.rounds >= problem.settings.rounds.value_or(1); },
        true);
    if (!state || problem.settings.energy || lambda < least_lambda) return state;
    const double left = std::max(0.0, 1 - state->freedom / data);
    const double chance = 1 + 2 / std::sqrt(6 * data);  // two deviations of a root mean square
    if (state->rms_residual <= chance * *problem.settings.noise * std::sqrt(3 * left)) return state;
  }
}

Expected<Fit> fit_once(FitProblem& problem) {
  problem.nets.number(problem.given);
  if (auto kept = problem.nets.hold(problem.given); !kept) return std::unexpected(kept.error());
  sort_by_cells(problem.nets, problem.points);
  auto joints = joints_of(problem);
  if (!joints) return std::unexpected(joints.error());
  problem.shares.resize(joints->size(), {1, 1});
  problem.asked.resize(joints->size(), {never, never});
  problem.pressed.resize(joints->size());
  for (std::size_t j = 0; j < joints->size(); ++j) {
    (*joints)[j].position_share = problem.shares[j][0];
    (*joints)[j].slope_share = problem.shares[j][1];
  }
  auto system =
      FitSystem::create(problem.nets, problem.points, *joints, problem.units, problem.size);
  if (!system) return std::unexpected(system.error());
  const bool noisy = problem.settings.noise.has_value();
  // Finer nets follow noise with about the λ of coarser ones, or less.
  const double first = noisy ? std::min(first_lambda, again * problem.lambda) : exact_lambda;
  double lambda = problem.settings.energy.value_or(first);
  auto state =
      noisy ? solve_noisy(problem, *system, lambda) : solve_exact(problem, *system, lambda);
  if (!state) return std::unexpected(state.error());
  problem.lambda = lambda;
  Fit result{*std::move(joints), *std::move(system), *std::move(state), lambda};
  auto surfaces = moved(problem, result.state.x);
  if (!surfaces) return std::unexpected(surfaces.error());
  result.surfaces = *std::move(surfaces);
  for (const Joint& joint : result.joints) {
    if (!joint.smooth) {
      result.angles.emplace_back();
      continue;
    }
    const auto angle = largest_angle(joint, problem.nets.surfaces, result.surfaces);
    if (!angle) return std::unexpected(angle.error());
    result.angles.push_back(*angle);
  }
  return result;
}

/// Asks for finer nets at a joint by one of its measures, positions (0) or angles (1). Of data with
/// noise a joint is uneven by chance, and more weight smooths it first. A measure that the last
/// refinement has hardly changed, as beside a cusp, does not ask again.
void plan_for_measure(FitProblem& problem, const Joint& joint, std::size_t j, std::size_t measure,
                      std::size_t point, double excess, RefinementPlan& plan) {
  const double share = problem.shares[j][measure];
  const bool heavy = problem.settings.noise ? share >= most_share : share > 1;
  if (excess <= (heavy ? 1 : light_joint) || (problem.settings.noise && !heavy)) return;
  double& asked = problem.asked[j][measure];
  asked = excess < helped * asked ? excess : 0;
  if (asked > 0) plan_for_joint(problem.nets, joint, point, excess, plan);
}

/// What of a fit asks for finer nets. Data with noise are followed no closer than λ lets them, and
/// a surface whose residuals the last refinement has hardly changed does not ask again.
RefinementPlan plan_for(FitProblem& problem, const Fit& fit) {
  RefinementPlan plan(problem.given.size());
  const double noise = problem.settings.noise.value_or(0);
  plan_for_residuals(
      problem.nets, problem.points,
      [&](std::size_t k) { return fit.system.residual(k, fit.state.x); },
      noise > 0 ? noise : problem.tolerance, noise, plan);
  problem.excess.resize(plan.size(), never);
  for (std::size_t s = 0; s < plan.size() && noise > 0; ++s) {
    const bool less = plan[s].excess < helped * helped * problem.excess[s];
    problem.excess[s] = less ? plan[s].excess : 0;
    if (!less) plan[s] = {};
  }
  for (std::size_t j = 0; j < fit.joints.size(); ++j) {
    const auto parting = fit.system.parting(j, fit.state.x);
    plan_for_measure(problem, fit.joints[j], j, 0, parting.point,
                     parting.distance / problem.parting, plan);
    plan_for_measure(problem, fit.joints[j], j, 1, fit.angles[j].point,
                     fit.angles[j].degrees / problem.settings.angle, plan);
  }
  return plan;
}

/// Raises the weights of what is near what is wanted or above it, by the square of the ratio
/// (C. Lawson, 1961: weighted least squares that tend to the least largest residual). Least squares
/// alone leave the largest residuals several times the mean, at corners of trimmed regions. Returns
/// whether something that is too large has got more weight. \param last nets stay as they are: the
/// residuals will not become less, and what has to stay together does not wait for them
bool reweigh(FitProblem& problem, const Fit& fit, bool last, bool joints_only) {
  bool result = false;
  const auto raise = [&](double& share, double excess, double most = most_share) {
    if (excess <= near_wanted) return;
    const double before = share;
    const double ratio = excess / near_wanted;
    share = std::min(most, share * std::min(most_raise, ratio * ratio));
    result = result || (excess > 1 && share > before);
  };
  for (std::size_t k = 0; k < problem.points.size() && !problem.settings.noise && !joints_only;
       ++k) {
    raise(problem.points[k].share, fit.system.residual(k, fit.state.x).norm() / problem.tolerance);
  }
  // While nets are too coarse for the data, heavier joints would only stiffen them.
  const bool settled =
      last || problem.settings.noise || fit.state.largest_residual <= settling * problem.tolerance;
  for (std::size_t j = 0; j < fit.joints.size(); ++j) {
    const auto& sides = fit.joints[j].surfaces;
    if (!settled && !problem.nets.stays(sides[0]) && !problem.nets.stays(sides[1])) continue;
    const double angle = fit.angles[j].degrees / problem.settings.angle;
    const double most = last ? most_share_late : most_share;
    const double parting = fit.system.parting(j, fit.state.x).distance / problem.parting;
    const std::array<double, 2> excess = {std::max(angle, parting), angle};
    for (std::size_t measure = 0; measure < 2; ++measure) {
      auto& [least, share] = problem.pressed[j][measure];
      if (excess[measure] <= eased * least) {
        least = excess[measure];
        share = problem.shares[j][measure];
      } else if (problem.shares[j][measure] > in_vain * share) {
        continue;  // that would cost residuals
      }
      raise(problem.shares[j][measure], excess[measure], most);
    }
  }
  return result;
}

/// A measure of a joint, at a point on its first side.
FitExcess excess_at(const FitProblem& problem, FitExcess::Measure measure, const Joint& joint,
                    std::size_t point, double found, double wanted) {
  const auto& at = joint.points[point][0].at;
  const Surface& s = problem.nets.surfaces[static_cast<std::size_t>(joint.surfaces[0])];
  const auto place = evaluate_point<2>(s, at);
  return {measure, joint.surfaces[0], at, place.value_or(Point::Zero()), joint.edge, found, wanted};
}

/// What is above what is wanted, by measure.
void list_excess(const FitProblem& problem, const Fit& fit, FitResult& result) {
  std::vector<std::optional<FitExcess>> worst(problem.given.size());
  for (std::size_t k = 0; k < problem.points.size(); ++k) {
    const FitPoint& point = problem.points[k];
    const double found = fit.system.residual(k, fit.state.x).norm();
    auto& of_surface = worst[static_cast<std::size_t>(point.surface)];
    if (found <= problem.tolerance || (of_surface && found <= of_surface->found)) continue;
    of_surface = FitExcess{FitExcess::Measure::residual,
                           point.surface,
                           point.at,
                           point.place,
                           {},
                           found,
                           problem.tolerance};
  }
  // Of data with noise single residuals are what the noise makes them.
  for (const auto& excess : worst) {
    if (excess && !problem.settings.noise) result.above.push_back(*excess);
  }
  for (std::size_t j = 0; j < fit.joints.size(); ++j) {
    const auto parting = fit.system.parting(j, fit.state.x);
    result.largest_parting = std::max(result.largest_parting, parting.distance);
    if (parting.distance <= problem.parting) continue;
    result.above.push_back(excess_at(problem, FitExcess::Measure::parting, fit.joints[j],
                                     parting.point, parting.distance, problem.parting));
  }
  for (std::size_t j = 0; j < fit.joints.size(); ++j) {
    result.largest_angle = std::max(result.largest_angle, fit.angles[j].degrees);
    if (fit.angles[j].degrees <= problem.settings.angle) continue;
    result.above.push_back(excess_at(problem, FitExcess::Measure::angle, fit.joints[j],
                                     fit.angles[j].point, fit.angles[j].degrees,
                                     problem.settings.angle));
  }
}

int control_points(const FitNets& nets) {
  int result = 0;
  for (const Surface& s : nets.surfaces) result += s.size();
  return result;
}

Expected<FitResult> fit_and_refine(FitProblem& problem) {
  if (auto made = raise_degrees(problem); !made) return std::unexpected(made.error());
  const double most = problem.settings.refinement * control_points(problem.nets);
  if (auto taken = take_knots(problem); !taken) return std::unexpected(taken.error());
  problem.lambda = problem.settings.begin_with_energy.value_or(never);
  const double allowed =
      std::max(problem.parting, problem.settings.allowed_parting.value_or(problem.parting));
  // Without holds residuals settle, and joints need not press before.
  const bool holds = keeps_something(problem);
  const int late_from = holds ? late : most_solves;
  FitResult result{.size = problem.size};
  auto fit = fit_once(problem);
  for (int solve = 1; fit && solve < most_solves + solves_for_joints; ++solve) {
    const bool joints_only = solve >= most_solves;
    if (joints_only && fit->state.largest_parting <= allowed) break;
    for (FitPoint& point : problem.points)
      point.share = joints_only ? std::max(1.0, point.share / 4) : point.share;
    RefinementPlan plan = plan_for(problem, *fit);
    const auto refined = joints_only
                             ? Expected<int>(0)
                             : refine(std::move(plan), static_cast<int>(std::min(most, 1e9)),
                                      problem.given, problem.nets);
    if (!refined) return std::unexpected(refined.error());
    // With a number of rounds that is given the fit is linear in the data: weights stay.
    const bool reweighed = !problem.settings.rounds &&
                           reweigh(problem, *fit, *refined == 0 || solve >= late_from, joints_only);
    if (*refined == 0 && !reweighed) break;
    result.refinements += *refined > 0 ? 1 : 0;
    fit = fit_once(problem);
  }
  if (!fit) return std::unexpected(fit.error());
  result.lambda = fit->lambda;
  result.rounds = fit->state.rounds;
  result.largest_residual = fit->state.largest_residual;
  result.rms_residual = fit->state.rms_residual;
  list_excess(problem, *fit, result);
  result.surfaces = std::move(fit->surfaces);
  return result;
}

}  // namespace

Expected<FitResult> fit_surfaces(std::span<const FitSurface> surfaces,
                                 std::span<const FitEdge> edges, std::span<const Datum> data,
                                 const FitSettings& settings) {
  auto posed = pose_problem(surfaces, edges, data, settings);
  if (!posed) return std::unexpected(posed.error());
  FitProblem& problem = *posed;
  auto plain = affine_result(problem);
  if (!plain) return std::unexpected(plain.error());
  Expected<FitResult> result =
      *plain ? Expected<FitResult>(**std::move(plain)) : fit_and_refine(problem);
  if (!result) return result;
  for (const Surface& s : result->surfaces) result->control_points += s.size();
  result->above.insert(result->above.end(), problem.contradicted.begin(),
                       problem.contradicted.end());
  return result;
}

}  // namespace knead::morph
