#include "knead/spline/extremum.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "knead/spline/evaluate.hpp"
#include "surface_jet.hpp"

namespace knead {
namespace {

/// A smooth function of the surface point with gradient and Hessian in (u, v).
struct Value {
  double value = 0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
};

/// The functions to maximise: f = S·S, or ± one coordinate.
struct SquaredNorm {
  [[nodiscard]] double at(const Point& s) const { return s.squaredNorm(); }
  [[nodiscard]] Value at(const SurfaceJet& j) const {
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
  [[nodiscard]] Value at(const SurfaceJet& j) const {
    Value r;
    r.value = sign * j.d[0][axis];
    r.gradient = sign * Eigen::Vector2d(j.d[1][axis], j.d[2][axis]);
    r.hessian << j.d[3][axis], j.d[4][axis], j.d[4][axis], j.d[5][axis];
    r.hessian *= sign;
    return r;
  }
};

/// Sample parameters of one direction with the basis of the span they belong to, so that both
/// one-sided limits at a knot are sampled.
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
      samples.table.derivatives.resize(samples.table.derivatives.size() +
                                       static_cast<std::size_t>(p + 1));
      basis_values(knots, span, u,
                   samples.table.derivatives.data() + samples.table.derivatives.size() - (p + 1));
    }
  }
  return samples;
}

/// The ascent from a sample of f.
template <class Function>
class Ascent {
 public:
  Ascent(const Surface& surface, const Function& f, const Eigen::Vector2d& x, double value,
         const Eigen::Vector2d& spacing)
      : surface_(surface),
        f_(f),
        domain_{surface.knots(0).domain(), surface.knots(1).domain()},
        x_(x),
        value_(value),
        spacing_(spacing) {}

  [[nodiscard]] SurfaceMaximum top() {
    if (!climb()) search();
    return {value_, {x_[0], x_[1]}};
  }

 private:
  [[nodiscard]] Eigen::Vector2d clamped(const Eigen::Vector2d& y) const {
    return {std::clamp(y[0], domain_[0].lower, domain_[0].upper),
            std::clamp(y[1], domain_[1].lower, domain_[1].upper)};
  }

  [[nodiscard]] bool on_knot(int d) const {
    const auto knots = surface_.knots(d).knots();
    return std::binary_search(knots.begin(), knots.end(), x_[d]);
  }

  /// Moves to y if f is larger there.
  bool go(const Eigen::Vector2d& y) {
    const double there = f_.at(surface_point(surface_, y[0], y[1]));
    if (!(there > value_)) return false;
    x_ = y;
    value_ = there;
    return true;
  }

  /// Newton's iteration, each direction on its own where f is not concave; true if it reaches a
  /// smooth maximum.
  bool climb() {
    for (int iteration = 0; iteration < 20; ++iteration) {
      const Value here = f_.at(surface_jet(surface_, x_[0], x_[1]));
      const Eigen::Vector2d g = here.gradient;
      // Directions that lead out of the domain are fixed.
      bool held[2];
      for (int d = 0; d < 2; ++d)
        held[d] =
            (x_[d] <= domain_[d].lower && g[d] <= 0) || (x_[d] >= domain_[d].upper && g[d] >= 0);
      Eigen::Vector2d step = Eigen::Vector2d::Zero();
      const double det = here.hessian.determinant();
      if (!held[0] && !held[1] && here.hessian(0, 0) < 0 && det > 0)
        step = -here.hessian.inverse() * g;
      if (!step.allFinite()) step.setZero();  // nearly singular
      // A Newton step this short changes f by its square; inside a span the point is then a
      // maximum.
      constexpr double arrived = 1e-7;
      if (!step.isZero(0) && std::abs(step[0]) <= arrived * spacing_[0] &&
          std::abs(step[1]) <= arrived * spacing_[1] && !on_knot(0) && !on_knot(1)) {
        return true;
      }
      if (step.isZero(0)) {
        for (int d = 0; d < 2; ++d) {
          if (!held[d] && here.hessian(d, d) < 0) step[d] = -g[d] / here.hessian(d, d);
        }
      }
      for (int d = 0; d < 2; ++d) step[d] = std::clamp(step[d], -spacing_[d], spacing_[d]);
      bool moved = false;
      for (double t = 1; t > 1e-3 && !moved; t /= 2) moved = go(clamped(x_ + t * step));
      if (!moved) break;
    }
    return false;
  }

  /// A compass search: for creases and kinks, where Newton's steps mislead.
  void search() {
    for (double h = 0.5; h > 1e-7; h /= 2) {
      bool improved = true;
      for (int round = 0; improved && round < 4; ++round) {
        improved = false;
        for (int d = 0; d < 2; ++d) {
          for (double sign : {-1.0, 1.0}) {
            Eigen::Vector2d y = x_;
            y[d] += sign * h * spacing_[d];
            improved = go(clamped(y)) || improved;
          }
        }
      }
    }
  }

  const Surface& surface_;
  const Function& f_;
  Interval domain_[2];
  Eigen::Vector2d x_;
  double value_;
  Eigen::Vector2d spacing_;
};

/// A local maximum of the samples of one span.
struct Peak {
  double value;
  Eigen::Vector2d at, spacing;
};

/// The spans of a surface and their samples, shared by several functions.
class SampledSpans {
 public:
  explicit SampledSpans(const Surface& surface)
      : surface_(surface),
        u_(sample_spans(surface.knots(0))),
        v_(sample_spans(surface.knots(1))),
        in_hull_(std::ranges::all_of(surface.weights(), [](double w) { return w > 0; })) {}

  /// False if a denominator is not positive: then only the net can be used.
  [[nodiscard]] bool valid() const {
    if (in_hull_) return true;
    return evaluate_grid<2>(surface_, std::array<const BasisTable*, 2>{&u_.table, &v_.table})
        .has_value();
  }

  template <class Function>
  [[nodiscard]] SurfaceMaximum maximise(const Function& f) const {
    std::vector<Peak> peaks = peaks_of(f);
    std::ranges::sort(peaks, std::ranges::greater{}, &Peak::value);
    if (in_hull_ && is_top(f, peaks.front().value))
      return {peaks.front().value, {peaks.front().at[0], peaks.front().at[1]}};
    // On a plateau every sample is a peak: the best few suffice, since equal values refine to equal
    // values.
    constexpr std::size_t refined = 8;
    std::vector<Eigen::Vector2d> begun;  // a peak on a knot line belongs to both adjacent spans
    SurfaceMaximum best;
    for (const Peak& peak : peaks) {
      if (std::ranges::find(begun, peak.at) != begun.end()) continue;
      const SurfaceMaximum found = Ascent(surface_, f, peak.at, peak.value, peak.spacing).top();
      if (begun.empty() || found.value > best.value) best = found;
      begun.push_back(peak.at);
      if (begun.size() == refined) break;
    }
    return best;
  }

 private:
  /// Whether a sample reaches the largest value at a control point, but for rounding: corners of a
  /// face do, and all of a plane across an axis. Nothing is larger then, and ascents from every
  /// sample of a plateau would find so at length.
  template <class Function>
  [[nodiscard]] bool is_top(const Function& f, double value) const {
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    const Points& net = surface_.control_points();
    double bound = -std::numeric_limits<double>::infinity();
    for (Eigen::Index k = 0; k < net.rows(); ++k)
      bound = std::max(bound, f.at(Point(net.row(k).transpose())));
    return value >= bound - rounding * std::abs(bound);
  }

  const Surface& surface_;
  Samples u_, v_;
  bool in_hull_;

  /// f is convex and the surface of a span lies in the hull of its control points, so f is nowhere
  /// larger than at those: spans that cannot exceed the best value are not sampled.
  template <class Function>
  std::vector<Peak> peaks_of(const Function& f) const {
    const int n = surface_.net()[1], p = u_.table.degree, q = v_.table.degree, rows = p + 3,
              columns = q + 3;
    std::vector<double> values(static_cast<std::size_t>(surface_.size()));
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] =
          f.at(Point(surface_.control_points().row(static_cast<Eigen::Index>(k)).transpose()));
    }
    struct Span {
      double bound;
      int i, j;  // first samples
    };
    std::vector<Span> spans;
    for (int i = 0; i < u_.table.size(); i += rows) {
      for (int j = 0; j < v_.table.size(); j += columns) {
        double bound = -std::numeric_limits<double>::infinity();
        for (int r = 0; r <= p; ++r) {
          const auto first = values.begin() +
                             (u_.table.first[static_cast<std::size_t>(i)] + r) * n +
                             v_.table.first[static_cast<std::size_t>(j)];
          bound = std::max(bound, *std::max_element(first, first + q + 1));
        }
        spans.push_back({bound, i, j});
      }
    }
    std::ranges::make_heap(spans, {}, &Span::bound);  // of thousands of spans few are sampled
    std::vector<Peak> peaks;
    double best = -std::numeric_limits<double>::infinity();
    std::vector<double> samples(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
    while (!spans.empty()) {
      std::ranges::pop_heap(spans, {}, &Span::bound);
      const Span span = spans.back();
      spans.pop_back();
      if (in_hull_ && !(span.bound > best)) break;
      sample(f, span.i, span.j, samples);
      const auto at = [&](int k, int l) {
        return samples[static_cast<std::size_t>(k) * static_cast<std::size_t>(columns) +
                       static_cast<std::size_t>(l)];
      };
      for (int k = 0; k < rows; ++k) {
        for (int l = 0; l < columns; ++l) {
          bool peak = true;
          for (int a = std::max(0, k - 1); peak && a <= std::min(rows - 1, k + 1); ++a) {
            for (int b = std::max(0, l - 1); peak && b <= std::min(columns - 1, l + 1); ++b)
              peak = at(a, b) <= at(k, l);
          }
          if (!peak) continue;
          best = std::max(best, at(k, l));
          peaks.push_back({at(k, l),
                           {parameter(u_, span.i + k), parameter(v_, span.j + l)},
                           {spacing(u_, span.i + k), spacing(v_, span.j + l)}});
        }
      }
    }
    return peaks;
  }

  static double parameter(const Samples& s, int k) {
    return s.parameters[static_cast<std::size_t>(k)];
  }
  static double spacing(const Samples& s, int k) {
    double h = 0;
    if (k > 0) h = std::max(h, parameter(s, k) - parameter(s, k - 1));
    if (k + 1 < s.table.size()) h = std::max(h, parameter(s, k + 1) - parameter(s, k));
    return h;
  }

  /// f at the samples of one span, those of u outermost.
  template <class Function>
  void sample(const Function& f, int first_u, int first_v, std::vector<double>& values) const {
    const int n = surface_.net()[1], p = u_.table.degree, q = v_.table.degree;
    std::size_t to = 0;
    std::array<Eigen::Vector4d, max_degree + 1> line;
    for (int k = first_u; k < first_u + p + 3; ++k) {
      for (int c = 0; c <= q; ++c) {
        Eigen::Vector4d sum = Eigen::Vector4d::Zero();
        for (int r = 0; r <= p; ++r) {
          const int index = (u_.table.first[static_cast<std::size_t>(k)] + r) * n +
                            v_.table.first[static_cast<std::size_t>(first_v)] + c;
          const double weight =
              surface_.rational() ? surface_.weights()[static_cast<std::size_t>(index)] : 1;
          Eigen::Vector4d point;
          point << weight * surface_.control_points().row(index).transpose(), weight;
          sum += u_.table.row(k, 0)[r] * point;
        }
        line[static_cast<std::size_t>(c)] = sum;
      }
      for (int l = first_v; l < first_v + q + 3; ++l) {
        Eigen::Vector4d sum = Eigen::Vector4d::Zero();
        for (int c = 0; c <= q; ++c)
          sum += v_.table.row(l, 0)[c] * line[static_cast<std::size_t>(c)];
        values[to++] =
            f.at(Point(surface_.rational() ? Point(sum.head<3>() / sum[3]) : Point(sum.head<3>())));
      }
    }
  }
};

}  // namespace

// Branch and bound over spans: a span's bound is the largest value at its control points (f convex,
// convex hull), spans are sampled in the order of their bounds, and the first bound below the best
// sample ends it. Of thousands of spans of a displacement field only those near the largest
// displacement are ever evaluated.
SurfaceMaximum largest_norm(const Surface& surface) {
  const double size = surface.control_points().cwiseAbs().maxCoeff();
  if (std::isfinite(size) && size > 0 && std::abs(std::ilogb(size)) > 100) {
    // Squares, and products of squares, of numbers far from 1 over- or underflow; scaling by a
    // power of two is exact.
    const int half = -std::ilogb(size) / 2, rest = -std::ilogb(size) - half;
    const auto scaled = surface.with_control_points(surface.control_points() *
                                                    std::ldexp(1.0, half) * std::ldexp(1.0, rest));
    if (scaled) {
      SurfaceMaximum best = largest_norm(*scaled);
      best.value = std::ldexp(best.value, std::ilogb(size));
      return best;
    }
  }
  if ((surface.control_points().array() == 0).all()) {
    return {0, {surface.knots(0).domain().lower, surface.knots(1).domain().lower}};
  }
  const SampledSpans spans(surface);
  if (!spans.valid()) return {surface.control_points().rowwise().norm().maxCoeff(), {}};
  SurfaceMaximum best = spans.maximise(SquaredNorm{});
  best.value = std::sqrt(best.value);
  return best;
}

BoundingBox bounding_box(const Surface& surface) {
  const SampledSpans spans(surface);
  BoundingBox box;
  const bool valid = spans.valid();
  for (int axis = 0; axis < 3; ++axis) {
    if (!valid) {
      box.lower[axis] = surface.control_points().col(axis).minCoeff();
      box.upper[axis] = surface.control_points().col(axis).maxCoeff();
      continue;
    }
    box.lower[axis] = 0.0 - spans.maximise(Coordinate{axis, -1}).value;  // never -0
    box.upper[axis] = spans.maximise(Coordinate{axis, 1}).value;
  }
  return box;
}

}  // namespace knead
