#include "knead/solve/partition.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "support/surfaces.hpp"

namespace knead {
namespace {

TEST(Partition, GatherAndScatterAreInverse) {
  const Partition partition({false, true, false, false, true});
  EXPECT_EQ(partition.free(), (std::vector<int>{0, 2, 3}));
  const Points x = testing::random_points(3, 1);
  EXPECT_EQ(partition.gather(partition.scatter(x)), x);
  EXPECT_EQ(partition.scatter(x).row(1).norm(), 0);
  const Points full = testing::random_points(5, 2);
  EXPECT_EQ(partition.free_part(full), partition.scatter(partition.gather(full)));
}

TEST(Partition, RestrictsAMatrixToItsFreeBlock) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Random(5, 5);
  dense(2, 3) = 0;
  const SparseMatrix matrix = dense.sparseView();
  const Partition partition({false, true, false, false, true});
  const Eigen::MatrixXd block = partition.restrict(matrix);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(block(r, c),
                dense(partition.free()[static_cast<std::size_t>(r)], partition.free()[static_cast<std::size_t>(c)]));
    }
  }
}

}  // namespace
}  // namespace knead
