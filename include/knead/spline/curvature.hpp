#pragma once

#include <array>

#include "knead/spline/evaluate.hpp"

namespace knead {

/// The fundamental forms of a surface at a point, from its derivatives there:
///   first   E = S_u·S_u, F = S_u·S_v, G = S_v·S_v,
///   second  L = n·S_uu, M = n·S_uv, N = n·S_vv      (do Carmo, Differential Geometry of Curves and
///   Surfaces, 2.5, 3.3).
/// For surfaces already evaluated on a grid; `curvature` serves single points.
struct FundamentalForms {
  double e = 0, f = 0, g = 0;  ///< length²
  double l = 0, m = 0, n = 0;  ///< length

  /// \param normal the unit normal n: S_u × S_v / |S_u × S_v|, or its opposite, which changes the
  /// sign of L, M, N.
  FundamentalForms(const Point& u, const Point& v, const Point& uu, const Point& uv,
                   const Point& vv, const Point& normal)
      : e(u.dot(u)),
        f(u.dot(v)),
        g(v.dot(v)),
        l(normal.dot(uu)),
        m(normal.dot(uv)),
        n(normal.dot(vv)) {}

  /// E G − F² = |S_u × S_v|².
  [[nodiscard]] double squared_area() const { return e * g - f * f; }
  /// Whether the derivatives span a tangent plane: E G − F² > 1e-18 (E + G)². False at poles and
  /// cusps, where none of the quantities below is defined.
  [[nodiscard]] bool regular() const { return squared_area() > 1e-18 * (e + g) * (e + g); }
  /// H = (E N − 2 F M + G L) / (2 (E G − F²)), 1/length.
  [[nodiscard]] double mean() const { return (e * n - 2 * f * m + g * l) / (2 * squared_area()); }
  /// K = (L N − M²) / (E G − F²), 1/length².
  [[nodiscard]] double gaussian() const { return (l * n - m * m) / squared_area(); }
};

/// How a surface bends at a point. Curvatures are positive where the surface bends towards the
/// normal: those of a sphere with outward normals are −1/radius.
struct SurfaceCurvature {
  Point normal = Point::Zero();       ///< S_u × S_v / |S_u × S_v|
  double mean = 0;                    ///< H = (κ₁ + κ₂)/2, 1/length
  double gaussian = 0;                ///< K = κ₁ κ₂, 1/length²
  std::array<double, 2> principal{};  ///< κ₁ >= κ₂, 1/length
  std::array<Point, 2> directions = {Point::Zero(),
                                     Point::Zero()};  ///< of κ₁ and κ₂: unit vectors, right-handed
                                                      ///< with the normal; at an umbilic along S_u
};

/// The second fundamental form as a symmetric map of space, W = J I⁻¹ II I⁻¹ Jᵀ with J = (S_u,
/// S_v): xᵀ W x is the normal curvature in a unit tangent direction x, W n = 0, 1/length. In space,
/// unlike in parameters, the maps of two surfaces can be subtracted (do Carmo, § 3-2). Only where
/// the forms are regular; its sign is that of the forms' normal.
[[nodiscard]] Eigen::Matrix3d shape_operator(const Point& u, const Point& v,
                                             const FundamentalForms& forms);
/// The same from principal curvatures and directions, Σ κ_k e_k e_kᵀ.
[[nodiscard]] Eigen::Matrix3d shape_operator(const SurfaceCurvature& curvature);

/// The curvatures of a surface at (u, v), at a knot those of the limit from `side` in both
/// directions.
///
/// The second form is expressed in the orthonormal frame S_u/|S_u|, n × S_u/|S_u| and its symmetric
/// 2 × 2 matrix diagonalised in closed form, so that nothing is lost near umbilics. Accuracy: a few
/// ulp of the largest curvature, times (|S_u| |S_v| / |S_u × S_v|)². Cost: one evaluation of
/// order 2. Errors: (u, v) outside the domain or not finite (input); no tangent plane there, as at
/// a pole, or a denominator that is not positive (numerical).
[[nodiscard]] Expected<SurfaceCurvature> curvature(const Surface& surface,
                                                   const std::array<double, 2>& at,
                                                   Side side = Side::right);

/// How a curve bends at a point.
struct CurveCurvature {
  Point tangent = Point::Zero();  ///< C' / |C'|
  /// Towards the centre of curvature, unit; zero where the curve is straight.
  Point normal = Point::Zero();
  double curvature = 0;  ///< κ = |C' × C''| / |C'|³ >= 0, 1/length
};

/// The curvature of a curve at t. Errors: t outside the domain or not finite (input); C' = 0, or a
/// denominator that is not positive (numerical).
[[nodiscard]] Expected<CurveCurvature> curvature(const Curve& curve, double t,
                                                 Side side = Side::right);

}  // namespace knead
