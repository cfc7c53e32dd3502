#pragma once

#include <utility>

#include "energy/form_energy.hpp"
#include "energy/shell_structure.hpp"

namespace knead {

/// A non-linear energy W of the control points in normalised units, as steps minimise it: positions
/// (x − centre)/length, energies divided by `energy`.
class ElasticEnergy {
 public:
  struct Units {
    Point centre = Point::Zero();
    double length = 1, energy = 1;
  };

  explicit ElasticEnergy(Units units) : units_(std::move(units)) {}
  virtual ~ElasticEnergy() = default;
  ElasticEnergy(const ElasticEnergy&) = delete;
  ElasticEnergy& operator=(const ElasticEnergy&) = delete;

  [[nodiscard]] Points unscaled(const Points& x) const {
    return (units_.length * x).rowwise() + units_.centre.transpose();
  }
  [[nodiscard]] double value(const Points& x) const {
    return parts(unscaled(x)).sum() / units_.energy;
  }
  /// The same, and its gradient.
  [[nodiscard]] double value(const Points& x, Points& gradient) const {
    const double sum = parts(unscaled(x), gradient).sum();
    gradient *= units_.length / units_.energy;
    return sum / units_.energy;
  }
  [[nodiscard]] SparseMatrix hessian(const Points& x) const {
    return scaled(file_hessian(unscaled(x)));
  }
  /// At x, reached from `before`, where that is better known.
  [[nodiscard]] SparseMatrix hessian(const Points& x, const Points& before) const {
    return scaled(file_hessian(unscaled(x), unscaled(before)));
  }
  /// Positive semidefinite parts of it: that of first derivatives of strains, and the same with
  /// tension.
  [[nodiscard]] SparseMatrix material_hessian(const Points& x) const {
    return scaled(file_material_hessian(unscaled(x)));
  }
  [[nodiscard]] SparseMatrix tense_hessian(const Points& x) const {
    return scaled(file_tense_hessian(unscaled(x)));
  }

  /// In units of the file.
  [[nodiscard]] virtual ShellParts parts(const Points& x) const = 0;
  [[nodiscard]] virtual ShellParts parts(const Points& x, Points& gradient) const = 0;
  [[nodiscard]] virtual SparseMatrix file_hessian(const Points& x) const = 0;

 private:
  [[nodiscard]] virtual SparseMatrix file_hessian(const Points& x, const Points& /*before*/) const {
    return file_hessian(x);
  }
  [[nodiscard]] virtual SparseMatrix file_material_hessian(const Points& x) const = 0;
  [[nodiscard]] virtual SparseMatrix file_tense_hessian(const Points& x) const = 0;

  [[nodiscard]] SparseMatrix scaled(SparseMatrix matrix) const {
    matrix *= units_.length * units_.length / units_.energy;
    return matrix;
  }

  Units units_;
};

/// That of shells and of the creases between them.
class ElasticShells final : public ElasticEnergy {
 public:
  ElasticShells(ShellStructure structure, Units units)
      : ElasticEnergy(std::move(units)), structure_(std::move(structure)) {}

  [[nodiscard]] ShellParts parts(const Points& x) const override { return structure_.energy(x); }
  [[nodiscard]] ShellParts parts(const Points& x, Points& gradient) const override {
    return structure_.energy(x, gradient);
  }
  [[nodiscard]] SparseMatrix file_hessian(const Points& x) const override {
    return structure_.hessian(x);
  }

 private:
  /// The geometric part takes the stresses of strains that are linearised about `before`
  /// (docs/shell.md).
  [[nodiscard]] SparseMatrix file_hessian(const Points& x, const Points& before) const override {
    return structure_.hessian(x, structure_.stress(before, x - before));
  }
  [[nodiscard]] SparseMatrix file_material_hessian(const Points& x) const override {
    return structure_.material_hessian(x);
  }
  [[nodiscard]] SparseMatrix file_tense_hessian(const Points& x) const override {
    return structure_.hessian(x, structure_.tension(structure_.stress(x)));
  }

  ShellStructure structure_;
};

/// That of the fundamental forms of a curve or volume.
template <int D>
class ElasticForms final : public ElasticEnergy {
 public:
  ElasticForms(FormEnergy<D> forms, Units units)
      : ElasticEnergy(std::move(units)), forms_(std::move(forms)) {}

  [[nodiscard]] ShellParts parts(const Points& x) const override { return forms_.energy(x); }
  [[nodiscard]] ShellParts parts(const Points& x, Points& gradient) const override {
    gradient = forms_.gradient(x);
    return forms_.energy(x);
  }
  [[nodiscard]] SparseMatrix file_hessian(const Points& x) const override {
    return forms_.hessian(x);
  }

 private:
  [[nodiscard]] SparseMatrix file_material_hessian(const Points& x) const override {
    return forms_.material_hessian(x);
  }
  [[nodiscard]] SparseMatrix file_tense_hessian(const Points& x) const override {
    return forms_.tense_hessian(x);
  }

  FormEnergy<D> forms_;
};

}  // namespace knead
