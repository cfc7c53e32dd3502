#pragma once

#include <sys/resource.h>

namespace knead::testing {

/// Less memory for programs that are started, until the end of the scope.
class LessMemory {
 public:
  explicit LessMemory(rlim_t bytes) {
    getrlimit(RLIMIT_AS, &before_);
    const rlimit less{bytes, before_.rlim_max};
    setrlimit(RLIMIT_AS, &less);
  }
  LessMemory(const LessMemory&) = delete;
  LessMemory& operator=(const LessMemory&) = delete;
  ~LessMemory() { setrlimit(RLIMIT_AS, &before_); }

 private:
  rlimit before_{};
};

}  // namespace knead::testing
