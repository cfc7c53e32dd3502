#pragma once

#include <algorithm>
#include <cstddef>

namespace knead::detail {

/// Work that is worth a block of its own, in multiplications with what goes along: 50 µs, or more
/// where they are not in vectors. Waking a thread takes some 10.
inline constexpr std::ptrdiff_t block_work = std::ptrdiff_t{1} << 18;

/// How many of `count` items, each of so much work, go into one block of `parallel_for`; all of
/// them where they are too few to be worth it. A multiple of `step`, and at most 64 blocks. It does
/// not depend on the number of threads.
[[nodiscard]] constexpr std::ptrdiff_t block_size(std::ptrdiff_t count, double work,
                                                  std::ptrdiff_t step = 1) {
  if (static_cast<double>(count) * work < 4.0 * block_work)
    return std::max<std::ptrdiff_t>(count, 1);
  const auto items = static_cast<std::ptrdiff_t>(block_work / std::max(work, 1.0));
  const std::ptrdiff_t size = std::max({items, (count + 63) / 64, std::ptrdiff_t{1}});
  return (size + step - 1) / step * step;
}

#ifndef __wasm__
/// body(context, begin, end) for the blocks of `size` items, by the threads of `thread_count`.
void run_blocks(std::ptrdiff_t count, std::ptrdiff_t size,
                void (*body)(const void*, std::ptrdiff_t, std::ptrdiff_t), const void* context);
#endif

/// Calls body(begin, end) for ranges that together are 0 … count − 1, by several threads where
/// there is more than one block of `size` items; returns when all are done. What the body writes
/// must not depend on how the items are divided, and no item may touch what another one writes:
/// then the result has the same bits with any number of threads.
///
/// With one thread, within the body of another call, while another thread of the program uses the
/// threads here, and in WebAssembly it is the one call body(0, count). Otherwise whole blocks, each
/// by whichever thread is free. What a body throws is thrown here, once all threads have left it
/// (of several the one of the first thread; which blocks have been done is unspecified). A process
/// that forks gets new threads in the child; a body must not fork.
template <class Body>
void parallel_for(std::ptrdiff_t count, [[maybe_unused]] std::ptrdiff_t size, const Body& body) {
#ifndef __wasm__
  if (count > size) {
    return run_blocks(
        count, size,
        [](const void* context, std::ptrdiff_t begin, std::ptrdiff_t end) {
          (*static_cast<const Body*>(context))(begin, end);
        },
        &body);
  }
#endif
  if (count > 0) body(std::ptrdiff_t{0}, count);
}

}  // namespace knead::detail
