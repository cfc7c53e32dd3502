#pragma once

#include <array>
#include <span>
#include <vector>

#include "knead/energy/shell_energy.hpp"
#include "knead/spline/basis.hpp"
#include "shell_point.hpp"
#include "simd/shell_kernels.hpp"
#include "tensor_pattern.hpp"

namespace knead::detail {

class ShellBlockSum;

/// The elements of a shell, four side by side, as `ShellKernels` take them.
class ShellBlocks {
 public:
  ShellBlocks() = default;
  /// \param surface the rest shape \param quadrature with derivatives up to the second
  /// \param points Gauss points per element \param elements and all their points, as `ShellEnergy`
  /// orders them \param rest receives the metric and curvature anew, to the last bit as the kernels
  /// find them: at rest W is zero
  ShellBlocks(const Surface& surface, const std::array<BasisQuadrature, 2>& quadrature,
              const std::array<int, 2>& points, const std::vector<ShellElement>& elements,
              std::vector<ShellRest>& rest);

  /// W; where asked for adds ∂W/∂x to `gradient`, and sets the stress resultants.
  [[nodiscard]] ShellParts forces(const Points& x, Eigen::Ref<Points>* gradient,
                                  ShellStress* stress) const;
  /// Adds ∂²W/∂x² to `matrix`, three by three the entries of `scalar`, which has the pattern.
  void add_hessian(const Points& x, const ShellStress& stress, const TensorPattern<2>& pattern,
                   const SparseMatrix& scalar, SparseMatrix& matrix) const;

 private:
  static constexpr int lanes = ShellBlockShape::lanes;
  struct Block {
    std::array<int, lanes> element;  // the last block repeats its last, with weights of zero
    int count;                       // of its own
    std::vector<double> table[2], rest, quotient, weight;
  };

  [[nodiscard]] static ShellBlockData data(const Block& block);
  void pack_tables(Block& block, const std::array<BasisQuadrature, 2>& quadrature) const;
  void pack_rest(Block& block, const std::vector<ShellRest>& rest) const;
  void measure_rest(const Points& x, std::vector<ShellRest>& rest);
  void pack_weights(Block& block, const Surface& surface,
                    const std::array<BasisQuadrature, 2>& quadrature) const;
  /// How many numbers the second derivatives of a block are, as the kernels give them.
  [[nodiscard]] std::size_t hessian_numbers() const;
  /// Those of these blocks, one after the other.
  void find_hessians(std::span<const Block> blocks, const Points& x, const ShellStress& stress,
                     double* to) const;
  /// Adds those of a block to the rows of the matrix that owns(node) chooses.
  template <class Owns>
  void add_entries(const Block& block, const double* numbers, const Owns& owns,
                   ShellBlockSum& sum) const;
  /// The control points of the numerators.
  void gather(const Block& block, const Points& x, std::vector<double>& to) const;
  [[nodiscard]] const int* nodes(int element) const {
    return nodes_.data() + static_cast<std::ptrdiff_t>(element) * shape_.local();
  }

  ShellBlockShape shape_{};
  const ShellKernels* kernels_ = nullptr;
  int spans_ = 0;           // of the second direction
  std::vector<int> nodes_;  // [element][function]
  std::vector<Block> blocks_;
};

}  // namespace knead::detail
