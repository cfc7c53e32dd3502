#pragma once

#include <array>

#include "knead/base/threads.hpp"

namespace knead::testing {

/// What results must not depend on.
inline constexpr std::array<int, 4> thread_counts = {1, 2, 3, 7};

/// run() with that many threads; the default number again afterwards.
template <class Run>
auto with_threads(int count, const Run& run) {
  struct Default {
    ~Default() { set_thread_count(0); }
  } afterwards;
  set_thread_count(count);
  return run();
}

}  // namespace knead::testing
