#include "large_memory.hpp"

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace knead::detail {

void ask_for_large_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::size_t page = std::size_t{2} << 20U, least = 4 * page;
  if (bytes < least) return;
  // Only whole pages inside the range: memory beside it belongs to others.
  const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(begin) % page) % page;
  const std::size_t whole = (bytes - before) / page * page;
  // Where the system has no large pages it says so, and nothing is lost.
  static_cast<void>(::madvise(static_cast<char*>(begin) + before, whole, MADV_HUGEPAGE));
#endif
}

}  // namespace knead::detail
