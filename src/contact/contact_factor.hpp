#pragma once

#include <optional>

#include "contact_anchor.hpp"
#include "contact_newton.hpp"
#include "coordinate_sum.hpp"
#include "solve/dissection.hpp"

namespace knead {

/// Directions of Newton's iteration by a factor M of A + H₀ over all coordinates, which the
/// stiffest springs ask for: H₀ is the Hessian at one iterate, and M serves as long as it leads to
/// (A + H) d = r in few conjugate gradients.
///
/// With s = A⁻¹ρ the displacement z = M ρ is s − M (H₀ s), whose right side acts in the
/// neighbourhood only, or M ρ where ρ does, and A z = ρ − H₀ z. Where springs are stiff z is tiny
/// against s, and its rounding is made large by H. So d is made from A d by A⁻¹, what is left of r
/// is found with it, and that is balanced likewise, in a few rounds (iterative refinement).
class ContactFactor {
 public:
  /// Whether there is what a factor needs, and not too much of it.
  [[nodiscard]] static bool is_possible(const StepProblem& problem);

  /// \param problem Its source and the potential stay where they are, and so does A.
  ContactFactor(const StepProblem& problem, const Potential& potential);

  /// The direction to `tolerance` of the first residual in the norm of A⁻¹, or as near as rounding
  /// allows. False if A + H is not positive definite, or too close to singular. The slope is left
  /// to be found.
  /// \param solves Is raised by the number of substitutions, and one per factor.
  [[nodiscard]] bool find(const PotentialState& state, const Anchor& anchor,
                          ContactNeighbourhood& near, Residual rest, double tolerance,
                          ContactDirection& to, int& solves);

 private:
  [[nodiscard]] bool factor(const PotentialState& state);
  [[nodiscard]] ContactDirection precondition(const Residual& rest,
                                              ContactNeighbourhood& near) const;
  [[nodiscard]] Combination conjugate_gradients(const PotentialState& state, const Anchor& anchor,
                                                ContactNeighbourhood& near, Residual rest,
                                                double target, bool& enough, int& solves) const;

  const Potential& potential_;
  ConstraintSpace space_;  // of coordinates
  GridPlaces places_;
  CoordinateSum system_;  // A + H₀
  std::optional<CoordinateRestriction> restriction_;
  std::optional<ConstrainedCholesky> inverse_;
  ConstrainedCholesky::Subset subset_;  // of the neighbourhood
  PotentialState factored_;             // where H₀ is the Hessian
};

}  // namespace knead
