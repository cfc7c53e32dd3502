#include "fit_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hold_fading.hpp"
#include "knead/energy/domain_scaling.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "spline/onto_net.hpp"

namespace knead::morph {
namespace {

constexpr int least_degree = 3;
constexpr double default_tolerance = 1e-5, default_parting = 7e-7;  // of the size
constexpr double affine_rest = 1e-13;  // of the size and the data: rounding of an affine map

/// What errors call a surface: its name, or its position in the list.
std::string called(std::span<const FitSurface> surfaces, std::size_t s) {
  return surfaces[s].name.empty() ? fmt::format("surface {}", s) : surfaces[s].name;
}

Expected<void> check(std::span<const FitSurface> surfaces, std::span<const FitEdge> edges,
                     std::span<const Datum> data, const FitSettings& settings) {
  const auto known = [&](int s) { return s >= 0 && s < static_cast<int>(surfaces.size()); };
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (!surfaces[s].surface) return usage_error("there is no surface", called(surfaces, s));
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
      !positive(settings.parting) || !positive(settings.allowed_parting) || !(settings.angle > 0) ||
      !(settings.refinement >= 1) || (settings.rounds && *settings.rounds < 1) ||
      !positive(settings.begin_with_energy)) {
    return input_error("a setting of the fit is out of range", "settings",
                       "lengths, angle and λ are above 0, refinement and rounds at least 1");
  }
  if (!settings.begin_with.empty() && settings.begin_with.size() != surfaces.size())
    return usage_error("there is not one of each surface to begin with", "settings");
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
Expected<void> place_data(std::span<const Datum> data, FitProblem& problem) {
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
    FitExcess worst{.measure = FitExcess::Measure::contradiction, .count = 0};
    if (!places) return std::unexpected(places.error().within(called(problem.given, s)));
    for (std::size_t k = 0; k < on[s].size(); ++k) {
      const Datum& d = data[on[s][k]];
      const Point place = places->points().row(static_cast<Eigen::Index>(k)).transpose();
      if (problem.given[s].fixed) {
        const double found = d.displacement.norm();
        if (found <= problem.tolerance) continue;
        const int count = worst.count + 1;
        if (found > worst.found) {
          worst = {FitExcess::Measure::contradiction,
                   d.surface,
                   d.parameters,
                   place,
                   {},
                   found,
                   problem.tolerance};
        }
        worst.count = count;
        continue;
      }
      const double weight = total > 0 ? problem.units[s].share * d.weight / total : 0;
      problem.points.push_back({d.surface, d.parameters, place, d.displacement, weight});
      problem.points.back().along = d.along;
    }
    if (worst.count > 0) problem.contradicted.push_back(std::move(worst));
  }
  return {};
}

/// Takes the affine part from the data. Where something is fixed, held or kept there is none: it
/// would move that.
Expected<void> take_affine_part(FitProblem& problem) {
  if (!problem.settings.affine || std::ranges::any_of(problem.given, &FitSurface::fixed) ||
      keeps_something(problem))
    return {};
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

}  // namespace

Expected<FitProblem> pose_problem(std::span<const FitSurface> surfaces,
                                  std::span<const FitEdge> edges, std::span<const Datum> data,
                                  const FitSettings& settings) {
  if (auto sound = check(surfaces, edges, data, settings); !sound)
    return std::unexpected(sound.error());
  FitProblem problem{.given = surfaces, .edges = edges, .settings = settings};
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
  if (auto done = fade_at_holds(problem); !done) return std::unexpected(done.error());
  if (auto taken = take_affine_part(problem); !taken) return std::unexpected(taken.error());
  return problem;
}

Expected<void> raise_degrees(FitProblem& problem) {
  for (std::size_t s = 0; s < problem.given.size(); ++s) {
    if (problem.nets.fixed[s]) continue;
    auto net = raised(problem.nets.surfaces[s]);
    if (!net) return std::unexpected(net.error().within(called(problem.given, s)));
    problem.nets.surfaces[s] = *std::move(net);
  }
  return {};
}

Expected<void> take_knots(FitProblem& problem) {
  const auto& from = problem.settings.begin_with;
  for (std::size_t s = 0; s < from.size(); ++s) {
    Surface& net = problem.nets.surfaces[s];
    // What nothing has moved is as it was given.
    if (problem.nets.fixed[s] || from[s].size() <= net.size()) continue;
    auto finer = onto_net(net, from[s]);
    if (!finer) return std::unexpected(finer.error().within(called(problem.given, s)));
    net = *std::move(finer);
  }
  return {};
}

Expected<std::vector<Surface>> moved(const FitProblem& problem, const Points& x) {
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
    if (!made) return std::unexpected(made.error().within(called(problem.given, s)));
    result.push_back(*std::move(made));
  }
  return result;
}

Expected<std::optional<FitResult>> affine_result(FitProblem& problem) {
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

}  // namespace knead::morph
