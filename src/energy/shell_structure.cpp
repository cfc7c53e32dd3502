#include "shell_structure.hpp"

#include <utility>

namespace knead {
namespace {

/// Square matrices along the diagonal of one.
SparseMatrix along_diagonal(std::span<const SparseMatrix> blocks) {
  Eigen::Index size = 0, entries = 0;
  for (const SparseMatrix& block : blocks) {
    size += block.rows();
    entries += block.nonZeros();
  }
  SparseMatrix result(size, size);
  result.reserve(entries);
  Eigen::Index first = 0;
  for (const SparseMatrix& block : blocks) {
    for (Eigen::Index outer = 0; outer < block.outerSize(); ++outer) {
      result.startVec(first + outer);
      for (SparseMatrix::InnerIterator it(block, outer); it; ++it) {
        result.insertBackByOuterInner(first + outer, first + it.index()) = it.value();
      }
    }
    first += block.rows();
  }
  result.finalize();
  return result;
}

}  // namespace

ShellStructure::ShellStructure(std::vector<ShellEnergy> shells, std::vector<ShellCrease> creases)
    : shells_(std::move(shells)), creases_(std::move(creases)) {
  for (const ShellEnergy& shell : shells_) rows_.push_back(rows_.back() + shell.size());
}

ShellParts ShellStructure::energy(const Points& x) const {
  ShellParts sum;
  for (std::size_t k = 0; k < shells_.size(); ++k) {
    const ShellParts part = shells_[k].energy(rows_of(x, k));
    sum.membrane += part.membrane;
    sum.bending += part.bending;
  }
  for (const ShellCrease& crease : creases_) sum.bending += crease.energy(x);
  return sum;
}

ShellParts ShellStructure::energy(const Points& x, Points& gradient) const {
  ShellParts sum;
  gradient = Points::Zero(x.rows(), 3);
  for (std::size_t k = 0; k < shells_.size(); ++k) {
    const ShellParts part =
        shells_[k].energy(rows_of(x, k), gradient.middleRows(rows_[k], rows_[k + 1] - rows_[k]));
    sum.membrane += part.membrane;
    sum.bending += part.bending;
  }
  for (const ShellCrease& crease : creases_) {
    sum.bending += crease.energy(x);
    crease.add_gradient(x, gradient);
  }
  return sum;
}

Points ShellStructure::gradient(const Points& x) const {
  Points result;
  static_cast<void>(energy(x, result));
  return result;
}

ShellStructure::Stress ShellStructure::stress(const Points& x) const {
  Stress result;
  for (std::size_t k = 0; k < shells_.size(); ++k)
    result.push_back(shells_[k].stress(rows_of(x, k)));
  return result;
}

ShellStructure::Stress ShellStructure::stress(const Points& x, const Points& d) const {
  Stress result;
  for (std::size_t k = 0; k < shells_.size(); ++k)
    result.push_back(shells_[k].stress(rows_of(x, k), rows_of(d, k)));
  return result;
}

ShellStructure::Stress ShellStructure::tension(const Stress& stress) const {
  Stress result;
  for (std::size_t k = 0; k < shells_.size(); ++k) result.push_back(shells_[k].tension(stress[k]));
  return result;
}

// Shells have control points of their own: their Hessians stand along the diagonal, and creases
// alone couple them.
SparseMatrix ShellStructure::hessian(const Points& x, const Stress& stress) const {
  std::vector<SparseMatrix> blocks;
  for (std::size_t k = 0; k < shells_.size(); ++k)
    blocks.push_back(shells_[k].hessian(rows_of(x, k), stress[k]));
  SparseMatrix sum = blocks.size() == 1 ? std::move(blocks.front()) : along_diagonal(blocks);
  if (creases_.empty()) return sum;
  std::vector<Eigen::Triplet<double>> entries;
  for (const ShellCrease& crease : creases_) crease.append_hessian(x, entries);
  SparseMatrix joints(sum.rows(), sum.cols());
  joints.setFromTriplets(entries.begin(), entries.end());
  return sum + joints;
}

// Without stress the geometric part of a shell's Hessian drops out.
SparseMatrix ShellStructure::material_hessian(const Points& x) const {
  Stress none = stress(x);
  for (ShellStress& s : none) s.setZero();
  return hessian(x, none);
}

SparseMatrix ShellStructure::mass() const {
  std::vector<SparseMatrix> blocks;
  for (const ShellEnergy& shell : shells_) blocks.push_back(shell.mass());
  return along_diagonal(blocks);
}

}  // namespace knead
