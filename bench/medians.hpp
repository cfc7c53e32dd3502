#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <vector>

namespace knead::bench {

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Time of the processor, which what else runs on the machine does not count in.
inline double milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

template <class F>
double milliseconds_of(const F& f) {
  const double begun = milliseconds();
  f();
  return milliseconds() - begun;
}

/// Both in turn in one loop; counters are the medians "ms" and "reference_ms" and their quotient,
/// "ratio", with ours below where it says how many times faster ours is.
enum class Ratio { over_reference, times_faster };
template <class Ours, class Reference>
void beside(benchmark::State& state, const Ours& ours, const Reference& reference, Ratio ratio) {
  std::vector<double> a, b;
  for (auto _ : state) {
    a.push_back(milliseconds_of(ours));
    b.push_back(milliseconds_of(reference));
  }
  const double mine = median(a), theirs = median(b);
  state.counters["ms"] = mine;
  state.counters["reference_ms"] = theirs;
  state.counters["ratio"] = ratio == Ratio::times_faster ? theirs / mine : mine / theirs;
}

}  // namespace knead::bench
