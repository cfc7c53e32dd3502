#pragma once

#include <memory>
#include <vector>

#include "spline/foot_search.hpp"

namespace knead::detail {

/// A plane curve over σ in [0, 1] whose coordinates are monotone: a segment, origin + size σ, or
/// half a quarter of a superellipse, origin + (size.x X, size.y Y) with X^p + Y^p = 1, p = 2/e:
///   s = σ^m, X = (1 + s^p)^(−1/p), Y = s X,  or X and Y exchanged (the other half).
/// s = Y/X is evenly distributed where a trigonometric parameter crowds; m makes second derivatives
/// bounded for 1 < p < 2 or p < 1 (at σ = 0 the curve then has infinite curvature or a cusp, and
/// its first derivative vanishes).
class MonotoneCurve {
 public:
  using Vector2 = Eigen::Vector2d;
  [[nodiscard]] static MonotoneCurve segment(const Vector2& from, const Vector2& to);
  [[nodiscard]] static MonotoneCurve arc(const Vector2& centre, const Vector2& size,
                                         double exponent, bool exchanged);

  /// The curve and its first two derivatives at σ.
  [[nodiscard]] std::array<Vector2, 3> at(double sigma) const;
  /// The ranges of the same six numbers over [lower, upper], ranges[derivative][coordinate], and in
  /// a fourth row those of the first derivative divided by σ^k, k the smaller exponent with which
  /// its coordinates vanish at σ = 0.
  [[nodiscard]] std::array<std::array<Range, 2>, 4> over(const Range& sigma) const;

 private:
  struct Factors;
  [[nodiscard]] Factors factors(double sigma, bool bounds) const;
  [[nodiscard]] Factors computed(double sigma, bool bounds) const;

  bool straight_ = true, exchanged_ = false;
  Vector2 origin_ = Vector2::Zero(), size_ = Vector2::Zero();
  double p_ = 2;
  int m_ = 1;
  std::shared_ptr<const std::vector<Factors>> table_;  // at whole multiples of 1/`halves`
};

/// S(u, v) = offset + scale ∘ (f g, f k, h) with (f, h)(u) and (g, k)(v) monotone curves: every
/// surface of revolution and every superquadric, one octant at a time. `axes` gives the coordinate
/// that each of the three becomes.
class SeparablePatch final : public Patch {
 public:
  SeparablePatch(const ParameterRectangle& rectangle, const MonotoneCurve& meridian,
                 const MonotoneCurve& parallel, const Point& scale,
                 const Point& offset = Point::Zero(), std::array<int, 3> axes = {0, 1, 2})
      : Patch(rectangle),
        meridian_(meridian),
        parallel_(parallel),
        scale_(scale),
        offset_(offset),
        axes_(axes) {}

  [[nodiscard]] PatchBounds bounds(const ParameterRectangle& at) const override;
  [[nodiscard]] PatchJet jet(double u, double v) const override;
  [[nodiscard]] bool pole(std::size_t side, const std::array<double, 2>& at) const override {
    return side == 1 && std::abs(meridian_.at(at[0])[0][0]) < 1e-6;
  }

 private:
  MonotoneCurve meridian_, parallel_;
  Point scale_, offset_;
  std::array<int, 3> axes_;
};

}  // namespace knead::detail
