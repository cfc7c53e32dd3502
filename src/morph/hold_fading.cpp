#include "hold_fading.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/parallel_for.hpp"
#include "hold/held_cells.hpp"
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

/// The polygon through the places of these parameters.
Expected<Hold> hold_through(const Surface& s, const std::vector<std::array<double, 2>>& corners) {
  Parameters<2> at(std::ssize(corners), 2);
  for (Eigen::Index k = 0; k < at.rows(); ++k) {
    const auto& corner = corners[static_cast<std::size_t>(k)];
    at.row(k) << corner[0], corner[1];
  }
  const auto places = evaluate<2>(s, at);
  if (!places) return std::unexpected(places.error());
  Hold result;
  for (Eigen::Index k = 0; k < at.rows(); ++k) {
    result.points.emplace_back(places->points().row(k).transpose());
    result.box.extend(result.points.back());
    const auto j = static_cast<std::size_t>(k);
    if (j > 0) result.length += (result.points[j] - result.points[j - 1]).norm();
  }
  result.jumps.assign(result.points.size(), 0);
  return result;
}

Expected<Hold> hold_of(const FitEdge& edge, const FitProblem& problem) {
  const auto& samples = edge.course ? edge.course->samples() : edge.samples;
  std::size_t k = 0;
  while (!edge.held && problem.nets.fixed[static_cast<std::size_t>(edge.surfaces[k])]) ++k;
  const Surface& s = problem.nets.surfaces[static_cast<std::size_t>(edge.surfaces[k])];
  const std::size_t count = std::min(samples.size() - 1, most_segments);
  std::vector<std::array<double, 2>> corners;
  for (std::size_t j = 0; j <= count; ++j)
    corners.push_back(parameters_at_foot(s, samples[j * (samples.size() - 1) / count].feet[k]));
  return hold_through(s, corners);
}

/// The cells of knots of a surface in which nothing moves: all control points that count there are
/// held.
class HeldCells {
 public:
  HeldCells(const Surface& s, const std::vector<bool>& held) : surface_(s) {
    for (std::size_t d = 0; d < 2; ++d) spans_[d] = s.knots(static_cast<int>(d)).spans();
    for (const Cell& cell : held_cells(s, held)) cells_.insert(cell);
  }

  [[nodiscard]] bool contain(const std::array<double, 2>& at) const {
    return !cells_.empty() && cells_.contains({surface_.knots(0).find_span(at[0]),
                                               surface_.knots(1).find_span(at[1])});
  }

  /// The sides of cells beyond which there is none, each as a polygon of parameters.
  [[nodiscard]] std::vector<std::vector<std::array<double, 2>>> outline() const {
    std::vector<std::vector<std::array<double, 2>>> result;
    for (const auto& cell : cells_) {
      for (std::size_t d = 0; d < 2; ++d) {
        for (const int step : {-1, 1}) {
          if (!cells_.contains(beside(cell, d, step))) result.push_back(side(cell, d, step));
        }
      }
    }
    return result;
  }

 private:
  using Cell = std::array<int, 2>;

  [[nodiscard]] Cell beside(Cell cell, std::size_t d, int step) const {
    const auto at = std::ranges::find(spans_[d], cell[d]) - spans_[d].begin() + step;
    cell[d] = at < 0 || at >= std::ssize(spans_[d]) ? -1 : spans_[d][static_cast<std::size_t>(at)];
    return cell;
  }
  [[nodiscard]] std::vector<std::array<double, 2>> side(const Cell& cell, std::size_t d,
                                                        int step) const {
    constexpr int parts = 4;
    const KnotVector &across = surface_.knots(static_cast<int>(d)),
                     &along = surface_.knots(static_cast<int>(1 - d));
    const double from = along[cell[1 - d]], to = along[cell[1 - d] + 1];
    std::vector<std::array<double, 2>> result(parts + 1);
    for (int k = 0; k <= parts; ++k) {
      auto& corner = result[static_cast<std::size_t>(k)];
      corner[d] = across[step < 0 ? cell[d] : cell[d] + 1];
      corner[1 - d] = k == parts ? to : from + (to - from) * k / parts;
    }
    return result;
  }

  const Surface& surface_;
  std::array<std::vector<int>, 2> spans_;
  std::set<Cell> cells_;
};

/// What surfaces keep of themselves: lines and points, and the outlines of where nothing moves.
Expected<void> add_kept_places(const FitProblem& problem, const std::vector<HeldCells>& cells,
                               std::vector<Hold>& holds) {
  for (std::size_t s = 0; s < problem.given.size(); ++s) {
    if (!problem.given[s].holds || problem.nets.fixed[s]) continue;
    auto lines = cells[s].outline();
    const auto& places = problem.given[s].holds->places;
    lines.insert(lines.end(), places.begin(), places.end());
    for (const auto& line : lines) {
      auto hold = hold_through(problem.nets.surfaces[s], line);
      if (!hold) return std::unexpected(hold.error());
      holds.push_back(*std::move(hold));
    }
  }
  return {};
}

/// Of each surface; none where nothing is kept.
Expected<std::vector<HeldCells>> cells_of(const FitProblem& problem) {
  std::vector<HeldCells> result;
  for (std::size_t s = 0; s < problem.given.size(); ++s) {
    const Surface& shape = problem.nets.surfaces[s];
    std::vector<bool> held(static_cast<std::size_t>(shape.size()));
    if (problem.given[s].holds && !problem.nets.fixed[s]) {
      auto kept = problem.given[s].holds->conditions(shape);
      if (!kept) return std::unexpected(kept.error());
      held = std::move(kept->held);
    }
    result.emplace_back(shape, held);
  }
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

/// w² |x − y|⁻² of a point alone.
double potential(const Point& y, const Point& x) {
  return 1 / std::max((x - y).squaredNorm(), std::numeric_limits<double>::min());
}

/// φ at a point, or less if no datum there can fade out.
double nearness(std::span<const Hold> holds, const Point& x) {
  double most = 0;
  for (const Hold& hold : holds) {
    const double distance = hold.box.exteriorDistance(x), wide = width * hold.largest;
    const double by_length = hold.points.size() > 1 ? hold.length / (2 * distance) : 1;
    most += distance > 0 ? wide * wide * by_length / (distance * distance) : 2;
  }
  if (most <= 1) return 0;
  double result = 0;
  for (const Hold& hold : holds) {
    if (hold.points.size() == 1) {
      const double wide = width * hold.largest;
      result += wide * wide * potential(hold.points[0], x);
    }
    for (std::size_t j = 1; j < hold.points.size(); ++j) {
      const double wide = width * (hold.jumps[j - 1] + hold.jumps[j]) / 2;
      if (wide > 0) result += wide * wide / 2 * potential(hold.points[j - 1], hold.points[j], x);
    }
  }
  return result;
}

double left_of(double nearness) {
  const double t = 1 / std::sqrt(nearness);
  return t * t * t * (10 + t * (6 * t - 15));
}

}  // namespace

bool keeps_something(const FitProblem& problem) {
  const auto held = [&](const FitEdge& edge) { return is_held(edge, problem.nets.fixed); };
  return std::ranges::any_of(problem.edges, held) ||
         std::ranges::any_of(problem.given, [](const FitSurface& s) { return s.holds != nullptr; });
}

bool is_held(const FitEdge& edge, const std::vector<bool>& fixed) {
  const auto is_fixed = [&](int s) { return fixed[static_cast<std::size_t>(s)]; };
  return !std::ranges::all_of(edge.surfaces, is_fixed) &&
         (edge.held || std::ranges::any_of(edge.surfaces, is_fixed));
}

Expected<void> fade_at_holds(FitProblem& problem) {
  if (!keeps_something(problem)) return {};
  const auto cells = cells_of(problem);
  if (!cells) return std::unexpected(cells.error());
  std::vector<Hold> holds;
  if (auto added = add_kept_places(problem, *cells, holds); !added) return added;
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
  std::vector<double> left(problem.points.size(), 1);
  const auto count = std::ssize(left);
  detail::parallel_for(
      count, detail::block_size(count, work), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
          const FitPoint& datum = problem.points[k];
          const double near = nearness(holds, datum.place);
          if (near > 1) left[k] = left_of(near);
          if ((*cells)[static_cast<std::size_t>(datum.surface)].contain(datum.at)) left[k] = 0;
        }
      });
  std::map<int, FitExcess> worst;
  for (std::size_t k = 0; k < left.size(); ++k) {
    FitPoint& datum = problem.points[k];
    const double found = (1 - left[k]) * datum.wanted.norm();
    datum.wanted *= left[k];
    datum.faded = left[k] < 1;  // where nothing moves at all too
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
