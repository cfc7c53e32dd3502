#include "body_constraints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "constraint_rows.hpp"
#include "knead/spline/basis.hpp"
#include "spline/basis_terms.hpp"

namespace knead {
namespace {

using detail::append;
using detail::Terms;

/// One side of a curve at a parameter: R_i and R_i' there, and the curve's own point and
/// derivative.
struct CurveSide {
  Terms values, slopes;
  Point point = Point::Zero(), tangent = Point::Zero();
};

// R = w N / W and R' = (w N' − R W')/W, from the span on that side of u: both limits exist at a
// knot of any multiplicity.
Expected<CurveSide> side_at(const Curve& curve, double u, Side from) {
  const KnotVector& knots = curve.knots(0);
  const int span = knots.find_span(u, from), p = knots.degree();
  std::array<double, 2 * (max_degree + 1)> n;
  basis_derivatives(knots, span, u, 1, n.data());
  double w = 0, dw = 0;
  CurveSide side;
  for (int r = 0; r <= p; ++r) {
    const int row = span - p + r;
    const double weight = curve.rational() ? curve.weights()[static_cast<std::size_t>(row)] : 1;
    side.values.emplace_back(row, weight * n[static_cast<std::size_t>(r)]);
    side.slopes.emplace_back(row, weight * n[static_cast<std::size_t>(p + 1 + r)]);
    w += side.values.back().second;
    dw += side.slopes.back().second;
  }
  if (!(w > 0)) return numerical_error("the denominator is not positive", fmt::format("u = {}", u));
  for (std::size_t r = 0; r < side.values.size(); ++r) {
    side.values[r].second /= w;
    side.slopes[r].second = (side.slopes[r].second - side.values[r].second * dw) / w;
    const auto control_point = curve.control_points().row(side.values[r].first).transpose();
    side.point += side.values[r].second * control_point;
    side.tangent += side.slopes[r].second * control_point;
  }
  return side;
}

/// a − factor b, terms of one control point added up.
Terms difference(Terms a, const Terms& b, double factor) {
  for (const auto& [row, value] : b) {
    const auto same = std::ranges::find(a, row, &Terms::value_type::first);
    if (same != a.end()) {
      same->second -= factor * value;
    } else {
      a.emplace_back(row, -factor * value);
    }
  }
  return a;
}

/// Couples two sides of a curve as it is at rest.
///
/// D_u⁺ = λ D_u⁻ with λ = |S_u⁺| / |S_u⁻| of the rest shape: S + D then has parallel tangents on
/// both sides, of the same ratio as at rest. Their angle is taken by atan2 of the cross and the
/// inner product, exact for small ones, where an arc cosine has half the digits.
SmoothKnot::State couple(const CurveSide& before, const CurveSide& after, bool torn_basis,
                         int degree, double size, const SmoothOptions& options,
                         const std::string& name, ConstraintList& to) {
  if ((after.point - before.point).norm() > options.gap * size) return SmoothKnot::State::torn;
  if (torn_basis) append(to, name, difference(after.values, before.values, 1));
  const double there = after.tangent.norm(), here = before.tangent.norm();
  if (degree < 2 || !(there > 0 && here > 0)) return SmoothKnot::State::crease;
  const double angle = std::atan2(before.tangent.cross(after.tangent).norm() / there,
                                  before.tangent.dot(after.tangent) / there);
  if (!(angle <= options.angle)) return SmoothKnot::State::crease;
  append(to, name, difference(after.slopes, before.slopes, there / here));
  return SmoothKnot::State::coupled;
}

}  // namespace

std::string side_name(DomainSide side) {
  return fmt::format("{}{}", "uvw"[side.direction], side.upper ? 1 : 0);
}

// A line of control points across the side, for every place along it: the first of these holds the
// side, the next its slope, a third its curvature. Elsewhere than at clamped ends a condition per
// line and order takes their place, on the p + 1 control points of the span.
template <int D>
Expected<void> hold_side(const Spline<D>& rest, DomainSide side, int order, ConstraintList& to) {
  if (side.direction < 0 || side.direction >= D) {
    return input_error(
        fmt::format("there is no side {}", side_name(side)), "which",
        D == 1 ? "a curve has the ends u0 and u1" : "a volume has the sides u0 to w1");
  }
  if (order < 0 || order > 2)
    return input_error(fmt::format("{} is not an order", order), "order", "use 0, 1 or 2");
  const KnotVector& knots = rest.knots(side.direction);
  const int p = knots.degree(), n = knots.count();
  const bool clamped = side.upper ? knots.clamped_end() : knots.clamped_start();
  const double c = side.upper ? knots.domain().upper : knots.domain().lower;
  const int span = knots.find_span(c, side.upper ? Side::left : Side::right);
  std::array<double, 3 * (max_degree + 1)> derivatives;
  if (!clamped) basis_derivatives(knots, span, c, order, derivatives.data());
  int stride = 1;
  for (int d = side.direction + 1; d < D; ++d) stride *= rest.knots(d).count();
  const std::string name = (D == 1 ? "end " : "side ") + side_name(side);
  for (int first = 0; first < rest.size(); ++first) {
    if ((first / stride) % n != 0)
      continue;  // the beginning of a line of control points across the side
    for (int k = 0; k <= std::min(order, p); ++k) {
      if (clamped) {
        to.hold(first + stride * (side.upper ? n - 1 - k : k), name);
        continue;
      }
      Terms row;
      for (int r = 0; r <= p; ++r) {
        const int at = first + stride * (span - p + r);
        const double weight = rest.rational() ? rest.weights()[static_cast<std::size_t>(at)] : 1;
        row.emplace_back(at, weight * derivatives[static_cast<std::size_t>(k * (p + 1) + r)]);
      }
      append(to, name, std::move(row));
    }
  }
  return {};
}

// One condition with three right sides. S + D takes the place given: Σ R X = place − S(u).
template <int D>
Expected<void> pin_place(const Spline<D>& rest, const std::array<double, D>& u,
                         const std::optional<Point>& place, ConstraintList& to) {
  std::string name = fmt::format("pin at ({})", fmt::join(u, ", "));
  Terms row = basis_terms<D>(rest, u);
  if (!std::ranges::all_of(row, [](const auto& term) { return std::isfinite(term.second); })) {
    return numerical_error("the denominator is not positive", name);
  }
  if (!place) {
    append(to, name, std::move(row));
    return {};
  }
  if (!place->allFinite()) return input_error("the place is not finite", name);
  name += fmt::format(" to ({}, {}, {})", place->x(), place->y(), place->z());
  // Σ R (place − P), not place − Σ R P: exactly zero if the point is already there, and accurate
  // far from 0.
  Point way = Point::Zero();
  std::erase_if(row, [](const auto& term) { return term.second == 0; });
  for (const auto& [at, c] : row) way += c * (*place - rest.control_points().row(at).transpose());
  to.constraints.push_back({name, std::move(row), way});
  return {};
}

// Below multiplicity p the basis itself is C¹. At p it is continuous only, at p + 1 torn; the two
// ends of a closed curve are like a torn knot.
Expected<std::vector<SmoothKnot>> keep_smooth_knots(const Curve& rest, const SmoothOptions& options,
                                                    ConstraintList& to) {
  const KnotVector& knots = rest.knots(0);
  const Interval domain = knots.domain();
  const int p = knots.degree();
  const Points& points = rest.control_points();
  const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  std::vector<SmoothKnot> found;
  double last = domain.lower;
  for (const double knot : knots.knots()) {
    if (!(knot > last && knot < domain.upper)) continue;
    last = knot;
    const int multiplicity = knots.multiplicity(knot);
    if (multiplicity < p) continue;
    const auto before = side_at(rest, knot, Side::left), after = side_at(rest, knot, Side::right);
    if (!before) return std::unexpected(before.error());
    if (!after) return std::unexpected(after.error());
    const auto state = couple(*before, *after, multiplicity > p, p, size, options,
                              fmt::format("smooth at u = {}", knot), to);
    found.push_back({knot, false, state});
  }
  const auto end = side_at(rest, domain.upper, Side::left),
             start = side_at(rest, domain.lower, Side::right);
  if (!end) return std::unexpected(end.error());
  if (!start) return std::unexpected(start.error());
  if ((start->point - end->point).norm() > options.gap * size) return found;
  found.push_back({domain.lower, true, couple(*end, *start, true, p, size, options, "closed", to)});
  return found;
}

template Expected<void> hold_side<1>(const Curve&, DomainSide, int, ConstraintList&);
template Expected<void> hold_side<3>(const Volume&, DomainSide, int, ConstraintList&);
template Expected<void> pin_place<1>(const Curve&, const std::array<double, 1>&,
                                     const std::optional<Point>&, ConstraintList&);
template Expected<void> pin_place<3>(const Volume&, const std::array<double, 3>&,
                                     const std::optional<Point>&, ConstraintList&);

}  // namespace knead
