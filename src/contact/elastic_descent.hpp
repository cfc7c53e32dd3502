#pragma once

#include <optional>

#include "contact_newton.hpp"
#include "elastic_energy.hpp"
#include "solve/coordinate_restriction.hpp"

namespace knead {

/// Φ(Y) = W(start + θ Y)/θ − b·Y + ½ Yᵀ Q Y + Ψ(start + Y) over all Y = Y₀ + T z.
struct ElasticStepProblem {
  const ElasticEnergy& energy;
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
///
/// ∇Φ = ∇W(start + θ Y) − b + Q Y − F and ∇²Φ = θ ∇²W + Q + ∇²Ψ, over 3N coordinates less those
/// that constraints determine. W is not convex, as a thin shell buckles, and Ψ neither: hence
/// descent by a line search, towards a minimum near the start and not any minimum. A Hessian
/// couples the coordinates, so that every iteration of Newton's method costs a quadrature of ∇²W
/// and a sparse factor, while one factor of a parabola serves several rounds.
class ElasticDescent {
 public:
  ElasticDescent(const ElasticStepProblem& problem, Potential& potential);

  /// From y, which becomes the minimum; returns Ψ there: by `approach` to 1e-3 of the forces that
  /// meet, and from where that ends by Newton's method with a line search.
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
  [[nodiscard]] Points position(const Points& y) const {
    return problem_.start + problem_.theta * y;
  }
  /// Minimises Φ with W replaced by a convex parabola about the place, and contact as it is
  /// (`minimise_step`), again and again, each time from the minimum before. The parabola is that of
  /// one place and kept as long as it leads far enough.
  [[nodiscard]] Place approach(Place place, double tolerance, ContactSummary& summary);
  [[nodiscard]] Place newton(Place place, ContactSummary& summary);
  /// Whether the place is good enough.
  [[nodiscard]] bool balanced(const Place& place, bool moved, double tolerance,
                              ContactSummary& summary);

  [[nodiscard]] Place at(Points y) const;
  /// θ H + Q, of H one of W's Hessians.
  [[nodiscard]] SparseMatrix elastic(SparseMatrix hessian) const;
  /// The same and ∇²Ψ.
  [[nodiscard]] SparseMatrix with_contact(const Place& place, SparseMatrix hessian) const;
  /// Whether it is positive definite.
  [[nodiscard]] bool factor(const SparseMatrix& system);
  /// \param before the position from where the place was reached, or none.
  [[nodiscard]] bool factor_at(const Place& place, const std::optional<Points>& before);
  [[nodiscard]] bool advance(Place& place, const Points& d, double slope) const;

  const ElasticStepProblem& problem_;
  Potential& potential_;
  SparseMatrix inertia_;                // of all coordinates
  std::optional<StepInverse> inverse_;  // of the last matrix that was factored
  SparseMatrix parabola_;               // its A, where that was the one of a parabola; else empty
  double residual_ = 0;
};

}  // namespace knead
