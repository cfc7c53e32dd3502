#include "knead/spline/curvature.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

namespace knead {

Eigen::Matrix3d shape_operator(const Point& u, const Point& v, const FundamentalForms& forms) {
  Eigen::Matrix<double, 3, 2> dual;  // J I⁻¹: e^i with e^i · S_j = δ_ij
  dual.col(0) = (forms.g * u - forms.f * v) / forms.squared_area();
  dual.col(1) = (forms.e * v - forms.f * u) / forms.squared_area();
  Eigen::Matrix2d second;
  second << forms.l, forms.m, forms.m, forms.n;
  return dual * second * dual.transpose();
}

Eigen::Matrix3d shape_operator(const SurfaceCurvature& curvature) {
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < 2; ++k) {
    const Point& along = curvature.directions[k];
    result += curvature.principal[k] * along * along.transpose();
  }
  return result;
}

Expected<SurfaceCurvature> curvature(const Surface& surface, const std::array<double, 2>& at,
                                     Side side) {
  Parameters<2> parameters(1, 2);
  parameters << at[0], at[1];
  const auto value = evaluate<2>(surface, parameters, 2, side);
  if (!value) return std::unexpected(value.error());
  const auto derivative = [&](int i, int j) { return Point(value->at({i, j}).row(0).transpose()); };
  const Point u = derivative(1, 0), v = derivative(0, 1);

  SurfaceCurvature result;
  result.normal = u.cross(v).normalized();
  const FundamentalForms forms(u, v, derivative(2, 0), derivative(1, 1), derivative(0, 2),
                               result.normal);
  if (!forms.regular()) {
    return numerical_error("the derivatives span no tangent plane",
                           fmt::format("({}, {})", at[0], at[1]), "ask beside the pole or cusp");
  }
  // S_u = r₁₁ e₁ and S_v = r₁₂ e₁ + r₂₂ e₂; the second form in the frame (e₁, e₂) is [a b; b c].
  const double r11 = u.norm();
  const Point e1 = u / r11, e2 = result.normal.cross(e1);
  const double ratio = v.dot(e1) / r11, r22 = v.dot(e2);
  const double a = forms.l / (r11 * r11);
  const double b = (forms.m - ratio * forms.l) / (r11 * r22);
  const double c = (forms.n - ratio * (2 * forms.m - ratio * forms.l)) / (r22 * r22);
  const double middle = 0.5 * (a + c), half = 0.5 * (a - c), radius = std::hypot(half, b);
  result.mean = middle;
  result.gaussian = a * c - b * b;
  result.principal = {middle + radius, middle - radius};
  const double turn = 0.5 * std::atan2(b, half);
  result.directions[0] = std::cos(turn) * e1 + std::sin(turn) * e2;
  result.directions[1] = std::cos(turn) * e2 - std::sin(turn) * e1;
  return result;
}

Expected<CurveCurvature> curvature(const Curve& curve, double t, Side side) {
  Parameters<1> parameters(1);
  parameters(0) = t;
  const auto value = evaluate<1>(curve, parameters, 2, side);
  if (!value) return std::unexpected(value.error());
  const Point first = value->at({1}).row(0).transpose(), second = value->at({2}).row(0).transpose();
  const double speed = first.norm();
  if (!(speed > 0)) {
    return numerical_error("the first derivative vanishes", fmt::format("t = {}", t),
                           "ask beside the cusp");
  }
  CurveCurvature result;
  result.tangent = first / speed;
  const Point across = second - result.tangent.dot(second) * result.tangent;
  result.curvature = across.norm() / (speed * speed);
  if (across.norm() > 0) result.normal = across.normalized();
  return result;
}

}  // namespace knead
