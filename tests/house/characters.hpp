#pragma once

#include <cstddef>
#include <string_view>

namespace knead::house {

/// Of UTF-8; marks that are set on another character are not counted.
inline std::ptrdiff_t characters(std::string_view line) {
  std::ptrdiff_t count = 0;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const auto byte = static_cast<unsigned char>(line[k]);
    const bool mark = byte == 0xCC || (byte == 0xCD && k + 1 < line.size() &&
                                       static_cast<unsigned char>(line[k + 1]) < 0xB0);
    count += (byte & 0xC0) != 0x80 && !mark ? 1 : 0;
  }
  return count;
}

}  // namespace knead::house
