#pragma once

#include "knead/gramian/gramian.hpp"

namespace knead {

/// Floating-point operations performed.
struct OperationCount {
  long additions = 0;  ///< and subtractions
  long multiplications = 0;
  long divisions = 0;  ///< and square roots
  [[nodiscard]] long total() const { return additions + multiplications + divisions; }

  friend OperationCount operator-(const OperationCount& a, const OperationCount& b) {
    return {a.additions - b.additions, a.multiplications - b.multiplications,
            a.divisions - b.divisions};
  }
};

/// The number of operations a method needs for the four Gramians: the method itself is run on
/// counting numbers. Copied rows (equal spans) count as if computed. gauss, gauss-reduced and
/// recurrence are the kernels that `gramians` runs (those by Gauss points to degree 7; above, and
/// where knot distances are out of the range of the kernels, the count of gauss is zero and that of
/// gauss-reduced is of the terms one by one).
[[nodiscard]] OperationCount count_operations(const KnotVector& knots, GramianMethod method);

}  // namespace knead
