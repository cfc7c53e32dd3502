#pragma once

#include <cstddef>

namespace knead::detail {

/// The highest degree of the kernels: above it the recurrence loses more digits in 22 than Gauss
/// points do, and its intermediate sums leave the first-level cache.
inline constexpr int max_kernel_degree = 15;

/// Knots for kernels that read whole vectors, and past the last knot, which is repeated there.
struct KernelKnots {
  static constexpr int readable = 128;  ///< more than any kernel reads at once

  const double* body = nullptr;  ///< all knots, not padded
  const double* tail = nullptr;  ///< the knots from index `tail_begin` on, padded
  int tail_begin = 0;
  int size = 0;

  /// A pointer to knot i from which `readable` numbers may be read.
  [[nodiscard]] const double* from(int i) const {
    return i + readable <= size ? body + i : tail + (i - tail_begin);
  }
};

/// The location of entry (i, i + s) of the four terms: g[term] + s · stride[term] + i, s = 0 … p,
/// and −s for the lower half of g10: lower10 + (s − 1) · stride[3] + i is entry (i + s, i), s = 1 …
/// p. Whole vectors are stored, up to 8 numbers past the end of the row range.
struct KernelOutput {
  double* g[4];  ///< 00, 11, 22, 10
  std::size_t stride[4];
  double* lower10[max_kernel_degree + 1];  ///< lower10[s − 1]
};

/// Up to p + 1 Gauss points on [0, 1]: t, 1 − t and the root of the weight.
struct GaussPoints {
  double t[max_kernel_degree + 1], complement[max_kernel_degree + 1],
      root_weight[max_kernel_degree + 1];
};

/// The kernels of one instruction set.
struct GramianKernels {
  int lanes;
  /// All four terms by the recurrence, over whole supports (as if inside the domain), p = 1 … 15.
  void (*recurrence)(const KernelKnots& knots, int degree, const KernelOutput& out);
  /// All four terms by p + 1 Gauss points over spans p … n − 1, the domain; p = 1 … 7. The lower
  /// half of 10 is minus the upper one, which is correct except where an unclamped domain cuts both
  /// functions.
  void (*gauss)(const KernelKnots& knots, int degree, const GaussPoints& points,
                const KernelOutput& out);
  /// The same by as many points as each term needs: `points` are three rules with p + 1, p and p
  /// − 1.
  void (*gauss_reduced)(const KernelKnots& knots, int degree, const GaussPoints* points,
                        const KernelOutput& out);
};

// Null if the compiler does not target the instruction set.
extern const GramianKernels* const scalar_kernels;
extern const GramianKernels* const vector128_kernels;
extern const GramianKernels* const avx2_kernels;
extern const GramianKernels* const avx512_kernels;

}  // namespace knead::detail
