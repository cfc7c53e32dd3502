#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

#include "parallel_for.hpp"

namespace knead::detail {

#ifdef __wasm__
inline void give_way() {}  // nobody is waited for where there is one thread
#else
/// Lets other threads run.
void give_way();
#endif

/// Calls body(item) for the items of `order`, by several threads where there are any, each once
/// what it needs is done: `needs` gives a range of the items before it in `order` that come first;
/// items that are not in `order` are not waited for. What two items write that do not need each
/// other must be apart. What a body throws is thrown here, as by `parallel_for`; no body begins
/// after that.
/// \param items numbers of items are below it.
/// \param worth whether there is enough to do for several threads.
template <class Needs, class Body>
void parallel_in_order(std::span<const int> order, std::size_t items, bool worth,
                       const Needs& needs, const Body& body) {
  if (!worth) {
    std::ranges::for_each(order, body);
    return;
  }
  std::vector<std::atomic<bool>> waited(items);  // for: not done yet
  for (const int item : order)
    waited[static_cast<std::size_t>(item)].store(true, std::memory_order_relaxed);
  std::atomic<bool> failed = false;
  struct Turn {
    std::atomic<bool>&here, &failed;
    bool done = false;
    ~Turn() {
      if (!done) failed.store(true, std::memory_order_relaxed);
      here.store(false, std::memory_order_release);
    }
  };
  // Blocks are taken in order, so that whatever is waited for has been taken: one that waits for
  // nothing goes on.
  parallel_for(
      static_cast<std::ptrdiff_t>(order.size()), 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t k = begin; k < end; ++k) {
          const int item = order[static_cast<std::size_t>(k)];
          Turn turn{waited[static_cast<std::size_t>(item)], failed};
          for (const int first : needs(item)) {
            for (int rounds = 0;
                 waited[static_cast<std::size_t>(first)].load(std::memory_order_acquire);) {
              if (rounds < 200) {
                ++rounds;
              } else {
                give_way();
              }
            }
          }
          if (failed.load(std::memory_order_relaxed)) return;
          body(item);
          turn.done = true;
        }
      });
}

}  // namespace knead::detail
