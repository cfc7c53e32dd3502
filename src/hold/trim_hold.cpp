#include "trim_hold.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

using Eigen::Vector2d;

// Of the domain: smaller deviations do not count.
constexpr double rounding_of_parameters = 8 * std::numeric_limits<double>::epsilon();
constexpr double grain = 1e-9;  // of the domain: smaller overlaps do not count
constexpr double share_of_cell = 0.25;

/// The spans of one direction and the functions over them.
struct Direction {
  const KnotVector& knots;
  std::vector<int> spans;
  std::vector<double> lines;  // distinct knots of the domain: ends of spans
  Interval domain;

  explicit Direction(const KnotVector& k) : knots(k), spans(k.spans()), domain(k.domain()) {
    for (const int s : spans) lines.push_back(k[s]);
    lines.push_back(domain.upper);
  }
  [[nodiscard]] int count() const { return static_cast<int>(spans.size()); }

  /// Spans that meet more than a grain of [lower, upper], as first and one past the last.
  [[nodiscard]] std::array<int, 2> meeting(double lower, double upper) const {
    const double e = grain * domain.length();
    const auto begin = lines.begin(), end = lines.end();
    const auto first = std::upper_bound(begin, end, lower - e) - begin - 1;
    const auto last = std::lower_bound(begin, end, upper + e) - begin;
    return {std::clamp(static_cast<int>(first), 0, count()),
            std::clamp(static_cast<int>(last), 0, count())};
  }
  /// Spans in the support of function i, as first and one past the last.
  [[nodiscard]] std::array<int, 2> support(int i) const {
    const auto first = std::lower_bound(spans.begin(), spans.end(), i) - spans.begin();
    const auto last =
        std::upper_bound(spans.begin(), spans.end(), i + knots.degree()) - spans.begin();
    return {static_cast<int>(first), static_cast<int>(last)};
  }
  /// Whether N_i has a non-zero derivative of order <= `order` at c, from inside its support.
  [[nodiscard]] bool acts(int i, double c, int order) const {
    const int p = knots.degree();
    const double lower = knots[i], upper = knots[i + p + 1];
    if (c < lower || c > upper) return false;
    if (c > lower && c < upper) return true;
    int multiplicity = 0;
    for (int k = i; k <= i + p + 1; ++k) multiplicity += knots[k] == c ? 1 : 0;
    return p + 1 - multiplicity <= order;
  }
};

/// A held piece of a knot line.
struct KnotLine {
  int direction;
  double at;
  Interval along;
  bool exact = true;  ///< the edge lies on it up to rounding
};

/// The spans of a surface, with the edges that run through them.
///
/// Chords of the edges are drawn into a grid of spans, as lines into pixels. Marked are all spans
/// that the box of a piece meets, slack included: too many rather than too few, as a span that is
/// missed would let an edge move.
class Cells {
 public:
  Cells(const Surface& surface, const VisibleRegion& region, double tolerance)
      : region_(region), u_(surface.knots(0)), v_(surface.knots(1)) {
    crossed_.assign(static_cast<std::size_t>(u_.count() * v_.count()), false);
    held_.assign(crossed_.size(), -1);
    // A length in parameters: by the largest speed of either direction, sampled.
    for (std::size_t d = 0; d < 2; ++d)
      snap_[d] = grain * direction(static_cast<int>(d)).domain.length();
    speed(surface, tolerance);
  }

  [[nodiscard]] const Direction& direction(int d) const { return d == 0 ? u_ : v_; }

  /// Marks the spans that an edge crosses, and returns the lines it runs along. `number` < 0: not
  /// held. The edge's deviation from its chords is in fractions of the domain, hence the slack.
  std::vector<KnotLine> mark(const TrimEdge& edge, int number) {
    std::vector<KnotLine> lines;
    const Vector2d slack = Vector2d(u_.domain.length(), v_.domain.length()) * edge.deviation;
    for (std::size_t k = 0; k + 1 < edge.course.size(); ++k) {
      for (const Vector2d& turn : turns(edge.course[k], edge.course[k + 1])) {
        chord(in_domain(edge.course[k] + turn), in_domain(edge.course[k + 1] + turn), slack, number,
              lines);
      }
    }
    return lines;
  }

  void mark_visible() {
    visible_.assign(crossed_.size(), false);
    for (int i = 0; i < u_.count(); ++i) {
      for (int j = 0; j < v_.count(); ++j) {
        const Vector2d middle(
            (0.5 * (u_.lines[at(i)] + u_.lines[at(i + 1)]) - u_.domain.lower) / u_.domain.length(),
            (0.5 * (v_.lines[at(j)] + v_.lines[at(j + 1)]) - v_.domain.lower) / v_.domain.length());
        visible_[cell(i, j)] = crossed_[cell(i, j)] || region_.contains(middle);
      }
    }
  }

  /// The number of a held edge that runs through the support of (i, j); −1: none.
  [[nodiscard]] int held_in_support(int i, int j) const {
    const auto us = u_.support(i), vs = v_.support(j);
    for (int a = us[0]; a < us[1]; ++a) {
      for (int b = vs[0]; b < vs[1]; ++b) {
        if (held_[cell(a, b)] >= 0) return held_[cell(a, b)];
      }
    }
    return -1;
  }
  [[nodiscard]] bool visible_in_support(int i, int j) const {
    const auto us = u_.support(i), vs = v_.support(j);
    for (int a = us[0]; a < us[1]; ++a) {
      for (int b = vs[0]; b < vs[1]; ++b) {
        if (visible_[cell(a, b)]) return true;
      }
    }
    return false;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] std::size_t cell(int i, int j) const { return at(i * v_.count() + j); }

  // The tolerance of space becomes one of parameters by the largest sampled speed, at most 1e-4 of
  // the domain: where a surface is nearly degenerate a length says nothing.
  void speed(const Surface& surface, double tolerance) {
    constexpr int samples = 12;
    std::array<std::vector<double>, 2> grid;
    for (int d = 0; d < 2; ++d) {
      const Interval domain = direction(d).domain;
      for (int k = 0; k <= samples; ++k)
        grid[at(d)].push_back(domain.lower + domain.length() * k / samples);
      grid[at(d)].back() = domain.upper;
    }
    const auto jet = evaluate_grid<2>(surface, {std::span<const double>(grid[0]), grid[1]}, 1);
    if (!jet) return;
    const double u = jet->at({1, 0}).rowwise().norm().maxCoeff(),
                 v = jet->at({0, 1}).rowwise().norm().maxCoeff();
    if (u > 0) snap_[0] = std::max(snap_[0], std::min(tolerance / u, 1e-4 * u_.domain.length()));
    if (v > 0) snap_[1] = std::max(snap_[1], std::min(tolerance / v, 1e-4 * v_.domain.length()));
  }

  /// Whole turns that bring part of a chord into the domain of a closed surface.
  [[nodiscard]] std::vector<Vector2d> turns(const Vector2d& a, const Vector2d& b) const {
    std::array<std::vector<double>, 2> shifts;
    for (int d = 0; d < 2; ++d) {
      shifts[at(d)] = {0};
      if (!region_.closed[at(d)]) continue;
      shifts[at(d)].clear();
      const double lower = std::min(a[d], b[d]), upper = std::max(a[d], b[d]);
      constexpr double touch = 1e-6;
      for (double s = std::ceil(-upper - touch); s <= std::floor(1 - lower + touch); ++s)
        shifts[at(d)].push_back(s);
    }
    std::vector<Vector2d> result;
    for (const double s : shifts[0]) {
      for (const double t : shifts[1]) result.emplace_back(s, t);
    }
    return result;
  }

  [[nodiscard]] Vector2d in_domain(const Vector2d& fractions) const {
    return {u_.domain.lower + fractions.x() * u_.domain.length(),
            v_.domain.lower + fractions.y() * v_.domain.length()};
  }

  // A chord with both ends near one knot line counts as on it and holds the functions of the line
  // only; others mark spans, in pieces so short that their boxes hold little but the chord.
  void chord(const Vector2d& a, const Vector2d& b, const Vector2d& slack, int number,
             std::vector<KnotLine>& lines) {
    for (int d = 0; d < 2; ++d) {
      const auto& all = direction(d).lines;
      const auto near =
          std::ranges::min_element(all, {}, [&](double c) { return std::abs(c - a[d]); });
      if (std::abs(*near - a[d]) > snap_[at(d)] || std::abs(*near - b[d]) > snap_[at(d)]) continue;
      const int e = 1 - d;
      const double off = std::max(std::abs(*near - a[d]), std::abs(*near - b[d]));
      const bool exact = off <= rounding_of_parameters * direction(d).domain.length() &&
                         slack[d] <= rounding_of_parameters * direction(d).domain.length();
      if (number >= 0)
        lines.push_back({d, *near, {std::min(a[e], b[e]), std::max(a[e], b[e])}, exact});
      return;
    }
    const int pieces = pieces_of(a, b);
    for (int k = 0; k < pieces; ++k) {
      const Vector2d from = a + (b - a) * k / pieces, to = a + (b - a) * (k + 1) / pieces;
      const Vector2d lower = from.cwiseMin(to) - slack, upper = from.cwiseMax(to) + slack;
      const auto us = u_.meeting(lower.x(), upper.x()), vs = v_.meeting(lower.y(), upper.y());
      for (int i = us[0]; i < us[1]; ++i) {
        for (int j = vs[0]; j < vs[1]; ++j) {
          crossed_[cell(i, j)] = true;
          if (number >= 0 && held_[cell(i, j)] < 0) held_[cell(i, j)] = number;
        }
      }
    }
  }
  /// The number of pieces such that each is shorter than a share of every span it meets.
  [[nodiscard]] int pieces_of(const Vector2d& a, const Vector2d& b) const {
    double pieces = 1;
    for (int d = 0; d < 2; ++d) {
      const Direction& along = direction(d);
      const auto [first, last] = along.meeting(std::min(a[d], b[d]), std::max(a[d], b[d]));
      for (int s = first; s < last; ++s) {
        const double length = along.lines[at(s + 1)] - along.lines[at(s)];
        pieces = std::max(pieces, std::abs(a[d] - b[d]) / (share_of_cell * length));
      }
    }
    return static_cast<int>(std::ceil(std::min(pieces, 1e4)));
  }

  const VisibleRegion& region_;
  Direction u_, v_;
  std::array<double, 2> snap_{};
  std::vector<bool> crossed_, visible_;
  std::vector<int> held_;  // the first held edge that runs through
};

/// The order to hold along a line so that an edge that only runs close to it keeps this one: a
/// tangent plane kept only on the line turns off it in proportion to the distance. The same at a
/// pole, where normals turn fast.
int beside_line(int order) { return order > 0 ? order + 1 : order; }

/// Control points that affect a line.
void hold_line(const Cells& cells, const KnotLine& line, int order, int columns,
               std::vector<int>& by, int number) {
  const Direction &across = cells.direction(line.direction),
                  &along = cells.direction(1 - line.direction);
  const auto [first, last] = along.meeting(line.along.lower, line.along.upper);
  for (int i = 0; i < across.knots.count(); ++i) {
    if (!across.acts(i, line.at, order)) continue;
    for (int j = 0; j < along.knots.count(); ++j) {
      const auto [from, to] = along.support(j);
      if (from >= last || to <= first) continue;
      int& held =
          by[static_cast<std::size_t>(line.direction == 0 ? i * columns + j : j * columns + i)];
      if (held < 0) held = number;
    }
  }
}

}  // namespace

// Three reasons to hold a control point, in this order: its function acts on a held line or pole up
// to the order; a held edge runs through its support; nothing visible does. The first that applies
// gives the name.
Expected<TrimHold> hold_trims(const Surface& rest, const VisibleRegion& region,
                              std::span<const int> orders, double tolerance, ConstraintList& to) {
  if (orders.size() != region.edges.size())
    return usage_error("there is not one order for each edge", "orders");
  for (const int order : orders) {
    if (order < -1 || order > 2)
      return usage_error(fmt::format("{} is not an order", order), "orders", "use -1 to 2");
  }
  Cells cells(rest, region, tolerance);
  const int columns = rest.net()[1];
  std::vector<int> by(static_cast<std::size_t>(rest.size()), -1);
  TrimHold result;
  int highest = -1;
  for (std::size_t e = 0; e < region.edges.size(); ++e) {
    const int number = static_cast<int>(e), order = orders[e];
    highest = std::max(highest, order);
    const auto lines = cells.mark(region.edges[e], order < 0 ? -1 : number);
    for (const KnotLine& line : lines) {
      hold_line(cells, line, line.exact ? order : beside_line(order), columns, by, number);
    }
    result.edges.push_back({region.edges[e].id, order,
                            lines.size() + 1 >= region.edges[e].course.size() && !lines.empty(),
                            0});
  }
  cells.mark_visible();
  const int outside = static_cast<int>(region.edges.size());
  for (int d = 0; d < 2 && highest >= 0; ++d) {
    for (std::size_t end = 0; end < 2; ++end) {
      if (!region.poles[static_cast<std::size_t>(d)][end]) continue;
      const Interval domain = cells.direction(d).domain;
      const KnotLine line{d, end == 0 ? domain.lower : domain.upper, cells.direction(1 - d).domain};
      hold_line(cells, line, beside_line(highest), columns, by, outside + 1);
    }
  }
  for (int i = 0; i < rest.net()[0]; ++i) {
    for (int j = 0; j < columns; ++j) {
      int& held = by[static_cast<std::size_t>(i * columns + j)];
      const bool visible = cells.visible_in_support(i, j);
      if (visible) ++result.visible;
      if (held < 0) held = cells.held_in_support(i, j);
      if (held < 0 && !visible) held = outside;
      if (held < 0) {
        ++result.free;
        continue;
      }
      if (held < outside) ++result.edges[static_cast<std::size_t>(held)].points;
      to.hold(i * columns + j, held < outside
                                   ? "edge " + region.edges[static_cast<std::size_t>(held)].id
                               : held == outside ? "what lies outside of the face"
                                                 : "pole");
    }
  }
  return result;
}

}  // namespace knead
