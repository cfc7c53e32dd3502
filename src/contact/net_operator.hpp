#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "base/parallel_for.hpp"
#include "knead/base/threads.hpp"
#include "knead/energy/stiffness.hpp"

namespace knead {

/// A sum of symmetric operators on the control points of several patches, each acting within one
/// patch, and of a multiple of the identity. It is applied patch by patch, and assembled nowhere
/// that `Stiffness` does without.
///
/// A product with the Kronecker factors of a polynomial patch takes O(p) operations a control point
/// and no memory, one with its assembled matrix (2p + 1)² on a surface, and as many entries.
template <int D>
class NetOperator {
 public:
  explicit NetOperator(int size = 0) : size_(size) {}

  /// Adds `factor` times an operator on the control points from row `first` on.
  void add(int first, double factor, Stiffness<D> block) {
    if (factor != 0) blocks_.push_back({first, factor, std::move(block)});
  }
  void add(double factor, const NetOperator& other) {
    for (const Block& block : other.blocks_)
      add(block.first, factor * block.factor, block.stiffness);
    for (const SparseMatrix& matrix : other.matrices_) matrices_.emplace_back(factor * matrix);
    identity_ += factor * other.identity_;
  }
  void add_identity(double factor) { identity_ += factor; }
  /// Adds a matrix between all control points, of which both triangles are stored.
  void add(SparseMatrix matrix) { matrices_.push_back(std::move(matrix)); }

  /// The product with N × 3 coordinates. Where there are patches enough, threads share them out;
  /// otherwise they share the lines of each.
  [[nodiscard]] Points operator*(const Points& x) const {
    if (!matrices_.empty()) return product_of_blocks(x) + product_of_matrices(x);
    return product_of_blocks(x);
  }

  /// All of it as one matrix.
  ///
  /// One patch, the usual case, adds values where patterns agree, as all energies of one net do;
  /// several patches go through triplets.
  [[nodiscard]] SparseMatrix assemble() const {
    SparseMatrix sum(size_, size_);
    if (std::ranges::all_of(blocks_,
                            [this](const Block& b) { return b.stiffness.size() == size_; })) {
      for (const Block& block : blocks_) {
        SparseMatrix part = block.stiffness.assemble();
        if (sum.nonZeros() == 0) {
          part.coeffs() *= block.factor;
          sum.swap(part);
        } else if (same_pattern(sum, part)) {
          sum.coeffs() += block.factor * part.coeffs();
        } else {
          sum = SparseMatrix(sum + block.factor * part);
        }
      }
    } else {
      std::vector<Eigen::Triplet<double>> entries;
      for (const Block& block : blocks_) append(block, entries);
      sum.setFromTriplets(entries.begin(), entries.end());
    }
    for (const SparseMatrix& matrix : matrices_) sum = SparseMatrix(sum + matrix);
    if (identity_ == 0) return sum;
    if (sum.nonZeros() == 0) sum.setIdentity(), sum.coeffs().setZero();
    sum.diagonal() += Eigen::VectorXd::Constant(size_, identity_);
    return sum;
  }

 private:
  struct Block {
    int first;
    double factor;
    Stiffness<D> stiffness;
  };

  /// Of every patch that blocks act on, ascending.
  [[nodiscard]] std::vector<int> first_rows() const {
    std::vector<int> first;
    for (const Block& block : blocks_) first.push_back(block.first);
    std::ranges::sort(first);
    first.erase(std::ranges::unique(first).begin(), first.end());
    return first;
  }

  [[nodiscard]] Points product_of_matrices(const Points& x) const {
    Points y = symmetric_product(matrices_.front(), x);
    for (std::size_t k = 1; k < matrices_.size(); ++k) y += symmetric_product(matrices_[k], x);
    return y;
  }

  // Patches write disjoint rows, so that threads need no order among them; blocks of one patch are
  // added in their own order. Both ways give the same bits.
  [[nodiscard]] Points product_of_blocks(const Points& x) const {
    if (blocks_.size() == 1 && identity_ == 0 && blocks_[0].factor == 1 &&
        blocks_[0].stiffness.size() == size_)
      return blocks_[0].stiffness.apply(x);
    Points y = identity_ * x;
    const std::vector<int> patches = first_rows();
    const auto count = static_cast<std::ptrdiff_t>(patches.size());
    if (count < 2 || count < thread_count()) {
      for (const Block& block : blocks_) add_product(block, x, y);
      return y;
    }
    const double work = work_per_row * static_cast<double>(x.rows()) / static_cast<double>(count);
    detail::parallel_for(count, detail::block_size(count, work),
                         [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                           for (; begin < end; ++begin) {
                             for (const Block& block : blocks_) {
                               if (block.first == patches[static_cast<std::size_t>(begin)])
                                 add_product(block, x, y);
                             }
                           }
                         });
    return y;
  }

  void add_product(const Block& block, const Points& x, Points& y) const {
    const int rows = block.stiffness.size();
    if (rows == size_) {
      y += block.factor * block.stiffness.apply(x);
    } else {
      y.middleRows(block.first, rows) +=
          block.factor * block.stiffness.apply(Points(x.middleRows(block.first, rows)));
    }
  }

  static bool same_pattern(const SparseMatrix& a, const SparseMatrix& b) {
    return a.nonZeros() == b.nonZeros() &&
           std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize() + 1,
                      b.outerIndexPtr()) &&
           std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
  }

  static void append(const Block& block, std::vector<Eigen::Triplet<double>>& entries) {
    const SparseMatrix part = block.stiffness.assemble();
    for (int j = 0; j < part.outerSize(); ++j) {
      for (SparseMatrix::InnerIterator it(part, j); it; ++it) {
        entries.emplace_back(block.first + static_cast<int>(it.row()), block.first + j,
                             block.factor * it.value());
      }
    }
  }

  static constexpr double work_per_row = 300;  ///< multiplications, roughly, of a cubic surface

  int size_;
  double identity_ = 0;
  std::vector<Block> blocks_;
  std::vector<SparseMatrix> matrices_;
};

}  // namespace knead
