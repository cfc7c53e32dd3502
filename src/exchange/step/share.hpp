#pragma once

#include <algorithm>
#include <cstddef>

#include "base/parallel_for.hpp"
#include "entity.hpp"

namespace knead::step {

/// Calls body(reader, k) for k = 0 … count − 1, of the surfaces of a file or what stands on them,
/// by several threads where the file is large; each has a reader of its own. `body` must not touch
/// what it touches for another k.
template <class Body>
void share(const Reader& reader, std::size_t count, const Body& body) {
  // Multiplications: together they take some 10 ns for each byte of the file.
  constexpr double work_per_byte = 50;
  const auto items = static_cast<std::ptrdiff_t>(count);
  const double bytes = static_cast<double>(reader.file().bytes().size());
  const double work =
      work_per_byte * bytes / static_cast<double>(std::max<std::ptrdiff_t>(items, 1));
  detail::parallel_for(items, detail::block_size(items, work),
                       [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                         const Reader worker(reader.file());
                         for (std::ptrdiff_t k = begin; k < end; ++k)
                           body(worker, static_cast<std::size_t>(k));
                       });
}

}  // namespace knead::step
