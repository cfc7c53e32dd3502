#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "constraint_rows.hpp"

namespace knead {
namespace {

using detail::Terms;

constexpr double least_tolerance = 1e-9;
constexpr int most_chords = 4096;  // per span

/// Where the segment from a to b crosses knots, as fractions of its length, without the ends.
/// Between crossings the curve stays in one span, where the surface is one polynomial.
void add_crossings(const KnotVector& knots, double a, double b, std::vector<double>& cuts) {
  for (const int span : knots.spans()) {
    const double t = (knots[span] - a) / (b - a);
    if (t > 0 && t < 1) cuts.push_back(t);
  }
}

/// The spans that contain the open piece around the middle parameter: both sides if it runs along a
/// tear.
std::vector<int> spans_of_piece(const KnotVector& knots, double a, double b, double middle) {
  if (a == b) return detail::spans_at(knots, a, 0);
  return {knots.find_span(middle)};
}

struct PieceRows {
  std::vector<Terms> rows;
  double growth = 1;  // of the displacement between the points
};

// On a straight piece within a span of degrees p and q the numerator of D is a polynomial of degree
// p + q in the piece's parameter: it vanishes if it does at p + q + 1 points. Chebyshev's extreme
// points serve, between which a polynomial grows by at most 1 + (2/π) ln(p + q + 1) (H. Ehlich and
// K. Zeller, 1966): so a remainder at the points bounds D between them. Of a rational surface D W
// is the polynomial, and the ratio of W's largest to its smallest value comes in.
Expected<void> add_piece(const Surface& s, const std::array<double, 2>& from,
                         const std::array<double, 2>& to, int span_u, int span_v, PieceRows& out) {
  const int degree = s.knots(0).degree() + s.knots(1).degree();
  const auto at = [&](double t, Terms* row) -> Expected<double> {
    double x[2];
    const int spans[2] = {span_u, span_v};
    for (std::size_t d = 0; d < 2; ++d) {
      const KnotVector& knots = s.knots(static_cast<int>(d));
      x[d] = std::clamp(from[d] + t * (to[d] - from[d]), knots[spans[d]], knots[spans[d] + 1]);
    }
    double w = 1;
    auto made = detail::rational_row(s, x[0], x[1], span_u, span_v, -1, &w);
    if (!made) return std::unexpected(made.error());
    if (row != nullptr) *row = std::move(*made);
    return w;
  };
  double largest = 0, smallest = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= 2 * degree;
       ++k) {  // Chebyshev points 0, 2, 4 … carry conditions, those between sample W
    Terms row;
    const auto w = at(0.5 - 0.5 * std::cos(std::numbers::pi * k / (2 * degree)), &row);
    if (!w) return std::unexpected(w.error());
    if (k % 2 == 0) largest = std::max(largest, *w), out.rows.push_back(std::move(row));
    smallest = std::min(smallest, *w);
  }
  const double lebesgue = 1 + 2 / std::numbers::pi * std::log(degree + 1);
  out.growth = std::max(out.growth, lebesgue * (s.rational() ? largest / smallest : 1));
  return {};
}

}  // namespace

// Every piece of the polyline within a span gives p + q + 1 rows; most follow from others, since
// neighbouring pieces share functions. `select_rows` keeps the independent ones, to a tolerance
// divided by the growth between points.
Expected<CurveHold> keep_curve(const Surface& rest, const Parameters<2>& polyline, double tolerance,
                               ConstraintList& to, const std::string& name) {
  if (polyline.rows() < 2) return input_error("the curve has less than two points", name);
  if (!(tolerance > 0 && tolerance <= 1)) {
    return input_error(fmt::format("{} is not a tolerance", tolerance), name,
                       "use a number above 0, up to 1");
  }
  for (Eigen::Index k = 0; k < polyline.rows(); ++k) {
    for (int d = 0; d < 2; ++d) {
      if (auto inside = detail::check_parameter(rest.knots(d), polyline(k, d), d == 0 ? "u" : "v");
          !inside) {
        return std::unexpected(inside.error().within(fmt::format("{} point {}", name, k)));
      }
    }
  }
  PieceRows all;
  for (Eigen::Index k = 0; k + 1 < polyline.rows(); ++k) {
    const std::array<double, 2> a = {polyline(k, 0), polyline(k, 1)},
                                b = {polyline(k + 1, 0), polyline(k + 1, 1)};
    std::vector<double> cuts = {0, 1};
    for (std::size_t d = 0; d < 2; ++d) {
      if (a[d] != b[d]) add_crossings(rest.knots(static_cast<int>(d)), a[d], b[d], cuts);
    }
    std::ranges::sort(cuts);
    for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
      const auto point = [&](double t) {
        return std::array{std::lerp(a[0], b[0], t), std::lerp(a[1], b[1], t)};
      };
      const auto from = point(cuts[c]), middle = point(0.5 * (cuts[c] + cuts[c + 1])),
                 end = point(cuts[c + 1]);
      if (!(cuts[c] < cuts[c + 1]) && a != b) continue;
      for (const int span_u : spans_of_piece(rest.knots(0), a[0], b[0], middle[0])) {
        for (const int span_v : spans_of_piece(rest.knots(1), a[1], b[1], middle[1])) {
          if (auto added = add_piece(rest, from, end, span_u, span_v, all); !added) {
            return std::unexpected(added.error().within(name));
          }
        }
      }
    }
  }
  for (Eigen::Index k = 0; k < polyline.rows();
       ++k) {  // a vertex on a tear lies on both sides of it
    const double u = polyline(k, 0), v = polyline(k, 1);
    const auto spans_u = detail::spans_at(rest.knots(0), u, 0),
               spans_v = detail::spans_at(rest.knots(1), v, 0);
    if (spans_u.size() * spans_v.size() == 1) continue;
    for (const int span_u : spans_u) {
      for (const int span_v : spans_v) {
        auto row = detail::rational_row(rest, u, v, span_u, span_v);
        if (!row) return std::unexpected(row.error().within(name));
        all.rows.push_back(std::move(*row));
      }
    }
  }
  const double least = std::max(tolerance, least_tolerance) / all.growth;
  const auto selected = detail::select_rows(all.rows, least);
  if (!selected) return std::unexpected(selected.error().within(name));
  for (const int k : selected->chosen)
    detail::append(to, name, std::move(all.rows[static_cast<std::size_t>(k)]));
  return CurveHold{static_cast<int>(selected->chosen.size()), all.growth * selected->remainder};
}

// Chords are doubled until the middle of each, straight in parameters, is near enough to the
// curve's on the surface: for a smooth curve the deviation falls by four each time, and is largest
// near the middle.
Expected<Parameters<2>> parameter_polyline(const Surface& rest, const Curve& parameter_curve,
                                           double tolerance) {
  if (auto valid = detail::check_tolerance(tolerance, "curve"); !valid)
    return std::unexpected(valid.error());
  const KnotVector& knots = parameter_curve.knots(0);
  for (int chords = 1; chords <= most_chords; chords *= 2) {
    std::vector<double> parameters;  // ends of chords and, between them, their midpoints
    for (const int span : knots.spans()) {
      for (int k = 0; k < 2 * chords; ++k)
        parameters.push_back(std::lerp(knots[span], knots[span + 1], k / (2.0 * chords)));
    }
    parameters.push_back(knots.domain().upper);
    const auto on_curve = evaluate_grid<1>(parameter_curve, {parameters});
    if (!on_curve) return std::unexpected(on_curve.error());
    const Points& c = on_curve->points();
    const Eigen::Index count = c.rows() / 2;
    Parameters<2> polyline(count + 1, 2), on_chords(count, 2), middles(count, 2);
    for (Eigen::Index k = 0; k <= count; ++k) polyline.row(k) = c.row(2 * k).head<2>();
    for (Eigen::Index k = 0; k < count; ++k) {
      middles.row(k) = c.row(2 * k + 1).head<2>();
      on_chords.row(k) = 0.5 * (polyline.row(k) + polyline.row(k + 1));
    }
    const auto curved = evaluate(rest, middles), straight = evaluate(rest, on_chords);
    if (!curved) return std::unexpected(curved.error().within("curve"));
    if (!straight) return std::unexpected(straight.error().within("curve"));
    if ((curved->points() - straight->points()).rowwise().norm().maxCoeff() <= tolerance)
      return polyline;
  }
  return numerical_error(
      fmt::format("the curve is not within {} of {} chords per span", tolerance, most_chords),
      "curve", "use a larger tolerance");
}

}  // namespace knead
