#pragma once

#include <variant>

#include "constrained_cholesky.hpp"
#include "multigrid.hpp"

namespace knead {

/// A⁻¹ on what constraints leave free: by a factor, or by iteration. Immutable, const is thread-safe.
class StepInverse {
 public:
  explicit StepInverse(ConstrainedCholesky factor) : engine_(std::move(factor)) {}
  explicit StepInverse(ConstrainedMultigrid multigrid) : engine_(std::move(multigrid)) {}

  [[nodiscard]] const ConstrainedCholesky* factor() const { return std::get_if<ConstrainedCholesky>(&engine_); }
  [[nodiscard]] const ConstrainedMultigrid* multigrid() const { return std::get_if<ConstrainedMultigrid>(&engine_); }

  [[nodiscard]] const ConstraintSpace& space() const {
    return std::visit([](const auto& engine) -> const ConstraintSpace& { return engine.space(); }, engine_);
  }
  /// The X = T y that solves Tᵀ A X = Tᵀ B.
  [[nodiscard]] Points solve(const Points& b) const {
    return std::visit([&](const auto& engine) { return engine.solve(b); }, engine_);
  }

 private:
  std::variant<ConstrainedCholesky, ConstrainedMultigrid> engine_;
};

}  // namespace knead
