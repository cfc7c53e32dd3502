#pragma once

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

}  // namespace knead::bench
