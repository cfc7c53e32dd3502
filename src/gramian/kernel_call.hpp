#pragma once

#include <array>

#include "knead/gramian/gramian.hpp"
#include "simd/kernels.hpp"

namespace knead::detail {

/// The knots and the four band matrices as the kernels need them. Valid as long as both arguments
/// exist.
class KernelCall {
 public:
  KernelCall(const KnotVector& knots, GramianSet& set);
  [[nodiscard]] const KernelKnots& knots() const { return knots_; }
  [[nodiscard]] const KernelOutput& output() const { return output_; }

 private:
  std::array<double, 3 * KernelKnots::readable> tail_;
  KernelKnots knots_;
  KernelOutput output_;
};

/// `count` points as the Gauss kernels need them.
[[nodiscard]] GaussPoints gauss_points(int count);

/// The rules of the reduced Gauss kernels.
[[nodiscard]] std::array<GaussPoints, 3> reduced_gauss_points(int degree);

/// Matrices of the right size for the four terms; those that already fit are kept, whatever their
/// content.
void resize(GramianSet& set, const KnotVector& knots);

}  // namespace knead::detail
