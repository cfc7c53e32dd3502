#include "active_shell.hpp"

#include "elastic_step.hpp"

namespace knead {
namespace {

Expected<void> check(const std::vector<Surface>& patches, const ShellStructure& structure,
                     const ActiveShellSettings& settings) {
  if (patches.size() != structure.shells().size())
    return usage_error("there must be one patch per shell");
  for (std::size_t k = 0; k < patches.size(); ++k) {
    if (patches[k].size() != structure.shells()[k].size())
      return usage_error("a patch does not fit its shell");
  }
  if (settings.evolution != Evolution::dynamic || settings.mass > 0) return {};
  for (const ShellEnergy& shell : structure.shells()) {
    if (shell.mass_per_area() == 0) {
      return input_error("a shell without density has no dynamics", "density",
                         "give its material a density");
    }
  }
  return {};
}

}  // namespace

struct ActiveShell::Model {
  ElasticModel<2> elastic;
  ShellStructure structure;
};

Expected<ActiveShell> ActiveShell::create(std::vector<Surface> patches, ShellStructure structure,
                                          ActiveShellSettings settings) {
  if (auto ok = check(patches, structure, settings); !ok) return std::unexpected(ok.error());
  auto elastic = ElasticModel<2>::create(std::move(patches), std::move(settings),
                                         structure.stretching_scale());
  if (!elastic) return std::unexpected(elastic.error());
  const bool heavy =
      elastic->settings.evolution == Evolution::dynamic && elastic->settings.mass == 0;
  auto made = elastic->complete(std::make_shared<const ElasticShells>(structure, elastic->units),
                                heavy ? structure.mass() : SparseMatrix());
  if (!made) return std::unexpected(made.error());
  return ActiveShell(
      std::make_shared<const Model>(Model{std::move(*elastic), std::move(structure)}));
}

const ShellStructure& ActiveShell::structure() const { return model_->structure; }
double ActiveShell::length() const { return model_->elastic.units.length; }

// Pressure, wind and moments turn with the shape: they are evaluated again where the shape is, and
// have no part in W.
Expected<ActiveStep> ActiveShell::step(const ActiveState& state, std::span<const Tool> tools,
                                       const ActiveLoads& loads) const {
  const bool blown = loads.pressure != 0 || loads.wind != Point::Zero();
  if (!blown && loads.moments.empty()) return elastic_step<2>(model_->elastic, state, tools, loads);
  const auto following = [&](const Points& x, const Points& velocity, Points& sum) {
    for (const EdgeMoment& moment : loads.moments) sum += moment.forces(x);
    if (!blown) return;
    const std::vector<int>& rows = model_->elastic.rows;
    for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
      const int first = rows[k], n = rows[k + 1] - first;
      sum.middleRows(first, n) += model_->structure.shells()[k].normal_load(
          x.middleRows(first, n), velocity.middleRows(first, n), loads.pressure, loads.wind);
    }
  };
  return elastic_step<2>(model_->elastic, state, tools, loads, following);
}

}  // namespace knead
