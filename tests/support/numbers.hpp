#pragma once

#include <Eigen/Core>
#include <limits>

namespace knead::testing {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The largest magnitude of an entry.
template <class Derived>
double largest(const Eigen::MatrixBase<Derived>& matrix) {
  return matrix.cwiseAbs().maxCoeff();
}

}  // namespace knead::testing
