#include "coordinate_sum.hpp"

#include <algorithm>

namespace knead {
namespace {

/// Where the three coordinates of each point are in a column, the first of them; false if one of
/// them is not there.
bool find_in_column(const SparseMatrix& matrix, Eigen::Index column, std::span<const int> points,
                    std::vector<Eigen::Index>& places) {
  const int *index = matrix.innerIndexPtr(), *end = index + matrix.outerIndexPtr()[column + 1];
  const int *begin = index + matrix.outerIndexPtr()[column], *at = begin;
  const auto is_here = [&](int first) {
    return end - at >= 3 && at[0] == first && at[1] == first + 1 && at[2] == first + 2;
  };
  for (std::size_t k = 0; k < points.size(); ++k) {
    const int first = 3 * points[k];
    if (!is_here(first))
      at = std::lower_bound(begin, end, first);  // else it follows the one before
    if (!is_here(first)) return false;
    places[k] = at - index;
    at += 3;
  }
  return true;
}

}  // namespace

CoordinateSum::CoordinateSum(SparseMatrix base) : base_(std::move(base)) {
  base_.makeCompressed();
  sum_ = base_;
}

bool CoordinateSum::renewed() {
  const bool result = renewed_;
  renewed_ = false;
  return result;
}

// Base and sum keep the same pattern, so that `clear` is a copy of values. Where contacts travel
// back and forth the pattern soon suffices.
void CoordinateSum::grow(std::span<const int> points) {
  std::vector<Eigen::Triplet<double>> zeros;
  for (const int i : points) {
    for (const int j : points) {
      for (int k = 0; k < 9; ++k) zeros.emplace_back(3 * i + k / 3, 3 * j + k % 3, 0.0);
    }
  }
  SparseMatrix more(base_.rows(), base_.cols());
  more.setFromTriplets(zeros.begin(), zeros.end());
  base_ = SparseMatrix(base_ + more);
  sum_ = SparseMatrix(sum_ + more);
  renewed_ = true;
}

// Three rows at a time, which are adjacent in a column: one search for each pair of points, and
// none where points follow one another as they do within an element.
void CoordinateSum::add(std::span<const int> points, const Eigen::MatrixXd& block) {
  std::vector<Eigen::Index> places(points.size());
  for (std::size_t j = 0; j < points.size(); ++j) {
    for (int c = 0; c < 3; ++c) {
      const Eigen::Index column = 3 * static_cast<Eigen::Index>(points[j]) + c;
      if (!find_in_column(sum_, column, points, places)) {
        grow(points);
        static_cast<void>(find_in_column(sum_, column, points, places));
      }
      const double* from = block.col(3 * static_cast<Eigen::Index>(j) + c).data();
      for (const Eigen::Index place : places) {
        double* to = sum_.valuePtr() + place;
        for (int e = 0; e < 3; ++e) to[e] += *from++;
      }
    }
  }
}

// The zeros are stored for the blocks of H to come, which fill all nine places of a pair of points.
SparseMatrix with_coordinate_blocks(const SparseMatrix& a) {
  SparseMatrix result(3 * a.rows(), 3 * a.cols());
  result.reserve(9 * a.nonZeros());
  for (Eigen::Index j = 0; j < a.outerSize(); ++j) {
    for (int c = 0; c < 3; ++c) {
      result.startVec(3 * j + c);
      for (SparseMatrix::InnerIterator it(a, j); it; ++it) {
        for (int e = 0; e < 3; ++e)
          result.insertBack(3 * it.index() + e, 3 * j + c) = e == c ? it.value() : 0.0;
      }
    }
  }
  result.finalize();
  return result;
}

}  // namespace knead
