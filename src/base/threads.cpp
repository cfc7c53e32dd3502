#include "knead/base/threads.hpp"

#ifndef __wasm__
#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdlib>
#include <string_view>
#include <thread>
#endif

namespace knead {

#ifdef __wasm__

void set_thread_count(int /*count*/) {}
int thread_count() { return 1; }

#else
namespace {

std::atomic<int> chosen = 0;

/// What KNEAD_THREADS says; 0 where it is no number above 0.
int from_environment() {
  const char* variable = std::getenv("KNEAD_THREADS");
  if (variable == nullptr) return 0;
  const std::string_view text = variable;
  int count = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), count);
  return failed == std::errc() && end == text.data() + text.size() ? std::max(count, 0) : 0;
}

int find_default() {
  const int wanted = from_environment();
  return std::clamp(wanted > 0 ? wanted : static_cast<int>(std::thread::hardware_concurrency()), 1,
                    max_thread_count);
}

}  // namespace

void set_thread_count(int count) {
  chosen.store(std::clamp(count, 0, max_thread_count), std::memory_order_relaxed);
}

int thread_count() {
  static const int otherwise = find_default();
  const int count = chosen.load(std::memory_order_relaxed);
  return count > 0 ? count : otherwise;
}
#endif

}  // namespace knead
