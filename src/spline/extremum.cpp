#include "knead/spline/extremum.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "homogeneous.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

/// S and its derivatives to order 2 (00, 10, 01, 20, 11, 02) at one point, without going over the whole net.
struct Jet {
  std::array<Point, 6> d;
};

Jet jet_at(const Surface& surface, double u, double v) {
  const KnotVector& ku = surface.knots(0);
  const KnotVector& kv = surface.knots(1);
  const int p = ku.degree(), q = kv.degree(), n = kv.count(), su = ku.find_span(u), sv = kv.find_span(v);
  std::array<double, 3 * (max_degree + 1)> nu, nv;
  basis_derivatives(ku, su, u, 2, nu.data());
  basis_derivatives(kv, sv, v, 2, nv.data());
  static constexpr std::array<std::array<int, 2>, 6> orders = {{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
  std::array<Eigen::Vector4d, 6> h;
  h.fill(Eigen::Vector4d::Zero());
  for (int r = 0; r <= p; ++r) {
    for (int c = 0; c <= q; ++c) {
      const int index = (su - p + r) * n + sv - q + c;
      const double weight = surface.rational() ? surface.weights()[static_cast<std::size_t>(index)] : 1;
      Eigen::Vector4d point;
      point << weight * surface.control_points().row(index).transpose(), weight;
      for (std::size_t k = 0; k < 6; ++k) {
        h[k] += nu[static_cast<std::size_t>(orders[k][0] * (p + 1) + r)] *
                nv[static_cast<std::size_t>(orders[k][1] * (q + 1) + c)] * point;
      }
    }
  }
  Jet jet;
  if (!surface.rational()) {
    for (std::size_t k = 0; k < 6; ++k) jet.d[k] = h[k].head<3>();
    return jet;
  }
  static const detail::QuotientRule<2> rule(2);
  std::vector<Points> cartesian(6, Points::Zero(1, 3));
  rule.apply(h.front().data(), 4, 0, cartesian);  // the samples have shown the denominator to be positive
  for (std::size_t k = 0; k < 6; ++k) jet.d[k] = cartesian[k].row(0).transpose();
  return jet;
}

/// A smooth function of the surface point with gradient and Hessian in (u, v).
struct Value {
  double value = 0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
};

/// The functions that are maximised: f = S·S, or ± one coordinate.
struct SquaredNorm {
  [[nodiscard]] double at(const Point& s) const { return s.squaredNorm(); }
  [[nodiscard]] Value at(const Jet& j) const {
    Value r;
    r.value = j.d[0].squaredNorm();
    r.gradient = 2 * Eigen::Vector2d(j.d[0].dot(j.d[1]), j.d[0].dot(j.d[2]));
    const double mixed = 2 * (j.d[1].dot(j.d[2]) + j.d[0].dot(j.d[4]));
    r.hessian << 2 * (j.d[1].squaredNorm() + j.d[0].dot(j.d[3])), mixed, mixed,
        2 * (j.d[2].squaredNorm() + j.d[0].dot(j.d[5]));
    return r;
  }
};

struct Coordinate {
  int axis;
  double sign;
  [[nodiscard]] double at(const Point& s) const { return sign * s[axis]; }
  [[nodiscard]] Value at(const Jet& j) const {
    Value r;
    r.value = sign * j.d[0][axis];
    r.gradient = sign * Eigen::Vector2d(j.d[1][axis], j.d[2][axis]);
    r.hessian << j.d[3][axis], j.d[4][axis], j.d[4][axis], j.d[5][axis];
    r.hessian *= sign;
    return r;
  }
};

/// Sample parameters of one direction with the basis of the span they were taken for, so that both one-sided limits at
/// a knot are seen.
struct Samples {
  std::vector<double> parameters;
  BasisTable table;
};

Samples sample_spans(const KnotVector& knots) {
  Samples samples;
  const int p = knots.degree(), steps = p + 2;
  samples.table.degree = p;
  for (int span : knots.spans()) {
    const double a = knots[span], b = knots[span + 1];
    for (int k = 0; k <= steps; ++k) {
      const double u = k == steps ? b : a + (b - a) * k / steps;
      samples.parameters.push_back(u);
      samples.table.first.push_back(span - p);
      samples.table.derivatives.resize(samples.table.derivatives.size() + static_cast<std::size_t>(p + 1));
      basis_values(knots, span, u, samples.table.derivatives.data() + samples.table.derivatives.size() - (p + 1));
    }
  }
  return samples;
}

template <class Function>
SurfaceMaximum refine(const Surface& surface, const Function& f, Eigen::Vector2d x, double value,
                      const Eigen::Vector2d& spacing) {
  const Interval du = surface.knots(0).domain(), dv = surface.knots(1).domain();
  const auto clamp = [&](const Eigen::Vector2d& y) {
    return Eigen::Vector2d(std::clamp(y[0], du.lower, du.upper), std::clamp(y[1], dv.lower, dv.upper));
  };
  const auto value_at = [&](const Eigen::Vector2d& y) { return f.at(jet_at(surface, y[0], y[1]).d[0]); };
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Value here = f.at(jet_at(surface, x[0], x[1]));
    Eigen::Vector2d g = here.gradient;
    // Directions that lead out of the domain are held.
    bool held[2];
    for (int d = 0; d < 2; ++d) {
      const Interval& domain = d == 0 ? du : dv;
      held[d] = (x[d] <= domain.lower && g[d] <= 0) || (x[d] >= domain.upper && g[d] >= 0);
    }
    Eigen::Vector2d step = Eigen::Vector2d::Zero();
    const double det = here.hessian.determinant();
    if (!held[0] && !held[1] && here.hessian(0, 0) < 0 && det > 0) step = -here.hessian.inverse() * g;
    if (!step.allFinite()) step.setZero();  // all but singular
    if (step.isZero(0)) {
      for (int d = 0; d < 2; ++d) {
        if (!held[d] && here.hessian(d, d) < 0) step[d] = -g[d] / here.hessian(d, d);
      }
    }
    for (int d = 0; d < 2; ++d) step[d] = std::clamp(step[d], -spacing[d], spacing[d]);
    bool moved = false;
    for (double t = 1; t > 1e-3 && !moved; t /= 2) {
      const Eigen::Vector2d y = clamp(x + t * step);
      const double there = value_at(y);
      if (there > value) {
        x = y;
        value = there;
        moved = true;
      }
    }
    if (!moved) break;
  }
  // Creases and kinks, where Newton's steps mislead.
  for (double h = 0.5; h > 1e-7; h /= 2) {
    bool improved = true;
    for (int round = 0; improved && round < 4; ++round) {
      improved = false;
      for (int d = 0; d < 2; ++d) {
        for (double sign : {-1.0, 1.0}) {
          Eigen::Vector2d y = x;
          y[d] += sign * h * spacing[d];
          y = clamp(y);
          const double there = value_at(y);
          if (there > value) {
            x = y;
            value = there;
            improved = true;
          }
        }
      }
    }
  }
  return {value, {x[0], x[1]}};
}

/// The maximum of f from a grid of sampled points.
template <class Function>
SurfaceMaximum maximise(const Surface& surface, const Function& f, const Samples& u, const Samples& v,
                        const Points& points) {
  const int m = u.table.size(), n = v.table.size();
  std::vector<double> values(static_cast<std::size_t>(m) * static_cast<std::size_t>(n));
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = f.at(Point(points.row(static_cast<Eigen::Index>(k))));
  const auto at = [&](int i, int j) {
    return values[static_cast<std::size_t>(i) * static_cast<std::size_t>(n) + static_cast<std::size_t>(j)];
  };
  std::vector<std::pair<double, std::pair<int, int>>> peaks;
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      bool peak = true;
      for (int a = std::max(0, i - 1); peak && a <= std::min(m - 1, i + 1); ++a) {
        for (int b = std::max(0, j - 1); peak && b <= std::min(n - 1, j + 1); ++b) peak = at(a, b) <= at(i, j);
      }
      if (peak) peaks.push_back({at(i, j), {i, j}});
    }
  }
  // A plateau makes every sample a peak: the best few will do, since equal values refine to equal values.
  constexpr std::size_t refined = 8;
  const std::size_t count = std::min(refined, peaks.size());
  std::partial_sort(peaks.begin(), peaks.begin() + static_cast<std::ptrdiff_t>(count), peaks.end(),
                    [](const auto& a, const auto& b) { return a.first > b.first; });
  SurfaceMaximum best;
  for (std::size_t k = 0; k < count; ++k) {
    const auto [i, j] = peaks[k].second;
    const auto spacing = [](const Samples& s, int at_sample) {
      double h = 0;
      if (at_sample > 0)
        h = std::max(h, s.parameters[static_cast<std::size_t>(at_sample)] -
                            s.parameters[static_cast<std::size_t>(at_sample - 1)]);
      if (at_sample + 1 < s.table.size())
        h = std::max(h, s.parameters[static_cast<std::size_t>(at_sample + 1)] -
                            s.parameters[static_cast<std::size_t>(at_sample)]);
      return h;
    };
    const SurfaceMaximum found =
        refine(surface, f, {u.parameters[static_cast<std::size_t>(i)], v.parameters[static_cast<std::size_t>(j)]},
               peaks[k].first, {spacing(u, i), spacing(v, j)});
    if (k == 0 || found.value > best.value) best = found;
  }
  return best;
}

struct SampledSurface {
  Samples u, v;
  Points points;
};

SampledSurface sample(const Surface& surface) {
  SampledSurface s{sample_spans(surface.knots(0)), sample_spans(surface.knots(1)), {}};
  if (auto grid = evaluate_grid<2>(surface, std::array<const BasisTable*, 2>{&s.u.table, &s.v.table})) {
    s.points = std::move(grid->derivatives.front());
  } else {
    s.points = surface.control_points();  // no positive denominator: the net is all there is
    s.u = s.v = {};
  }
  return s;
}

}  // namespace

SurfaceMaximum largest_norm(const Surface& surface) {
  const double size = surface.control_points().cwiseAbs().maxCoeff();
  if (std::isfinite(size) && size > 0 && std::abs(std::ilogb(size)) > 100) {
    // Squares, and products of squares, of numbers far from 1 leave the range of numbers; a power of two costs no
    // digit.
    const int half = -std::ilogb(size) / 2, rest = -std::ilogb(size) - half;
    const auto scaled =
        surface.with_control_points(surface.control_points() * std::ldexp(1.0, half) * std::ldexp(1.0, rest));
    if (scaled) {
      SurfaceMaximum best = largest_norm(*scaled);
      best.value = std::ldexp(best.value, std::ilogb(size));
      return best;
    }
  }
  const SampledSurface s = sample(surface);
  if (s.u.parameters.empty()) return {s.points.rowwise().norm().maxCoeff(), {}};
  if ((s.points.array() == 0).all() && (surface.control_points().array() == 0).all()) {
    return {0, {surface.knots(0).domain().lower, surface.knots(1).domain().lower}};
  }
  SurfaceMaximum best = maximise(surface, SquaredNorm{}, s.u, s.v, s.points);
  best.value = std::sqrt(best.value);
  return best;
}

BoundingBox bounding_box(const Surface& surface) {
  const SampledSurface s = sample(surface);
  BoundingBox box;
  for (int axis = 0; axis < 3; ++axis) {
    if (s.u.parameters.empty()) {
      box.lower[axis] = s.points.col(axis).minCoeff();
      box.upper[axis] = s.points.col(axis).maxCoeff();
      continue;
    }
    box.lower[axis] = 0.0 - maximise(surface, Coordinate{axis, -1}, s.u, s.v, s.points).value;  // never -0
    box.upper[axis] = maximise(surface, Coordinate{axis, 1}, s.u, s.v, s.points).value;
  }
  return box;
}

}  // namespace knead
