#pragma once

#include <variant>

#include "constrained_cholesky.hpp"
#include "multigrid.hpp"

namespace knead {

/// A⁻¹ on what constraints leave free: by a factor, or by iteration. Immutable, const is
/// thread-safe.
///
/// Whoever needs whole solves alone asks this; minimisations, which work in a neighbourhood or with
/// single cycles, take the engine itself.
class StepInverse {
 public:
  /// \param rounded of a matrix that had to be raised above the rounding of its entries to be
  /// factored
  explicit StepInverse(ConstrainedCholesky factor, bool rounded = false)
      : engine_(std::move(factor)), rounded_(rounded) {}
  explicit StepInverse(ConstrainedMultigrid multigrid) : engine_(std::move(multigrid)) {}

  [[nodiscard]] const ConstrainedCholesky* factor() const {
    return std::get_if<ConstrainedCholesky>(&engine_);
  }
  [[nodiscard]] const ConstrainedMultigrid* multigrid() const {
    return std::get_if<ConstrainedMultigrid>(&engine_);
  }

  /// Whether results have fewer digits than those of exact steps.
  [[nodiscard]] bool rounded() const { return rounded_; }

  [[nodiscard]] const ConstraintSpace& space() const {
    return std::visit([](const auto& engine) -> const ConstraintSpace& { return engine.space(); },
                      engine_);
  }
  /// The X = T y that solves Tᵀ A X = Tᵀ B.
  [[nodiscard]] Points solve(const Points& b) const {
    return std::visit([&](const auto& engine) { return engine.solve(b); }, engine_);
  }

 private:
  std::variant<ConstrainedCholesky, ConstrainedMultigrid> engine_;
  bool rounded_ = false;
};

}  // namespace knead
