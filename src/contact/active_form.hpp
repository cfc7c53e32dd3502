#pragma once

#include <memory>
#include <span>

#include "active_shell.hpp"
#include "energy/form_energy.hpp"

namespace knead {

/// A curve or volume under tools that keeps its fundamental forms: `FormEnergy` in the place of the
/// linear energy of `ActiveSpline`, with the steps of `ActiveShell`. Lengths are divided by L, the
/// normalised length of the rest shape, energies by 2 · `stretching_scale`; tools, friction,
/// limits, λ, mass, damping and tolerances then mean what they do in the linear model with α = 1.
/// Immutable, const is thread-safe.
template <int D>
class ActiveForm {
 public:
  /// \param rest the rest shape of the energy. Errors: settings out of range, contradictory
  /// constraints, dynamics without mass (input); a shape without size (numerical).
  [[nodiscard]] static Expected<ActiveForm> create(Spline<D> rest, FormEnergy<D> energy,
                                                   ActiveShellSettings settings);

  /// One step as `ActiveShell::step`: from the present shape, `stretch` and `bend` the parts of
  /// metric and curvature in units of the file. Errors (numerical): the result is not finite,
  /// nothing holds the shape against the forces.
  [[nodiscard]] Expected<ActiveStep> step(const ActiveState& state, std::span<const Tool> tools,
                                          const ActiveLoads& loads) const;

 private:
  struct Model;
  explicit ActiveForm(std::shared_ptr<const Model> model) : model_(std::move(model)) {}
  std::shared_ptr<const Model> model_;
};

}  // namespace knead
