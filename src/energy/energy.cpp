#include "knead/energy/energy.hpp"

#include <cmath>

namespace knead {

template <int D>
Energy<D> stretch_and_bend(const MaterialOf<D>& material) {
  const auto unit = [](int i) {
    MultiIndex<D> a{};
    a[static_cast<std::size_t>(i)] = 1;
    return a;
  };
  const auto second = [&unit](int i, int j) {
    MultiIndex<D> a = unit(i);
    ++a[static_cast<std::size_t>(j)];
    return a;
  };
  Energy<D> stretch, bend;
  for (int i = 0; i < D; ++i) {
    for (int j = i; j < D; ++j) {
      const std::size_t place = MaterialOf<D>::place(i, j);
      if (const double alpha = material.alpha[place]; alpha != 0) {
        stretch.push_back({alpha, unit(i), unit(j)});
        if (i != j) stretch.push_back({alpha, unit(j), unit(i)});
      }
      if (const double beta = material.beta[place]; beta != 0) {
        bend.push_back({i == j ? beta : 2 * beta, second(i, j), second(i, j)});
      }
      if (i == j || material.poisson == 0) continue;
      const double ii = material.beta[MaterialOf<D>::place(i, i)],
                   jj = material.beta[MaterialOf<D>::place(j, j)];
      if (const double coupled = material.poisson * std::sqrt(ii * jj); coupled != 0) {
        bend.push_back({coupled, second(i, i), second(j, j)});
        bend.push_back({coupled, second(j, j), second(i, i)});
      }
    }
  }
  stretch.insert(stretch.end(), bend.begin(), bend.end());
  return stretch;
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
        term.coefficient =
            exponent > 0 ? term.coefficient * factors[d] : term.coefficient / factors[d];
      }
    }
  }
  return scaled;
}

template Energy<1> stretch_and_bend<1>(const MaterialOf<1>&);
template Energy<2> stretch_and_bend<2>(const MaterialOf<2>&);
template Energy<3> stretch_and_bend<3>(const MaterialOf<3>&);
template Energy<1> mass_energy<1>(double);
template Energy<2> mass_energy<2>(double);
template Energy<3> mass_energy<3>(double);
template Energy<1> on_scaled_domain<1>(const Energy<1>&, const std::array<double, 1>&);
template Energy<2> on_scaled_domain<2>(const Energy<2>&, const std::array<double, 2>&);
template Energy<3> on_scaled_domain<3>(const Energy<3>&, const std::array<double, 3>&);

}  // namespace knead
