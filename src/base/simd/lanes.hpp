// Vectors of KNEAD_LANES numbers: included by one translation unit per instruction set, which
// defines that and KNEAD_ISA, or with KNEAD_COUNTING, KNEAD_LANES 1 and a number `Counted` that
// counts. Everything is in a namespace of that instruction set, and nothing from the standard
// library is instantiated here: an inline function that the linker shares between translation units
// could otherwise carry AVX code into the portable ones.
#pragma once

#if KNEAD_LANES > 1 && (defined(__x86_64__) || defined(__i386__))
#include <immintrin.h>
#endif

#include <cstddef>
#include <type_traits>

#if defined(KNEAD_COUNTING)  // not for speed: nothing needs to be inlined
#define KNEAD_INLINE inline
#define KNEAD_LAMBDA
#else
#define KNEAD_INLINE __attribute__((always_inline)) inline
#define KNEAD_LAMBDA __attribute__((always_inline))
#endif

namespace knead::detail::KNEAD_ISA {

inline constexpr int lanes = KNEAD_LANES;

// Rows i, i + 1, … i + lanes − 1 of one quantity.
#if defined(KNEAD_COUNTING)
using Lanes = Counted;  // a double that counts its operations
KNEAD_INLINE Lanes load(const double* p) { return *p; }
KNEAD_INLINE void store(double* p, Lanes v) { *p = v.value; }
KNEAD_INLINE Lanes splat(double x) { return x; }
KNEAD_INLINE double first(Lanes v) { return v.value; }
KNEAD_INLINE bool any_not_positive(Lanes v) { return !(v.value > 0); }
KNEAD_INLINE int differs(Lanes, Lanes) { return 1; }  // no row is copied: all must be counted
KNEAD_INLINE bool any(int mask) { return mask != 0; }
KNEAD_INLINE Lanes shifted(Lanes, double next) { return next; }
#elif KNEAD_LANES == 1
using Lanes = double;
KNEAD_INLINE Lanes load(const double* p) { return *p; }
KNEAD_INLINE void store(double* p, Lanes v) { *p = v; }
KNEAD_INLINE Lanes splat(double x) { return x; }
KNEAD_INLINE double first(Lanes v) { return v; }
KNEAD_INLINE bool any_not_positive(Lanes v) { return !(v > 0); }
KNEAD_INLINE int differs(Lanes a, Lanes b) { return a != b ? 1 : 0; }
KNEAD_INLINE bool any(int mask) { return mask != 0; }
/// Rows i + 1, …, i + lanes; the last comes from `next`, the row after this group.
KNEAD_INLINE Lanes shifted(Lanes, double next) { return next; }
#else
typedef double Lanes __attribute__((vector_size(8 * KNEAD_LANES)));
typedef double Unaligned __attribute__((vector_size(8 * KNEAD_LANES), aligned(8), may_alias));
KNEAD_INLINE Lanes load(const double* p) { return *reinterpret_cast<const Unaligned*>(p); }
KNEAD_INLINE void store(double* p, Lanes v) { *reinterpret_cast<Unaligned*>(p) = v; }
KNEAD_INLINE Lanes splat(double x) {
#if KNEAD_LANES == 2
  return Lanes{x, x};
#elif KNEAD_LANES == 4
  return Lanes{x, x, x, x};
#else
  return Lanes{x, x, x, x, x, x, x, x};
#endif
}
KNEAD_INLINE double first(Lanes v) { return v[0]; }
KNEAD_INLINE bool any(decltype(Lanes{} < Lanes{}) mask) {
#if KNEAD_LANES == 8
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask)) != 0;
#elif KNEAD_LANES == 4
  return _mm256_movemask_pd(reinterpret_cast<__m256d>(mask)) != 0;
#else
  return (mask[0] | mask[1]) != 0;
#endif
}
/// Bit k: number k of a comparison is true.
KNEAD_INLINE unsigned bits(decltype(Lanes{} < Lanes{}) mask) {
#if KNEAD_LANES == 8
  return static_cast<unsigned>(_mm512_movepi64_mask(reinterpret_cast<__m512i>(mask)));
#elif KNEAD_LANES == 4
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
#elif defined(__SSE2__)
  return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<__m128d>(mask)));
#else
  return static_cast<unsigned>((mask[0] & 1) | (mask[1] & 2));
#endif
}
KNEAD_INLINE bool any_not_positive(Lanes v) { return any(v <= splat(0)); }
KNEAD_INLINE auto differs(Lanes a, Lanes b) { return a != b; }
KNEAD_INLINE Lanes shifted(Lanes v, double next) {
  const Lanes after = {next};
#if KNEAD_LANES == 8
  // Unlike the permutation that compilers take, this leaves v as it was, and needs no copy of it.
  const auto low = reinterpret_cast<__m512i>(v), high = reinterpret_cast<__m512i>(after);
  return reinterpret_cast<Lanes>(_mm512_maskz_alignr_epi64(0xFF, high, low, 1));
#elif KNEAD_LANES == 2
  return __builtin_shufflevector(v, after, 1, 2);
#else
  return __builtin_shufflevector(v, after, 1, 2, 3, 4);
#endif
}
#endif

KNEAD_INLINE Lanes square_root(Lanes v) {
#if defined(KNEAD_COUNTING)
  return root(v);
#elif KNEAD_LANES == 1
  return __builtin_sqrt(v);
#elif KNEAD_LANES == 8
  return _mm512_maskz_sqrt_pd(0xFF, v);  // the plain form makes GCC 12 warn of an undefined value
#elif KNEAD_LANES == 4
  return _mm256_sqrt_pd(v);
#elif defined(__SSE2__)
  return _mm_sqrt_pd(v);
#else
  return Lanes{__builtin_sqrt(v[0]), __builtin_sqrt(v[1])};
#endif
}

/// v where condition > 0, else 0.
KNEAD_INLINE Lanes where_positive(Lanes v, Lanes condition) {
  return condition > splat(0) ? v : splat(0);
}

template <int I>
using Index = std::integral_constant<int, I>;

/// f(Index<From>()), f(Index<From + 1>()), … below To: a loop whose counter is a constant.
template <int From, int To, class F>
KNEAD_INLINE void unrolled(F&& f) {
  if constexpr (From < To) {
    f(Index<From>());
    unrolled<From + 1, To>(f);
  }
}

}  // namespace knead::detail::KNEAD_ISA
