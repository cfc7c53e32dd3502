#include "active_form.hpp"

#include "elastic_step.hpp"

namespace knead {

template <int D>
struct ActiveForm<D>::Model {
  ElasticModel<D> elastic;
};

template <int D>
Expected<ActiveForm<D>> ActiveForm<D>::create(Spline<D> rest, FormEnergy<D> energy,
                                              ActiveShellSettings settings) {
  if (rest.size() != energy.size()) return usage_error("the shape does not fit its energy");
  if (settings.evolution == Evolution::dynamic && settings.mass == 0) {
    return input_error("without mass there are no dynamics", "mass", "give the material a mass");
  }
  auto elastic =
      ElasticModel<D>::create({std::move(rest)}, std::move(settings), energy.stretching_scale());
  if (!elastic) return std::unexpected(elastic.error());
  auto made = elastic->complete(
      std::make_shared<const ElasticForms<D>>(std::move(energy), elastic->units), {});
  if (!made) return std::unexpected(made.error());
  return ActiveForm(std::make_shared<const Model>(Model{std::move(*elastic)}));
}

template <int D>
Expected<ActiveStep> ActiveForm<D>::step(const ActiveState& state, std::span<const Tool> tools,
                                         const ActiveLoads& loads) const {
  if (loads.pressure != 0 || loads.wind != Point::Zero() || !loads.moments.empty()) {
    return usage_error("pressure, wind and moments act on surfaces");
  }
  return elastic_step<D>(model_->elastic, state, tools, loads);
}

template class ActiveForm<1>;
template class ActiveForm<3>;

}  // namespace knead
