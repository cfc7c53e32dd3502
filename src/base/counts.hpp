#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace knead {

/// Control points or samples that one spline may have: 1.6 GB of coordinates. Beyond it, sizes are
/// refused before they are allocated; products of counts below it fit 32 bits.
inline constexpr std::int64_t max_spline_size = std::int64_t{1} << 26;

/// The product of counts >= 0; nothing if it exceeds `most`. Exact on every target, also where
/// std::size_t has 32 bits.
[[nodiscard]] constexpr std::optional<std::int64_t> product_of(
    std::span<const int> counts, std::int64_t most = max_spline_size) {
  std::int64_t product = 1;
  bool over = false;
  for (const int count : counts) {
    if (count == 0) return 0;
    over = over || product > most / count;
    if (!over) product *= count;
  }
  return over ? std::nullopt : std::optional(product);
}

}  // namespace knead
