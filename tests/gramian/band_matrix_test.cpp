#include "knead/gramian/band_matrix.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>

namespace knead {
namespace {

BandMatrix counted(int n, int p, BandSymmetry symmetry) {
  BandMatrix matrix(n, p, symmetry);
  for (int i = 0; i < n; ++i) {
    for (int j = std::max(0, i - p); j <= std::min(n - 1, i + p); ++j) {
      if (symmetry == BandSymmetry::general || i <= j) matrix.at(i, j) = 100 * i + j + 1;
    }
  }
  return matrix;
}

TEST(BandMatrix, is_zero_outside_the_band_and_when_new) {
  const BandMatrix zero(6, 2), matrix = counted(6, 2, BandSymmetry::general);
  EXPECT_EQ(zero.dense().norm(), 0);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) EXPECT_EQ(matrix(i, j), std::abs(i - j) > 2 ? 0 : 100 * i + j + 1);
  }
}

TEST(BandMatrix, diagonals_hold_the_entries_of_their_offset) {
  for (const BandSymmetry symmetry : {BandSymmetry::general, BandSymmetry::symmetric}) {
    for (const int n : {1, 2, 3, 4, 9, 64}) {
      const BandMatrix matrix = counted(n, 3, symmetry);
      for (int s = -3; s <= 3; ++s) {
        const auto diagonal = matrix.diagonal(s);
        ASSERT_EQ(static_cast<int>(diagonal.size()), std::max(0, n - std::abs(s)));
        for (int k = 0; k < static_cast<int>(diagonal.size()); ++k) {
          EXPECT_EQ(diagonal[static_cast<std::size_t>(k)],
                    matrix(k + std::max(0, -s), k + std::max(0, s)));
        }
      }
    }
  }
}

TEST(BandMatrix, a_symmetric_matrix_keeps_one_number_for_two_entries) {
  BandMatrix matrix = counted(5, 2, BandSymmetry::symmetric);
  matrix.at(3, 1) = -7;
  EXPECT_EQ(matrix(1, 3), -7);
  EXPECT_EQ(matrix.diagonal(2).data(), matrix.diagonal(-2).data());
  EXPECT_EQ(matrix.transposed().dense(), matrix.dense());
}

TEST(BandMatrix, agrees_with_dense_algebra) {
  for (const BandSymmetry symmetry : {BandSymmetry::general, BandSymmetry::symmetric}) {
    for (const int n : {1, 2, 3, 7, 20}) {
      const BandMatrix matrix = counted(n, 3, symmetry);
      EXPECT_EQ(matrix.transposed().dense(), matrix.dense().transpose());
      EXPECT_EQ(Eigen::MatrixXd(matrix.sparse()), matrix.dense());
      const Eigen::MatrixXd x = Eigen::MatrixXd::Random(n, 4);
      EXPECT_LE((matrix.multiply(x) - matrix.dense() * x).norm(), 1e-12 * matrix.dense().norm());
    }
  }
}

TEST(BandMatrix, diagonals_are_padded_to_whole_cache_lines_and_never_a_power_of_two_apart) {
  for (const int n : {1, 8, 9, 56, 57, 120, 128, 1016, 4096}) {
    const BandMatrix matrix(n, 2);
    EXPECT_EQ(matrix.stride() % 8, 0u);
    EXPECT_GE(matrix.stride(), static_cast<std::size_t>(n) + 8);
    EXPECT_TRUE(n < 8 || !std::has_single_bit(matrix.stride()));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(matrix.diagonal(-2).data()) % 64, 0u);
  }
}

}  // namespace
}  // namespace knead
