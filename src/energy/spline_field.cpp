#include "knead/energy/spline_field.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/counts.hpp"
#include "spline/interpolation/greville_interpolation.hpp"
#include "spline/tensor_contraction.hpp"

namespace knead {
namespace {

template <int D>
std::array<KnotVector, D> array_of(std::vector<KnotVector> knots) {
  return [&]<std::size_t... d>(std::index_sequence<d...>) {
    return std::array<KnotVector, D>{std::move(knots[d])...};
  }
  (std::make_index_sequence<D>{});
}

}  // namespace

template <int D>
Expected<SplineField<D>> SplineField<D>::create(std::array<KnotVector, D> knots,
                                                std::vector<double> coefficients) {
  std::array<int, D> counts;
  for (std::size_t d = 0; d < D; ++d) counts[d] = knots[d].count();
  const std::optional<std::int64_t> asked = product_of(counts);
  if (!asked || static_cast<std::int64_t>(coefficients.size()) != *asked) {
    return input_error(fmt::format("the knots ask for {} coefficients, not {}",
                                   fmt::join(counts, " x "), coefficients.size()));
  }
  const std::size_t count = coefficients.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(coefficients[i])) {
      return input_error("the coefficient is not a finite number",
                         fmt::format("coefficient {}", i));
    }
  }
  return SplineField(std::move(knots), std::move(coefficients));
}

template <int D>
std::array<int, D> SplineField<D>::net() const {
  std::array<int, D> n;
  for (std::size_t d = 0; d < D; ++d) n[d] = knots_[d].count();
  return n;
}

template <int D>
Interval SplineField<D>::range() const {
  const auto [low, high] = std::ranges::minmax_element(coefficients_);
  return {*low, *high};
}

template <int D>
std::vector<double> SplineField<D>::on_grid(const std::array<const BasisTable*, D>& tables) const {
  return contract_grid<D>(tables, net(), coefficients_.data(), 1);
}

template <int D>
Expected<std::vector<double>> SplineField<D>::on_grid(
    const std::array<std::span<const double>, D>& parameters, Side side) const {
  std::array<BasisTable, D> tables;
  std::array<const BasisTable*, D> pointers;
  for (std::size_t d = 0; d < D; ++d) {
    auto table = tabulate_basis(knots_[d], parameters[d], 0, side);
    if (!table) return std::unexpected(table.error().within(fmt::format("direction {}", d)));
    tables[d] = std::move(*table);
    pointers[d] = &tables[d];
  }
  return on_grid(pointers);
}

template <int D>
Expected<double> SplineField<D>::at(const std::array<double, D>& u) const {
  std::array<std::span<const double>, D> parameters;
  for (std::size_t d = 0; d < D; ++d) parameters[d] = std::span(&u[d], 1);
  const auto values = on_grid(parameters);
  if (!values) return std::unexpected(values.error());
  return values->front();
}

// The smallest space of the highest degree that contains all the given ones: at a knot of
// multiplicity m a spline of degree p has p − m continuous derivatives, so degree q needs
// multiplicity q − p + m there.
Expected<KnotVector> common_knots(std::span<const KnotVector> knots) {
  if (knots.empty()) return usage_error("there are no knots to find common ones of");
  const Interval domain = knots.front().domain();
  int degree = 0;
  for (const KnotVector& k : knots) {
    const Interval other = k.domain();
    if (other.lower != domain.lower || other.upper != domain.upper) {
      return input_error(fmt::format("the domains [{}, {}] and [{}, {}] differ", domain.lower,
                                     domain.upper, other.lower, other.upper),
                         {}, "give fields over the domain of the spline");
    }
    degree = std::max(degree, k.degree());
  }
  std::map<double, int> multiplicity;
  for (const KnotVector& k : knots) {
    for (const double x : k.knots()) {
      if (x <= domain.lower || x >= domain.upper) continue;
      int& m = multiplicity[x];  // the continuity is degree − multiplicity
      m = std::max(m, degree - k.degree() + k.multiplicity(x));
    }
  }
  std::vector<double> result(static_cast<std::size_t>(degree + 1), domain.lower);
  for (const auto& [x, m] : multiplicity)
    result.insert(result.end(), static_cast<std::size_t>(m), x);
  result.insert(result.end(), static_cast<std::size_t>(degree + 1), domain.upper);
  return KnotVector::create(degree, std::move(result));
}

template <int D>
Expected<std::array<KnotVector, D>> common_knots(std::span<const std::array<KnotVector, D>> knots) {
  std::vector<KnotVector> made;
  for (std::size_t d = 0; d < D; ++d) {
    std::vector<KnotVector> direction;
    for (const auto& k : knots) direction.push_back(k[d]);
    auto common = common_knots(std::span<const KnotVector>(direction));
    if (!common) return std::unexpected(common.error().within(fmt::format("direction {}", d)));
    made.push_back(std::move(*common));
  }
  return array_of<D>(std::move(made));
}

// Interpolation at the Greville abscissae of the new knots, direction by direction: the collocation
// matrix is a Kronecker product, solved in O(p) per coefficient and direction. It gives the field
// itself, up to rounding, if the new space contains the old one, as that of common knots does.
// Refinement of knots would do the same, in as many steps as there are degrees to raise.
template <int D>
Expected<SplineField<D>> on_knots(const Coefficient<D>& coefficient,
                                  const std::array<KnotVector, D>& knots) {
  std::size_t count = 1;
  for (const KnotVector& k : knots) count *= static_cast<std::size_t>(k.count());
  if (const double* constant = std::get_if<double>(&coefficient)) {
    return SplineField<D>::create(knots, std::vector<double>(count, *constant));
  }
  const auto& field = std::get<SplineField<D>>(coefficient);
  if (field.knots() == knots) return field;
  std::vector<GrevilleInterpolation> interpolation;
  std::array<BasisTable, D> tables;
  std::array<const BasisTable*, D> pointers;
  for (std::size_t d = 0; d < D; ++d) {
    const Interval range = field.knots()[d].domain(), other = knots[d].domain();
    if (range.lower != other.lower || range.upper != other.upper) {
      return input_error(fmt::format("the domains [{}, {}] and [{}, {}] differ", range.lower,
                                     range.upper, other.lower, other.upper),
                         fmt::format("direction {}", d),
                         "give a field over the domain of the spline");
    }
    auto made = GrevilleInterpolation::create(knots[d]);
    if (!made) return std::unexpected(made.error());
    interpolation.push_back(std::move(*made));
    tables[d] = interpolation.back().tabulate(field.knots()[d]);
    pointers[d] = &tables[d];
  }
  std::vector<double> values = field.on_grid(pointers);
  std::size_t outer = 1, inner = count;
  for (std::size_t d = 0; d < D; ++d) {
    inner /= static_cast<std::size_t>(knots[d].count());
    interpolation[d].solve(values.data(), outer, inner);
    outer *= static_cast<std::size_t>(knots[d].count());
  }
  return SplineField<D>::create(knots, std::move(values));
}

template <int D>
Expected<std::array<KnotVector, D>> sample_knots(const std::array<Interval, D>& domain,
                                                 const std::array<int, D>& counts) {
  std::vector<KnotVector> made;
  for (std::size_t d = 0; d < D; ++d) {
    if (counts[d] < 2) {
      return input_error(fmt::format("{} samples do not span a grid", counts[d]),
                         fmt::format("direction {}", d), "give 2 or more in every direction");
    }
  }
  if (!product_of(counts)) {
    return input_error(fmt::format("{} samples are too many", fmt::join(counts, " x ")), "counts",
                       fmt::format("give at most {} in all", max_spline_size));
  }
  for (std::size_t d = 0; d < D; ++d) {
    auto knots = KnotVector::clamped_uniform(1, counts[d], domain[d].lower, domain[d].upper);
    if (!knots) return std::unexpected(knots.error().within(fmt::format("direction {}", d)));
    made.push_back(std::move(*knots));
  }
  return array_of<D>(std::move(made));
}

template <int D>
Expected<SplineField<D>> sampled_field(const std::array<Interval, D>& domain,
                                       const std::array<int, D>& counts,
                                       std::vector<double> samples) {
  auto knots = sample_knots<D>(domain, counts);
  if (!knots) return std::unexpected(knots.error());
  return SplineField<D>::create(std::move(*knots), std::move(samples));
}

#define KNEAD_INSTANTIATE(D)                                                                   \
  template class SplineField<D>;                                                               \
  template Expected<std::array<KnotVector, D>> common_knots<D>(                                \
      std::span<const std::array<KnotVector, D>>);                                             \
  template Expected<SplineField<D>> on_knots<D>(const Coefficient<D>&,                         \
                                                const std::array<KnotVector, D>&);             \
  template Expected<std::array<KnotVector, D>> sample_knots<D>(const std::array<Interval, D>&, \
                                                               const std::array<int, D>&);     \
  template Expected<SplineField<D>> sampled_field<D>(                                          \
      const std::array<Interval, D>&, const std::array<int, D>&, std::vector<double>);
KNEAD_INSTANTIATE(1)
KNEAD_INSTANTIATE(2)
KNEAD_INSTANTIATE(3)
#undef KNEAD_INSTANTIATE

}  // namespace knead
