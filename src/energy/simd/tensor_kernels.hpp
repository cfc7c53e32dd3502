#pragma once

#include <cstddef>

#include "knead/base/instruction_set.hpp"

namespace knead::detail {

/// The inner loops of tensor products of band matrices, compiled for one instruction set. All give
/// the same bits: the same operations in the same order, nothing fused.
///
/// Lines of points lie in segments (the layout of Henretty et al., Data layout transformation for
/// stencil computations on short-vector SIMD architectures, CC 2011): cut into as many segments as
/// a vector has numbers, all of `points` points, vector 3 i + c holds coordinate c of the i-th
/// point of every segment. The neighbours of a vector's points are then whole vectors, too, and no
/// load straddles cache lines.
struct TensorKernels {
  std::ptrdiff_t lanes;  ///< numbers per vector
  /// y[m · lanes + l] = x[l · length + m], 0 <= m < length, 0 <= l < lanes: a line put in segments
  /// of `length` numbers.
  void (*to_segments)(const double* x, std::ptrdiff_t length, double* y);
  /// The inverse: y[l · length + m] = x[m · lanes + l].
  void (*from_segments)(const double* x, std::ptrdiff_t length, double* y);
  /// y[g · y_stride + m] = Σ_k factors[k · kinds + g] x[k · stride + m], 0 <= m < length, 0 <= g <
  /// kinds: x is read once for three kinds, or for five by vectors of eight.
  void (*combine)(const double* x, std::ptrdiff_t stride, const double* factors,
                  std::ptrdiff_t kinds, std::ptrdiff_t count, std::ptrdiff_t length, double* y,
                  std::ptrdiff_t y_stride);
  /// Writes the p points before and behind every segment of a line x, which are those of its
  /// neighbours, or zero.
  void (*surround)(double* x, std::ptrdiff_t points, std::ptrdiff_t p);
  /// y[l · y_stride + i] += Σ_g Σ_k bands[g][i, k] x[g · x_kind + l · x_stride + i + k − p], 0 <= i
  /// < points, 0 <= l < lines, 0 <= g < kinds, 0 <= k <= 2p, where i counts the points of all
  /// segments at once, by vectors: 2p + 1 for each i in bands[g], three in surrounded lines x and
  /// in y. With `from_zero` = instead of +=. The bands are read once for `lines_at_once` lines, and
  /// y once for all kinds.
  void (*add_bands)(const double* const* bands, std::ptrdiff_t kinds, std::ptrdiff_t p,
                    std::ptrdiff_t points, const double* x, std::ptrdiff_t x_kind,
                    std::ptrdiff_t x_stride, std::ptrdiff_t lines, bool from_zero, double* y,
                    std::ptrdiff_t y_stride);
  static constexpr std::ptrdiff_t lines_at_once = 2;
  /// For every row of `rows` and in it every column of `columns`: to[c] = Σ_g weights[g] band[g ·
  /// stride + c], 0 <= c < length; the next column's weights are `kinds` further, the next row has
  /// the same and its band is `step` further; values follow each other. Writes up to `spare` values
  /// too many after the last column.
  void (*write_runs)(const double* band, std::ptrdiff_t stride, std::ptrdiff_t step,
                     std::ptrdiff_t rows, const double* weights, std::ptrdiff_t kinds,
                     std::ptrdiff_t columns, std::ptrdiff_t length, double* to);
  static constexpr std::ptrdiff_t spare = 8;  ///< `band` is read as far beyond a run, too
};

extern const TensorKernels* const vector128_tensor_kernels;
extern const TensorKernels* const avx2_tensor_kernels;  ///< null if the compiler does not target it
extern const TensorKernels* const avx512_tensor_kernels;  ///< likewise

/// The fastest that this machine runs, up to those of an instruction set.
[[nodiscard]] const TensorKernels& tensor_kernels(InstructionSet set = best_instruction_set());

}  // namespace knead::detail
