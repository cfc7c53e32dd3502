#include "site_values.hpp"

#include <fmt/format.h>

#include <cassert>

#include "chebyshev_interpolation.hpp"
#include "greville_interpolation.hpp"
#include "spline/tensor_contraction.hpp"

namespace knead {
namespace {

template <int D>
std::vector<double> at_abscissae(const std::vector<SiteInterpolation>& interpolation,
                                 const double* x, std::size_t components) {
  std::array<const BasisTable*, D> tables;
  std::array<int, D> net;
  for (std::size_t d = 0; d < D; ++d) {
    tables[d] = &interpolation[d].basis();
    net[d] = interpolation[d].size();
  }
  return contract_grid<D>(tables, net, x, components);
}

Expected<SiteInterpolation> interpolation_of(const KnotVector& knots, Sites sites) {
  if (sites == Sites::greville) return GrevilleInterpolation::create(knots);
  return ChebyshevInterpolation::create(knots);
}

}  // namespace

template <int D>
struct SiteValues<D>::Factors {
  std::vector<SiteInterpolation> interpolation;
  std::vector<double> weights,
      denominators;  // at control points and at the abscissae; empty for a polynomial spline
};

template <int D>
Expected<SiteValues<D>> SiteValues<D>::create(const Spline<D>& shape, Sites sites) {
  Factors made;
  for (std::size_t d = 0; d < D; ++d) {
    auto direction = interpolation_of(shape.knots()[d], sites);
    if (!direction)
      return std::unexpected(direction.error().within(fmt::format("direction {}", d)));
    made.interpolation.push_back(std::move(*direction));
  }
  if (shape.rational()) {
    made.weights.assign(shape.weights().begin(), shape.weights().end());
    made.denominators = at_abscissae<D>(made.interpolation, made.weights.data(), 1);
  }
  for (std::size_t i = 0; i < made.weights.size(); ++i) {
    if (made.weights[i] == 0) {
      return input_error(
          "a weight is 0, so that no value at an abscissa determines its coefficient",
          fmt::format("control point {}", i), "use weights > 0");
    }
    if (!(made.denominators[i] > 0)) {
      return numerical_error("the rational denominator is not positive", "sites",
                             "use positive weights");
    }
  }
  return SiteValues(std::make_shared<const Factors>(std::move(made)));
}

template <int D>
int SiteValues<D>::size() const {
  int size = 1;
  for (const SiteInterpolation& direction : factors_->interpolation) size *= direction.size();
  return size;
}

template <int D>
const std::vector<double>& SiteValues<D>::abscissae(int direction) const {
  return factors_->interpolation[static_cast<std::size_t>(direction)].abscissae();
}

// v = diag(W)⁻¹ C diag(w) x, and `coefficients` applies the inverses from left to right.
template <int D>
Points SiteValues<D>::values(const Points& x) const {
  assert(x.rows() == size());
  const auto& [interpolation, weights, denominators] = *factors_;
  if (weights.empty()) {
    const std::vector<double> values = at_abscissae<D>(interpolation, x.data(), 3);
    return Eigen::Map<const Points>(values.data(), x.rows(), 3);
  }
  const Points weighted =
      Eigen::Map<const Eigen::VectorXd>(weights.data(), x.rows()).asDiagonal() * x;
  const std::vector<double> values = at_abscissae<D>(interpolation, weighted.data(), 3);
  Points result = Eigen::Map<const Points>(values.data(), x.rows(), 3);
  for (Eigen::Index i = 0; i < result.rows(); ++i)
    result.row(i) /= denominators[static_cast<std::size_t>(i)];
  return result;
}

template <int D>
Points SiteValues<D>::coefficients(Points v) const {
  assert(v.rows() == size());
  const auto& [interpolation, weights, denominators] = *factors_;
  const bool rational = !weights.empty();
  for (Eigen::Index i = 0; i < v.rows() && rational; ++i)
    v.row(i) *= denominators[static_cast<std::size_t>(i)];
  std::size_t outer = 1, inner = static_cast<std::size_t>(v.size());
  for (const SiteInterpolation& direction : interpolation) {
    const auto n = static_cast<std::size_t>(direction.size());
    inner /= n;
    direction.solve(v.data(), outer, inner);
    outer *= n;
  }
  for (Eigen::Index i = 0; i < v.rows() && rational; ++i)
    v.row(i) /= weights[static_cast<std::size_t>(i)];
  return v;
}

template class SiteValues<1>;
template class SiteValues<2>;
template class SiteValues<3>;

}  // namespace knead
