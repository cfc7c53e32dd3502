// Included by one translation unit per instruction set, as base/simd/lanes.hpp is.
#pragma once

#include "base/simd/lanes.hpp"

namespace knead::detail::KNEAD_ISA {

/// As many points as a vector has numbers, each coordinate by itself. In memory theirs stand side
/// by side: x y z x y z …
struct Three {
  Lanes x, y, z;
};

#if KNEAD_LANES == 2

KNEAD_INLINE Three load_three(const double* p) {
  const Lanes a = load(p), b = load(p + 2), c = load(p + 4);
  return {__builtin_shufflevector(a, b, 0, 3), __builtin_shufflevector(a, c, 1, 2),
          __builtin_shufflevector(b, c, 0, 3)};
}

KNEAD_INLINE void store_three(double* p, const Three& v) {
  store(p, __builtin_shufflevector(v.x, v.y, 0, 2));
  store(p + 2, __builtin_shufflevector(v.z, v.x, 0, 3));
  store(p + 4, __builtin_shufflevector(v.y, v.z, 1, 3));
}

#elif KNEAD_LANES == 4

// By vectors that hold x0 y0 x2 y2, z0 x1 z2 x3 and y1 z1 y3 z3: either step keeps to halves or
// exchanges them.
KNEAD_INLINE Three load_three(const double* p) {
  const Lanes v0 = load(p), v1 = load(p + 4), v2 = load(p + 8);
  const Lanes a = __builtin_shufflevector(v0, v1, 0, 1, 6, 7),
              b = __builtin_shufflevector(v0, v2, 2, 3, 4, 5);
  const Lanes c = __builtin_shufflevector(v1, v2, 0, 1, 6, 7);
  return {__builtin_shufflevector(a, b, 0, 5, 2, 7), __builtin_shufflevector(a, c, 1, 4, 3, 6),
          __builtin_shufflevector(b, c, 0, 5, 2, 7)};
}

KNEAD_INLINE void store_three(double* p, const Three& v) {
  const Lanes a = __builtin_shufflevector(v.x, v.y, 0, 4, 2, 6),
              b = __builtin_shufflevector(v.z, v.x, 0, 5, 2, 7);
  const Lanes c = __builtin_shufflevector(v.y, v.z, 1, 5, 3, 7);
  store(p, __builtin_shufflevector(a, b, 0, 1, 4, 5));
  store(p + 4, __builtin_shufflevector(c, a, 0, 1, 6, 7));
  store(p + 8, __builtin_shufflevector(b, c, 2, 3, 6, 7));
}

#else

// Two permutations of two vectors each: all but what stands in the third, and that.
KNEAD_INLINE Three load_three(const double* p) {
  const Lanes v0 = load(p), v1 = load(p + 8), v2 = load(p + 16);
  const Lanes x = __builtin_shufflevector(v0, v1, 0, 3, 6, 9, 12, 15, -1, -1);
  const Lanes y = __builtin_shufflevector(v0, v1, 1, 4, 7, 10, 13, -1, -1, -1);
  const Lanes z = __builtin_shufflevector(v0, v1, 2, 5, 8, 11, 14, -1, -1, -1);
  return {__builtin_shufflevector(x, v2, 0, 1, 2, 3, 4, 5, 10, 13),
          __builtin_shufflevector(y, v2, 0, 1, 2, 3, 4, 8, 11, 14),
          __builtin_shufflevector(z, v2, 0, 1, 2, 3, 4, 9, 12, 15)};
}

KNEAD_INLINE void store_three(double* p, const Three& v) {
  const Lanes a = __builtin_shufflevector(v.x, v.y, 0, 8, -1, 1, 9, -1, 2, 10);
  const Lanes b = __builtin_shufflevector(v.x, v.y, -1, 3, 11, -1, 4, 12, -1, 5);
  const Lanes c = __builtin_shufflevector(v.x, v.y, 13, -1, 6, 14, -1, 7, 15, -1);
  store(p, __builtin_shufflevector(a, v.z, 0, 1, 8, 3, 4, 9, 6, 7));
  store(p + 8, __builtin_shufflevector(b, v.z, 10, 1, 2, 11, 4, 5, 12, 7));
  store(p + 16, __builtin_shufflevector(c, v.z, 0, 13, 2, 3, 14, 5, 6, 15));
}

#endif

/// The first `count` of them only.
KNEAD_INLINE void store_some(double* p, const Three& v, std::ptrdiff_t count) {
  double all[3 * lanes];
  store_three(all, v);
  for (std::ptrdiff_t i = 0; i < 3 * count; ++i) p[i] = all[i];
}

}  // namespace knead::detail::KNEAD_ISA
