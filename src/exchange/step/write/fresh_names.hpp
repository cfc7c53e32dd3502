#pragma once

#include <cstdint>
#include <limits>

#include "exchange/part21/part21.hpp"

namespace knead::step {

/// Names for new records: above all others, so that they cannot be mistaken for records deleted
/// earlier; but within the range of readers with 32-bit names while free names remain there.
class FreshNames {
 public:
  explicit FreshNames(const Part21File& file) : file_(file), next_(file.largest_id() + 1) {}

  std::uint64_t next() {
    constexpr std::uint64_t readable = std::numeric_limits<std::int32_t>::max();
    if (next_ > readable && !exhausted_) {
      while (file_.taken(low_) && low_ <= readable) ++low_;
      if (low_ <= readable) return low_++;
      exhausted_ = true;
    }
    return next_++;
  }

 private:
  const Part21File& file_;
  std::uint64_t next_;
  std::uint64_t low_ = 1;
  bool exhausted_ = false;
};

}  // namespace knead::step
