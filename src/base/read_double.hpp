#pragma once

#include <charconv>
#ifndef __cpp_lib_to_chars
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>
#endif

namespace knead {

/// std::from_chars for decimal numbers, also where the standard library reads integers only.
inline std::from_chars_result read_double(const char* first, const char* last, double& value) {
#ifdef __cpp_lib_to_chars
  return std::from_chars(first, last, value);
#else
  // libc++ 19, for WebAssembly, where there is no locale that could change what strtod reads.
  const std::string_view text(first, static_cast<std::size_t>(last - first));
  const std::string number(text.substr(0, text.find_first_not_of("0123456789.eE+-")));
  if (number.starts_with('+')) return {first, std::errc::invalid_argument};
  char* end = nullptr;
  errno = 0;
  const double read = std::strtod(number.c_str(), &end);
  const char* const stop = first + (end - number.c_str());
  if (stop == first) return {first, std::errc::invalid_argument};
  if (errno == ERANGE && (read == 0 || std::isinf(read)))
    return {stop, std::errc::result_out_of_range};
  value = read;
  return {stop, std::errc()};
#endif
}

}  // namespace knead
