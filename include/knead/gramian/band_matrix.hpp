#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cassert>
#include <cstddef>
#include <new>
#include <span>
#include <vector>

namespace knead {

/// Allocates on cache-line boundaries, so that whole vectors of a diagonal can be stored at once.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t alignment{64};
  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}
  [[nodiscard]] T* allocate(std::size_t n) {
    return static_cast<T*>(::operator new(n * sizeof(T), alignment));
  }
  void deallocate(T* p, std::size_t) { ::operator delete(p, alignment); }
  friend bool operator==(CacheLineAllocator, CacheLineAllocator) { return true; }
};

/// Whether both halves of a band are stored, or only the upper one for both.
enum class BandSymmetry { general, symmetric };

/// A square n × n band matrix A with half bandwidth p: A(i, j) = 0 where |i − j| > p.
///
/// Stored by diagonals: diagonal s = j − i, −p <= s <= p, is contiguous, so that kernels vectorise
/// along it and a product with a vector is 2p + 1 long multiply-adds. If the matrix is symmetric
/// only s >= 0 is stored and `diagonal(-s)` is the same memory as `diagonal(s)`.
class BandMatrix {
 public:
  /// The zero matrix. Requires size >= 0, half_bandwidth >= 0 (asserted).
  explicit BandMatrix(int size = 0, int half_bandwidth = 0,
                      BandSymmetry symmetry = BandSymmetry::general);

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] int half_bandwidth() const { return half_bandwidth_; }
  [[nodiscard]] BandSymmetry symmetry() const { return symmetry_; }

  /// A(i, j) for any 0 <= i, j < size(); 0 outside the band.
  [[nodiscard]] double operator()(int i, int j) const {
    assert(i >= 0 && i < size_ && j >= 0 && j < size_);
    return i - j > half_bandwidth_ || j - i > half_bandwidth_ ? 0.0 : data_[offset(i, j)];
  }
  /// The entry inside the band (asserted). In a symmetric matrix A(i, j) and A(j, i) are one
  /// number.
  [[nodiscard]] double& at(int i, int j) {
    assert(i >= 0 && i < size_ && j >= 0 && j < size_ && i - j <= half_bandwidth_ &&
           j - i <= half_bandwidth_);
    return data_[offset(i, j)];
  }

  /// Diagonal s, −p <= s <= p: the size() − |s| entries A(k, k + s) for s >= 0, A(k − s, k) for s <
  /// 0, k = 0, 1, … (empty where |s| >= size()).
  [[nodiscard]] std::span<const double> diagonal(int s) const { return {start(s), length(s)}; }
  [[nodiscard]] std::span<double> diagonal(int s) {
    return {const_cast<double*>(start(s)), length(s)};
  }

  /// Distance in doubles between stored diagonals s and s + 1: at least size() rounded up to whole
  /// cache lines, with at least one line to spare, all of it owned, so that a kernel may store
  /// whole vectors past the end of a diagonal. Never a power of two, which would map all diagonals
  /// to the same cache sets.
  [[nodiscard]] std::size_t stride() const { return stride_; }

  [[nodiscard]] bool all_finite() const;
  /// Aᵀ.
  [[nodiscard]] BandMatrix transposed() const;
  /// A X for an n × m matrix X. Cost: (2p + 1) n m multiply-adds.
  [[nodiscard]] Eigen::MatrixXd multiply(const Eigen::Ref<const Eigen::MatrixXd>& x) const;
  [[nodiscard]] Eigen::MatrixXd dense() const;
  /// All entries inside the band, zeros included, so that the pattern depends on n and p alone.
  [[nodiscard]] Eigen::SparseMatrix<double> sparse() const;

 private:
  [[nodiscard]] int stored(int s) const {
    return symmetry_ == BandSymmetry::symmetric ? (s < 0 ? -s : s) : s + half_bandwidth_;
  }
  [[nodiscard]] const double* start(int s) const {
    assert(s >= -half_bandwidth_ && s <= half_bandwidth_);
    return data_.data() + static_cast<std::size_t>(stored(s)) * stride_;
  }
  [[nodiscard]] std::size_t length(int s) const {
    const int missing = s < 0 ? -s : s;
    return missing < size_ ? static_cast<std::size_t>(size_ - missing) : 0;
  }
  [[nodiscard]] std::size_t offset(int i, int j) const {
    return static_cast<std::size_t>(stored(j - i)) * stride_ +
           static_cast<std::size_t>(i < j ? i : j);
  }

  int size_;
  int half_bandwidth_;
  BandSymmetry symmetry_;
  std::size_t stride_;
  std::vector<double, CacheLineAllocator<double>> data_;
};

}  // namespace knead
