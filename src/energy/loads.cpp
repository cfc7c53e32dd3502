#include "knead/energy/loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/gauss_legendre.hpp"
#include "knead/energy/spline_field.hpp"
#include "knead/gramian/triple_gramian.hpp"
#include "knead/spline/evaluate.hpp"
#include "rational_load.hpp"

namespace knead {
namespace {

template <int D>
double volume(const DomainScaling<D>& scaling) {
  double product = 1;
  for (const double f : scaling.factors) product *= f;
  return product;
}

/// Σ over a tensor grid of points: F_i = Σ_q weight_q R_i(q) f_q, f one row per point, last
/// direction fastest. For rational bases the values are divided by the denominator; the sum over
/// each direction is a transposed `contract_along`.
template <int D>
Expected<Points> integrate(const Spline<D>& shape, const std::array<BasisTable, D>& tables,
                           const std::array<std::vector<double>, D>& weights, Points f) {
  if (shape.rational()) {
    // The denominator is the sum of the rational basis's numerators: the spline of the weights, as
    // a coordinate.
    Points w = Points::Zero(shape.size(), 3);
    for (int i = 0; i < shape.size(); ++i) w(i, 0) = shape.weights()[static_cast<std::size_t>(i)];
    const auto denominator_spline = Spline<D>::create(shape.knots(), std::move(w));
    if (!denominator_spline) return std::unexpected(denominator_spline.error());
    std::array<const BasisTable*, D> pointers;
    for (std::size_t d = 0; d < D; ++d) pointers[d] = &tables[d];
    const auto at = evaluate_grid<D>(*denominator_spline, pointers, 0);
    if (!at) return std::unexpected(at.error());
    for (Eigen::Index q = 0; q < f.rows(); ++q) {
      const double denominator = at->points()(q, 0);
      if (!(denominator > 0)) {
        return numerical_error("the rational denominator is not positive", "load",
                               "use positive weights");
      }
      f.row(q) /= denominator;
    }
  }
  std::size_t inner = static_cast<std::size_t>(f.size()), outer = 1;
  std::vector<double> from(f.data(), f.data() + f.size()), to;
  for (std::size_t d = 0; d < D; ++d) {
    const auto points = static_cast<std::size_t>(tables[d].size()),
               n = static_cast<std::size_t>(shape.knots()[d].count());
    inner /= points;
    to.assign(outer * n * inner, 0.0);
    for (std::size_t o = 0; o < outer; ++o) {
      for (std::size_t q = 0; q < points; ++q) {
        const double* x = from.data() + (o * points + q) * inner;
        const double* values = tables[d].row(static_cast<int>(q), 0);
        double* y = to.data() + (o * n + static_cast<std::size_t>(tables[d].first[q])) * inner;
        for (int r = 0; r <= tables[d].degree; ++r, y += inner) {
          const double factor = weights[d][q] * values[r];
          for (std::size_t c = 0; c < inner; ++c) y[c] += factor * x[c];
        }
      }
    }
    outer *= n;
    std::swap(from, to);
  }
  Points result = Eigen::Map<const Points>(from.data(), shape.size(), 3);
  if (shape.rational()) {
    for (int i = 0; i < shape.size(); ++i)
      result.row(i) *= shape.weights()[static_cast<std::size_t>(i)];
  }
  return result;
}

/// A load with weights of its own.
template <int D>
Expected<Points> weighted_load(const Spline<D>& shape, const Spline<D>& load) {
  std::array<BasisTable, D> first, other;
  std::array<std::vector<double>, D> weights;
  std::array<const BasisTable*, D> pointers;
  for (std::size_t d = 0; d < D; ++d) {
    const KnotVector &a = shape.knots()[d], &b = load.knots()[d];
    const auto [lower, upper] = a.domain();
    std::vector<double> breaks;
    for (const KnotVector* k : {&a, &b}) {
      for (const double x : k->knots()) {
        if (lower <= x && x <= upper) breaks.push_back(x);
      }
    }
    std::ranges::sort(breaks);
    breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
    // A load with weights has no bound here; eight points more than its polynomial would need.
    const GaussRule rule = gauss_legendre(std::max(a.degree(), b.degree()) + 8);
    std::vector<double> at;
    for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
      const double half = (breaks[k + 1] - breaks[k]) / 2;
      for (std::size_t g = 0; g < rule.abscissae.size(); ++g) {
        at.push_back(std::clamp(breaks[k] + half + half * rule.abscissae[g], breaks[k],
                                std::nextafter(breaks[k + 1], breaks[k])));
        weights[d].push_back(half * rule.weights[g]);
      }
    }
    auto made = tabulate_basis(a, at, 0);
    if (!made) return std::unexpected(made.error());
    first[d] = std::move(*made);
    made = tabulate_basis(b, at, 0);
    if (!made) return std::unexpected(made.error());
    other[d] = std::move(*made);
    pointers[d] = &other[d];
  }
  auto f = evaluate_grid<D>(load, pointers, 0);
  if (!f) return std::unexpected(f.error());
  return integrate<D>(shape, first, weights, f->points());
}

}  // namespace

template <int D>
Expected<Points> load_forces(const Spline<D>& shape, const DomainScaling<D>& scaling,
                             const Spline<D>& load) {
  for (std::size_t d = 0; d < D; ++d) {
    const Interval a = shape.knots()[d].domain(), b = load.knots()[d].domain();
    if (a.lower != b.lower || a.upper != b.upper) {
      return input_error(
          fmt::format("the domains [{}, {}] of the shape and [{}, {}] of the load differ", a.lower,
                      a.upper, b.lower, b.upper),
          fmt::format("load: direction {}", d), "give a load over the domain of the shape");
    }
  }
  if (shape.rational() || load.rational()) {
    auto result =
        load.rational() ? weighted_load<D>(shape, load) : detail::rational_load<D>(shape, load);
    if (result) *result *= volume<D>(scaling);
    return result;
  }
  // One direction after the other; the product with three columns of coordinates innermost.
  std::vector<double> from(load.control_points().data(),
                           load.control_points().data() + load.control_points().size()),
      to;
  std::size_t inner = from.size(), outer = 1;
  for (std::size_t d = 0; d < D; ++d) {
    const auto m = static_cast<std::size_t>(load.knots()[d].count()),
               n = static_cast<std::size_t>(shape.knots()[d].count());
    // F = (G_u ⊗ G_v ⊗ G_w) f with the mixed Gramians ∫ N_i M_j of both bases: exact for
    // polynomials, O(N p) per direction.
    const auto gramian = mixed_gramian(shape.knots()[d], 0, load.knots()[d], 0);
    if (!gramian) return std::unexpected(gramian.error());
    inner /= m;
    to.assign(outer * n * inner, 0.0);
    for (std::size_t o = 0; o < outer; ++o) {
      for (Eigen::Index j = 0; j < gramian->outerSize(); ++j) {
        const double* x = from.data() + (o * m + static_cast<std::size_t>(j)) * inner;
        for (Eigen::SparseMatrix<double>::InnerIterator it(*gramian, j); it; ++it) {
          double* y = to.data() + (o * n + static_cast<std::size_t>(it.row())) * inner;
          for (std::size_t c = 0; c < inner; ++c) y[c] += it.value() * x[c];
        }
      }
    }
    outer *= n;
    std::swap(from, to);
  }
  return Points(volume<D>(scaling) * Eigen::Map<const Points>(from.data(), shape.size(), 3));
}

template <int D>
Expected<Points> load_forces(const Spline<D>& shape, const DomainScaling<D>& scaling,
                             const LoadFunction<D>& load, int points_per_span) {
  std::array<BasisTable, D> tables;
  std::array<std::vector<double>, D> parameters, weights;
  Eigen::Index total = 1;
  for (std::size_t d = 0; d < D; ++d) {
    const KnotVector& k = shape.knots()[d];
    BasisQuadrature q = gauss_basis(
        k, points_per_span > 0 ? std::min(points_per_span, max_gauss_points) : k.degree() + 4, 0);
    tables[d] = std::move(q.basis);
    parameters[d] = std::move(q.parameters);
    weights[d] = std::move(q.weights);
    total *= tables[d].size();
  }
  Points f(total, 3);
  for (Eigen::Index k = 0; k < total; ++k) {
    std::array<double, D> u;
    auto rest = static_cast<std::size_t>(k);
    for (std::size_t d = D; d-- > 0;) {
      u[d] = parameters[d][rest % parameters[d].size()];
      rest /= parameters[d].size();
    }
    const Point value = load(u);
    if (!value.allFinite()) {
      std::string place;
      for (const double x : u) place += fmt::format("{}{}", place.empty() ? "" : ", ", x);
      return input_error("the load has no finite value", fmt::format("parameters ({})", place));
    }
    f.row(k) = value.transpose();
  }
  auto result = integrate<D>(shape, tables, weights, std::move(f));
  if (result) *result *= volume<D>(scaling);
  return result;
}

template <int D>
Expected<Spline<D>> sampled_load(const Spline<D>& shape, const std::array<int, D>& counts,
                                 Points samples) {
  std::array<Interval, D> domain;
  for (std::size_t d = 0; d < D; ++d) domain[d] = shape.knots()[d].domain();
  auto knots = sample_knots<D>(domain, counts);
  if (!knots) return std::unexpected(knots.error().within("load"));
  auto made = Spline<D>::create(std::move(*knots), std::move(samples));
  if (!made) return std::unexpected(made.error().within("load"));
  return made;
}

#define KNEAD_INSTANTIATE(D)                                                          \
  template Expected<Points> load_forces<D>(const Spline<D>&, const DomainScaling<D>&, \
                                           const Spline<D>&);                         \
  template Expected<Points> load_forces<D>(const Spline<D>&, const DomainScaling<D>&, \
                                           const LoadFunction<D>&, int);              \
  template Expected<Spline<D>> sampled_load<D>(const Spline<D>&, const std::array<int, D>&, Points);
KNEAD_INSTANTIATE(1)
KNEAD_INSTANTIATE(2)
KNEAD_INSTANTIATE(3)
#undef KNEAD_INSTANTIATE

}  // namespace knead
