#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "shape_kernel.hpp"

namespace knead::detail {
namespace {

class Sphere final : public ShapeKernel {
 public:
  explicit Sphere(double radius) : radius_(radius) {
    size = radius;
    box = {Point::Constant(-radius), Point::Constant(radius)};
  }
  Nearest nearest(const Point& x) const override {
    Nearest r;
    double norm = x.norm();
    if (!(norm > 1e-150 && norm < 1e150)) norm = x.stableNorm();  // the squares under- or overflow
    r.distance = norm - radius_;
    if (norm == 0) {
      r.point = Point(0, 0, radius_);
      return r;
    }
    r.normal = x / norm;
    r.point = radius_ * r.normal;
    r.hessian = (1 / norm) * (Eigen::Matrix3d::Identity() - r.normal * r.normal.transpose());
    return r;
  }

 private:
  double radius_;
};

class Plane final : public ShapeKernel {
 public:
  Plane() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    size = infinity;
    box = {Point::Constant(-infinity), Point::Constant(infinity)};
  }
  Nearest nearest(const Point& x) const override {
    Nearest r;
    r.distance = x.z();
    r.point = Point(x.x(), x.y(), 0);
    r.normal = Point::UnitZ();
    return r;
  }
};

/// A box of half sizes `core` grown by `rounding`.
class Box final : public ShapeKernel {
 public:
  Box(const Point& half_sizes, double rounding)
      : core_((half_sizes.array() - rounding).max(0.0)), half_(half_sizes), rounding_(rounding) {
    size = half_sizes.minCoeff();
    box = {-half_sizes, half_sizes};
  }
  Nearest nearest(const Point& x) const override {
    Nearest r;
    const Point side = x.unaryExpr([](double c) { return std::signbit(c) ? -1.0 : 1.0; }),
                folded = x.cwiseAbs();
    const Point beyond = (folded - core_).cwiseMax(0.0);
    const double reach = beyond.stableNorm();
    if (reach > 0) {
      Point n = beyond / reach;
      // A direction along one axis is exactly that axis, and the distance is a difference.
      const int axes = static_cast<int>((beyond.array() > 0).count());
      int axis = 0;
      beyond.maxCoeff(&axis);
      r.distance = axes == 1 ? folded[axis] - half_[axis] : reach - rounding_;
      if (axes == 1) n = Point::Unit(axis);
      r.normal = side.cwiseProduct(n);
      r.point = side.cwiseProduct(folded.cwiseMin(core_) + rounding_ * n);
      if (axes == 1) r.point[axis] = side[axis] * half_[axis];
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          if (beyond[a] > 0 && beyond[b] > 0) {
            r.hessian(a, b) = ((a == b ? 1.0 : 0.0) - r.normal[a] * r.normal[b]) / reach;
          }
        }
      }
      return r;
    }
    int axis = 0;
    r.distance = (folded - half_).maxCoeff(&axis);
    r.normal[axis] = side[axis];
    r.point = x;
    r.point[axis] = side[axis] * half_[axis];
    return r;
  }

 private:
  Point core_, half_;
  double rounding_;
};

/// The nearest point solves y_i = a_i² x_i / (τ + a_i² − a_0²), a_0 the smallest semi-axis, with τ
/// the root of the convex decreasing g(τ) = Σ (a_i x_i / (τ + a_i² − a_0²))² − 1 on τ > 0: Newton's
/// iteration from the left of the root increases towards it and always converges (D. Eberly,
/// Distance from a Point to an Ellipsoid; here with Newton's iteration).
/// Substituting τ + a_i² − a_0² for the Lagrange parameter keeps differences of nearly equal
/// squares out of the sum: gap_i = (a_i − a_0)(a_i + a_0). At τ = max(a_i x_i − gap_i) one term is
/// 1, so that g >= 0 there and the iteration starts left of the root.
class Ellipsoid final : public ShapeKernel {
 public:
  explicit Ellipsoid(const Point& semi_axes) : a_(semi_axes) {
    size = semi_axes.minCoeff(&smallest_);
    box = {-semi_axes, semi_axes};
    for (int i = 0; i < 3; ++i) gap_[i] = (a_[i] - size) * (a_[i] + size);
  }
  Nearest nearest(const Point& x) const override {
    Nearest r;
    const Point side = x.unaryExpr([](double c) { return std::signbit(c) ? -1.0 : 1.0; }),
                folded = x.cwiseAbs();
    const Point weighted = a_.cwiseProduct(folded);
    const Point y = foot(weighted);
    Point n = y.cwiseQuotient(a_).cwiseQuotient(a_ / size);  // in units that cannot overflow
    const double slope = n.norm();
    n /= slope;
    r.distance = (folded - y).dot(n);
    r.point = side.cwiseProduct(y);
    r.normal = side.cwiseProduct(n);
    if (symmetric_tie(folded, y)) {
      r.normal.setZero();
      return r;
    }
    // With B = diag(1/a²)/|∇F/2| the shape operator is W = P B P, and ∇²φ = W (I + φ W)^-1 on the
    // tangent plane.
    const Point b = (a_.cwiseAbs2() / size).cwiseInverse() / slope;
    Eigen::Matrix<double, 3, 2> t;
    t.col(0) = r.normal.unitOrthogonal();
    t.col(1) = r.normal.cross(t.col(0));
    const Eigen::Matrix2d w = t.transpose() * b.asDiagonal() * t;
    const Eigen::Matrix2d grown = Eigen::Matrix2d::Identity() + r.distance * w;
    if (!(grown.determinant() > 0)) return r;  // a focal point: no second derivative
    r.hessian = t * (w * grown.inverse()) * t.transpose();
    r.hessian = 0.5 * (r.hessian + r.hessian.transpose()).eval();
    return r;
  }

 private:
  [[nodiscard]] Point foot(const Point& weighted) const {
    const auto g = [&](double tau, double& slope) {
      double sum = -1;
      slope = 0;
      for (int i = 0; i < 3; ++i) {
        if (weighted[i] == 0) continue;
        const double d = tau + gap_[i], q = weighted[i] / d;
        sum += q * q;
        slope -= 2 * q * q / d;
      }
      return sum;
    };
    double tau = 0, slope = 0;
    for (int i = 0; i < 3; ++i)
      tau = std::max(tau, weighted[i] - gap_[i]);  // term i alone is 1 there: g >= 0
    bool rooted = tau > 0;
    if (!rooted) {
      // Nothing along the shortest axis (or underflow): g(0) decides between a root and the medial
      // disc.
      double sum = -1;
      for (int i = 0; i < 3; ++i) {
        if (gap_[i] > 0) sum += (weighted[i] / gap_[i]) * (weighted[i] / gap_[i]);
      }
      rooted = sum > 0;
    }
    if (rooted) {
      for (int k = 0; k < 100; ++k) {
        const double value = g(tau, slope);
        if (!(value > 0) || slope == 0) break;
        const double next = tau - value / slope;
        if (!(next > tau)) break;
        tau = next;
      }
      Point y;
      for (int i = 0; i < 3; ++i)
        y[i] = weighted[i] == 0 ? 0 : a_[i] * (weighted[i] / (tau + gap_[i]));
      return y;
    }
    Point y = Point::Zero();
    double rest = 1;
    for (int i = 0; i < 3; ++i) {
      if (gap_[i] == 0) continue;
      const double q = weighted[i] / gap_[i];
      y[i] = a_[i] * q;
      rest -= q * q;
    }
    y[smallest_] = a_[smallest_] * std::sqrt(std::max(0.0, rest));

    return y;
  }
  /// x has no component along two or three equal shortest axes, but the nearest point has.
  [[nodiscard]] bool symmetric_tie(const Point& x, const Point& y) const {
    int equal = 0;
    double part = 0;
    for (int i = 0; i < 3; ++i) {
      if (gap_[i] == 0) ++equal, part = std::max(part, x[i]);
    }
    return equal > 1 && part == 0 && y[smallest_] > 0;
  }

  Point a_, gap_ = Point::Zero();
  int smallest_ = 0;
};

}  // namespace

Kernel sphere_kernel(double radius) { return std::make_unique<Sphere>(radius); }
Kernel ellipsoid_kernel(const Point& semi_axes) { return std::make_unique<Ellipsoid>(semi_axes); }
Kernel box_kernel(const Point& half_sizes, double rounding) {
  return std::make_unique<Box>(half_sizes, rounding);
}
Kernel plane_kernel() { return std::make_unique<Plane>(); }

}  // namespace knead::detail
