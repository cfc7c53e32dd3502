#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace knead::studio {

/// Numbers that stay in the module's memory until the next call, and their name for the page.
struct Buffer {
  std::string_view name;
  std::string_view type;  ///< "float32", "float64", "uint32" or "uint8"
  const void* data;
  std::size_t count;

  Buffer(std::string_view named, std::span<const float> from) : Buffer(named, "float32", from.data(), from.size()) {}
  Buffer(std::string_view named, std::span<const double> from) : Buffer(named, "float64", from.data(), from.size()) {}
  Buffer(std::string_view named, std::span<const std::uint32_t> from)
      : Buffer(named, "uint32", from.data(), from.size()) {}
  Buffer(std::string_view named, std::span<const std::uint8_t> from)
      : Buffer(named, "uint8", from.data(), from.size()) {}

 private:
  Buffer(std::string_view named, std::string_view typed, const void* at, std::size_t size)
      : name(named), type(typed), data(at), count(size) {}
};

/// {"positions": {"type": "float32", "at": 1234, "count": 96}, …}: the input of the page's `readBuffers` (buffers.ts).
[[nodiscard]] std::string buffers_json(std::initializer_list<Buffer> buffers);

}  // namespace knead::studio
