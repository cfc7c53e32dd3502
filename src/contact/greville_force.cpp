#include "greville_force.hpp"

#include <cassert>

namespace knead {

template <int D>
Expected<GrevilleForce<D>> GrevilleForce<D>::create(const Spline<D>& shape,
                                                    const DomainScaling<D>& scaling,
                                                    const StiffnessOptions& options) {
  auto values = SiteValues<D>::create(shape, Sites::greville);
  if (!values) {
    Error error = values.error();
    if (error.kind == ErrorKind::input) error.remedy = "use the Gauss route";
    return std::unexpected(std::move(error));
  }
  auto mass =
      Stiffness<D>::create(shape, on_scaled_domain<D>(mass_energy<D>(), scaling.factors), options);
  if (!mass) return std::unexpected(mass.error());
  return GrevilleForce(std::move(*mass), std::move(*values));
}

template <int D>
Points GrevilleForce<D>::forces(Points f) const {
  assert(f.rows() == size());
  return mass_.apply(values_.coefficients(std::move(f)));
}

template class GrevilleForce<1>;
template class GrevilleForce<2>;
template class GrevilleForce<3>;

}  // namespace knead
