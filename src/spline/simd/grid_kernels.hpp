#pragma once

#include <cstddef>

#include "knead/base/instruction_set.hpp"

namespace knead::detail {

/// Neighbouring parameters begin … end − 1 of one span, whose first basis function is `first`.
struct SpanRun {
  std::ptrdiff_t first, begin, end;
};

/// The parameters of a grid's last direction, `runs` one after the other. Basis values are tables
/// of `terms` rows, values[r · stride + k] = N_{first+r}(u_k); of a row `GridKernels::spare`
/// numbers more may be read.
struct GridRow {
  const SpanRun* runs;
  std::ptrdiff_t run_count, size, stride, terms;
};

/// − factor ∂^b W ∂^{a−b} R, by the positions of b and a − b.
struct QuotientTerm {
  std::size_t weight, lower;
  double factor;
};

/// The quotient rule for `count` derivatives: the terms of a are those from begin[a] to before
/// begin[a + 1].
struct QuotientTerms {
  const QuotientTerm* terms;
  const std::size_t* begin;
  std::size_t count;
};

/// The inner loops of evaluation on grids, compiled for one instruction set. All give the same
/// bits: the operations of `evaluate` at scattered points, in the same order, nothing fused.
struct GridKernels {
  static constexpr std::ptrdiff_t spare = 8;

  /// to[c] = Σ_r values[r] from[r · length + c], 0 <= c < length, 0 <= r < terms.
  void (*contract)(const double* values, std::ptrdiff_t terms, const double* from,
                   std::ptrdiff_t length, double* to);
  /// The points of one row, three numbers each, of a line of the net of as many.
  void (*points)(const GridRow& row, const double* values, const double* line, double* to);
  /// The same with four numbers per control point, each coordinate by itself: to[c · stride + k].
  /// Writes up to `spare` numbers beyond.
  void (*homogeneous)(const GridRow& row, const double* values, const double* line, double* to);
  /// Cartesian derivatives of points 0 … size − 1 from such rows, those of derivative a at from + 4
  /// a · stride, to to[a] + 3 · offset. \param work 3 · `spare` numbers for each derivative \return
  /// the first point whose denominator is not positive, where it ends; `size` if there is none
  std::ptrdiff_t (*divide)(const QuotientTerms& rule, const double* from, std::ptrdiff_t stride,
                           std::ptrdiff_t size, double* work, double* const* to,
                           std::ptrdiff_t offset);
  /// Unit normals of `count` points, three numbers each: u × v / |u × v|, zero where |u × v| <=
  /// 1e-9 (|u|² + |v|²).
  void (*normals)(const double* u, const double* v, std::ptrdiff_t count, double* to);
};

extern const GridKernels* const vector128_grid_kernels;
extern const GridKernels* const avx2_grid_kernels;    ///< null if the compiler does not target it
extern const GridKernels* const avx512_grid_kernels;  ///< likewise

/// The fastest that this machine runs, up to those of an instruction set.
[[nodiscard]] const GridKernels& grid_kernels(InstructionSet set = best_instruction_set());

}  // namespace knead::detail
