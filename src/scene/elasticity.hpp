#pragma once

#include <variant>

#include "energy/form_energy.hpp"
#include "knead/energy/shell_energy.hpp"

namespace knead {

// What resists when a shape of a scene is deformed: one of these at any time.

/// The linear active model (thesis Eq. 4.8). Its coefficients are the shape's `material`, which the
/// shape keeps while another elasticity stands in their place.
struct LinearElasticity {
  friend bool operator==(const LinearElasticity&, const LinearElasticity&) = default;
};

namespace detail {
template <int D>
struct ElasticityOf {  // of curves and volumes
  using type = std::variant<LinearElasticity, FormWeights>;
};
template <>
struct ElasticityOf<2> {
  using type = std::variant<LinearElasticity, ShellMaterial, FundamentalMaterial>;
};
}  // namespace detail

/// Of curves and volumes linear or by their fundamental forms (`FormEnergy`), of surfaces also that
/// of a shell
/// (`ShellEnergy`).
template <int D>
using Elasticity = typename detail::ElasticityOf<D>::type;

/// Whether steps minimise a non-linear energy.
template <class... Kinds>
[[nodiscard]] bool is_nonlinear(const std::variant<LinearElasticity, Kinds...>& elasticity) {
  return elasticity.index() != 0;
}

}  // namespace knead
