#include "knead/contact/active_spline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "active_assembly.hpp"
#include "active_model.hpp"
#include "base/interruption.hpp"
#include "knead/energy/field_assembler.hpp"
#include "solve/coordinate_map.hpp"
#include "solve/eigen_problem.hpp"
#include "step_engine.hpp"

namespace knead {
namespace {

template <int D>
Expected<void> validate_numbers(const ActiveSettings<D>& s) {
  if (const auto material = validated<D>(s.material); !material)
    return std::unexpected(material.error());
  for (const MaterialFieldOf<D>& field : s.fields) {
    if (const auto checked = validated<D>(field); !checked) return std::unexpected(checked.error());
  }
  if (!std::isfinite(s.lambda) || s.lambda < 0) {
    return input_error(fmt::format("{} is not a step parameter", s.lambda), "lambda",
                       "use a finite number >= 0");
  }
  if (s.evolution == Evolution::dynamic && !(std::isfinite(s.time_step) && s.time_step > 0)) {
    return input_error(fmt::format("{} is not a time step", s.time_step), "time_step",
                       "use a finite number > 0");
  }
  if (!std::isfinite(s.mass) || s.mass < 0 || (s.evolution == Evolution::dynamic && s.mass == 0)) {
    return input_error(fmt::format("{} is not a mass", s.mass), "mass", "use a finite number > 0");
  }
  if (!std::isfinite(s.damping) || s.damping < 0) {
    return input_error(fmt::format("{} is not a damping", s.damping), "damping",
                       "use a finite number >= 0");
  }
  return {};
}

template <int D>
Expected<void> validate(const std::vector<Spline<D>>& patches, const ActiveSettings<D>& settings) {
  if (auto checked = validate_numbers<D>(settings); !checked) return checked;
  if (patches.empty()) return usage_error("there is nothing to make active");
  int size = 0;
  for (const Spline<D>& patch : patches) size += patch.size();
  if (!settings.fields.empty() && settings.fields.size() != patches.size()) {
    return usage_error(
        fmt::format("{} materials do not fit {} patches", settings.fields.size(), patches.size()));
  }
  if (!settings.visible.empty() && (D != 2 || settings.visible.size() != patches.size())) {
    return usage_error(fmt::format("{} visible regions do not fit {} patches",
                                   settings.visible.size(), patches.size()));
  }
  if (!settings.held.empty() && settings.held.size() != static_cast<std::size_t>(size)) {
    return usage_error(fmt::format("{} flags of held control points do not fit {} control points",
                                   settings.held.size(), size));
  }
  return {};
}

/// The rest shape: its control points, patch after patch, and its centre and size.
struct RestShape {
  std::vector<int> rows = {0};  // first of every patch, and the end
  Points points;
  Point centre;
  double diagonal;  // of the control points
};

template <int D>
RestShape at_rest(const std::vector<Spline<D>>& patches) {
  RestShape rest;
  for (const Spline<D>& patch : patches) rest.rows.push_back(rest.rows.back() + patch.size());
  rest.points.resize(rest.rows.back(), 3);
  for (std::size_t k = 0; k < patches.size(); ++k)
    rest.points.middleRows(rest.rows[k], patches[k].size()) = patches[k].control_points();
  const Eigen::RowVector3d lower = rest.points.colwise().minCoeff(),
                           upper = rest.points.colwise().maxCoeff();
  rest.centre = (lower + 0.5 * (upper - lower)).transpose();
  rest.diagonal = (upper - lower).norm();
  return rest;
}

/// The constraints of the settings, as conditions on X in units of `length`.
template <int D>
Expected<ConstraintSpace> hold(const ActiveSettings<D>& settings, const RestShape& rest,
                               double length) {
  const int size = rest.rows.back();
  std::vector<LinearConstraint> constraints = settings.constraints;
  for (LinearConstraint& c : constraints) {
    if (settings.rest ==
        RestMode::none) {  // X is not the displacement, but the displacement and the rest shape
      for (const auto& [unknown, a] : c.terms) {
        if (unknown >= 0 && unknown < size)
          c.value += a * (rest.points.row(unknown).transpose() - rest.centre);
      }
    }
    c.value /= length;
  }
  return ConstraintSpace::create(size, constraints, settings.held);
}

}  // namespace

// Everything that steps have in common is made here: Gramians, constraints, and A's inverse, by far
// the largest part. Centre and length are those of the rest shape and stay, so that the same shape
// has the same bits in every step.
template <int D>
Expected<ActiveSpline<D>> ActiveSpline<D>::create(std::vector<Spline<D>> patches,
                                                  const ActiveSettings<D>& settings) {
  if (auto valid = validate<D>(patches, settings); !valid) return std::unexpected(valid.error());
  auto assembly = assemble<D>(patches, settings);
  if (!assembly) return std::unexpected(assembly.error());
  RestShape rest = at_rest<D>(patches);
  const double length = assembly->scalings.front().length;
  auto space = hold<D>(settings, rest, length);
  if (!space) return std::unexpected(space.error());

  NetOperator<D> a = step_operator<D>(patches, settings, *assembly, rest.rows.back());
  auto chosen = invert<D>(a, std::move(*space), patches, assembly->scalings, settings);
  if (!chosen) return std::unexpected(chosen.error());
  return ActiveSpline(std::make_shared<const Model>(Model{settings,
                                                          std::move(patches),
                                                          std::move(rest.rows),
                                                          std::move(assembly->scalings),
                                                          std::move(assembly->loads),
                                                          std::move(assembly->greville),
                                                          length,
                                                          rest.centre,
                                                          rest.diagonal / length,
                                                          std::move(rest.points),
                                                          std::move(assembly->stretch),
                                                          std::move(assembly->bend),
                                                          std::move(assembly->stiffness),
                                                          std::move(assembly->weight),
                                                          std::move(assembly->mass),
                                                          std::move(assembly->damping),
                                                          std::move(a),
                                                          assembly->energy_error,
                                                          std::move(chosen->inverse),
                                                          std::move(chosen->engine)}));
}

// Keeps the last system: a drag moves where springs draw to from step to step, not the springs. It
// is made by the engine of the model, so that both results have the same accuracy.
template <int D>
std::shared_ptr<const SprungSystem<D>> ActiveSpline<D>::Model::with_springs(
    std::span<const PointForce> forces) const {
  std::vector<PointForce> springs = standing_springs<D>(forces, patches);
  if (springs.empty()) return nullptr;
  auto system = sprung->last();
  if (!system || !same_stiffness(system->springs, springs)) {
    SprungSystem<D> made{std::move(springs), a, std::nullopt};
    made.a.add(spring_stiffness(rows.back(), made.springs));
    ActiveSettings<D> same_engine = settings;
    same_engine.solver = engine.iterative ? StepSolver::iterative : StepSolver::direct;
    auto chosen = invert<D>(made.a, inverse.space(), patches, scalings, same_engine);
    if (Interruption::asked_for()) return nullptr;
    if (chosen) made.inverse.emplace(std::move(chosen->inverse));
    system = std::make_shared<const SprungSystem<D>>(std::move(made));
    sprung->keep(system);
  }
  return system->inverse ? system : nullptr;
}

template <int D>
double ActiveSpline<D>::energy(const ActiveState& state) const {
  return model_->energy(model_->stiffness,
                        (state.control_points - model_->origin(state)) / model_->length);
}

template <int D>
Points ActiveSpline<D>::allowed(const Points& displacement) const {
  const ConstraintSpace& space = model_->inverse.space();
  Points free = displacement;
  for (Eigen::Index i = 0; i < free.rows(); ++i) {
    if (space.is_determined(static_cast<int>(i))) free.row(i).setZero();
  }
  return space.feasible(free) - space.feasible(Points::Zero(free.rows(), 3));
}

// The projection in the norm of A: Y = S + T y minimises |Y − U|_A over y for a start S that is
// allowed, hence TᵀA T y = TᵀA (U − S).
template <int D>
Points ActiveSpline<D>::nearest_allowed(const Points& displacement) const {
  Points start = allowed(displacement);
  if ((displacement.array() == start.array()).all()) return start;
  // Dependent control points may follow from alternating sums of others: of high degree nothing of
  // a displacement is left in them but rounding. None is allowed too, and leaves no such numbers to
  // cancel.
  if (start.cwiseAbs().maxCoeff() > 2 * displacement.cwiseAbs().maxCoeff()) start.setZero();
  return start + model_->inverse.solve(model_->a * Points(displacement - start));
}

// One implicit step from the shape itself, (K + λW) Y = −K P, of the energy without a rest shape.
template <int D>
Points ActiveSpline<D>::fairing(const Points& control_points) const {
  // K annihilates constants.
  const Points centred = control_points.rowwise() - control_points.colwise().mean();
  return model_->inverse.solve(-(model_->stiffness * centred));
}

template <int D>
Expected<std::vector<Eigenmode>> ActiveSpline<D>::modes(int count) const {
  return mapped_vibration_modes(on_coordinates(model_->stiffness.assemble()),
                                on_coordinates(model_->mass.assemble()),
                                coordinate_map(model_->inverse.space()), count);
}

template <int D>
const DomainScaling<D>& ActiveSpline<D>::scaling(int patch) const {
  return model_->scalings[static_cast<std::size_t>(patch)];
}

template <int D>
const ActiveSettings<D>& ActiveSpline<D>::settings() const {
  return model_->settings;
}

template <int D>
const StepEngine& ActiveSpline<D>::engine() const {
  return model_->engine;
}

template <int D>
const std::vector<int>& ActiveSpline<D>::rows() const {
  return model_->rows;
}

template <int D>
int ActiveSpline<D>::free_count() const {
  return model_->inverse.space().free_count();
}

template class ActiveSpline<1>;
template class ActiveSpline<2>;
template class ActiveSpline<3>;

}  // namespace knead
