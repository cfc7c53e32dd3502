#include "active_assembly.hpp"

#include <algorithm>
#include <limits>

#include "knead/energy/field_assembler.hpp"

namespace knead {
namespace {

/// The parts of the energy: stretch has a first derivative in every factor of a term, bend a
/// second.
template <int D>
std::array<Energy<D>, 2> parts(const MaterialOf<D>& material) {
  std::array<Energy<D>, 2> result;
  for (const EnergyTerm<D>& term : stretch_and_bend<D>(material)) {
    int order = 0;
    for (int a : term.a) order += a;
    result[order == 1 ? 0 : 1].push_back(term);
  }
  return result;
}

/// The operators of patch k, whose scaling is already known.
template <int D>
Expected<void> add_operators(const Spline<D>& patch, std::size_t k, int first,
                             const ActiveSettings<D>& settings, const StiffnessOptions& options,
                             Assembly<D>& to) {
  const DomainScaling<D>& scaling = to.scalings[k];
  auto weight =
      Stiffness<D>::create(patch, on_scaled_domain<D>(mass_energy<D>(), scaling.factors), options);
  if (!weight) return std::unexpected(weight.error());
  to.weight.add(first, 1, *weight);
  const auto err = [&](double bound) {
    if (patch.rational()) to.energy_error = std::max(to.energy_error.value_or(0), bound);
  };
  err(weight->error_bound());
  if (!settings.fields.empty()) {
    auto matrices = FieldAssembler<D>(patch, options).assemble(settings.fields[k], scaling.factors);
    if (!matrices) return std::unexpected(matrices.error());
    err(matrices->error_bound);
    to.stiffness.add(first, 1, Stiffness<D>::of_matrix(patch, matrices->stretch + matrices->bend));
    to.stretch.add(first, 1, Stiffness<D>::of_matrix(patch, std::move(matrices->stretch)));
    to.bend.add(first, 1, Stiffness<D>::of_matrix(patch, std::move(matrices->bend)));
    to.mass.add(first, 1, Stiffness<D>::of_matrix(patch, std::move(matrices->mass)));
    to.damping.add(first, 1, Stiffness<D>::of_matrix(patch, std::move(matrices->damping)));
    return {};
  }
  const auto create = [&](const Energy<D>& energy) {
    return Stiffness<D>::create(patch, on_scaled_domain<D>(energy, scaling.factors), options);
  };
  auto [stretching, bending] = parts<D>(settings.material);
  auto stretch = create(stretching), bend = create(bending);
  if (!stretch) return std::unexpected(stretch.error());
  if (!bend) return std::unexpected(bend.error());
  err(std::max(stretch->error_bound(), bend->error_bound()));
  if (patch.rational()) {  // both are assembled
    to.stiffness.add(first, 1,
                     Stiffness<D>::of_matrix(patch, stretch->assemble() + bend->assemble()));
  } else {
    stretching.insert(stretching.end(), bending.begin(), bending.end());
    to.stiffness.add(first, 1, *create(stretching));
  }
  to.stretch.add(first, 1, std::move(*stretch));
  to.bend.add(first, 1, std::move(*bend));
  to.mass.add(first, settings.mass, *weight);
  to.damping.add(first, settings.damping, std::move(*weight));
  return {};
}

/// The evaluation of tool forces on patch k.
template <int D>
Expected<void> assemble_forces(const Spline<D>& patch, std::size_t k,
                               const ActiveSettings<D>& settings, const StiffnessOptions& options,
                               Assembly<D>& to) {
  auto load = ToolGrids<D>::create(
      patch, to.scalings[k],
      settings.detail > 0 ? settings.detail : std::numeric_limits<double>::infinity());
  if (!load) return std::unexpected(load.error());
  if constexpr (D == 2) {
    if (k < settings.visible.size() && settings.visible[k] && settings.route == ForceRoute::gauss) {
      load->show(settings.visible[k]);
    }
  }
  to.loads.push_back(std::move(*load));
  if (settings.route == ForceRoute::analytic) {
    auto force = GrevilleForce<D>::create(patch, to.scalings[k], options);
    if (!force) return std::unexpected(force.error());
    to.greville.push_back(std::move(*force));
  }
  return {};
}

/// K + c W of polynomial patches of one material: as many distinct factors as K alone.
///
/// One `Stiffness` with the term of mass among those of K applies in one pass over the coordinates;
/// a sum of two operators would take two.
template <int D>
NetOperator<D> with_mass(const std::vector<Spline<D>>& patches, const ActiveSettings<D>& settings,
                         const Assembly<D>& from, double mass, int size) {
  NetOperator<D> a(size);
  int first = 0;
  for (std::size_t k = 0; k < patches.size(); first += patches[k++].size()) {
    Energy<D> energy = stretch_and_bend<D>(settings.material);
    for (EnergyTerm<D> term : mass_energy<D>()) {
      term.coefficient *= mass;
      energy.push_back(term);
    }
    const auto& factors = from.scalings[k].factors;
    a.add(first, 1,
          *Stiffness<D>::create(patches[k], on_scaled_domain<D>(energy, factors),
                                {.method = settings.method}));
  }
  return a;
}

}  // namespace

// Domains are scaled patch by patch, so that the sides of each are the mean lengths of its
// isocurves; lengths are those of the first patch for all, since displacements of coupled patches
// must have one unit. `raw` leaves knots and coordinates as they are, the thesis' own setting.
template <int D>
Expected<Assembly<D>> assemble(const std::vector<Spline<D>>& patches,
                               const ActiveSettings<D>& settings) {
  const StiffnessOptions options{.method = settings.method,
                                 .rational_tolerance = settings.energy_tolerance};
  int size = 0;
  for (const Spline<D>& patch : patches) size += patch.size();
  Assembly<D> result(size);
  int first = 0;
  for (std::size_t k = 0; k < patches.size(); first += patches[k++].size()) {
    DomainScaling<D> scaling;
    if (!settings.raw) {
      const auto normalised = normalised_scaling<D>(patches[k]);
      if (!normalised) return std::unexpected(normalised.error());
      scaling = k == 0 ? *normalised : in_unit<D>(*normalised, result.scalings.front().length);
    }
    result.scalings.push_back(scaling);
    if (auto status = add_operators<D>(patches[k], k, first, settings, options, result); !status)
      return std::unexpected(status.error());
    if (auto status = assemble_forces<D>(patches[k], k, settings, options, result); !status)
      return std::unexpected(status.error());
  }
  return result;
}

// A is K (stationary), K + λ W (acm; W the mass matrix, or the identity of the thesis), or K + D/τ
// + M/τ² (dynamic), τ the length of a stage. `with_mass` serves where M and D are multiples of one
// mass matrix, which is where no field and no weights are.
template <int D>
NetOperator<D> step_operator(const std::vector<Spline<D>>& patches,
                             const ActiveSettings<D>& settings, const Assembly<D>& from, int size) {
  NetOperator<D> a = from.stiffness;
  if (settings.evolution == Evolution::stationary) return a;
  const bool plain =
      settings.fields.empty() &&
      std::ranges::none_of(patches, [](const Spline<D>& patch) { return patch.rational(); });
  if (settings.evolution == Evolution::dynamic) {
    const double tau = dynamic_stage * settings.time_step, damping = 1 / tau,
                 mass = 1 / (tau * tau);
    if (plain)
      return with_mass<D>(patches, settings, from,
                          damping * settings.damping + mass * settings.mass, size);
    a.add(damping, from.damping);
    a.add(mass, from.mass);
  } else if (settings.weight == StepWeight::mass) {
    if (plain) return with_mass<D>(patches, settings, from, settings.lambda, size);
    a.add(settings.lambda, from.weight);
  } else {
    a.add_identity(settings.lambda);
  }
  return a;
}

template Expected<Assembly<1>> assemble(const std::vector<Spline<1>>&, const ActiveSettings<1>&);
template NetOperator<1> step_operator(const std::vector<Spline<1>>&, const ActiveSettings<1>&,
                                      const Assembly<1>&, int);
template Expected<Assembly<2>> assemble(const std::vector<Spline<2>>&, const ActiveSettings<2>&);
template NetOperator<2> step_operator(const std::vector<Spline<2>>&, const ActiveSettings<2>&,
                                      const Assembly<2>&, int);
template Expected<Assembly<3>> assemble(const std::vector<Spline<3>>&, const ActiveSettings<3>&);
template NetOperator<3> step_operator(const std::vector<Spline<3>>&, const ActiveSettings<3>&,
                                      const Assembly<3>&, int);

}  // namespace knead
