#include "knead/energy/energy.hpp"

#include <cmath>

namespace knead {

Energy<2> stretch_and_bend(const Material& material) {
  const auto& [a11, a12, a22] = material.alpha;
  const auto& [b11, b12, b22] = material.beta;
  Energy<2> energy;
  const auto add = [&energy](double c, MultiIndex<2> a, MultiIndex<2> b) {
    if (c != 0) energy.push_back({c, a, b});
  };
  add(a11, {1, 0}, {1, 0});
  add(a12, {1, 0}, {0, 1});
  add(a12, {0, 1}, {1, 0});
  add(a22, {0, 1}, {0, 1});
  add(b11, {2, 0}, {2, 0});
  add(2 * b12, {1, 1}, {1, 1});
  add(b22, {0, 2}, {0, 2});
  return energy;
}

template <int D>
Energy<D> mass_energy(double coefficient) {
  return {{coefficient, {}, {}}};
}

template <int D>
Energy<D> on_scaled_domain(const Energy<D>& energy, const std::array<double, D>& factors) {
  Energy<D> scaled = energy;
  for (EnergyTerm<D>& term : scaled) {
    for (std::size_t d = 0; d < D; ++d) {
      const int exponent = 1 - term.a[d] - term.b[d];
      for (int k = 0; k < std::abs(exponent); ++k) {
        term.coefficient = exponent > 0 ? term.coefficient * factors[d] : term.coefficient / factors[d];
      }
    }
  }
  return scaled;
}

template Energy<1> mass_energy<1>(double);
template Energy<2> mass_energy<2>(double);
template Energy<3> mass_energy<3>(double);
template Energy<1> on_scaled_domain<1>(const Energy<1>&, const std::array<double, 1>&);
template Energy<2> on_scaled_domain<2>(const Energy<2>&, const std::array<double, 2>&);
template Energy<3> on_scaled_domain<3>(const Energy<3>&, const std::array<double, 3>&);

}  // namespace knead
