#include "greville_force.hpp"

#include <fmt/format.h>

#include <cassert>

#include "spline/tensor_contraction.hpp"

namespace knead {
namespace {

template <int D>
std::vector<double> at_abscissae(const std::vector<GrevilleInterpolation>& interpolation, const double* x,
                                 std::size_t components) {
  std::array<const BasisTable*, D> tables;
  std::array<int, D> net;
  for (std::size_t d = 0; d < D; ++d) {
    tables[d] = &interpolation[d].basis();
    net[d] = interpolation[d].size();
  }
  return contract_grid<D>(tables, net, x, components);
}

}  // namespace

template <int D>
Expected<GrevilleForce<D>> GrevilleForce<D>::create(const Spline<D>& shape, const DomainScaling<D>& scaling,
                                                    const StiffnessOptions& options) {
  std::vector<GrevilleInterpolation> interpolation;
  for (std::size_t d = 0; d < D; ++d) {
    auto made = GrevilleInterpolation::create(shape.knots()[d]);
    if (!made) return std::unexpected(made.error().within(fmt::format("direction {}", d)));
    interpolation.push_back(std::move(*made));
  }
  auto mass = Stiffness<D>::create(shape, on_scaled_domain<D>(mass_energy<D>(), scaling.factors), options);
  if (!mass) return std::unexpected(mass.error());
  GrevilleForce result(std::move(*mass), std::move(interpolation));
  if (!shape.rational()) return result;
  result.weights_.assign(shape.weights().begin(), shape.weights().end());
  result.denominators_ = at_abscissae<D>(result.interpolation_, result.weights_.data(), 1);
  for (std::size_t i = 0; i < result.weights_.size(); ++i) {
    if (result.weights_[i] == 0) {
      return input_error("a weight is 0, so that no force determines its coefficient",
                         fmt::format("control point {}", i), "use the Gauss route");
    }
    if (!(result.denominators_[i] > 0)) {
      return numerical_error("the rational denominator is not positive", "Greville abscissae", "use positive weights");
    }
  }
  return result;
}

template <int D>
Points GrevilleForce<D>::places(const Points& x) const {
  assert(x.rows() == size());
  if (weights_.empty()) {
    const std::vector<double> values = at_abscissae<D>(interpolation_, x.data(), 3);
    return Eigen::Map<const Points>(values.data(), x.rows(), 3);
  }
  const auto weights = Eigen::Map<const Eigen::VectorXd>(weights_.data(), x.rows());
  const Points weighted = weights.asDiagonal() * x;
  const std::vector<double> values = at_abscissae<D>(interpolation_, weighted.data(), 3);
  Points result = Eigen::Map<const Points>(values.data(), x.rows(), 3);
  for (Eigen::Index i = 0; i < result.rows(); ++i) result.row(i) /= denominators_[static_cast<std::size_t>(i)];
  return result;
}

template <int D>
Points GrevilleForce<D>::forces(Points f) const {
  assert(f.rows() == size());
  for (Eigen::Index i = 0; i < f.rows() && !weights_.empty(); ++i)
    f.row(i) *= denominators_[static_cast<std::size_t>(i)];
  std::size_t outer = 1, inner = static_cast<std::size_t>(f.size());
  for (const GrevilleInterpolation& direction : interpolation_) {
    const auto n = static_cast<std::size_t>(direction.size());
    inner /= n;
    direction.solve(f.data(), outer, inner);
    outer *= n;
  }
  for (Eigen::Index i = 0; i < f.rows() && !weights_.empty(); ++i) f.row(i) /= weights_[static_cast<std::size_t>(i)];
  return mass_.apply(f);
}

template class GrevilleForce<1>;
template class GrevilleForce<2>;
template class GrevilleForce<3>;

}  // namespace knead
