#include "named_points.hpp"

#include <fmt/format.h>

namespace knead {

void describe(NamedPoints& points, Fields& fields) {
  fields.add("which", points.which,
             {.help = "numbers i n + j of control points of the net m × n, from 0; one of these "
                      "three, or several"});
  fields.add("rows_u", points.rows_u, {.help = "`[i, …]`: all control points (i, ·)"});
  fields.add("rows_v", points.rows_v, {.help = "`[j, …]`: all control points (·, j)"});
}

Expected<std::vector<int>> indices_of(const NamedPoints& named, const std::array<int, 2>& net) {
  const auto [m, n] = net;
  std::vector<int> result;
  std::vector<bool> met(static_cast<std::size_t>(m) * static_cast<std::size_t>(n));
  const auto add = [&](int k) {
    if (met[static_cast<std::size_t>(k)]) return;
    met[static_cast<std::size_t>(k)] = true;
    result.push_back(k);
  };
  const auto missing = [](const char* what, int index, const char* where, std::size_t place,
                          int count) {
    return input_error(fmt::format("there is no {} {}", what, index),
                       fmt::format("{}[{}]", where, place),
                       fmt::format("use numbers from 0 to {}", count - 1));
  };
  for (std::size_t k = 0; k < named.which.size(); ++k) {
    const int index = named.which[k];
    if (index < 0 || index >= m * n) return missing("control point", index, "which", k, m * n);
    add(index);
  }
  for (std::size_t k = 0; k < named.rows_u.size(); ++k) {
    const int i = named.rows_u[k];
    if (i < 0 || i >= m) return missing("row u", i, "rows_u", k, m);
    for (int j = 0; j < n; ++j) add(i * n + j);
  }
  for (std::size_t k = 0; k < named.rows_v.size(); ++k) {
    const int j = named.rows_v[k];
    if (j < 0 || j >= n) return missing("row v", j, "rows_v", k, n);
    for (int i = 0; i < m; ++i) add(i * n + j);
  }
  if (!result.empty()) return result;
  return input_error("no control points are named", "which",
                     "give which, rows_u or rows_v, counted from 0");
}

}  // namespace knead
