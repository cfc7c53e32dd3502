#pragma once

#include <algorithm>
#include <array>

#include "knead/energy/stiffness.hpp"

namespace knead {

/// Where the entries of a D-fold tensor product of band matrices stand in compressed storage: row i = (i_0, …, i_{D−1})
/// holds the columns j with |i_d − j_d| <= p_d, sorted with the last direction fastest.
template <int D>
struct TensorPattern {
  std::array<int, D> net, degree;

  [[nodiscard]] int first(std::size_t d, int i) const { return std::max(0, i - degree[d]); }
  [[nodiscard]] int length(std::size_t d, int i) const { return std::min(net[d] - 1, i + degree[d]) - first(d, i) + 1; }
  [[nodiscard]] int size() const {
    int n = 1;
    for (int m : net) n *= m;
    return n;
  }

  /// The row as a multi-index.
  [[nodiscard]] std::array<int, D> unpack(int row) const {
    std::array<int, D> i;
    for (std::size_t d = D; d-- > 0;) {
      i[d] = row % net[d];
      row /= net[d];
    }
    return i;
  }

  /// A square matrix with this pattern and uninitialised values.
  [[nodiscard]] SparseMatrix allocate() const {
    const int n = size();
    SparseMatrix matrix(n, n);
    auto* outer = matrix.outerIndexPtr();
    outer[0] = 0;
    for (int row = 0; row < n; ++row) {
      const std::array<int, D> i = unpack(row);
      int count = 1;
      for (std::size_t d = 0; d < D; ++d) count *= length(d, i[d]);
      outer[row + 1] = outer[row] + count;
    }
    matrix.resizeNonZeros(outer[n]);
    auto* inner = matrix.innerIndexPtr();
    for (int row = 0; row < n; ++row) {
      const std::array<int, D> i = unpack(row);
      std::array<int, D> j;
      for (std::size_t d = 0; d < D; ++d) j[d] = first(d, i[d]);
      for (auto at = outer[row]; at < outer[row + 1]; ++at) {
        int column = 0;
        for (std::size_t d = 0; d < D; ++d) column = column * net[d] + j[d];
        inner[at] = column;
        for (std::size_t d = D; d-- > 0;) {
          if (++j[d] < first(d, i[d]) + length(d, i[d])) break;
          j[d] = first(d, i[d]);
        }
      }
    }
    return matrix;
  }

  /// Offset of column j inside the row i.
  [[nodiscard]] int offset(const std::array<int, D>& i, const std::array<int, D>& j) const {
    int at = 0;
    for (std::size_t d = 0; d < D; ++d) at = at * length(d, i[d]) + (j[d] - first(d, i[d]));
    return at;
  }
};

/// K of a rational spline by Gauss points on the rational basis, all entries of the tensor pattern stored.
template <int D>
[[nodiscard]] Expected<SparseMatrix> assemble_rational(const Spline<D>& spline, const Energy<D>& energy,
                                                       int gauss_points);

}  // namespace knead
