#include "mass_spring.hpp"

#include <Eigen/LU>
#include <cmath>

#include "knead/spline/basis.hpp"

namespace knead::examples {

Eigen::MatrixXd differenced_contour(int n, double alpha, double beta, double h) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  const double second = alpha / (h * h), fourth = beta / (h * h * h * h);
  for (int i = 0; i < n; ++i) {
    const auto at = [&](int offset) -> double& { return a(i, (i + offset + n) % n); };
    at(0) = 2 * second + 6 * fourth;
    at(-1) = at(1) = -second - 4 * fourth;
    at(-2) = at(2) = fourth;
  }
  return a;
}

Eigen::MatrixXd spring_ring(int n, double stretch, double bend) {
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n, before = (i + n - 1) % n;
    k(i, i) += stretch, k(next, next) += stretch;
    k(i, next) -= stretch, k(next, i) -= stretch;
    const std::array<int, 3> at = {before, i, next};
    constexpr std::array<double, 3> c = {1, -2, 1};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t s = 0; s < 3; ++s) k(at[r], at[s]) += bend * c[r] * c[s];
    }
  }
  return k;
}

Eigen::MatrixXd spring_chain(int n, double stretch) {
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i + 1 < n; ++i) {
    k(i, i) += stretch, k(i + 1, i + 1) += stretch;
    k(i, i + 1) -= stretch, k(i + 1, i) -= stretch;
  }
  return k;
}

SparseMatrix spring_sheet(int n, double stretch, double bend) {
  const int inner = n - 2;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < inner; ++i) {
    for (int j = 0; j < inner; ++j) {
      const int at = i * inner + j;
      entries.emplace_back(at, at, 4);
      if (i > 0) entries.emplace_back(at, at - inner, -1);
      if (i + 1 < inner) entries.emplace_back(at, at + inner, -1);
      if (j > 0) entries.emplace_back(at, at - 1, -1);
      if (j + 1 < inner) entries.emplace_back(at, at + 1, -1);
    }
  }
  SparseMatrix laplacian(inner * inner, inner * inner);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  // On a hinged border the mirrored neighbours make the bend the square of the Laplacian.
  const SparseMatrix squared = laplacian * laplacian;
  return stretch * laplacian + bend * squared;
}

Relaxation relax(const SparseMatrix& k, const Eigen::VectorXd& f, double slowest,
                 double tolerance) {
  double fastest = 0;  // Gershgorin
  for (Eigen::Index j = 0; j < k.outerSize(); ++j) {
    double sum = 0;
    for (SparseMatrix::InnerIterator it(k, j); it; ++it) sum += std::abs(it.value());
    fastest = std::max(fastest, sum);
  }
  const double damping = 2 * std::sqrt(slowest), step = 1.8 / std::sqrt(fastest);
  Relaxation result{Eigen::VectorXd::Zero(f.size())};
  Eigen::VectorXd v = result.x, r = f;
  const double target = tolerance * f.norm();
  while (r.norm() > target && result.steps < 10'000'000) {
    v = (v + step * r) / (1 + step * damping);
    result.x += step * v;
    r = f - k * result.x;
    ++result.steps;
  }
  return result;
}

Eigen::MatrixXd basis_matrix(const KnotVector& knots, const std::vector<double>& at) {
  Eigen::MatrixXd result =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(at.size()), knots.count());
  std::array<double, max_degree + 1> values;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const int span = knots.find_span(at[k]);
    basis_values(knots, span, at[k], values.data());
    for (int r = 0; r <= knots.degree(); ++r) {
      result(static_cast<Eigen::Index>(k), span - knots.degree() + r) =
          values[static_cast<std::size_t>(r)];
    }
  }
  return result;
}

Expected<KnotVector> averaged_knots(const std::vector<double>& at) {
  std::vector<double> knots(4, at.front());
  for (std::size_t j = 1; j + 3 < at.size(); ++j)
    knots.push_back((at[j] + at[j + 1] + at[j + 2]) / 3);
  knots.insert(knots.end(), 4, at.back());
  return KnotVector::create(3, std::move(knots));
}

std::vector<double> equidistant(int n) {
  std::vector<double> result;
  for (int k = 0; k < n; ++k) result.push_back(static_cast<double>(k) / (n - 1));
  return result;
}

GlobalInterpolation::GlobalInterpolation(const KnotVector& knots, const std::vector<double>& at)
    : collocation_(basis_matrix(knots, at)), inverse_(collocation_.partialPivLu().inverse()) {}

Eigen::MatrixXd GlobalInterpolation::control_points(const Eigen::MatrixXd& heights) const {
  return inverse_ * heights * inverse_.transpose();
}

Eigen::MatrixXd GlobalInterpolation::heights(const Eigen::MatrixXd& control_points) const {
  return collocation_ * control_points * collocation_.transpose();
}

}  // namespace knead::examples
