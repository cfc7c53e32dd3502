#include <Eigen/Dense>
#include <algorithm>

#include "rational_basis.hpp"
#include "tensor_pattern.hpp"

namespace knead {
namespace {

/// Which element (span in every direction) each Gauss point of a direction belongs to: runs of equal `first`.
std::vector<std::pair<int, int>> element_runs(const BasisTable& table) {
  std::vector<std::pair<int, int>> runs;
  for (int k = 0; k < table.size();) {
    int end = k + 1;
    while (end < table.size() &&
           table.first[static_cast<std::size_t>(end)] == table.first[static_cast<std::size_t>(k)]) {
      ++end;
    }
    runs.emplace_back(k, end);
    k = end;
  }
  return runs;
}

}  // namespace

template <int D>
Expected<SparseMatrix> assemble_rational(const Spline<D>& spline, const Energy<D>& energy, int gauss_points) {
  TensorPattern<D> pattern;
  pattern.net = spline.net();
  int order = 0;
  for (const EnergyTerm<D>& term : energy) {
    int a = 0, b = 0;
    for (std::size_t d = 0; d < D; ++d) {
      a += term.a[d];
      b += term.b[d];
    }
    order = std::max({order, a, b});
  }
  std::array<BasisQuadrature, D> quadrature;
  std::array<std::vector<std::pair<int, int>>, D> runs;
  int local = 1;
  for (std::size_t d = 0; d < D; ++d) {
    pattern.degree[d] = spline.knots()[d].degree();
    const int points = gauss_points > 0 ? gauss_points : pattern.degree[d] + 8;
    quadrature[d] = gauss_basis(spline.knots()[d], points, order);
    runs[d] = element_runs(quadrature[d].basis);
    local *= pattern.degree[d] + 1;
  }
  SparseMatrix matrix = pattern.allocate();
  double* values = matrix.valuePtr();
  std::fill(values, values + matrix.nonZeros(), 0.0);

  const std::vector<MultiIndex<D>> indices = multi_indices<D>(order);
  using Dense = Eigen::MatrixXd;
  std::vector<Dense> basis(indices.size());  // basis[a](local function, point)
  RationalBasis<D> rational(spline, order);

  std::array<std::size_t, D> element{};
  while (true) {
    std::array<int, D> points, first;
    int total = 1;
    for (std::size_t d = 0; d < D; ++d) {
      points[d] = runs[d][element[d]].second - runs[d][element[d]].first;
      first[d] = quadrature[d].basis.first[static_cast<std::size_t>(runs[d][element[d]].first)];
      total *= points[d];
    }
    for (Dense& b : basis) b.resize(local, total);
    Eigen::VectorXd weight(total);
    for (int k = 0; k < total; ++k) {
      std::array<const double*, D> rows;
      double w = 1;
      for (std::size_t d = D, rest = static_cast<std::size_t>(k); d-- > 0;) {
        const int at = runs[d][element[d]].first + static_cast<int>(rest % static_cast<std::size_t>(points[d]));
        rest /= static_cast<std::size_t>(points[d]);
        rows[d] = quadrature[d].basis.row(at, 0);
        w *= quadrature[d].weights[static_cast<std::size_t>(at)];
      }
      weight(k) = w;
      if (auto ok = rational.evaluate(first, rows, k, basis); !ok) return std::unexpected(ok.error());
    }
    Dense block = Dense::Zero(local, local);
    for (const EnergyTerm<D>& term : energy) {
      const Dense& a = basis[static_cast<std::size_t>(multi_index_position<D>(term.a))];
      const Dense& b = basis[static_cast<std::size_t>(multi_index_position<D>(term.b))];
      block.noalias() += (a * (term.coefficient * weight).asDiagonal()) * b.transpose();
    }
    // The two terms of a symmetric pair are rounded apart; the mean of both halves is symmetric to the last bit.
    const Dense symmetric = 0.5 * (block + block.transpose());
    for (int r = 0; r < local; ++r) {
      const std::array<int, D> i = rational.global(first, r);
      int row = 0;
      for (std::size_t d = 0; d < D; ++d) row = row * pattern.net[d] + i[d];
      double* to = values + matrix.outerIndexPtr()[row];
      for (int c = 0; c < local; ++c) to[pattern.offset(i, rational.global(first, c))] += symmetric(r, c);
    }
    std::size_t d = D;
    while (d-- > 0) {
      if (++element[d] < runs[d].size()) break;
      element[d] = 0;
      if (d == 0) return matrix;
    }
  }
}

template Expected<SparseMatrix> assemble_rational<1>(const Spline<1>&, const Energy<1>&, int);
template Expected<SparseMatrix> assemble_rational<2>(const Spline<2>&, const Energy<2>&, int);
template Expected<SparseMatrix> assemble_rational<3>(const Spline<3>&, const Energy<3>&, int);

}  // namespace knead
