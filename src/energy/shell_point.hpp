#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace knead::detail {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// What the rest shape gives at one Gauss point.
struct ShellRest {
  double weight;  // of the quadrature, times the measure that the energy is integrated over
  double area;    // of the quadrature, times the area element
  double mass;    // that times the mass per area
  Eigen::Vector3d metric, curvature;
  Eigen::Matrix3d membrane, bending;  // stress resultants per strain

  [[nodiscard]] Vector6 stress(const Vector6& strain) const {
    Vector6 result;
    result.head<3>() = membrane * strain.head<3>();
    result.tail<3>() = bending * strain.tail<3>();
    return result;
  }
};

/// The basis on one element.
struct ShellElement {
  std::vector<int> nodes;      // local function -> control point
  Eigen::MatrixXd derivative;  // L × 5 per point: R_,1, R_,2, R_,11, R_,22, R_,12
  Eigen::MatrixXd value;       // L × points
};

/// S_u, S_v, S_uu, S_vv, S_uv at one point, as columns.
using ShellDerivatives = Eigen::Matrix<double, 3, 5>;

/// The local geometry of a surface. Triples hold the components 11, 22, 12 of a symmetric tensor.
struct ShellPoint {
  Eigen::Matrix<double, 3, 2> tangent, dual;  // a_1, a_2 and a^1, a^2 with a^α·a_β = δ
  Eigen::Vector3d normal;
  double area;                              // |a_1 × a_2|
  Eigen::Vector3d metric, curvature;        // a_αβ, b_αβ
  Eigen::Vector3d inverse;                  // a^αβ
  Eigen::Matrix<double, 3, 2> christoffel;  // (αβ, γ): S_αβ·a^γ

  explicit ShellPoint(const ShellDerivatives& d) : tangent(d.leftCols<2>()) {
    const Eigen::Vector3d cross = tangent.col(0).cross(tangent.col(1));
    area = cross.norm();
    normal = cross / area;
    metric << tangent.col(0).squaredNorm(), tangent.col(1).squaredNorm(),
        tangent.col(0).dot(tangent.col(1));
    const double determinant = area * area;
    inverse << metric[1] / determinant, metric[0] / determinant, -metric[2] / determinant;
    dual.col(0) = inverse[0] * tangent.col(0) + inverse[2] * tangent.col(1);
    dual.col(1) = inverse[2] * tangent.col(0) + inverse[1] * tangent.col(1);
    curvature.noalias() = d.rightCols<3>().transpose() * normal;
    christoffel.noalias() = d.rightCols<3>().transpose() * dual;
  }
};

/// The elasticity tensor of plane stress without its thickness, for strains written 11, 22, 2·12.
inline Eigen::Matrix3d plane_stress(const Eigen::Vector3d& inverse, double young, double poisson) {
  const double a = inverse[0], b = inverse[1], c = inverse[2];
  Eigen::Matrix3d m;
  m << a * a, poisson * a * b + (1 - poisson) * c * c, a * c,  //
      0, b * b, b * c,                                         //
      0, 0, ((1 - poisson) * a * b + (1 + poisson) * c * c) / 2;
  m.triangularView<Eigen::StrictlyLower>() = m.transpose();
  return young / (1 - poisson * poisson) * m;
}

/// The part of membrane forces n^αβ that pulls: with A = L Lᵀ the metric, Lᵀ n L without its
/// negative eigenvalues.
inline Eigen::Vector3d tension(const Eigen::Vector3d& force, const Eigen::Vector3d& metric) {
  Eigen::Matrix2d l = Eigen::Matrix2d::Zero(), n;
  l(0, 0) = std::sqrt(metric[0]);
  l(1, 0) = metric[2] / l(0, 0);
  l(1, 1) = std::sqrt(std::max(0.0, metric[1] - l(1, 0) * l(1, 0)));
  n << force[0], force[2], force[2], force[1];
  const Eigen::Matrix2d here = l.transpose() * n * l;
  const double mean = (here(0, 0) + here(1, 1)) / 2, half = (here(0, 0) - here(1, 1)) / 2,
               shear = here(0, 1);
  const double radius = std::sqrt(half * half + shear * shear);
  if (mean >= radius) return force;
  if (mean <= -radius) return Eigen::Vector3d::Zero();
  // (mean + radius) times the projection on the direction of the larger principal value.
  const double share = (mean + radius) / (2 * radius);
  Eigen::Matrix2d pulling;
  pulling << share * (radius + half), share * shear, share * shear, share * (radius - half);
  const Eigen::Matrix2d inverse = l.inverse(), back = inverse.transpose() * pulling * inverse;
  return {back(0, 0), back(1, 1), back(0, 1)};
}

/// ε and κ of a point against the rest shape's forms, each written 11, 22, 2·12.
inline Vector6 shell_strain(const ShellPoint& at, const Eigen::Vector3d& metric,
                            const Eigen::Vector3d& curvature) {
  Vector6 strain;
  strain.head<3>() = (at.metric - metric) / 2;
  strain.tail<3>() = curvature - at.curvature;
  strain[2] *= 2;
  strain[5] *= 2;
  return strain;
}

/// The functions of one point that strains depend on: for local function r the covariant second
/// derivatives c_αβ = R_,αβ − Γ^γ_αβ R_,γ, with which δb_αβ = n · Σ_r c_αβ(r) δx_r. \param basis
/// R_,1, R_,2, R_,11, R_,22, R_,12 as columns.
template <class Basis>
Eigen::MatrixX3d covariant_second(const ShellPoint& at, const Basis& basis) {
  Eigen::MatrixX3d c = basis.template rightCols<3>();
  c.noalias() -= basis.template leftCols<2>() * at.christoffel.transpose();
  return c;
}

/// ∂(ε, κ)/∂x of one point: 6 rows, columns c L + r for coordinate c of local function r.
template <class Basis, class Out>
void strain_rows(const ShellPoint& at, const Basis& basis, const Eigen::MatrixX3d& second,
                 Out&& rows) {
  const Eigen::Index local = basis.rows();
  for (Eigen::Index c = 0; c < 3; ++c) {
    auto block = rows.middleCols(c * local, local);
    const double a1 = at.tangent(c, 0), a2 = at.tangent(c, 1), n = at.normal[c];
    block.row(0) = a1 * basis.col(0).transpose();
    block.row(1) = a2 * basis.col(1).transpose();
    block.row(2) = a2 * basis.col(0).transpose() + a1 * basis.col(1).transpose();
    block.row(3) = -n * second.col(0).transpose();
    block.row(4) = -n * second.col(1).transpose();
    block.row(5) = -2 * n * second.col(2).transpose();
  }
}

}  // namespace knead::detail
