#pragma once

#include <dlfcn.h>

namespace knead::testing {

/// Whether the address sanitizer is at work, be it compiled in or only in the library that this
/// program has loaded.
inline bool sanitized() {
  static const bool result = dlsym(RTLD_DEFAULT, "__asan_init") != nullptr;
  return result;
}

}  // namespace knead::testing
