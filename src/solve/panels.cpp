#include "panels.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace knead {

// The nonzeros of L⁻¹ e_i are at the unknowns on the path from i to the root of the elimination
// tree (Gilbert and Peierls, "Sparse partial pivoting in time proportional to arithmetic
// operations", 1988). One pass over the panels in ascending order finds them for all rows at once:
// a panel's rows below it lie in later panels. The backward sweep for the same rows needs the same
// panels, since a row of x depends on later rows alone. Rows of a task's own stand for rows of the
// matrix (`original_`).
std::vector<int> Panels::reach(std::span<const int> rows) const {
  std::vector<char> marked(panels_.size(), 0);
  const auto size = static_cast<int>(panel_of_.size());
  const auto mark = [&](int row) {
    if (row >= size) row = original_[static_cast<std::size_t>(row - size)];
    marked[static_cast<std::size_t>(panel_of_[static_cast<std::size_t>(row)])] = 1;
  };
  for (const int row : rows) mark(row);
  std::vector<int> result;
  for (std::size_t k = 0; k < panels_.size(); ++k) {
    if (!marked[k]) continue;
    result.push_back(static_cast<int>(k));
    for (int i = 0; i < panels_[k].rows; ++i)
      mark(rows_[static_cast<std::size_t>(panels_[k].row + i)]);
  }
  return result;
}

std::size_t Panels::stored() const {
  std::size_t sum = 0;
  for (const Panel& p : panels_) {
    const auto width = static_cast<std::size_t>(p.width);
    sum += width * static_cast<std::size_t>(p.rows) + width * (width + 1) / 2;
  }
  return sum;
}

}  // namespace knead
