#include <vector>

#include "knead/energy/stiffness.hpp"

namespace knead {

namespace {

/// Three coordinates and a fourth that is not used, in vectors that every processor has.
struct Row {
  typedef double Pair __attribute__((vector_size(16)));
  Pair xy = {0, 0}, z = {0, 0};

  void add(double factor, const Row& other) {
    xy += factor * other.xy;
    z += factor * other.z;
  }
};

}  // namespace

// A row of A is a column of it, so that every row of the result is gathered once and never read. Four sums side by side
// do not wait for one another.
Points symmetric_product(const SparseMatrix& a, const Points& x) {
  assert(a.isCompressed() && a.rows() == a.cols() && a.cols() == x.rows());
  std::vector<Row> rows(static_cast<std::size_t>(x.rows()));
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    rows[static_cast<std::size_t>(i)] = Row{Row::Pair{x(i, 0), x(i, 1)}, Row::Pair{x(i, 2), 0}};
  const auto* start = a.outerIndexPtr();
  const auto* index = a.innerIndexPtr();
  const double* value = a.valuePtr();
  const Row* from = rows.data();
  Points result(x.rows(), 3);
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    Row sum[4];
    auto k = start[j];
    for (; k + 4 <= start[j + 1]; k += 4) {
      for (int c = 0; c < 4; ++c) sum[c].add(value[k + c], from[index[k + c]]);
    }
    for (; k < start[j + 1]; ++k) sum[0].add(value[k], from[index[k]]);
    for (int c = 1; c < 4; ++c) sum[0].add(1, sum[c]);
    double* to = result.data() + 3 * j;
    to[0] = sum[0].xy[0];
    to[1] = sum[0].xy[1];
    to[2] = sum[0].z[0];
  }
  return result;
}

}  // namespace knead
