#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "knead/spline/basis.hpp"

namespace knead {

/// One direction of a tensor-product evaluation: y[o, k, c] = Σ_r N_{first[k]+r}(u_k) x[o,
/// first[k]+r, c] with the values of `table` (derivative 0), o < outer, c < inner, last index
/// fastest; x has `functions` entries in the direction.
inline void contract_along(const BasisTable& table, std::size_t functions, std::size_t outer,
                           std::size_t inner, const double* x, double* y) {
  for (std::size_t o = 0; o < outer; ++o, x += functions * inner) {
    for (int k = 0; k < table.size(); ++k, y += inner) {
      const double* values = table.row(k, 0);
      const double* from =
          x + static_cast<std::size_t>(table.first[static_cast<std::size_t>(k)]) * inner;
      std::fill_n(y, inner, 0.0);
      for (int r = 0; r <= table.degree; ++r, from += inner) {
        for (std::size_t c = 0; c < inner; ++c) y[c] += values[r] * from[c];
      }
    }
  }
}

/// All directions: the values Σ N_i(u) x_i on the grid of the tables' parameters, with `components`
/// numbers per coefficient and per value, last direction fastest. Cost: about p + 1 multiply-adds
/// per direction, point and component.
template <int D>
[[nodiscard]] std::vector<double> contract_grid(const std::array<const BasisTable*, D>& tables,
                                                const std::array<int, D>& net, const double* x,
                                                std::size_t components) {
  std::size_t inner = components, outer = 1;
  for (std::size_t d = 0; d < D; ++d) inner *= static_cast<std::size_t>(net[d]);
  std::vector<double> from, to;
  for (std::size_t d = 0; d < D; ++d) {
    const auto n = static_cast<std::size_t>(net[d]),
               points = static_cast<std::size_t>(tables[d]->size());
    inner /= n;
    to.resize(outer * points * inner);
    contract_along(*tables[d], n, outer, inner, d == 0 ? x : from.data(), to.data());
    outer *= points;
    std::swap(from, to);
  }
  return from;
}

}  // namespace knead
