#include <algorithm>
#include <vector>

#include "base/parallel_for.hpp"
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

// Every row of the result is gathered once from a column of A and never read. Four sums side by
// side do not wait for one another.
Points transposed_product(const SparseMatrix& a, const Points& x) {
  assert(a.isCompressed() && a.rows() == x.rows());
  std::vector<Row> rows(static_cast<std::size_t>(x.rows()));
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    rows[static_cast<std::size_t>(i)] = Row{Row::Pair{x(i, 0), x(i, 1)}, Row::Pair{x(i, 2), 0}};
  const auto* start = a.outerIndexPtr();
  const auto* index = a.innerIndexPtr();
  const double* value = a.valuePtr();
  const Row* from = rows.data();
  Points result(a.cols(), 3);
  const double work = 3.0 * static_cast<double>(a.nonZeros()) /
                      static_cast<double>(std::max<Eigen::Index>(a.cols(), 1));
  detail::parallel_for(a.cols(), detail::block_size(a.cols(), work),
                       [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                         for (Eigen::Index j = begin; j < end; ++j) {
                           Row sum[4];
                           auto k = start[j];
                           for (; k + 4 <= start[j + 1]; k += 4) {
                             for (int c = 0; c < 4; ++c)
                               sum[c].add(value[k + c], from[index[k + c]]);
                           }
                           for (; k < start[j + 1]; ++k) sum[0].add(value[k], from[index[k]]);
                           for (int c = 1; c < 4; ++c) sum[0].add(1, sum[c]);
                           double* to = result.data() + 3 * j;
                           to[0] = sum[0].xy[0];
                           to[1] = sum[0].xy[1];
                           to[2] = sum[0].z[0];
                         }
                       });
  return result;
}

Points symmetric_product(const SparseMatrix& a, const Points& x) {
  assert(a.rows() == a.cols());
  return transposed_product(a, x);
}

}  // namespace knead
