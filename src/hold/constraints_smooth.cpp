#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/decompositions.hpp"
#include "constraint_rows.hpp"

namespace knead {
namespace {

using detail::LocalBasis;
using detail::NetAcross;
using detail::proportional;
using detail::Terms;

/// A knot line of multiplicity p or p + 1: its two sides, and the rest shape at samples along it.
struct Line {
  NetAcross net;
  int direction;
  double knot;
  int span_left, span_right;
  LocalBasis left, right;
  std::vector<double> along;  // parameters of the samples
  Points across_left, across_right, tangent;
  double gap = 0, angle = 0, ratio = 1, ratio_error = 0;
  bool pointlike = false;

  Line(const Surface& s, int d, double c)
      : net(s, d),
        direction(d),
        knot(c),
        span_left(net.knots().find_span(c, Side::left)),
        span_right(net.knots().find_span(c, Side::right)),
        left(net.knots(), span_left, c, 1),
        right(net.knots(), span_right, c, 1) {}

  [[nodiscard]] bool torn_basis() const { return left.last() < right.first; }
  Expected<void> measure();
};

// Chebyshev points, 2q + 4 a span of degree q along the line: more than the degree of a product of
// the numerators and weights on both sides needs, and none on a knot, where one-sided limits would
// differ.
Expected<void> Line::measure() {
  const KnotVector& knots = net.knots_along();
  const int samples = 2 * knots.degree() + 4;
  for (const int span : knots.spans()) {
    for (int k = 0; k < samples; ++k) {
      const double t = 0.5 - 0.5 * std::cos(std::numbers::pi * (2 * k + 1) / (2 * samples));
      const double v = std::lerp(knots[span], knots[span + 1], t);
      if (v > knots[span] && v < knots[span + 1]) along.push_back(v);
    }
  }
  Parameters<2> at(static_cast<Eigen::Index>(along.size()), 2);
  for (std::size_t k = 0; k < along.size(); ++k) {
    at(static_cast<Eigen::Index>(k), direction) = knot;
    at(static_cast<Eigen::Index>(k), 1 - direction) = along[k];
  }
  const auto l = evaluate(net.surface(), at, 1, Side::left),
             r = evaluate(net.surface(), at, 1, Side::right);
  if (!l) return std::unexpected(l.error());
  if (!r) return std::unexpected(r.error());
  across_left = l->at(net.derivative(1, 0));
  across_right = r->at(net.derivative(1, 0));
  tangent = l->at(net.derivative(0, 1));
  const Points tangent_right = r->at(net.derivative(0, 1));
  gap = (l->points() - r->points()).rowwise().norm().maxCoeff();
  int normals = 0;
  for (Eigen::Index k = 0; k < at.rows(); ++k) {
    const Point a = across_left.row(k), b = across_right.row(k), v = tangent.row(k),
                w = tangent_right.row(k);
    const Point before = a.cross(v), after = b.cross(w);
    if (before.norm() <= 1e-12 * a.norm() * v.norm() || after.norm() <= 1e-12 * b.norm() * w.norm())
      continue;
    ++normals;
    angle = std::max(angle, std::atan2(before.cross(after).norm(), before.dot(after)));
  }
  pointlike = normals == 0;
  const double square = across_left.squaredNorm();
  ratio = square > 0 ? across_left.cwiseProduct(across_right).sum() / square : 1;
  const double size = across_left.rowwise().norm().maxCoeff() * std::abs(ratio);
  ratio_error =
      size > 0 ? (across_right - ratio * across_left).rowwise().norm().maxCoeff() / size : 0;
  return {};
}

/// Σ_k a_k b_k / Σ_k a_k² fits b = f a; `error` becomes the largest |b − f a| in units of `scale`.
double proportion(const std::vector<double>& a, const std::vector<double>& b,
                  const std::vector<double>& scale, double& error) {
  double ab = 0, aa = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    ab += a[k] * b[k] / (scale[k] * scale[k]), aa += a[k] * a[k] / (scale[k] * scale[k]);
  const double f = aa > 0 ? ab / aa : 0;
  error = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    error = std::max(error, std::abs(b[k] - f * a[k]) / scale[k]);
  return f;
}

/// σ and κ of the weights at the line, and whether they are constant along it.
struct WeightRatios {
  double sigma = 1, kappa = 0;
  bool positions = true, derivatives = true;
};

// With E the numerator and D = E/W: D_u⁺ = ρ D_u⁻ and D⁺ = D⁻ read E_u⁺/σ − ρ E_u⁻ = κ E⁻, where W⁺
// = σ W⁻ and W_u⁺/σ − ρ W_u⁻ = κ W⁻. If σ and κ are constant along the line, this is one equation
// for each function along it, exact; otherwise both sides are rational functions of other
// denominators, and samples must do.
WeightRatios weight_ratios(const Line& line) {
  WeightRatios result;
  const NetAcross& net = line.net;
  if (!net.surface().rational()) return result;
  std::vector<double> before, after, jump, size, w;
  double error = 0;
  const auto sum = [&](const LocalBasis& basis, int order, int j, double& total) {
    double s = 0;
    for (int i = basis.first; i <= basis.last(); ++i) {
      const double term = basis.at(i, order) * net.weight(i, j);
      s += term;
      total += std::abs(term);
    }
    return s;
  };
  for (int j = 0; j < net.columns(); ++j) {
    double total = 0;
    before.push_back(sum(line.left, 0, j, total));
    after.push_back(sum(line.right, 0, j, total));
    size.push_back(total);
  }
  if (line.torn_basis()) {
    result.sigma = proportion(before, after, size, error);
    result.positions = error <= proportional && result.sigma > 0;
  }
  for (int j = 0; j < net.columns(); ++j) {
    double total_left = 0, total_right = 0;
    jump.push_back(sum(line.right, 1, j, total_right) / result.sigma -
                   line.ratio * sum(line.left, 1, j, total_left));
    size[static_cast<std::size_t>(j)] =
        total_right / std::abs(result.sigma) + std::abs(line.ratio) * total_left;
  }
  result.kappa = proportion(before, jump, size, error);
  result.derivatives = error <= proportional;
  return result;
}

/// Adds factor · (terms of the row).
void add(Terms& sum, const Terms& row, double factor) {
  for (const auto& [unknown, c] : row) sum.emplace_back(unknown, factor * c);
}

/// Merges repeated unknowns.
Terms united(Terms terms) {
  std::ranges::sort(terms);
  Terms result;
  for (const auto& [unknown, c] : terms) {
    if (!result.empty() && result.back().first == unknown) {
      result.back().second += c;
    } else {
      result.emplace_back(unknown, c);
    }
  }
  return result;
}

/// D on one side of the line at the sample v, with its derivatives across and along.
Expected<std::array<Terms, 3>> rows_at(const Line& line, double v, int span_across) {
  std::array<Terms, 3> result;
  const Surface& s = line.net.surface();
  const int span_along = line.net.knots_along().find_span(v);
  const std::array kinds = {-1, line.direction, 1 - line.direction};
  for (std::size_t k = 0; k < 3; ++k) {
    auto row = line.direction == 0
                   ? detail::rational_row(s, line.knot, v, span_across, span_along, kinds[k])
                   : detail::rational_row(s, v, line.knot, span_along, span_across, kinds[k]);
    if (!row) return std::unexpected(row.error());
    result[k] = std::move(*row);
  }
  return result;
}

Expected<void> append_selected(std::vector<Terms> rows, const std::string& name, double tolerance,
                               ConstraintList& to) {
  for (Terms& row : rows) {
    row = united(std::move(row));
    double sum = 0;
    for (const auto& [unknown, c] : row) sum += std::abs(c);
    for (auto& [unknown, c] : row) c /= sum > 0 ? sum : 1;
  }
  const auto selected = detail::select_rows(rows, tolerance);
  if (!selected) return std::unexpected(selected.error().within(name));
  for (const int k : selected->chosen)
    detail::append(to, name, std::move(rows[static_cast<std::size_t>(k)]));
  return {};
}

/// C0 at samples, or D_u⁺ = λ D_u⁻ + μ D_v with λ and μ of the rest shape at each sample.
///
/// Least squares express S_u⁺ by S_u⁻ and S_v of the rest shape, and D_u⁺ obeys the same: the three
/// stay in a plane at the samples, and to the tolerance between.
Expected<void> couple_samples(const Line& line, bool derivatives, const std::string& name,
                              double tolerance, ConstraintList& to) {
  std::vector<Terms> rows;
  for (std::size_t k = 0; k < line.along.size(); ++k) {
    const auto left = rows_at(line, line.along[k], line.span_left),
               right = rows_at(line, line.along[k], line.span_right);
    if (!left) return std::unexpected(left.error());
    if (!right) return std::unexpected(right.error());
    Terms row = (*right)[derivatives ? 1 : 0];
    if (derivatives) {
      const auto at = static_cast<Eigen::Index>(k);
      Eigen::MatrixXd frame(3, 2);
      frame << line.across_left.row(at).transpose(), line.tangent.row(at).transpose();
      const auto factors =
          detail::least_squares(frame, Eigen::VectorXd(line.across_right.row(at).transpose()));
      if (!factors) return std::unexpected(factors.error().within(name));
      add(row, (*left)[1], -(*factors)[0]);
      add(row, (*left)[2], -(*factors)[1]);
    } else {
      add(row, (*left)[0], -1);
    }
    rows.push_back(std::move(row));
  }
  return append_selected(std::move(rows), name, tolerance, to);
}

Expected<void> couple_positions(const Line& line, const WeightRatios& weights,
                                const std::string& name, const SmoothOptions& options,
                                ConstraintList& to) {
  if (!line.torn_basis()) return {};
  if (!weights.positions) return couple_samples(line, false, name, options.tolerance, to);
  for (int j = 0; j < line.net.columns(); ++j) {
    detail::append(
        to, name,
        {{line.net.index(line.right.first, j), 1.0}, {line.net.index(line.left.last(), j), -1.0}});
  }
  return {};
}

// E_u⁺/σ − ρ E_u⁻ − κ E⁻ = 0 for each function along the line, `ratio` being ρ.
void couple_derivatives(const Line& line, const WeightRatios& weights, const std::string& name,
                        ConstraintList& to) {
  for (int j = 0; j < line.net.columns(); ++j) {
    Terms terms;
    for (int i = line.left.first; i <= line.right.last(); ++i) {
      const double c = line.right.at(i, 1) / weights.sigma - line.ratio * line.left.at(i, 1) -
                       weights.kappa * line.left.at(i, 0);
      terms.emplace_back(line.net.index(i, j), c * line.net.weight(i, j));
    }
    detail::append(to, name, std::move(terms));
  }
}

// Positions first, whatever the angle: a torn basis would open where it creases. Then tangents, by
// the exact conditions where speeds and weights are in constant ratios, at samples elsewhere.
Expected<SmoothLine> keep_smooth_line(Line& line, const SmoothOptions& options, double size,
                                      ConstraintList& to) {
  if (auto measured = line.measure(); !measured) return std::unexpected(measured.error());
  SmoothLine result{line.direction, line.knot, line.net.knots().multiplicity(line.knot)};
  result.angle = line.angle;
  result.ratio = line.ratio;
  const std::string name =
      fmt::format("smooth line {} = {}", line.direction == 0 ? "u" : "v", line.knot);
  const std::size_t before = to.constraints.size();
  const auto finish = [&](SmoothLine::State state) {
    result.state = state;
    result.constraints = static_cast<int>(to.constraints.size() - before);
    return result;
  };
  using enum SmoothLine::State;
  if (line.torn_basis() && line.gap > options.gap * size) return finish(torn);
  const WeightRatios weights = weight_ratios(line);
  if (auto joined = couple_positions(line, weights, name, options, to); !joined)
    return std::unexpected(joined.error());
  if (line.net.knots().degree() == 1) return finish(linear);
  if (line.pointlike) return finish(pointlike);
  if (line.angle > options.angle) return finish(crease);
  if (weights.positions && weights.derivatives && line.ratio > 0 &&
      line.ratio_error <= options.angle) {
    couple_derivatives(line, weights, name, to);
    return finish(coupled);
  }
  if (auto joined = couple_samples(line, true, name, options.tolerance, to); !joined)
    return std::unexpected(joined.error());
  return finish(sampled);
}

}  // namespace

// Only interior lines of multiplicity p or more: elsewhere every D of the space is C¹. On an error
// no condition is left behind.
Expected<std::vector<SmoothLine>> keep_smooth(const Surface& rest, const SmoothOptions& options,
                                              ConstraintList& to) {
  for (const auto& [value, name] :
       {std::pair{options.angle, "angle"}, std::pair{options.gap, "gap"},
        std::pair{options.tolerance, "tolerance"}}) {
    if (auto valid = detail::check_tolerance(value, name); !valid)
      return std::unexpected(valid.error());
  }
  const Points& points = rest.control_points();
  const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  const std::size_t before = to.constraints.size();
  std::vector<SmoothLine> lines;
  for (int d = 0; d < 2; ++d) {
    const KnotVector& knots = rest.knots(d);
    for (const int span : knots.spans()) {
      const double knot = knots[span];
      if (knot == knots.domain().lower || knots.multiplicity(knot) < knots.degree()) continue;
      Line line(rest, d, knot);
      auto kept = keep_smooth_line(line, options, size, to);
      if (!kept) {
        to.constraints.resize(before);
        return std::unexpected(kept.error());
      }
      lines.push_back(*kept);
    }
  }
  return lines;
}

}  // namespace knead
