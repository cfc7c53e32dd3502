#include "hold_fading.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/parallel_for.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::morph {
namespace {

constexpr double width = 8;        // of the zone in which data fade out, over what contradicts
constexpr double steepest = 0.25;  // growth of displacements per length that is no contradiction
constexpr double beside = 2;       // data count up to so many times the distance of the nearest one
constexpr double deviations = 6;   // of noise, that contradict nothing
constexpr std::size_t most_segments = 64;  // of an edge
constexpr double work = 1000;              // for a datum or a point of an edge

/// A held edge as a polygon, and by how much data contradict it at its corners.
struct Hold {
  std::vector<Point> points;
  std::vector<double> jumps;
  Eigen::AlignedBox3d box;
  double length = 0, largest = 0;  ///< of `jumps`
};

Expected<Hold> hold_of(const FitEdge& edge, const FitProblem& problem) {
  const auto& samples = edge.course ? edge.course->samples() : edge.samples;
  std::size_t k = 0;
  while (!edge.held && problem.nets.fixed[static_cast<std::size_t>(edge.surfaces[k])]) ++k;
  const Surface& s = problem.nets.surfaces[static_cast<std::size_t>(edge.surfaces[k])];
  const std::size_t count = std::min(samples.size() - 1, most_segments);
  Parameters<2> at(static_cast<Eigen::Index>(count + 1), 2);
  for (std::size_t j = 0; j <= count; ++j) {
    const auto u = parameters_at_foot(s, samples[j * (samples.size() - 1) / count].feet[k]);
    at.row(static_cast<Eigen::Index>(j)) << u[0], u[1];
  }
  const auto places = evaluate<2>(s, at);
  if (!places) return std::unexpected(places.error());
  Hold result;
  for (std::size_t j = 0; j <= count; ++j) {
    result.points.emplace_back(places->points().row(static_cast<Eigen::Index>(j)).transpose());
    result.box.extend(result.points.back());
    if (j > 0) result.length += (result.points[j] - result.points[j - 1]).norm();
  }
  result.jumps.assign(count + 1, 0);
  return result;
}

/// Finds what contradicts an edge. \param margin displacements that are none
void find_jumps(std::span<const FitPoint> data, double margin, Hold& hold) {
  const auto excess = [&](const FitPoint& datum, const Point& y) {
    return datum.wanted.norm() - margin - steepest * (datum.place - y).norm();
  };
  for (std::size_t j = 0; j < hold.points.size(); ++j) {
    const Point& y = hold.points[j];
    double near = std::numeric_limits<double>::infinity();
    for (const FitPoint& datum : data) near = std::min(near, (datum.place - y).squaredNorm());
    for (const FitPoint& datum : data) {
      if ((datum.place - y).squaredNorm() <= beside * beside * near)
        hold.jumps[j] = std::max(hold.jumps[j], excess(datum, y));
    }
    hold.largest = std::max(hold.largest, hold.jumps[j]);
  }
}

/// ∫ |x − y|⁻³ dy over a segment.
double potential(const Point& a, const Point& b, const Point& x) {
  const double length = (b - a).norm();
  if (!(length > 0)) return 0;
  const Point along = (b - a) / length;
  const double from = (a - x).dot(along), to = from + length;
  // On the segment itself it is infinite: a large number that is right at 1e-6 of its length.
  const double square = std::max((a - x + -from * along).squaredNorm(), 1e-12 * length * length);
  return (to / std::sqrt(square + to * to) - from / std::sqrt(square + from * from)) / square;
}

/// φ at a point, or less if no datum there can fade out.
double nearness(std::span<const Hold> holds, const Point& x) {
  double most = 0;
  for (const Hold& hold : holds) {
    const double distance = hold.box.exteriorDistance(x), wide = width * hold.largest;
    most += distance > 0 ? wide * wide * hold.length / (2 * distance * distance * distance) : 2;
  }
  if (most <= 1) return 0;
  double result = 0;
  for (const Hold& hold : holds) {
    for (std::size_t j = 1; j < hold.points.size(); ++j) {
      const double wide = width * (hold.jumps[j - 1] + hold.jumps[j]) / 2;
      if (wide > 0) result += wide * wide / 2 * potential(hold.points[j - 1], hold.points[j], x);
    }
  }
  return result;
}

double faded(double nearness) {
  const double t = 1 / std::sqrt(nearness);
  return t * t * t * (10 + t * (6 * t - 15));
}

}  // namespace

bool is_held(const FitEdge& edge, const std::vector<bool>& fixed) {
  const auto is_fixed = [&](int s) { return fixed[static_cast<std::size_t>(s)]; };
  return !std::ranges::all_of(edge.surfaces, is_fixed) &&
         (edge.held || std::ranges::any_of(edge.surfaces, is_fixed));
}

Expected<void> fade_at_holds(FitProblem& problem) {
  std::vector<Hold> holds;
  for (const FitEdge& edge : problem.edges) {
    if (!is_held(edge, problem.nets.fixed)) continue;
    auto hold = hold_of(edge, problem);
    if (!hold) return std::unexpected(hold.error());
    holds.push_back(*std::move(hold));
  }
  const double margin =
      std::max(problem.tolerance, deviations * problem.settings.noise.value_or(0));
  detail::parallel_for(std::ssize(holds), 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
      find_jumps(problem.points, margin, holds[k]);
  });
  std::erase_if(holds, [](const Hold& hold) { return hold.largest == 0; });
  if (holds.empty()) return {};
  std::vector<double> left(problem.points.size(), 1);
  const auto count = std::ssize(left);
  detail::parallel_for(
      count, detail::block_size(count, work), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
          const double near = nearness(holds, problem.points[k].place);
          if (near > 1) left[k] = faded(near);
        }
      });
  std::map<int, FitExcess> worst;
  for (std::size_t k = 0; k < left.size(); ++k) {
    FitPoint& datum = problem.points[k];
    const double found = (1 - left[k]) * datum.wanted.norm();
    datum.wanted *= left[k];
    datum.faded = left[k] < 1;
    if (found <= problem.tolerance) continue;
    FitExcess& excess = worst[datum.surface];
    const int number = excess.count + (excess.found > 0 ? 1 : 0);
    if (found > excess.found) {
      excess = {FitExcess::Measure::contradiction,
                datum.surface,
                datum.at,
                datum.place,
                {},
                found,
                problem.tolerance};
    }
    excess.count = number;
  }
  for (auto& [surface, excess] : worst) problem.contradicted.push_back(std::move(excess));
  return {};
}

}  // namespace knead::morph
