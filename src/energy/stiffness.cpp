#include "knead/energy/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tensor_pattern.hpp"

namespace knead {
namespace {

/// Y = (I ⊗ G ⊗ I) X along one direction of a tensor stored with the last index fastest: X has `outer` slabs of
/// G.size() rows of `inner` contiguous numbers.
void apply_along(const BandMatrix& gramian, std::size_t outer, std::size_t inner, const double* x, double* y) {
  const int n = gramian.size(), p = gramian.half_bandwidth();
  std::fill(y, y + outer * static_cast<std::size_t>(n) * inner, 0.0);
  for (std::size_t o = 0; o < outer; ++o) {
    const double* slab = x + o * static_cast<std::size_t>(n) * inner;
    double* out = y + o * static_cast<std::size_t>(n) * inner;
    for (int i = 0; i < n; ++i) {
      double* row = out + static_cast<std::size_t>(i) * inner;
      for (int j = std::max(0, i - p); j <= std::min(n - 1, i + p); ++j) {
        const double g = gramian(i, j);
        const double* from = slab + static_cast<std::size_t>(j) * inner;
        for (std::size_t c = 0; c < inner; ++c) row[c] += g * from[c];
      }
    }
  }
}

template <int D>
std::array<int, D> degrees(const std::array<KnotVector, D>& knots) {
  std::array<int, D> result;
  for (std::size_t d = 0; d < D; ++d) result[d] = knots[d].degree();
  return result;
}

template <int D>
Expected<void> check_orders(const Energy<D>& energy) {
  for (const EnergyTerm<D>& term : energy) {
    for (std::size_t d = 0; d < D; ++d) {
      if (term.a[d] < 0 || term.a[d] > 2 || term.b[d] < 0 || term.b[d] > 2) {
        return usage_error(fmt::format("an energy term of order {} is not available", std::max(term.a[d], term.b[d])),
                           {}, "use orders 0 to 2 per direction");
      }
    }
  }
  return {};
}

}  // namespace

template <int D>
Expected<Stiffness<D>> Stiffness<D>::create(const std::array<KnotVector, D>& knots, const Energy<D>& given,
                                            const StiffnessOptions& options) {
  if (auto checked = check_orders<D>(given); !checked) return std::unexpected(checked.error());
  // Terms with a != b come in mirrored pairs. Summed first, a pair gives x + y above the diagonal and y + x below, the
  // same number: K is symmetric to the last bit.
  Energy<D> energy = given;
  std::ranges::stable_partition(energy, [](const EnergyTerm<D>& term) { return term.a != term.b; });
  Stiffness result;
  result.degree_ = degrees<D>(knots);
  result.size_ = 1;
  for (std::size_t d = 0; d < D; ++d) {
    result.net_[d] = knots[d].count();
    result.size_ *= result.net_[d];
  }
  for (const EnergyTerm<D>& term : energy) result.terms_.push_back({term.coefficient, {}});
  for (std::size_t d = 0; d < D; ++d) {
    std::map<std::pair<int, int>, int> known;
    for (std::size_t t = 0; t < energy.size(); ++t) {
      const int a = energy[t].a[d], b = energy[t].b[d];
      const auto [it, added] = known.try_emplace({a, b}, static_cast<int>(result.factors_[d].size()));
      if (added) {
        // G^ab with a < b is the transpose of G^ba, so that the two halves of a symmetric pair agree to the last bit.
        auto matrix = gramian(knots[d], std::max(a, b), std::min(a, b), options.method);
        if (!matrix) return std::unexpected(matrix.error());
        result.factors_[d].push_back(a < b ? matrix->transposed() : std::move(*matrix));
      }
      result.terms_[t].factor[d] = it->second;
    }
  }
  return result;
}

template <int D>
Expected<Stiffness<D>> Stiffness<D>::create(const Spline<D>& spline, const Energy<D>& energy,
                                            const StiffnessOptions& options) {
  if (!spline.rational()) return create(spline.knots(), energy, options);
  if (auto checked = check_orders<D>(energy); !checked) return std::unexpected(checked.error());
  auto matrix = assemble_rational<D>(spline, energy, options.rational_gauss_points);
  if (!matrix) return std::unexpected(matrix.error());
  Stiffness result;
  result.net_ = spline.net();
  result.degree_ = degrees<D>(spline.knots());
  result.size_ = spline.size();
  result.assembled_ = std::make_shared<const SparseMatrix>(std::move(*matrix));
  return result;
}

template <int D>
Points Stiffness<D>::apply(const Points& x) const {
  assert(x.rows() == size_);
  if (assembled_) return *assembled_ * x;
  Points sum = Points::Zero(size_, 3);
  Points buffers[2] = {Points(size_, 3), Points(size_, 3)};
  for (const Term& term : terms_) {
    const double* from = x.data();
    std::size_t outer = 1, inner = static_cast<std::size_t>(size_) * 3;
    for (std::size_t d = 0; d < D; ++d) {
      inner /= static_cast<std::size_t>(net_[d]);
      apply_along(factors_[d][static_cast<std::size_t>(term.factor[d])], outer, inner, from, buffers[d % 2].data());
      from = buffers[d % 2].data();
      outer *= static_cast<std::size_t>(net_[d]);
    }
    sum += term.coefficient * buffers[(D - 1) % 2];
  }
  return sum;
}

template <int D>
double Stiffness<D>::energy(const Points& x) const {
  return x.cwiseProduct(apply(x)).sum();
}

template <int D>
SparseMatrix Stiffness<D>::assemble() const {
  if (assembled_) return *assembled_;
  const TensorPattern<D> pattern{net_, degree_};
  SparseMatrix matrix = pattern.allocate();
  double* values = matrix.valuePtr();

  // The factors of the last direction as full rows of 2p + 1 numbers, row j from column j − p on.
  constexpr std::size_t last = D - 1;
  const int n = net_[last], p = degree_[last], width = 2 * p + 1;
  const std::size_t kinds = factors_[last].size();
  std::vector<double> band(kinds * static_cast<std::size_t>(n) * static_cast<std::size_t>(width), 0.0);
  for (std::size_t g = 0; g < kinds; ++g) {
    for (int i = 0; i < n; ++i) {
      for (int j = pattern.first(last, i); j < pattern.first(last, i) + pattern.length(last, i); ++j) {
        band[(g * static_cast<std::size_t>(n) + static_cast<std::size_t>(i)) * static_cast<std::size_t>(width) +
             static_cast<std::size_t>(j - i + p)] = factors_[last][g](i, j);
      }
    }
  }

  // For every pair of outer indices the terms collapse to one coefficient per factor of the last direction; they are
  // kept by kind, outer column by outer column.
  TensorPattern<D> outer_pattern = pattern;
  outer_pattern.net[last] = 1;
  outer_pattern.degree[last] = 0;
  std::vector<double> weights;
  std::size_t at = 0;
  for (int row = 0; row < outer_pattern.size(); ++row) {
    const std::array<int, D> i = outer_pattern.unpack(row);
    int columns = 1;
    for (std::size_t d = 0; d < last; ++d) columns *= pattern.length(d, i[d]);
    weights.assign(static_cast<std::size_t>(columns) * kinds, 0.0);
    for (int column = 0; column < columns; ++column) {
      std::array<int, D> j{};
      for (std::size_t d = last, rest = static_cast<std::size_t>(column); d-- > 0;) {
        const auto length = static_cast<std::size_t>(pattern.length(d, i[d]));
        j[d] = pattern.first(d, i[d]) + static_cast<int>(rest % length);
        rest /= length;
      }
      for (const Term& term : terms_) {
        double product = term.coefficient;
        for (std::size_t d = 0; d < last; ++d)
          product *= factors_[d][static_cast<std::size_t>(term.factor[d])](i[d], j[d]);
        weights[static_cast<std::size_t>(column) * kinds + static_cast<std::size_t>(term.factor[last])] += product;
      }
    }
    for (int k = 0; k < n; ++k) {
      const int length = pattern.length(last, k), skip = pattern.first(last, k) - k + p;
      for (int column = 0; column < columns; ++column) {
        const double* w = weights.data() + static_cast<std::size_t>(column) * kinds;
        double* to = values + at;
        for (std::size_t g = 0; g < kinds; ++g) {
          const double* from =
              band.data() +
              (g * static_cast<std::size_t>(n) + static_cast<std::size_t>(k)) * static_cast<std::size_t>(width) + skip;
          if (g == 0) {
            for (int c = 0; c < length; ++c) to[c] = w[g] * from[c];
          } else {
            for (int c = 0; c < length; ++c) to[c] += w[g] * from[c];
          }
        }
        if (kinds == 0) std::fill(to, to + length, 0.0);
        at += static_cast<std::size_t>(length);
      }
    }
  }
  return matrix;
}

template class Stiffness<1>;
template class Stiffness<2>;
template class Stiffness<3>;

}  // namespace knead
