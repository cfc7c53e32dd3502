#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "base/parallel_for.hpp"
#include "knead/energy/material_field.hpp"
#include "knead/energy/stiffness.hpp"

namespace knead {

/// The positions of the entries of a D-fold tensor product of band matrices in compressed storage:
/// row i = (i_0, …, i_{D−1}) holds the columns j with |i_d − j_d| <= p_d, sorted with the last
/// direction fastest.
template <int D>
struct TensorPattern {
  std::array<int, D> net, degree;

  [[nodiscard]] int first(std::size_t d, int i) const { return std::max(0, i - degree[d]); }
  [[nodiscard]] int length(std::size_t d, int i) const {
    return std::min(net[d] - 1, i + degree[d]) - first(d, i) + 1;
  }
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

  /// The pattern of all directions but the last, treated as having one function.
  [[nodiscard]] TensorPattern outer() const {
    TensorPattern pattern = *this;
    pattern.net[D - 1] = 1;
    pattern.degree[D - 1] = 0;
    return pattern;
  }

  /// The columns of row i of an `outer` pattern, ascending, as multi-indices.
  [[nodiscard]] std::vector<std::array<int, D>> columns(const std::array<int, D>& i) const {
    std::size_t count = 1;
    for (std::size_t d = 0; d < D; ++d) count *= static_cast<std::size_t>(length(d, i[d]));
    std::vector<std::array<int, D>> result(count);
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t d = D, rest = k; d-- > 0;) {
        const auto n = static_cast<std::size_t>(length(d, i[d]));
        result[k][d] = first(d, i[d]) + static_cast<int>(rest % n);
        rest /= n;
      }
    }
    return result;
  }

  /// A square matrix with this pattern and uninitialised values.
  [[nodiscard]] SparseMatrix allocate() const {
    const TensorPattern rows = outer();
    const int n = net[D - 1];
    SparseMatrix matrix(size(), size());
    auto* start = matrix.outerIndexPtr();
    start[0] = 0;
    std::vector<std::vector<int>> bases(
        static_cast<std::size_t>(rows.size()));  // first column of each run
    for (int row = 0; row < rows.size(); ++row) {
      std::vector<int>& base = bases[static_cast<std::size_t>(row)];
      for (const std::array<int, D>& j : rows.columns(rows.unpack(row))) {
        int column = 0;
        for (std::size_t d = 0; d + 1 < D; ++d) column = column * net[d] + j[d];
        base.push_back(column * n);
      }
      for (int k = 0; k < n; ++k, ++start)
        start[1] = start[0] + static_cast<int>(base.size()) * length(D - 1, k);
    }
    matrix.resizeNonZeros(*start);
    const std::ptrdiff_t outer_size = rows.size();
    const double work = static_cast<double>(matrix.nonZeros()) / rows.size();
    detail::parallel_for(outer_size, detail::block_size(outer_size, work),
                         [&](std::ptrdiff_t row, std::ptrdiff_t end) {
                           auto* to = matrix.innerIndexPtr() + matrix.outerIndexPtr()[row * n];
                           for (; row < end; ++row) {
                             for (int k = 0; k < n; ++k) {
                               const int begin = first(D - 1, k), count = length(D - 1, k);
                               for (const int run : bases[static_cast<std::size_t>(row)]) {
                                 for (int c = 0; c < count; ++c) to[c] = run + begin + c;
                                 to += count;
                               }
                             }
                           }
                         });
    return matrix;
  }

  /// Offset of column j inside the row i.
  [[nodiscard]] int offset(const std::array<int, D>& i, const std::array<int, D>& j) const {
    int at = 0;
    for (std::size_t d = 0; d < D; ++d) at = at * length(d, i[d]) + (j[d] - first(d, i[d]));
    return at;
  }
};

/// K of a rational spline, all entries of the tensor pattern stored.
struct RationalStiffness {
  SparseMatrix matrix;
  double error_bound;  ///< as `Stiffness::error_bound`
};

/// As `StiffnessOptions` say. Errors: orders or options (usage), a field over another domain
/// (input), a denominator that is not positive or weights that differ too much for the tolerance
/// (numerical).
template <int D>
[[nodiscard]] Expected<RationalStiffness> assemble_rational(const Spline<D>& spline,
                                                            const Energy<D>& energy,
                                                            const StiffnessOptions& options);
template <int D>
[[nodiscard]] Expected<RationalStiffness> assemble_rational(const Spline<D>& spline,
                                                            const FieldEnergy<D>& energy,
                                                            const StiffnessOptions& options);

}  // namespace knead
