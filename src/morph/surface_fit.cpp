#include "surface_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "affine_part.hpp"
#include "fit_refinement.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/spline_refinement.hpp"

namespace knead::morph {
namespace {

constexpr int least_degree = 3;
constexpr double default_tolerance = 1e-5, default_parting = 1e-6;  // of the size
constexpr double exact_lambda = 1e-7, first_lambda = 1e-2, least_lambda = 1e-8;
constexpr int most_rounds = 30, most_refinements = 8;
constexpr double stalled = 0.97;       // a solve that leaves more than this is the last one
constexpr double affine_rest = 1e-13;  // of the size and the data: rounding of an affine map

/// What all parts of a fit need to know.
struct Problem {
  std::span<const FitSurface> given;
  std::span<const FitEdge> edges;
  FitSettings settings;
  double size = 0, tolerance = 0, parting = 0;
  std::vector<FitUnits> units = {};
  std::vector<FitPoint> points = {};  ///< on free surfaces; wanted: what the affine part leaves
  std::vector<FitExcess> contradicted = {};  ///< data on fixed surfaces
  AffinePart affine = {};
  FitNets nets = {};

  [[nodiscard]] bool satisfied(const FitState& state) const {
    return state.largest_residual <= tolerance && state.largest_parting <= parting;
  }
};

Expected<void> check(std::span<const FitSurface> surfaces, std::span<const FitEdge> edges,
                     std::span<const Datum> data, const FitSettings& settings) {
  const auto known = [&](int s) { return s >= 0 && s < static_cast<int>(surfaces.size()); };
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (!surfaces[s].surface)
      return usage_error("there is no surface", fmt::format("surface {}", s));
  }
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const FitEdge& edge = edges[k];
    const std::string at = fmt::format("edge {}", k);
    const auto& samples = edge.course ? edge.course->samples() : edge.samples;
    if (samples.size() < 2) return usage_error("it has fewer than two samples", at);
    for (const auto& sample : samples) {
      if (sample.feet.size() != edge.surfaces.size())
        return usage_error("a sample does not have a foot on each of its surfaces", at);
    }
    if (!std::ranges::all_of(edge.surfaces, known))
      return input_error("it names a surface that does not exist", at);
  }
  for (std::size_t k = 0; k < data.size(); ++k) {
    const Datum& d = data[k];
    const std::string at = fmt::format("datum {}", k);
    if (!known(d.surface)) return input_error("it names a surface that does not exist", at);
    if (!d.displacement.allFinite() || !(d.weight >= 0) || !std::isfinite(d.weight)) {
      return input_error("its displacement or weight is not a finite number", at,
                         "leave it out, or give it a weight of 0 or more");
    }
    for (int c = 0; c < 2; ++c) {
      const auto& knots = surfaces[static_cast<std::size_t>(d.surface)].surface->knots(c);
      if (auto in = detail::check_parameter(knots, d.parameters[static_cast<std::size_t>(c)],
                                            c == 0 ? "u" : "v");
          !in)
        return std::unexpected(in.error().within(at));
    }
  }
  const auto positive = [](const std::optional<double>& x) {
    return !x || (std::isfinite(*x) && *x > 0);
  };
  if (!positive(settings.tolerance) || !positive(settings.noise) || !positive(settings.energy) ||
      !positive(settings.parting) || !(settings.angle > 0) || !(settings.refinement >= 1) ||
      (settings.rounds && *settings.rounds < 1)) {
    return input_error("a setting of the fit is out of range", "settings",
                       "lengths, angle and λ are above 0, refinement and rounds at least 1");
  }
  return {};
}

/// The diagonal of the box of what is visible: the edges of surfaces that have some, the nets of
/// the others.
double size_of(std::span<const FitSurface> surfaces) {
  Eigen::AlignedBox3d box;
  for (const FitSurface& s : surfaces) {
    for (const TrimEdge& edge : s.region.edges) {
      for (const Point& p : edge.points) box.extend(p);
    }
    if (!s.region.edges.empty()) continue;
    for (int k = 0; k < s.surface->size(); ++k)
      box.extend(Point(s.surface->control_points().row(k).transpose()));
  }
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

/// Points, lines and slivers have no scaling: their energy is that of the domain as a unit square,
/// of the least share, and data and edges move them.
FitUnits units_of(const Surface& s, double size) {
  const auto scaling = normalised_scaling<2>(s);
  if (!scaling) {
    return {{1 / s.knots(0).domain().length(), 1 / s.knots(1).domain().length()}, least_share};
  }
  const double side = scaling->length / size;
  return {scaling->factors, std::max(least_share, side * side)};
}

/// Evaluates the places of the data of every surface, and shares its weight among them.
Expected<void> place_data(std::span<const Datum> data, Problem& problem) {
  std::vector<std::vector<std::size_t>> on(problem.given.size());
  for (std::size_t k = 0; k < data.size(); ++k)
    on[static_cast<std::size_t>(data[k].surface)].push_back(k);
  for (std::size_t s = 0; s < on.size(); ++s) {
    Parameters<2> at(static_cast<Eigen::Index>(on[s].size()), 2);
    double total = 0;
    for (std::size_t k = 0; k < on[s].size(); ++k) {
      const Datum& d = data[on[s][k]];
      at.row(static_cast<Eigen::Index>(k)) << d.parameters[0], d.parameters[1];
      total += d.weight;
    }
    const auto places = evaluate<2>(*problem.given[s].surface, at);
    if (!places) return std::unexpected(places.error().within(fmt::format("surface {}", s)));
    for (std::size_t k = 0; k < on[s].size(); ++k) {
      const Datum& d = data[on[s][k]];
      const Point place = places->points().row(static_cast<Eigen::Index>(k)).transpose();
      if (problem.given[s].fixed) {
        const double found = d.displacement.norm();
        if (found > problem.tolerance) {
          problem.contradicted.push_back({FitExcess::Measure::contradiction,
                                          d.surface,
                                          d.parameters,
                                          place,
                                          {},
                                          found,
                                          problem.tolerance});
        }
        continue;
      }
      const double weight = total > 0 ? problem.units[s].share * d.weight / total : 0;
      problem.points.push_back({d.surface, d.parameters, place, d.displacement, weight});
    }
  }
  return {};
}

/// Takes the affine part from the data. With fixed surfaces there is none: it would move them.
Expected<void> take_affine_part(Problem& problem) {
  if (std::ranges::any_of(problem.given, &FitSurface::fixed)) return {};
  const auto n = static_cast<Eigen::Index>(problem.points.size());
  Points places(n, 3), displacements(n, 3);
  std::vector<double> weights;
  for (Eigen::Index k = 0; k < n; ++k) {
    const FitPoint& point = problem.points[static_cast<std::size_t>(k)];
    places.row(k) = point.place.transpose();
    displacements.row(k) = point.wanted.transpose();
    weights.push_back(point.weight);
  }
  const auto affine = best_affine(places, displacements, weights);
  if (!affine) return std::unexpected(affine.error());
  problem.affine = *affine;
  for (FitPoint& point : problem.points) point.wanted -= affine->at(point.place);
  return {};
}

/// Clamped, and of degree 3 at least.
Expected<Surface> raised(const Surface& surface) {
  Surface result = surface;
  if (!surface.knots(0).clamped() || !surface.knots(1).clamped()) {
    auto clamped = with_clamped_ends(surface);
    if (!clamped) return clamped;
    result = *std::move(clamped);
  }
  for (int d = 0; d < 2; ++d) {
    const int times = least_degree - result.knots(d).degree();
    if (times <= 0) continue;
    auto made = elevate_degree<2>(result, d, times);
    if (!made) return made;
    result = *std::move(made);
  }
  return result;
}

/// The surfaces moved by X and the affine part; fixed ones, and those that nothing moves, are the
/// ones given.
Expected<std::vector<Surface>> moved(const Problem& problem, const Points& x) {
  std::vector<Surface> result;
  for (std::size_t s = 0; s < problem.given.size(); ++s) {
    const Surface& net = problem.nets.surfaces[s];
    Points displacement = problem.nets.of_surface(static_cast<int>(s), x);
    for (int k = 0; k < net.size() && !problem.nets.fixed[s]; ++k) {
      displacement.row(k) += problem.affine.at(net.control_points().row(k).transpose()).transpose();
    }
    if (displacement.isZero(0)) {
      result.push_back(*problem.given[s].surface);
      continue;
    }
    auto made = net.with_control_points(net.control_points() + displacement);
    if (!made) return std::unexpected(made.error().within(fmt::format("surface {}", s)));
    result.push_back(*std::move(made));
  }
  return result;
}

/// The joints of the nets as they are.
Expected<std::vector<Joint>> joints_of(const Problem& problem) {
  std::vector<Joint> joints = joints_of_edges(problem.edges, problem.nets);
  auto lines = joints_of_lines(problem.nets);
  if (!lines) return lines;
  for (Joint& line : *lines) joints.push_back(std::move(line));
  std::erase_if(joints, [&](const Joint& joint) {
    return problem.nets.fixed[static_cast<std::size_t>(joint.surfaces[0])] &&
           problem.nets.fixed[static_cast<std::size_t>(joint.surfaces[1])];
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

Expected<FitState> solve_exact(const Problem& problem, const FitSystem& system, double lambda) {
  FitState before;
  return system.solve(lambda, [&](const FitState& state) {
    if (problem.settings.rounds) return state.rounds >= *problem.settings.rounds;
    if (problem.satisfied(state) || state.rounds >= most_rounds) return true;
    const bool little = state.rounds > 1 && state.rms_residual > stalled * before.rms_residual &&
                        state.largest_parting > stalled * before.largest_parting;
    before = state;
    return little;
  });
}

/// Root mean square of the residuals of data with noise, whose fit has taken up a part of it.
double expected_rms(const Problem& problem) {
  const double free =
      1 - static_cast<double>(problem.nets.unknowns) / static_cast<double>(problem.points.size());
  constexpr double least_free = 0.25;  // smooth displacements have less freedom than unknowns
  return *problem.settings.noise * std::sqrt(3 * std::max(free, least_free));
}

/// The largest λ of a sequence whose residuals are of the size of the noise (Morozov's discrepancy
/// principle).
Expected<FitState> solve_noisy(const Problem& problem, const FitSystem& system, double& lambda) {
  constexpr int rounds = 3;
  const double target = expected_rms(problem);
  for (;; lambda /= 10) {
    auto state = system.solve(lambda, [&](const FitState& now) {
      return now.rounds >= problem.settings.rounds.value_or(rounds) || now.rms_residual <= target;
    });
    if (!state || state->rms_residual <= target || problem.settings.energy ||
        lambda < 2 * least_lambda)
      return state;
  }
}

Expected<Fit> fit_once(Problem& problem) {
  problem.nets.number(problem.given);
  sort_by_cells(problem.nets, problem.points);
  auto joints = joints_of(problem);
  if (!joints) return std::unexpected(joints.error());
  auto system =
      FitSystem::create(problem.nets, problem.points, *joints, problem.units, problem.size);
  if (!system) return std::unexpected(system.error());
  const bool noisy = problem.settings.noise.has_value();
  double lambda = problem.settings.energy.value_or(noisy ? first_lambda : exact_lambda);
  auto state =
      noisy ? solve_noisy(problem, *system, lambda) : solve_exact(problem, *system, lambda);
  if (!state) return std::unexpected(state.error());
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

/// What of a fit asks for finer nets.
RefinementPlan plan_for(const Problem& problem, const Fit& fit) {
  RefinementPlan plan(problem.given.size());
  const double noise = problem.settings.noise.value_or(0);
  if (noise == 0 || fit.state.rms_residual > expected_rms(problem)) {
    plan_for_residuals(
        problem.nets, problem.points,
        [&](std::size_t k) { return fit.system.residual(k, fit.state.x); },
        noise > 0 ? noise : problem.tolerance, noise, plan);
  }
  for (std::size_t j = 0; j < fit.joints.size(); ++j) {
    const auto parting = fit.system.parting(j, fit.state.x);
    if (parting.distance > problem.parting) {
      plan_for_joint(problem.nets, fit.joints[j], parting.point, parting.distance / problem.parting,
                     plan);
    }
    if (fit.angles[j].degrees > problem.settings.angle) {
      plan_for_joint(problem.nets, fit.joints[j], fit.angles[j].point,
                     fit.angles[j].degrees / problem.settings.angle, plan);
    }
  }
  return plan;
}

/// A measure of a joint, at a point on its first side.
FitExcess excess_at(const Problem& problem, FitExcess::Measure measure, const Joint& joint,
                    std::size_t point, double found, double wanted) {
  const auto& at = joint.points[point][0].at;
  const Surface& s = problem.nets.surfaces[static_cast<std::size_t>(joint.surfaces[0])];
  const auto place = evaluate_point<2>(s, at);
  return {measure, joint.surfaces[0], at, place.value_or(Point::Zero()), joint.edge, found, wanted};
}

/// What is above what is wanted, by measure.
void list_excess(const Problem& problem, const Fit& fit, FitResult& result) {
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

/// Nothing to do but the affine map, or nothing at all: the nets stay.
Expected<std::optional<FitResult>> without_fit(Problem& problem) {
  double largest = 0, squares = 0, data = 0;
  for (const FitPoint& point : problem.points) {
    largest = std::max(largest, point.wanted.norm());
    squares += point.wanted.squaredNorm();
    data = std::max(data, (point.wanted + problem.affine.at(point.place)).norm());
  }
  if (largest > affine_rest * (data > 0 ? problem.size + data : 0)) return std::nullopt;
  problem.nets.number(problem.given);
  auto surfaces = moved(problem, Points::Zero(problem.nets.unknowns, 3));
  if (!surfaces) return std::unexpected(surfaces.error());
  FitResult result{.surfaces = *std::move(surfaces), .size = problem.size};
  result.largest_residual = largest;
  result.rms_residual =
      std::sqrt(squares / static_cast<double>(std::max<std::size_t>(problem.points.size(), 1)));
  return result;
}

int control_points(const FitNets& nets) {
  int result = 0;
  for (const Surface& s : nets.surfaces) result += s.size();
  return result;
}

Expected<FitResult> fit_and_refine(Problem& problem) {
  for (std::size_t s = 0; s < problem.given.size(); ++s) {
    if (problem.nets.fixed[s]) continue;
    auto net = raised(problem.nets.surfaces[s]);
    if (!net) return std::unexpected(net.error().within(fmt::format("surface {}", s)));
    problem.nets.surfaces[s] = *std::move(net);
  }
  const double most = problem.settings.refinement * control_points(problem.nets);
  FitResult result{.size = problem.size};
  auto fit = fit_once(problem);
  while (fit && result.refinements < most_refinements) {
    const auto refined =
        refine(plan_for(problem, *fit), static_cast<int>(std::min(most, 1e9)), problem.nets);
    if (!refined) return std::unexpected(refined.error());
    if (*refined == 0) break;
    ++result.refinements;
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
  if (auto sound = check(surfaces, edges, data, settings); !sound)
    return std::unexpected(sound.error());
  Problem problem{.given = surfaces, .edges = edges, .settings = settings};
  problem.size = size_of(surfaces);
  if (!(problem.size > 0)) return input_error("the surfaces have no extent", "surfaces");
  problem.tolerance = settings.tolerance.value_or(default_tolerance * problem.size);
  problem.parting = settings.parting.value_or(default_parting * problem.size);
  for (const FitSurface& s : surfaces) {
    problem.units.push_back(units_of(*s.surface, problem.size));
    problem.nets.surfaces.push_back(*s.surface);
    problem.nets.fixed.push_back(s.fixed);
  }
  if (auto placed = place_data(data, problem); !placed) return std::unexpected(placed.error());
  if (problem.points.empty()) {
    return input_error("no datum lies on a surface that is free to move", "data",
                       "give data on such surfaces, or let more of them move");
  }
  if (auto taken = take_affine_part(problem); !taken) return std::unexpected(taken.error());
  auto plain = without_fit(problem);
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
