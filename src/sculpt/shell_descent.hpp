#pragma once

#include <Eigen/SparseCholesky>

#include "contact_newton.hpp"
#include "knead/energy/shell_structure.hpp"

namespace knead {

/// The energy of a structure in normalised units: positions (x − centre)/length, energies divided by `energy`.
struct ScaledStructure {
  const ShellStructure& structure;
  Point centre;
  double length = 1, energy = 1;

  [[nodiscard]] Points unscaled(const Points& x) const { return (length * x).rowwise() + centre.transpose(); }
  [[nodiscard]] double value(const Points& x) const { return structure.energy(unscaled(x)).sum() / energy; }
  [[nodiscard]] Points gradient(const Points& x) const { return length / energy * structure.gradient(unscaled(x)); }
  [[nodiscard]] SparseMatrix hessian(const Points& x, const ShellStructure::Stress& stress) const {
    return length * length / energy * structure.hessian(unscaled(x), stress);
  }
  [[nodiscard]] ShellStructure::Stress stress(const Points& x) const { return structure.stress(unscaled(x)); }
  /// With the strains linearised about x.
  [[nodiscard]] ShellStructure::Stress stress(const Points& x, const Points& d) const {
    return structure.stress(unscaled(x), length * d);
  }
};

/// Φ(Y) = W(start + θ Y)/θ − b·Y + ½ Yᵀ Q Y + Ψ(start + Y) over all Y = Y₀ + T z.
struct ShellStepProblem {
  const ScaledStructure& structure;
  const SparseMatrix& map;  ///< T, 3N × m
  Points start;
  double theta = 1;
  const SparseMatrix& inertia;  ///< Q on one coordinate, N × N, or empty
  Points b;
  /// Of the forces that meet: smaller imbalances end the iteration.
  double tolerance = 1e-9;
};

/// Newton's method on Φ from one minimum to the next, as the potential changes.
class ShellDescent {
 public:
  ShellDescent(const ShellStepProblem& problem, const Potential& potential);

  /// Minimises from y, which becomes the minimum, in Newton iterations with a line search; returns Ψ there.
  [[nodiscard]] PotentialState run(Points& y, ContactSummary& summary);

  /// The imbalance of the last minimum, relative to the forces that meet there.
  [[nodiscard]] double residual() const { return residual_; }

 private:
  /// All that is known at one Y.
  struct Place {
    Points y;
    PotentialState contact;
    double phi = 0;
    Eigen::VectorXd imbalance;  // Tᵀ of the forces
    double scale = 0;           // of the forces that meet
  };

  [[nodiscard]] Points inertia_times(const Points& y) const;
  [[nodiscard]] Points position(const Points& y) const { return problem_.start + problem_.theta * y; }
  [[nodiscard]] Place at(Points y) const;
  [[nodiscard]] SparseMatrix reduced(const SparseMatrix& elastic, const PotentialState& contact) const;
  [[nodiscard]] bool factor(const SparseMatrix& system);
  [[nodiscard]] bool factor_at(const Place& place, const ShellStructure::Stress& stress);
  [[nodiscard]] bool advance(Place& place, const Points& d, double slope) const;

  const ShellStepProblem& problem_;
  const Potential& potential_;
  SparseMatrix inertia_;  // of all coordinates
  Eigen::SimplicialLDLT<SparseMatrix> solver_;
  Eigen::Index analysed_ = -1;  // entries of the matrix whose pattern was analysed
  double residual_ = 0;
};

}  // namespace knead
