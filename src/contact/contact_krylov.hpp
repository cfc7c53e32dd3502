#pragma once

#include "contact_newton.hpp"

namespace knead {

/// The minimisation of a step on the whole net, for an A that is not factored: Newton's iteration
/// with (A + H) d = r solved by conjugate gradients on the cycles of `ConstrainedMultigrid`. Every
/// residual, direction and product is an array of the whole net. Decrements are measured with a
/// cycle B in place of A⁻¹.
class KrylovMinimisation {
 public:
  KrylovMinimisation(const StepProblem& problem, const ConstrainedMultigrid& inverse,
                     Potential& potential, Points& y);

  ContactSummary summary;

  [[nodiscard]] PotentialState take_state() { return std::move(state_); }
  /// Call after the potential has changed.
  void renew() { state_ = potential_.evaluate(problem_.start + y_); }
  /// The imbalance of forces, as a share of the norm of b.
  double imbalance();
  /// Iterates until the decrement is `tolerance` of the terms that the step balances. With
  /// `certain` A Y is computed anew for the last decrement.
  void iterate(double tolerance, int max_iterations, bool certain);

 private:
  /// A displacement d, A d, and the slope of Φ along d.
  struct ContactDirection {
    Points d, ad;
    double slope = 0;
  };
  /// The imbalance of forces on the unknowns, and B of it.
  struct Residual {
    Points r, image;
    double squared = 0;  // rᵀ B r
  };

  [[nodiscard]] Points product(const Points& x) const;
  Residual residual();
  double norm(const Points& force);
  double norm_of_b();
  ContactDirection direction(Residual at, double tolerance);
  void advance(const ContactDirection& to, bool rounded);
  [[nodiscard]] double quadratic() const;

  const StepProblem& problem_;
  const ConstrainedMultigrid& inverse_;
  Potential& potential_;
  Points& y_;
  Points ay_;          // A Y
  bool fresh_ = true;  // ay_ was computed from Y, not from its steps
  PotentialState state_;
  double norm_of_b_ = -1;  // below 0: not known yet
};

}  // namespace knead
