#include <algorithm>
#include <cstddef>
#include <ctime>
#include <vector>

#include "figures/roofline.hpp"
#include "knead/base/instruction_set.hpp"
#include "knead/gramian/band_matrix.hpp"

namespace knead::figures {
namespace {

constexpr int chains = 12;  // hide the latency of an addition after a multiplication
constexpr long rounds = 2'000'000;

typedef double Two __attribute__((vector_size(16), may_alias));
typedef double Four __attribute__((vector_size(32), may_alias));
typedef double Eight __attribute__((vector_size(64), may_alias));

/// Multiplications and additions that depend on the ones before in their chain only.
template <class Vector>
[[gnu::always_inline]] inline double multiply_and_add() {
  Vector x[chains], factor = Vector{} + 0.5, term = Vector{} + 0.25;
#pragma GCC unroll 12
  for (int c = 0; c < chains; ++c) x[c] = Vector{} + 0.1 * c;
  for (long k = 0; k < rounds; ++k) {
#pragma GCC unroll 12
    for (int c = 0; c < chains; ++c) x[c] = x[c] * factor + term;
  }
  double sum = 0;
#pragma GCC unroll 12
  for (int c = 0; c < chains; ++c) sum += x[c][0];
  return sum;
}

/// b = a / 2, of whole vectors that are aligned.
template <class Vector>
[[gnu::always_inline]] inline void halve(const double* a, double* b, std::size_t count) {
  constexpr std::size_t lanes = sizeof(Vector) / sizeof(double);
  for (std::size_t k = 0; k < count; k += lanes) {
    *reinterpret_cast<Vector*>(b + k) = 0.5 * *reinterpret_cast<const Vector*>(a + k);
  }
}

/// What is measured, by the vectors of an instruction set.
struct Loops {
  double lanes;
  double (*compute)();
  void (*move)(const double*, double*, std::size_t);
};

double compute_by_two() { return multiply_and_add<Two>(); }
void move_by_two(const double* a, double* b, std::size_t count) { halve<Two>(a, b, count); }
#if defined(__x86_64__)
[[gnu::target("avx2")]] double compute_by_four() { return multiply_and_add<Four>(); }
[[gnu::target("avx2")]] void move_by_four(const double* a, double* b, std::size_t count) {
  halve<Four>(a, b, count);
}
[[gnu::target("avx512f")]] double compute_by_eight() { return multiply_and_add<Eight>(); }
[[gnu::target("avx512f")]] void move_by_eight(const double* a, double* b, std::size_t count) {
  halve<Eight>(a, b, count);
}
#endif

Loops best_loops() {
#if defined(__x86_64__)
  if (best_instruction_set() == InstructionSet::avx512) return {8, compute_by_eight, move_by_eight};
  if (best_instruction_set() == InstructionSet::avx2) return {4, compute_by_four, move_by_four};
#endif
  return {2, compute_by_two, move_by_two};
}

double peak(const Loops& loops) {
  volatile double keep = 0;
  return 2.0 * chains * rounds * loops.lanes / shortest_seconds([&] { keep = loops.compute(); });
}

double bytes_per_second(const Loops& loops, std::size_t count) {
  std::vector<double, CacheLineAllocator<double>> a(count, 1.0), b(count, 0.0);
  const std::size_t times = std::max<std::size_t>(1, (std::size_t{1} << 23) / count);
  const double seconds = shortest_seconds([&] {
    for (std::size_t t = 0; t < times; ++t) {
      loops.move(a.data(), b.data(), count);
      asm volatile("" : : "r"(b.data()), "r"(a.data()) : "memory");
    }
  });
  return 16.0 * static_cast<double>(count * times) / seconds;
}

}  // namespace

double shortest_seconds(const std::function<void()>& run) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  double best = 1e300;
  for (int k = 0; k < 31; ++k) {
    const double start = now();
    run();
    best = std::min(best, now() - start);
  }
  return best;
}

Machine measured_machine() {
  const Loops loops = best_loops();
  return {.memory = bytes_per_second(loops, std::size_t{1} << 22),
          .cache = bytes_per_second(loops, std::size_t{1} << 13),
          .peak = peak(loops)};
}

}  // namespace knead::figures
