#include "two_passes.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "knead/energy/stiffness.hpp"
#include "knead/gramian/gramian.hpp"

namespace knead::examples {
namespace {

using Matrix = Eigen::MatrixXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// G_kk of the free functions.
Matrix free_gramian(const KnotVector& knots, int order, int held) {
  const Matrix all = gramian(knots, order, order)->dense();
  const Eigen::Index free = all.rows() - 2 * held;
  return all.block(held, held, free, free);
}

/// Σ_k weights_k G_kk.
Matrix weighted(const KnotVector& knots, const Eigen::Vector3d& weights, int held) {
  Matrix sum = Matrix::Zero(knots.count() - 2 * held, knots.count() - 2 * held);
  for (int k = 0; k < 3; ++k) {
    if (weights[k] != 0) sum += weights[k] * free_gramian(knots, k, held);
  }
  return sum;
}

Expected<void> check_held(const std::array<KnotVector, 2>& knots, int held) {
  if (held >= 0 && 2 * held < knots[0].count() && 2 * held < knots[1].count()) return {};
  return input_error("nothing is free to move", "held", "hold fewer control points");
}

}  // namespace

Expected<ProductTerms> product_terms(const Energy<2>& energy) {
  ProductTerms terms = ProductTerms::Zero();
  for (const EnergyTerm<2>& term : energy) {
    if (term.coefficient == 0) continue;
    if (term.a != term.b) {
      return input_error(
          fmt::format("a term has derivatives ({}, {}) on one side and ({}, {}) on the other",
                      term.a[0], term.a[1], term.b[0], term.b[1]),
          "energy", "leave out alpha12");
    }
    terms(term.a[0], term.a[1]) += term.coefficient;
  }
  return terms;
}

Expected<TwoPasses> TwoPasses::create(const std::array<KnotVector, 2>& knots,
                                      const Energy<2>& energy, int held) {
  if (auto free = check_held(knots, held); !free) return std::unexpected(free.error());
  const auto terms = product_terms(energy);
  if (!terms) return std::unexpected(terms.error());
  // c = a bᵀ: the row and the column of the largest entry, if c has rank 1.
  Eigen::Index row = 0, column = 0;
  const double largest = terms->cwiseAbs().maxCoeff(&row, &column);
  if (!(largest > 0)) return input_error("there is no energy", "energy");
  const Eigen::Vector3d a = terms->col(column) / (*terms)(row, column),
                        b = terms->row(row).transpose();
  if ((a * b.transpose() - *terms).cwiseAbs().maxCoeff() > 1e-14 * largest) {
    return input_error("the terms of the energy are no single product", "energy",
                       "solve the vectorised system");
  }
  TwoPasses result;
  for (std::size_t d = 0; d < 2; ++d) {
    auto factor = std::make_shared<Factor>();
    factor->compute(weighted(knots[d], d == 0 ? a : b, held).sparseView());
    if (factor->info() != Eigen::Success) {
      return input_error(fmt::format("the factor of direction {} is not positive definite", d + 1),
                         "energy", "add mass, or hold control points");
    }
    result.factors_[d] = std::move(factor);
    result.size_[d] = knots[d].count() - 2 * held;
  }
  return result;
}

Points TwoPasses::solve(const Points& d) const {
  const auto [m, n] = size_;
  // Row i of the net, all its coordinates, is row i of an m × 3n matrix.
  const RowMajor y = factors_[0]->solve(Matrix(Eigen::Map<const RowMajor>(d.data(), m, 3 * n)));
  Points result(m * n, 3);
  for (Eigen::Index i = 0; i < m; ++i) {
    result.middleRows(i * n, n) =
        factors_[1]->solve(Matrix(Eigen::Map<const Points>(y.row(i).data(), n, 3)));
  }
  return result;
}

Expected<FastDiagonalisation> FastDiagonalisation::create(const std::array<KnotVector, 2>& knots,
                                                          const Energy<2>& energy, int held) {
  if (auto free = check_held(knots, held); !free) return std::unexpected(free.error());
  const auto terms = product_terms(energy);
  if (!terms) return std::unexpected(terms.error());
  FastDiagonalisation result;
  std::array<Eigen::VectorXd, 2> values;
  std::array<int, 2> order = {};
  for (std::size_t d = 0; d < 2; ++d) {
    const auto used = [&](int k) {
      return d == 0 ? !terms->row(k).isZero(0) : !terms->col(k).isZero(0);
    };
    if (used(1) && used(2)) {
      return input_error(fmt::format("stretch and bending stand together in direction {}", d + 1),
                         "energy", "solve the vectorised system");
    }
    order[d] = used(2) ? 2 : 1;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> pairs(
        free_gramian(knots[d], order[d], held), free_gramian(knots[d], 0, held));
    if (pairs.info() != Eigen::Success)
      return numerical_error("the eigenvalues do not converge", "energy");
    result.vectors_[d] = pairs.eigenvectors();
    values[d] = pairs.eigenvalues();
  }
  const double both = (*terms)(order[0], order[1]), first = (*terms)(order[0], 0),
               second = (*terms)(0, order[1]);
  const Eigen::ArrayXd s = values[0].array(), t = values[1].array();
  const Matrix ones = Matrix::Ones(s.size(), t.size());
  result.divisors_ = (*terms)(0, 0) * ones + both * s.matrix() * t.matrix().transpose() +
                     first * s.matrix() * ones.row(0) +
                     second * ones.col(0) * t.matrix().transpose();
  if (!(result.divisors_.minCoeff() > 0)) {
    return input_error("the energy is not positive definite", "energy",
                       "add mass, or hold control points");
  }
  return result;
}

Points FastDiagonalisation::solve(const Points& d) const {
  const auto& [u, v] = vectors_;
  Points result(d.rows(), 3);
  for (Eigen::Index c = 0; c < 3; ++c) {
    const Eigen::VectorXd column = d.col(c);
    const Matrix values = Eigen::Map<const RowMajor>(column.data(), u.rows(), v.rows());
    const Matrix inner = (u.transpose() * values * v).cwiseQuotient(divisors_);
    const RowMajor x = u * inner * v.transpose();
    result.col(c) = Eigen::Map<const Eigen::VectorXd>(x.data(), x.size());
  }
  return result;
}

Eigen::SparseMatrix<double> vectorised(const std::array<KnotVector, 2>& knots,
                                       const Energy<2>& energy, int held) {
  const auto whole = Stiffness<2>::create(knots, energy)->assemble();
  if (held == 0) return whole;
  const int m = knots[0].count(), n = knots[1].count(), columns = n - 2 * held;
  const auto place = [&](Eigen::Index k) -> int {
    const int i = static_cast<int>(k) / n - held, j = static_cast<int>(k) % n - held;
    return i < 0 || j < 0 || i >= m - 2 * held || j >= columns ? -1 : i * columns + j;
  };
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < whole.outerSize(); ++k) {
    for (Eigen::SparseMatrix<double>::InnerIterator at(whole, k); at; ++at) {
      if (place(at.row()) >= 0 && place(k) >= 0)
        entries.emplace_back(place(at.row()), place(k), at.value());
    }
  }
  Eigen::SparseMatrix<double> result((m - 2 * held) * columns, (m - 2 * held) * columns);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace knead::examples
