#include "homogeneous.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace knead::detail {

template <int D>
HomogeneousNet<D>::HomogeneousNet(const Spline<D>& spline, bool whole)
    : width_(spline.rational() ? 4 : 3),
      cartesian_(spline.control_points().data()),
      weights_(spline.weights().data()) {
  if (spline.rational() && whole) {
    std::vector<double> points(spline.weights().size() * width_);
    copy(0, spline.weights().size(), points.data());
    premultiplied_ = std::move(points);
  }
  std::size_t block = width_;
  for (std::size_t d = D; d-- > 0;) {
    stride_[d] = block;
    block *= static_cast<std::size_t>(spline.knots()[d].count());
  }
}

template <int D>
double* HomogeneousNet<D>::copy(std::size_t first, std::size_t count, double* to) const {
  if (whole()) return std::copy_n(data() + first * width_, count * width_, to);
  for (std::size_t i = first; i < first + count; ++i) {
    for (std::size_t c = 0; c < 3; ++c) *to++ = weights_[i] * cartesian_[i * 3 + c];
    *to++ = weights_[i];
  }
  return to;
}

template <int D>
bool divide_point(const QuotientRule<D>& rule, const double* homogeneous, std::size_t stride,
                  Eigen::Index row, std::span<double* const> out) {
  const double denominator = homogeneous[3];
  if (!(denominator > 0)) return false;
  for (std::size_t k = 0; k < rule.size(); ++k) {
    const double* numerator = homogeneous + k * stride;
    double value[3] = {numerator[0], numerator[1], numerator[2]};
    for (const auto& term : rule.terms(k)) {
      const double factor = term.factor * homogeneous[term.denominator * stride + 3];
      const double* lower = out[term.rest] + row * 3;
      for (int c = 0; c < 3; ++c) value[c] -= factor * lower[c];
    }
    double* to = out[k] + row * 3;
    for (int c = 0; c < 3; ++c) to[c] = value[c] / denominator;
  }
  return true;
}

template <int D>
std::unexpected<Error> denominator_error(const std::array<std::size_t, D>& at) {
  return numerical_error("the rational denominator is not positive",
                         fmt::format("parameter {}", fmt::join(at, ", ")), "use positive weights");
}

#define KNEAD_INSTANTIATE(D)                                                                      \
  template class HomogeneousNet<D>;                                                               \
  template bool divide_point<D>(const QuotientRule<D>&, const double*, std::size_t, Eigen::Index, \
                                std::span<double* const>);                                        \
  template std::unexpected<Error> denominator_error<D>(const std::array<std::size_t, D>&);
KNEAD_INSTANTIATE(1)
KNEAD_INSTANTIATE(2)
KNEAD_INSTANTIATE(3)
#undef KNEAD_INSTANTIATE

}  // namespace knead::detail
