#include "knead/hold/constraints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

#include "constraint_list_space.hpp"
#include "constraint_rows.hpp"
#include "knead/base/error_code.hpp"

namespace knead {
namespace {

using detail::append;
using detail::LocalBasis;
using detail::NetAcross;
using detail::Terms;

/// The row of control points through which the line c of span `span` runs; −1 if there is none: if
/// fewer than p knots of the span's functions lie at c.
///
/// At a knot of p equal ones among the function's own the curve interpolates a control point: that
/// row is the line. Held control points keep their bits and leave the system smaller, which an
/// equation would not.
int row_on_line(const KnotVector& knots, int span, double c) {
  const int p = knots.degree();
  if (c == knots[span] && knots[span - p + 1] == c) return span - p;
  if (c == knots[span + 1] && knots[span + p] == c) return span;
  return -1;
}

// Where rows lie on the line its first order + 1 rows fix the derivatives up to that order.
// Elsewhere each derivative of the numerator, Σ_i N_i^(k)(c) w_ij X_ij, vanishes for every j; with
// those of lower order this makes the derivatives of D vanish, as D W is the numerator.
Expected<void> hold_line(const NetAcross& net, double c, int order, const std::string& name,
                         ConstraintList& to) {
  if (order < 0 || order > 2)
    return input_error(fmt::format("{} is not an order", order), name, "use 0, 1 or 2");
  const KnotVector& knots = net.knots();
  const int p = knots.degree(), highest = std::min(order, p);
  for (const int span : detail::spans_at(knots, c, highest)) {
    const int row = row_on_line(knots, span, c);
    if (row >= 0) {
      const int step = row == span ? -1 : 1;
      for (int k = 0; k <= highest; ++k) {
        for (int j = 0; j < net.columns(); ++j) to.hold(net.index(row + step * k, j), name);
      }
      continue;
    }
    const LocalBasis basis(knots, span, c, highest);
    for (int k = 0; k <= highest; ++k) {
      for (int j = 0; j < net.columns(); ++j) {
        Terms terms;
        for (int i = basis.first; i <= basis.last(); ++i) {
          terms.emplace_back(net.index(i, j), basis.at(i, k) * net.weight(i, j));
        }
        append(to, name, std::move(terms));
      }
    }
  }
  return {};
}

/// Spans from the one containing `interval.lower` to the one containing `interval.upper`, as first
/// and last.
Expected<std::pair<int, int>> covering_spans(const KnotVector& knots, Interval interval,
                                             const char* name) {
  for (double end : {interval.lower, interval.upper}) {
    if (auto inside = detail::check_parameter(knots, end, name); !inside)
      return std::unexpected(inside.error());
  }
  if (interval.upper < interval.lower) {
    return input_error(
        fmt::format("the region ends at {} before it starts at {}", interval.upper, interval.lower),
        name);
  }
  const int first = knots.find_span(interval.lower, Side::right);
  return std::pair{first, std::max(first, knots.find_span(interval.upper, Side::left))};
}

}  // namespace

void ConstraintList::hold(int i, const std::string& name) {
  const auto k = static_cast<std::size_t>(i);
  if (!held[k]) held_by[k] = name;
  held[k] = true;
}

void keep_present(ConstraintList& list, const Points& displacement, std::size_t first) {
  for (std::size_t k = first; k < list.constraints.size(); ++k) {
    LinearConstraint& c = list.constraints[k];
    c.value.setZero();
    for (const auto& [unknown, a] : c.terms) c.value += a * displacement.row(unknown).transpose();
  }
}

// Values are divided by the model's size first, the unit in which the space compares right sides.
Expected<ConstraintSpace> constraint_space(const ConstraintList& list, const Points& displacement,
                                           double size) {
  assert(size > 0);
  std::vector<LinearConstraint> scaled = list.constraints;
  for (LinearConstraint& c : scaled) c.value /= size;
  auto space = ConstraintSpace::create(static_cast<int>(list.held.size()), scaled, list.held);
  if (!space) return space;
  // The space skips conditions on held unknowns alone: whether they are met depends on the
  // positions of those.
  const Points x = space->feasible(displacement / size);
  const double rounding = 1e-9 * std::max(1.0, x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0.0);
  for (const LinearConstraint& c : scaled) {
    Point miss = -c.value;
    std::set<std::string> holds;
    for (const auto& [unknown, a] : c.terms) {
      miss += a * x.row(unknown).transpose();
      const auto k = static_cast<std::size_t>(unknown);
      if (list.held[k]) holds.insert(list.held_by[k]);
    }
    const double amount =
        c.normal ? std::abs(c.normal->normalized().dot(miss)) : miss.cwiseAbs().maxCoeff();
    if (amount <= rounding) continue;
    std::string names;
    for (const std::string& hold : holds) names += (names.empty() ? "" : ", ") + hold;
    return input_error(fmt::format("the constraint contradicts {} by {:.3g}",
                                   names.empty() ? "what else is held" : names, amount * size),
                       c.name, "release one of them", {ErrorCode::constraint_contradicts});
  }
  return space;
}

Expected<void> hold_isoline(const Surface& rest, int direction, double c, int order,
                            ConstraintList& to) {
  const char* name = direction == 0 ? "u" : "v";
  if (auto inside = detail::check_parameter(rest.knots(direction), c, name); !inside) return inside;
  return hold_line({rest, direction}, c, order, fmt::format("line {} = {}", name, c), to);
}

Expected<void> hold_edge(const Surface& rest, SurfaceEdge edge, int order, ConstraintList& to) {
  const int direction = edge_across(edge);
  const Interval domain = rest.knots(direction).domain();
  return hold_line({rest, direction}, edge_at_end(edge) ? domain.upper : domain.lower, order,
                   fmt::format("edge {}", edge_name(edge)), to);
}

// On a torn knot line the point is one of each side, up to four, and all are pinned.
Expected<void> pin_point(const Surface& rest, double u, double v, const std::optional<Point>& place,
                         ConstraintList& to) {
  if (auto inside = detail::check_parameter(rest.knots(0), u, "u"); !inside) return inside;
  if (auto inside = detail::check_parameter(rest.knots(1), v, "v"); !inside) return inside;
  std::string name = fmt::format("pin at ({}, {})", u, v);
  if (place) {
    if (!place->allFinite()) return input_error("the place is not finite", name);
    name += fmt::format(" to ({}, {}, {})", place->x(), place->y(), place->z());
  }
  std::vector<Terms> rows;
  for (const int span_u : detail::spans_at(rest.knots(0), u, 0)) {
    for (const int span_v : detail::spans_at(rest.knots(1), v, 0)) {
      auto row = detail::rational_row(rest, u, v, span_u, span_v);
      if (!row) return std::unexpected(row.error());
      rows.push_back(std::move(*row));
    }
  }
  for (Terms& row : rows) {
    if (!place) {
      append(to, name, std::move(row));
      continue;
    }
    // Σ R (P − place), not Σ R P − place: exactly zero if the point is already there, and accurate
    // far from 0.
    Point way = Point::Zero();
    std::erase_if(row, [](const auto& term) { return term.second == 0; });
    for (const auto& [unknown, c] : row)
      way += c * (*place - rest.control_points().row(unknown).transpose());
    to.constraints.push_back({name, std::move(row), way});
  }
  return {};
}

// All functions that are not zero somewhere in these spans: D is then exactly 0 there, and with it
// every derivative. Held are whole spans, since a function is not zero on parts of one.
Expected<FrozenRegion> freeze_region(const Surface& rest, Interval u, Interval v,
                                     ConstraintList& to) {
  const auto spans_u = covering_spans(rest.knots(0), u, "u");
  if (!spans_u) return std::unexpected(spans_u.error());
  const auto spans_v = covering_spans(rest.knots(1), v, "v");
  if (!spans_v) return std::unexpected(spans_v.error());
  const auto bounds = [](const KnotVector& knots, std::pair<int, int> spans) {
    return Interval{knots[spans.first], knots[spans.second + 1]};
  };
  const FrozenRegion region{bounds(rest.knots(0), *spans_u), bounds(rest.knots(1), *spans_v)};
  const std::string name = fmt::format("frozen [{}, {}] x [{}, {}]", region.u.lower, region.u.upper,
                                       region.v.lower, region.v.upper);
  // Functions between non-empty spans: those of empty spans inside are non-zero on a neighbour, or
  // only there.
  for (int i = spans_u->first - rest.knots(0).degree(); i <= spans_u->second; ++i) {
    for (int j = spans_v->first - rest.knots(1).degree(); j <= spans_v->second; ++j) {
      to.hold(i * rest.net()[1] + j, name);
    }
  }
  return region;
}

}  // namespace knead
