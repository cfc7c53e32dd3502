#include "trims.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "followed.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"
#include "places.hpp"

namespace knead {
namespace {

constexpr double least_tolerance = 1e-7;  // of the size

/// |S_current − S_opened| at fractions, which may be off by a turn on closed surfaces.
Expected<double> deviation_at(const SceneSurface& s, Eigen::Vector2d at) {
  for (int d = 0; d < 2; ++d) {
    if (s.visible->closed[static_cast<std::size_t>(d)] && (at[d] < 0 || at[d] > 1))
      at[d] -= std::floor(at[d]);
  }
  const auto now = evaluate_point<2>(*s.current, parameters_of(*s.current, at));
  const auto then = evaluate_point<2>(*s.opened, parameters_of(*s.opened, at));
  if (!now) return std::unexpected(now.error());
  if (!then) return std::unexpected(then.error());
  return (*now - *then).norm();
}

}  // namespace

bool holds_trims(const std::vector<KeptConstraint>& constraints) {
  return std::ranges::any_of(constraints, [](const KeptConstraint& kept) {
    const auto* all = std::get_if<TrimHolds>(&kept.constraint);
    return (all != nullptr && all->order >= 0) ||
           std::holds_alternative<TrimEdgeHold>(kept.constraint);
  });
}

bool may_open(const std::vector<KeptConstraint>& constraints, const std::string& edge) {
  bool all = false;
  std::optional<bool> one;
  for (const KeptConstraint& kept : constraints) {
    if (const auto* trims = std::get_if<TrimHolds>(&kept.constraint)) all = trims->order < 0;
    const auto* hold = std::get_if<TrimEdgeHold>(&kept.constraint);
    if (hold != nullptr && hold->id == edge) one = hold->order < 0 && !hold->follow;
  }
  return one.value_or(all);
}

bool touches_visible(const Scene& scene) {
  return std::ranges::any_of(scene.tools,
                             [](const Tool& t) { return t.touches == ToolTouch::visible; });
}

// Two passes, since a hold of one edge overrules that of all edges wherever it stands in the list;
// among holds of the same kind the last one counts.
std::vector<int> trim_orders(const std::vector<KeptConstraint>& constraints,
                             const VisibleRegion& region) {
  int all = -1;
  for (const KeptConstraint& kept : constraints) {
    if (const auto* trims = std::get_if<TrimHolds>(&kept.constraint)) all = trims->order;
  }
  std::vector<int> orders(region.edges.size(), all);
  for (const KeptConstraint& kept : constraints) {
    const auto* edge = std::get_if<TrimEdgeHold>(&kept.constraint);
    for (std::size_t e = 0; edge != nullptr && e < orders.size(); ++e) {
      if (region.edges[e].id == edge->id) orders[e] = edge->order;
    }
  }
  return orders;
}

double trim_tolerance(const Surface& surface, const VisibleRegion& region) {
  return std::max(region.uncertainty, least_tolerance * net_size(surface));
}

Expected<TrimHold> hold_face_edges(const Surface& reference,
                                   const std::vector<KeptConstraint>& constraints,
                                   const VisibleRegion& region, ConstraintList& list) {
  const std::vector<int> orders = trim_orders(constraints, region);
  if (region.edges.empty()) return TrimHold{{}, reference.size(), reference.size()};
  return hold_trims(reference, region, orders, trim_tolerance(reference, region), list);
}

// Where a tool touches the visible part, and how far that is from the nearest held edge: the two
// numbers that decide how fine the net must be there. Cost: at most two searches by `visible_least`
// (41² evaluations, then 8 rounds of 9²), which need no derivative of the tool and miss only minima
// narrower than 1/41 of the visible extent.
Expected<std::optional<TrimContact>> trim_contact(const SceneSurface& s, const Tool& tool) {
  const ModelTool probe(tool, Point::Zero(), 1);
  const Points& net = s.current->control_points();
  const Point lower = net.colwise().minCoeff().transpose(),
              upper = net.colwise().maxCoeff().transpose();
  if (!probe.may_reach(lower, upper)) return std::nullopt;
  const VisibleRegion everything;
  const VisibleRegion& region = s.visible ? *s.visible : everything;
  const std::vector<int> orders = trim_orders(s.constraints, region);
  std::vector<bool> held;
  for (const int order : orders) held.push_back(order >= 0);
  // Negative where the tool acts: inside of one that collides, within its range of one that does
  // not.
  const double reach = tool.collides() ? 0 : tool.range;
  const auto entry = [&](const Point& p) {
    return tool.collides() ? probe.distance(p) : std::abs(probe.distance(p)) - reach;
  };
  // First the deepest point; if that is close to an edge, one that is both deep and far from edges.
  auto best = visible_least(*s.current, region, entry);
  if (!best) return std::unexpected(best.error());
  if (!*best || (*best)->distance >= 0) return std::nullopt;
  const auto distance = [&](const Eigen::Vector2d& at) -> double {
    const auto then = evaluate_point<2>(*s.opened, parameters_of(*s.opened, at));
    return then ? region.distance(*then, held) : 0;
  };
  TrimContact contact{parameters_of(*s.current, (*best)->at), distance((*best)->at)};
  // The deepest point may lie right on a held edge, where nothing moves whatever the net.
  // max(entry, −distance) is least where depth and distance balance, the point at which the tool
  // will press hardest against what can give way.
  if (contact.distance < -(*best)->distance) {
    best = visible_least(*s.current, region, [&](const Point& p) {
      return std::max(entry(p), -region.distance(p, held));
    });
    if (!best) return std::unexpected(best.error());
    contact = {parameters_of(*s.current, (*best)->at), distance((*best)->at)};
  }
  return contact;
}

// A fold: n_before · n_after < 0 at a visible point, n = S_u × S_v not normalised, as only the sign
// counts. Each span is looked at in 4 × 4 points at the middles of its cells, not at knots, where a
// crease has no normal of its own. Points that have not moved by more than rounding are passed
// over: at poles and degenerate corners the sign of n is noise. The test of visibility, the most
// expensive, comes last.
Expected<std::optional<Eigen::Vector2d>> first_fold(const Surface& before, const Surface& after,
                                                    const VisibleRegion& region) {
  constexpr int per_span = 4;
  std::array<std::vector<double>, 2> grid;
  for (int d = 0; d < 2; ++d) {
    const KnotVector& knots = after.knots(d);
    for (const int span : knots.spans()) {
      for (int k = 0; k < per_span; ++k) {
        grid[static_cast<std::size_t>(d)].push_back(knots[span] + (knots[span + 1] - knots[span]) *
                                                                      (k + 0.5) / per_span);
      }
    }
  }
  const auto a = evaluate_grid<2>(before, {std::span<const double>(grid[0]), grid[1]}, 1);
  const auto b = evaluate_grid<2>(after, {std::span<const double>(grid[0]), grid[1]}, 1);
  if (!a) return std::unexpected(a.error());
  if (!b) return std::unexpected(b.error());
  // Rounding of the evaluation is about 1e-15 of the net's size; what moves less than 1e-9 cannot
  // fold a span.
  const double apart = 1e-9 * net_size(before);
  const auto normal = [](const Evaluation<2>& jet, Eigen::Index row) -> Point {
    return Point(jet.at({1, 0}).row(row)).cross(Point(jet.at({0, 1}).row(row)));
  };
  const auto columns = static_cast<Eigen::Index>(grid[1].size());
  for (Eigen::Index row = 0; row < a->points().rows(); ++row) {
    if ((a->points().row(row) - b->points().row(row)).norm() <= apart) continue;
    if (normal(*a, row).dot(normal(*b, row)) >= 0) continue;
    Eigen::Vector2d at;
    for (int d = 0; d < 2; ++d) {
      const Interval domain = after.knots(d).domain();
      const auto k = static_cast<std::size_t>(d == 0 ? row / columns : row % columns);
      at[d] = (grid[static_cast<std::size_t>(d)][k] - domain.lower) / domain.length();
    }
    if (region.contains(at)) return at;
  }
  return std::nullopt;
}

namespace {

/// The corners of a course and the points midway between them, in the parameters of a surface.
Parameters<2> places_along(const TrimEdge& edge, const Surface& surface) {
  const auto corners = static_cast<Eigen::Index>(edge.course.size());
  Parameters<2> places(std::max<Eigen::Index>(0, 2 * corners - 1), 2);
  for (Eigen::Index k = 0; k < places.rows(); ++k) {
    const auto a = static_cast<std::size_t>(k / 2), b = static_cast<std::size_t>((k + 1) / 2);
    const auto at = parameters_at_foot(surface, 0.5 * (edge.course[a] + edge.course[b]));
    places.row(k) << at[0], at[1];
  }
  return places;
}

/// The angle between the normals of two evaluations at a row; 0 where one has none, as at a pole.
double turn_at(const Evaluation<2>& before, const Evaluation<2>& after, Eigen::Index row) {
  // |n| against |S_u|² + |S_v|² is at most half the sine of their angle; below this the direction
  // of n is rounding.
  constexpr double least_sine = 1e-9;
  const auto normal = [&](const Evaluation<2>& jet) -> Point {
    const Point u = jet.at({1, 0}).row(row), v = jet.at({0, 1}).row(row);
    const Point n = u.cross(v);
    return n.norm() > least_sine * (u.squaredNorm() + v.squaredNorm()) ? n : Point(Point::Zero());
  };
  const Point a = normal(before), b = normal(after);
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

// What edges that are held did in fact: the distance |S_after − S_before|, and from order 1 the
// turn of the normal, at the corners of each course and midway between. Orders above 1 are measured
// as order 1, since curvature has no tolerance in a file. The place reported is that of the
// distance, or of the turn where only that is too large.
Expected<std::vector<MovedTrim>> moved_trims(const Surface& before, const Surface& after,
                                             const std::vector<int>& orders,
                                             const VisibleRegion& region) {
  std::vector<MovedTrim> result;
  const double tolerance = trim_tolerance(before, region);
  for (std::size_t e = 0; e < orders.size(); ++e) {
    const TrimEdge& edge = region.edges[e];
    if (orders[e] < 0) continue;
    const int order = std::min(orders[e], 1);
    const auto then = evaluate<2>(before, places_along(edge, before), order);
    if (!then) return std::unexpected(then.error());
    const auto now = evaluate<2>(after, places_along(edge, after), order);
    if (!now) return std::unexpected(now.error());
    MovedTrim moved;
    moved.id = edge.id;
    moved.neighbours = edge.neighbours;
    Point turned = Point::Zero();
    for (Eigen::Index k = 0; k < then->points().rows(); ++k) {
      const double distance = (now->points().row(k) - then->points().row(k)).norm();
      const double turn = order > 0 ? turn_at(*then, *now, k) : 0;
      if (turn > moved.turn) turned = then->points().row(k);
      if (distance > moved.distance) moved.place = then->points().row(k);
      moved.turn = std::max(moved.turn, turn);
      moved.distance = std::max(moved.distance, distance);
    }
    if (moved.distance <= tolerance) moved.place = turned;
    if (moved.distance > tolerance || moved.turn > accepted_angle)
      result.push_back(std::move(moved));
  }
  return result;
}

// The hold is computed anew into a list of its own, which is thrown away: only its numbers of free
// and visible control points and what it holds of each edge are reported.
Expected<TrimReport> trim_report(const SceneSurface& s) {
  TrimReport report;
  report.net = s.current->net();
  ConstraintList list(s.current->size());
  auto held = hold_face_edges(*s.reference, s.constraints, *s.visible, list);
  if (!held) return std::unexpected(held.error());
  report.free = held->free;
  report.visible = held->visible;
  for (std::size_t e = 0; e < s.visible->edges.size(); ++e) {
    const TrimEdge& edge = s.visible->edges[e];
    TrimReport::Edge& made = report.edges.emplace_back();
    made.held = held->edges[e];
    made.neighbours = edge.neighbours;
    made.follows = follows(s, edge.id);
    for (std::size_t k = 0; k < edge.course.size(); ++k) {
      const auto measure = [&](const Eigen::Vector2d& at) -> Expected<void> {
        const auto deviation = deviation_at(s, at);
        if (!deviation) return std::unexpected(deviation.error());
        made.deviation = std::max(made.deviation, *deviation);
        ++report.samples;
        return {};
      };
      if (auto status = measure(edge.course[k]); !status) return std::unexpected(status.error());
      if (k == 0) continue;
      if (auto status = measure(0.5 * (edge.course[k - 1] + edge.course[k])); !status)
        return std::unexpected(status.error());
    }
    if (!made.follows) report.largest = std::max(report.largest, made.deviation);
  }
  return report;
}

}  // namespace knead
