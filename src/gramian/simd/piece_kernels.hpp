#pragma once

#include <cstddef>

#include "knead/base/instruction_set.hpp"

namespace knead::detail {

inline constexpr int max_piece_degree = 25;

/// What the values of B-splines on a piece of a span are made of. Reciprocals of distances are
/// shared by all spans: reciprocal[(q − 1) stride + r] is that of the support of function r of
/// degree q − 1 on the span.
struct PieceDistances {
  const double *from_left,
      *to_right;  ///< [q]: from knot span + 1 − q to the lower end, from the upper end to span + q
  const double* reciprocal;  ///< see above
  std::ptrdiff_t stride;
  double length;  ///< of the piece
};

/// The inner loops of integrals over the pieces of two knot vectors, compiled for one instruction
/// set. All give the same bits: the same operations in the same order, nothing fused. Lines of
/// points have n of them, a multiple of `step`.
struct PieceKernels {
  static constexpr std::ptrdiff_t step = 4;

  /// to[r n + g]: the derivative of this order, at most the degree, of function r at t[g], of which
  /// complement[g] is 1 − t.
  void (*basis)(const PieceDistances& piece, int degree, int order, const double* t,
                const double* complement, std::ptrdiff_t n, double* to);
  /// to[r n + g] = (factor weights[g]) from[r n + g], r < functions.
  void (*weigh)(double factor, const double* weights, const double* from, std::ptrdiff_t functions,
                std::ptrdiff_t n, double* to);
  /// The products of every line of a with every line of b, with those from its own number on if
  /// `upper`, in this order.
  void (*multiply)(const double* a, const double* b, std::ptrdiff_t functions, bool upper,
                   std::ptrdiff_t n, double* to);
  /// to[f][k] += Σ_g factors[f n + g] values[g width + k] for f < count, g < points, k < functions.
  /// `width` is `functions` rounded up to a multiple of `step`.
  void (*accumulate)(const double* factors, std::ptrdiff_t count, std::ptrdiff_t n,
                     std::ptrdiff_t points, const double* values, std::ptrdiff_t functions,
                     std::ptrdiff_t width, double* const* to);
};

extern const PieceKernels* const vector128_piece_kernels;
extern const PieceKernels* const avx2_piece_kernels;  ///< null if the compiler does not target it

/// The fastest that this machine runs, up to those of an instruction set.
[[nodiscard]] const PieceKernels& piece_kernels(InstructionSet set = best_instruction_set());

}  // namespace knead::detail
