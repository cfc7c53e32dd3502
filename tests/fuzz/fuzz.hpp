// Shared by the fuzz targets: checks that end the run, and the memory that reading may take.
#pragma once

#include <sanitizer/allocator_interface.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

namespace knead::fuzz {

[[noreturn]] inline void fail(const std::string& what) {
  std::fprintf(stderr, "CHECK FAILED: %s\n", what.c_str());
  std::abort();
}
inline void check(bool holds, const std::string& what) {
  if (!holds) fail(what);
}

/// Errors say something, in one line that a terminal can show.
inline void check_error(const Error& error) {
  check(!error.what.empty(), "an error without a text");
  for (const char c : error.message())
    check(static_cast<unsigned char>(c) >= 0x20, "an error of several lines");
}

template <int D>
void check_finite(const Spline<D>& spline, const char* where) {
  check(spline.control_points().allFinite(),
        std::string("control points that are no numbers: ") + where);
  for (const double w : spline.weights())
    check(std::isfinite(w), std::string("a weight of ") + where);
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// The most bytes that were allocated at once since `begin`.
class PeakMemory {
 public:
  static void begin() {
    static const bool installed = [] {
      return __sanitizer_install_malloc_and_free_hooks(allocated, freed) != 0;
    }();
    check(installed, "the allocator cannot be watched");
    live = peak = 0;
  }
  [[nodiscard]] static std::int64_t bytes() { return peak; }

 private:
  static void allocated(const volatile void*, std::size_t size) {
    live += static_cast<std::int64_t>(size);
    if (live > peak) peak = live.load();
  }
  static void freed(const volatile void* at) {
    if (at != nullptr) live -= static_cast<std::int64_t>(__sanitizer_get_allocated_size(at));
  }
  static inline std::atomic<std::int64_t> live = 0, peak = 0;
};

/// Bytes that a reader may hold at once for one byte of the file, beside a fixed part. Records of a
/// few bytes each are the worst: "#1=A();" is an instance, a value and a name.
inline constexpr std::int64_t reading_multiple = 64, reading_base = 2 << 20;

inline void check_memory(std::size_t size, const char* what) {
  const auto most = reading_base + reading_multiple * static_cast<std::int64_t>(size);
  if (PeakMemory::bytes() > most) {
    fail(std::string(what) + " took " + std::to_string(PeakMemory::bytes()) + " bytes for " +
         std::to_string(size));
  }
}

}  // namespace knead::fuzz
