#pragma once

#include <cstdlib>

namespace knead::testing {

/// Whether KNEAD_LONG asks for all that a test has, as `make check-long` does. Else tests that take
/// long check a sample of the same kinds of input.
inline bool long_run() { return std::getenv("KNEAD_LONG") != nullptr; }

/// Whether it is the turn of one in `every` of the things that are counted; in a long run it is
/// always.
class Sample {
 public:
  explicit Sample(int every) : every_(long_run() ? 1 : every) {}
  bool next() { return count_++ % every_ == 0; }

 private:
  int every_, count_ = 0;
};

}  // namespace knead::testing
