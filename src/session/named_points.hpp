#pragma once

#include <vector>

#include "command_fields.hpp"

namespace knead {

/// Control points of the one selected surface: by numbers i n + j of a net m × n, and by whole rows. In this order,
/// each once; together at least one.
struct NamedPoints {
  std::vector<int> which;
  std::vector<int> rows_u;  ///< all (i, ·) for these i
  std::vector<int> rows_v;  ///< all (·, j) for these j
};

/// The fields that say which control points are meant.
template <class P, class V>
void visit_points(P& p, V& v) {
  v.field("which", Presence::optional, p.which, "numbers i n + j of control points, from 0; and:");
  v.field("rows_u", Presence::optional, p.rows_u, "[i, …]: all control points (i, ·); and:");
  v.field("rows_v", Presence::optional, p.rows_v, "[j, …]: all control points (·, j)");
}

/// Indices i n + j of the control points that are meant, in the order they are named, each once.
/// Errors (input): a number or row that there is not, with its place; none at all.
[[nodiscard]] Expected<std::vector<int>> indices_of(const NamedPoints& named, const std::array<int, 2>& net);

}  // namespace knead
