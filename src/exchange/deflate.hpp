#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "knead/base/error.hpp"

namespace knead::detail {

/// CRC-32 of ISO 3309, which gzip and ZIP share.
[[nodiscard]] std::uint32_t crc_32(std::string_view bytes);

/// What DEFLATE data (RFC 1951), all of them, hold: exactly `size` bytes. Errors (input): damaged,
/// too short, more or less than that. `size` is allocated; it must have been checked.
[[nodiscard]] Expected<std::string> inflate(std::string_view packed, std::size_t size);

/// DEFLATE data of at most 4 GiB - 1 bytes.
[[nodiscard]] Expected<std::string> deflate(std::string_view bytes);

}  // namespace knead::detail
