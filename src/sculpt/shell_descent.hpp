#pragma once

#include <optional>

#include "contact_newton.hpp"
#include "knead/energy/shell_structure.hpp"
#include "solve/coordinate_restriction.hpp"

namespace knead {

/// The energy of a structure in normalised units: positions (x − centre)/length, energies divided by `energy`.
struct ScaledStructure {
  const ShellStructure& structure;
  Point centre;
  double length = 1, energy = 1;

  [[nodiscard]] Points unscaled(const Points& x) const { return (length * x).rowwise() + centre.transpose(); }
  [[nodiscard]] double value(const Points& x) const { return structure.energy(unscaled(x)).sum() / energy; }
  /// The same, and its gradient.
  [[nodiscard]] double value(const Points& x, Points& gradient) const {
    const double sum = structure.energy(unscaled(x), gradient).sum();
    gradient *= length / energy;
    return sum / energy;
  }
  [[nodiscard]] Points gradient(const Points& x) const { return length / energy * structure.gradient(unscaled(x)); }
  [[nodiscard]] SparseMatrix hessian(const Points& x, const ShellStructure::Stress& stress) const {
    SparseMatrix result = structure.hessian(unscaled(x), stress);
    result *= length * length / energy;
    return result;
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
  const ConstraintSpace& space;  ///< of coordinates, T
  const CoordinateRestriction& restriction;
  Points start;
  double theta = 1;
  const SparseMatrix& inertia;  ///< Q on one coordinate, N × N, or empty
  Points b;
  /// Of the forces that meet: smaller imbalances end the iteration.
  double tolerance = 1e-9;
};

/// Minimises Φ from one minimum to the next, as the potential changes.
class ShellDescent {
 public:
  ShellDescent(const ShellStepProblem& problem, Potential& potential);

  /// From y, which becomes the minimum; returns Ψ there: by `approach` to 1e-3 of the forces that meet, and from where
  /// that ends by Newton's method with a line search.
  [[nodiscard]] PotentialState run(Points& y, ContactSummary& summary);

  /// The imbalance of the last minimum, relative to the forces that meet there.
  [[nodiscard]] double residual() const { return residual_; }

 private:
  /// All that is known at one Y.
  struct Place {
    Points y;
    PotentialState contact;
    double phi = 0;
    Points pull;                // b − Qy − ∇W
    Eigen::VectorXd imbalance;  // Tᵀ of all forces
    double scale = 0;           // of the forces that meet
  };

  [[nodiscard]] Points inertia_times(const Points& y) const;
  [[nodiscard]] Points position(const Points& y) const { return problem_.start + problem_.theta * y; }
  /// Minimises Φ with W replaced by a convex parabola about the place, and contact as it is (`minimise_step`), again
  /// and again, each time from the minimum before. The parabola is that of one place and kept as long as it leads far
  /// enough.
  [[nodiscard]] Place approach(Place place, double tolerance, ContactSummary& summary);
  [[nodiscard]] Place newton(Place place, ContactSummary& summary);
  /// Whether the place is good enough.
  [[nodiscard]] bool balanced(const Place& place, bool moved, double tolerance, ContactSummary& summary);

  [[nodiscard]] Place at(Points y) const;
  /// θ ∇²W + Q, with these stresses in the geometric part of W's.
  [[nodiscard]] SparseMatrix elastic(const Points& x, const ShellStructure::Stress& stress) const;
  /// The same and ∇²Ψ.
  [[nodiscard]] SparseMatrix hessian(const Place& place, const ShellStructure::Stress& stress) const;
  /// Whether it is positive definite.
  [[nodiscard]] bool factor(const SparseMatrix& system);
  [[nodiscard]] bool factor_at(const Place& place, const ShellStructure::Stress& stress);
  [[nodiscard]] bool advance(Place& place, const Points& d, double slope) const;

  const ShellStepProblem& problem_;
  Potential& potential_;
  SparseMatrix inertia_;                        // of all coordinates
  std::optional<ConstrainedCholesky> inverse_;  // of the last matrix that was factored
  SparseMatrix parabola_;                       // its A, where that was the one of a parabola; else empty
  double residual_ = 0;
};

}  // namespace knead
