#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "base/decompositions.hpp"
#include "form_energy.hpp"

namespace knead::detail {

/// The derivatives of a shape that its forms depend on: of a curve S' and S'', of a volume S_u, S_v
/// and S_w, as columns.
template <int D>
inline constexpr int form_vectors = D == 1 ? 2 : 3;
template <int D>
using FormDerivatives = Eigen::Matrix<double, 3, form_vectors<D>>;

/// What the rest shape gives at one point.
template <int D>
struct FormRest {
  double weight;  // of the quadrature
  Eigen::Matrix<double, D, D> metric;
  double curvature = 0;
};

/// κ² = (s r − t²)/s³ of s = S'·S', t = S'·S'', r = S''·S'', with its derivatives by these.
struct SquaredCurvature {
  double value;
  Eigen::Vector3d gradient;
  Eigen::Matrix3d hessian;

  explicit SquaredCurvature(const FormDerivatives<1>& d) {
    const double s = d.col(0).squaredNorm(), t = d.col(0).dot(d.col(1)), r = d.col(1).squaredNorm();
    const double s3 = s * s * s, s4 = s3 * s;
    value = d.col(0).cross(d.col(1)).squaredNorm() / s3;  // s r − t² without cancellation
    gradient << r / s3 - 3 * value / s, -2 * t / s3, 1 / (s * s);
    hessian << 6 * r / s4 - 12 * t * t / (s4 * s), 6 * t / s4, -2 / s3,  //
        6 * t / s4, -2 / s3, 0,                                          //
        -2 / s3, 0, 0;
  }
};

/// The energy density of a point with its derivatives by those of the shape, one vector after the
/// other.
template <int D>
struct FormPoint {
  static constexpr int unknowns = 3 * form_vectors<D>;

  double metric = 0, bend = 0;
  Eigen::Matrix<double, unknowns, 1> gradient = Eigen::Matrix<double, unknowns, 1>::Zero();
  Eigen::Matrix<double, unknowns, unknowns> hessian =
      Eigen::Matrix<double, unknowns, unknowns>::Zero();
  Eigen::Matrix<double, unknowns, unknowns> material =
      hessian;                         // the part of products of first derivatives
  Eigen::Matrix<double, D, D> stress;  // 4 w e

  FormPoint(const FormDerivatives<D>& a, const FormRest<D>& rest, const FormWeights& weights)
      : stress(4 * weights.w1 * strain(a, rest)) {
    add_metric(a, rest, weights.w1);
    if constexpr (D == 1) {
      if (weights.w2 > 0) add_curvature(a, rest.curvature, weights.w2);
    }
    hessian += material;
  }

  /// `material` and the geometric part of positive principal stresses.
  [[nodiscard]] Eigen::Matrix<double, unknowns, unknowns> tense() const {
    Eigen::Matrix<double, unknowns, unknowns> sum = material;
    Eigen::Matrix<double, D, D> tension = stress;  // where it is not finite, neither is the result
    if (const auto principal = detail::symmetric_eigen(stress)) {
      const auto& axes = principal->vectors;
      tension = axes * principal->values.cwiseMax(0).asDiagonal() * axes.transpose();
    }
    for (int i = 0; i < D; ++i) {
      for (int k = 0; k < D; ++k)
        sum.template block<3, 3>(3 * i, 3 * k).diagonal().array() += tension(i, k);
    }
    return sum;
  }

 private:
  [[nodiscard]] static Eigen::Matrix<double, D, D> strain(const FormDerivatives<D>& a,
                                                          const FormRest<D>& rest) {
    const auto tangents = a.template leftCols<D>();
    return tangents.transpose() * tangents - rest.metric;
  }

  /// w Σ e_ij², e_ij = S_i·S_j − S⁰_i·S⁰_j.
  ///   ∂/∂S_i = 4 w Σ_j e_ij S_j,
  ///   ∂²/∂S_i ∂S_k = 4 w (S_k S_iᵀ + δ_ik Σ_j S_j S_jᵀ) + 4 w e_ik I.
  /// The first part, of products of first derivatives, is positive semidefinite; the second is the
  /// geometric stiffness, negative where e is a compression.
  void add_metric(const FormDerivatives<D>& a, const FormRest<D>& rest, double w) {
    const auto tangents = a.template leftCols<D>();
    const Eigen::Matrix<double, D, D> e = strain(a, rest);
    const Eigen::Matrix3d sum = tangents * tangents.transpose();
    metric = w * e.squaredNorm();
    for (int i = 0; i < D; ++i) {
      gradient.template segment<3>(3 * i) = 4 * w * tangents * e.col(i);
      for (int k = 0; k < D; ++k) {
        auto part = material.template block<3, 3>(3 * i, 3 * k);
        part = 4 * w * tangents.col(k) * tangents.col(i).transpose();
        if (i == k) part += 4 * w * sum;
        hessian.template block<3, 3>(3 * i, 3 * k).diagonal().array() += stress(i, k);
      }
    }
  }

  /// w (κ − κ⁰)² = w φ(κ²), φ(k) = k − 2 κ⁰ √k + κ⁰².
  /// With s, t, r as in `SquaredCurvature` the chain rule gives both derivatives through three
  /// scalars. φ has no second derivative at k = 0 unless κ⁰ = 0, where w κ² is smooth: there the
  /// part of products is that of the vector c with |c| = κ, elsewhere that of κ itself. What
  /// remains is what `hessian` has beyond it.
  void add_curvature(const FormDerivatives<D>& a, double at_rest, double w) {
    const SquaredCurvature k(a);
    const double curvature = std::sqrt(k.value);
    bend = w * (curvature - at_rest) * (curvature - at_rest);
    if (k.value == 0 && at_rest > 0) return;  // no derivative
    const double slope = at_rest > 0 ? 1 - at_rest / curvature : 1;
    const double bent = at_rest > 0 ? at_rest / (2 * k.value * curvature) : 0;
    // Derivatives of s, t, r.
    Eigen::Matrix<double, 6, 3> gram = Eigen::Matrix<double, 6, 3>::Zero();
    gram.template block<3, 1>(0, 0) = 2 * a.col(0);
    gram.template block<3, 1>(0, 1) = a.col(1);
    gram.template block<3, 1>(3, 1) = a.col(0);
    gram.template block<3, 1>(3, 2) = 2 * a.col(1);
    const Eigen::Matrix<double, 6, 1> g = gram * k.gradient;
    gradient += w * slope * g;
    Eigen::Matrix<double, 6, 6> all = gram * k.hessian * gram.transpose();
    all.template topLeftCorner<3, 3>().diagonal().array() += 2 * k.gradient[0];
    all.template topRightCorner<3, 3>().diagonal().array() += k.gradient[1];
    all.template bottomLeftCorner<3, 3>().diagonal().array() += k.gradient[1];
    all.template bottomRightCorner<3, 3>().diagonal().array() += 2 * k.gradient[2];
    all = w * (slope * all + bent * g * g.transpose());
    // κ = |c|, c = S' × S''/|S'|³
    const double s = a.col(0).squaredNorm(), cube = s * std::sqrt(s);
    const Eigen::Vector3d c = a.col(0).cross(a.col(1)) / cube;
    Eigen::Matrix<double, 3, 6> dc;
    dc << -cross_matrix(a.col(1)) / cube - 3 / s * c * a.col(0).transpose(),
        cross_matrix(a.col(0)) / cube;
    Eigen::Matrix<double, 6, 6> part = 2 * w * dc.transpose() * dc;
    if (at_rest > 0) {
      const Eigen::Matrix<double, 1, 6> row = c.transpose() / curvature * dc;
      part = 2 * w * row.transpose() * row;
    }
    material += part;
    hessian += all - part;
  }

  static Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& x) {
    Eigen::Matrix3d m;
    m << 0, -x[2], x[1], x[2], 0, -x[0], -x[1], x[0], 0;
    return m;
  }
};

/// The basis on one element: the derivatives of L functions at its Gauss points, side by side.
struct FormElement {
  std::vector<int> nodes;
  Eigen::MatrixXd derivative;
};

}  // namespace knead::detail
