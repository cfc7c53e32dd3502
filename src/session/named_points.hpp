#pragma once

#include <vector>

#include "command_fields.hpp"

namespace knead {

/// Control points of the only selected surface: by indices i n + j of a net m × n, and by whole
/// rows. In this order, each once; at least one in all.
struct NamedPoints {
  std::vector<int> which;
  std::vector<int> rows_u;  ///< all (i, ·) for these i
  std::vector<int> rows_v;  ///< all (·, j) for these j
};

void describe(NamedPoints& points, Fields& fields);

/// Indices i n + j of the named control points, in the order named, each once.
/// Errors (input): a number or row that does not exist, with its place; none at all.
[[nodiscard]] Expected<std::vector<int>> indices_of(const NamedPoints& named,
                                                    const std::array<int, 2>& net);

}  // namespace knead
