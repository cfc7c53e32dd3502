#pragma once

#include <cstddef>

namespace knead::detail {

/// Asks the system to back memory that nothing has been written into yet by large pages, where it
/// has them; what is too little for that stays as it is.
void ask_for_large_pages(void* begin, std::size_t bytes);

/// Makes room for `count` items of a vector or string that is about to be filled. A hundred
/// megabytes in pages of 4 kB are 25,000 faults, of 10 µs each on some machines; in large ones they
/// are 50.
template <class Container>
void reserve_large(Container& items, std::size_t count) {
  items.reserve(count);
  const std::size_t filled = items.size();
  ask_for_large_pages(items.data() + filled, (items.capacity() - filled) * sizeof(*items.data()));
}

}  // namespace knead::detail
