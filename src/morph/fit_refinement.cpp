#include "fit_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "knead/spline/spline_refinement.hpp"

namespace knead::morph {
namespace {
constexpr double least_span = 1e-3;  // of the domain
constexpr double same_knot = 1e-9;   // likewise
constexpr int most_parts = 4;
constexpr double second_part = 0.8;  // of what is wanted, of the direction with the lesser part
constexpr std::size_t least_points =
    8;  // of a cell: fewer say nothing of its halves, faded ones do

struct Cell {
  int surface = 0;
  std::array<int, 2> spans = {};
  friend auto operator<=>(const Cell&, const Cell&) = default;
};

Cell cell_of(const FitNets& nets, const FitPoint& point) {
  const Surface& s = nets.surfaces[static_cast<std::size_t>(point.surface)];
  return {point.surface, {s.knots(0).find_span(point.at[0]), s.knots(1).find_span(point.at[1])}};
}

/// P_n(t), by Bonnet's recursion.
double legendre(int n, double t) {
  double before = 1, now = t;
  for (int k = 1; k < n; ++k)
    before = std::exchange(now, ((2 * k + 1) * t * now - k * before) / (k + 1));
  return n == 0 ? 1 : now;
}

/// Where a parameter lies in a span, from −1 to 1.
double within(const KnotVector& knots, int span, double u) {
  return 2 * (u - knots[span]) / (knots[span + 1] - knots[span]) - 1;
}

/// The size of the part of the residuals of a cell that P_{p+1} in each direction explains, file
/// units, and the largest residual.
struct CellError {
  std::array<double, 2> part = {};
  std::array<double, 2> deviation = {};  ///< of a part by noise of deviation 1 in each coordinate
  double largest = 0;
};
CellError error_in(const Surface& s, const Cell& cell, std::span<const FitPoint> points,
                   const std::function<Point(std::size_t)>& residual, std::size_t first) {
  CellError result;
  std::array<std::array<Point, 2>, 2> sums;
  std::array<std::array<double, 2>, 2> norms = {};
  for (auto& of_direction : sums) of_direction.fill(Point::Zero());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point r = residual(first + k);
    result.largest = std::max(result.largest, r.norm());
    const std::array<double, 2> t = {within(s.knots(0), cell.spans[0], points[k].at[0]),
                                     within(s.knots(1), cell.spans[1], points[k].at[1])};
    for (std::size_t d = 0; d < 2; ++d) {
      const double p = legendre(s.knots(static_cast<int>(d)).degree() + 1, t[d]);
      for (std::size_t other = 0; other < 2; ++other) {
        const double shape = other == 0 ? p : p * t[1 - d];
        sums[d][other] += shape * r;
        norms[d][other] += shape * shape;
      }
    }
  }
  for (std::size_t d = 0; d < 2; ++d) {
    for (std::size_t other = 0; other < 2; ++other) {
      if (!(norms[d][other] > 0)) continue;
      result.part[d] += sums[d][other].norm() / norms[d][other];
      result.deviation[d] += std::sqrt(3 / norms[d][other]);
    }
  }
  return result;
}

void ask(SurfaceRefinement& surface, std::size_t direction, int span, int parts, double urgency) {
  SpanRefinement& now = surface.spans[direction][span];
  now = {std::max(now.parts, parts), std::max(now.urgency, urgency)};
  surface.urgency = std::max(surface.urgency, urgency);
}

/// A span that is to be divided.
struct AskedSpan {
  std::size_t direction = 0;
  int span = 0;
  SpanRefinement how = {};
};

/// The most urgent first; of equal ones in the order of directions and spans.
std::vector<AskedSpan> by_urgency(const SurfaceRefinement& surface) {
  std::vector<AskedSpan> result;
  for (std::size_t d = 0; d < 2; ++d) {
    for (const auto& [span, how] : surface.spans[d]) result.push_back({d, span, how});
  }
  std::ranges::stable_sort(result, std::greater{},
                           [](const AskedSpan& asked) { return asked.how.urgency; });
  return result;
}

/// New knots in each direction, at most so many control points with them.
using NewKnots = std::array<std::vector<double>, 2>;
int size_with(const Surface& s, const NewKnots& inserted) {
  const auto net = s.net();
  return (net[0] + static_cast<int>(inserted[0].size())) *
         (net[1] + static_cast<int>(inserted[1].size()));
}

NewKnots knots_in(const Surface& s, std::span<const AskedSpan> asked, int most_parts_now,
                  int most) {
  NewKnots inserted;
  for (const auto& [d, span, how] : asked) {
    const KnotVector& knots = s.knots(static_cast<int>(d));
    const double a = knots[span], b = knots[span + 1];
    const double fits = (b - a) / (least_span * knots.domain().length());
    const int parts = std::min(how.parts, most_parts_now);
    const std::size_t before = inserted[d].size();
    for (int j = 1; j < std::min<double>(parts, fits); ++j)
      inserted[d].push_back(std::lerp(a, b, double(j) / parts));
    if (size_with(s, inserted) > most) inserted[d].resize(before);
  }
  for (auto& knots : inserted) std::ranges::sort(knots);
  return inserted;
}

/// All that is asked for if that is no more than `most` control points, else what is possible.
NewKnots knots_for(const Surface& s, const SurfaceRefinement& surface, int most) {
  const auto asked = by_urgency(surface);
  const NewKnots all = knots_in(s, asked, most_parts, std::numeric_limits<int>::max());
  return size_with(s, all) <= most ? all : knots_in(s, asked, 2, most);
}

/// What is asked of spans is asked of their mirror images too.
void mirror(const KnotVector& knots, std::map<int, SpanRefinement>& asked) {
  const auto before = asked;
  for (const auto& [span, refinement] : before) {
    SpanRefinement& image = asked[knots.count() + knots.degree() - 1 - span];
    image.parts = std::max(image.parts, refinement.parts);
    image.urgency = std::max(image.urgency, refinement.urgency);
  }
}

/// Takes away knots without a mirror image, and makes the others symmetric to the last bit.
void make_symmetric(const Interval& domain, std::vector<double>& inserted) {
  const std::vector<double> before = inserted;
  const double sum = domain.lower + domain.upper;
  std::vector<double> result;
  for (const double u : before) {
    const bool paired = std::ranges::any_of(before, [&](double other) {
      return std::abs(other - (sum - u)) <= same_knot * domain.length();
    });
    if (!paired || u > sum / 2 + same_knot * domain.length()) continue;
    result.push_back(u);
    if (u < sum / 2 - same_knot * domain.length()) result.push_back(sum - u);
  }
  std::ranges::sort(result);
  inserted = std::move(result);
}

}  // namespace

void sort_by_cells(const FitNets& nets, std::vector<FitPoint>& points) {
  std::vector<std::pair<Cell, std::size_t>> order;
  order.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) order.emplace_back(cell_of(nets, points[k]), k);
  std::ranges::sort(order);
  std::vector<FitPoint> sorted;
  sorted.reserve(points.size());
  for (const auto& [cell, k] : order) sorted.push_back(points[k]);
  points = std::move(sorted);
}

void plan_for_residuals(const FitNets& nets, std::span<const FitPoint> points,
                        const std::function<Point(std::size_t)>& residual, double wanted,
                        double noise, RefinementPlan& plan) {
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    const Cell cell = cell_of(nets, points[begin]);
    while (end < points.size() && cell_of(nets, points[end]) == cell) ++end;
    const auto surface = static_cast<std::size_t>(cell.surface);
    const std::span<const FitPoint> within = points.subspan(begin, end - begin);
    const bool faded = std::ranges::any_of(within, &FitPoint::faded);
    if (nets.fixed[surface] || (within.size() < least_points && !faded)) continue;
    const Surface& s = nets.surfaces[surface];
    const CellError error = error_in(s, cell, within, residual, begin);
    // Of exact data the largest residual counts, shared out by the parts; of others the parts.
    const double sum = error.part[0] + error.part[1];
    const double scale = noise > 0 || sum == 0 ? 1 : error.largest / sum;
    if (noise == 0 && error.largest <= wanted) continue;
    for (std::size_t d = 0; d < 2; ++d) {
      const double found = scale * error.part[d];
      const double least =
          error.part[d] >= error.part[1 - d] && noise == 0 ? 0 : second_part * wanted;
      if (found <= std::max(least, 3 * noise * error.deviation[d])) continue;
      const int degree = s.knots(static_cast<int>(d)).degree();
      const double parts = std::floor(std::pow(found / wanted, 1.0 / (degree + 1)));
      ask(plan[surface], d, cell.spans[d], std::clamp(static_cast<int>(parts), 2, most_parts),
          found / wanted);
      plan[surface].excess += static_cast<double>(within.size()) * std::pow(found / wanted, 2);
    }
  }
}

void plan_for_joint(const FitNets& nets, const Joint& joint, std::size_t point, double urgency,
                    RefinementPlan& plan) {
  const std::size_t next = point + 1 < joint.points.size() ? point + 1 : point - 1;
  constexpr double along = 0.1;  // of the larger change of a parameter, in spans
  const bool held = nets.stays(joint.surfaces[0]) || nets.stays(joint.surfaces[1]);
  for (std::size_t side = 0; side < 2; ++side) {
    if (nets.stays(joint.surfaces[side])) continue;
    const auto surface = static_cast<std::size_t>(joint.surfaces[side]);
    const Surface& s = nets.surfaces[surface];
    std::array<double, 2> change = {};
    std::array<int, 2> spans = {};
    for (std::size_t d = 0; d < 2; ++d) {
      const KnotVector& knots = s.knots(static_cast<int>(d));
      const double u = joint.points[point][side].at[d];
      spans[d] = knots.find_span(u, joint.sides[side]);
      change[d] =
          std::abs(joint.points[next][side].at[d] - u) / (knots[spans[d] + 1] - knots[spans[d]]);
    }
    for (std::size_t d = 0; d < 2; ++d) {
      if (held || change[d] >= along * change[1 - d]) ask(plan[surface], d, spans[d], 2, urgency);
    }
  }
}

Expected<int> refine(RefinementPlan plan, int most, std::span<const FitSurface> given,
                     FitNets& nets) {
  std::vector<std::size_t> order(plan.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t k) { return plan[k].urgency; });
  int count = 0, total = 0;
  for (const Surface& s : nets.surfaces) total += s.size();
  for (const std::size_t k : order) {
    const Surface& s = nets.surfaces[k];
    const auto mirrored = given[k].holds ? given[k].holds->mirrored : std::array{false, false};
    for (std::size_t d = 0; d < 2; ++d) {
      if (mirrored[d]) mirror(s.knots(static_cast<int>(d)), plan[k].spans[d]);
    }
    NewKnots inserted = knots_for(s, plan[k], most - total + s.size());
    for (std::size_t d = 0; d < 2; ++d) {
      if (mirrored[d]) make_symmetric(s.knots(static_cast<int>(d)).domain(), inserted[d]);
    }
    const int finer = size_with(s, inserted);
    if (finer == s.size()) continue;
    auto made = insert_knots<2>(s, inserted);
    if (!made) return std::unexpected(made.error());
    total += finer - s.size();
    nets.surfaces[k] = *std::move(made);
    ++count;
  }
  return count;
}

}  // namespace knead::morph
