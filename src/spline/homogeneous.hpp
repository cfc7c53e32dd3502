#pragma once

#include <array>
#include <span>
#include <vector>

#include "knead/spline/evaluate.hpp"
#include "quotient_rule.hpp"

namespace knead::detail {

/// The control net as evaluation reads it: rows of `width` numbers, (x, y, z) or with weights (wx,
/// wy, wz, w). It refers to the spline, which must outlive it.
template <int D>
class HomogeneousNet {
 public:
  /// \param whole Whether `data` will be read. If not, a rational net is left as it is: where a few
  /// points are
  ///              evaluated, all others of a large net need not be touched.
  explicit HomogeneousNet(const Spline<D>& spline, bool whole = true);

  [[nodiscard]] std::size_t width() const { return width_; }
  /// Distance in memory of neighbours in `direction`.
  [[nodiscard]] std::size_t stride(std::size_t direction) const { return stride_[direction]; }
  [[nodiscard]] const double* data() const {
    return premultiplied_.empty() ? cartesian_ : premultiplied_.data();
  }
  [[nodiscard]] bool whole() const { return width_ == 3 || !premultiplied_.empty(); }
  /// Copies `count` rows from `first` on, in the order of the net, of the same bits as in `data`.
  /// Returns where they end.
  double* copy(std::size_t first, std::size_t count, double* to) const;

 private:
  std::size_t width_;
  const double *cartesian_, *weights_;
  std::vector<double> premultiplied_;
  std::array<std::size_t, D> stride_{};
};

/// Cartesian derivatives of one point from homogeneous ones, R = A / W, by the quotient rule.
/// \param homogeneous (wx, wy, wz, w) of multi-index k at homogeneous + k · stride
/// \param row         row of `out[k]` to write, for every k
/// False, with nothing written, if w is not positive.
template <int D>
[[nodiscard]] bool divide_point(const QuotientRule<D>& rule, const double* homogeneous,
                                std::size_t stride, Eigen::Index row, std::span<double* const> out);

/// The memory of an evaluation of so many points, made as large as it must be: where every
/// derivative begins.
template <int D>
[[nodiscard]] std::vector<double*> memory_of(Evaluation<D>& result, int order, Eigen::Index points);
/// The same of memory of the caller, whose size is asserted.
template <int D>
[[nodiscard]] std::vector<double*> checked_memory(DerivativeMemory out, int order,
                                                  Eigen::Index points);

/// The denominator at the parameters numbered `at` is not positive.
template <int D>
[[nodiscard]] std::unexpected<Error> denominator_error(const std::array<std::size_t, D>& at);

}  // namespace knead::detail
