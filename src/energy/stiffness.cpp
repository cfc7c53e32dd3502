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

/// One row of an assembled matrix: for every outer column a run of `length` entries Σ_g weight_g · band_g, the bands
/// `stride` apart.
struct Runs {
  const double* band;
  std::size_t stride;
  const double* weights;
  std::size_t kinds, columns;

  template <int length>
  double* write(double* to) const {
    const double* w = weights;
    for (std::size_t column = 0; column < columns; ++column, w += kinds, to += length) {
      double sum[length] = {};
      for (std::size_t g = 0; g < kinds; ++g) {
        for (int c = 0; c < length; ++c) sum[c] += w[g] * band[g * stride + static_cast<std::size_t>(c)];
      }
      std::copy_n(sum, length, to);
    }
    return to;
  }

  double* write(double* to, int length) const {
    const double* w = weights;
    for (std::size_t column = 0; column < columns; ++column, w += kinds, to += length) {
      std::fill_n(to, length, 0.0);
      for (std::size_t g = 0; g < kinds; ++g) {
        for (int c = 0; c < length; ++c) to[c] += w[g] * band[g * stride + static_cast<std::size_t>(c)];
      }
    }
    return to;
  }
};

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
  if (assembled_) return symmetric_product(*assembled_, x);
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

  // For every pair of outer indices the terms collapse to one coefficient per factor of the last direction.
  const TensorPattern<D> rows = pattern.outer();
  std::vector<double> weights;
  double* to = matrix.valuePtr();
  for (int row = 0; row < rows.size(); ++row) {
    const std::array<int, D> i = rows.unpack(row);
    const std::vector<std::array<int, D>> columns = rows.columns(i);
    weights.assign(columns.size() * kinds, 0.0);
    for (std::size_t column = 0; column < columns.size(); ++column) {
      for (const Term& term : terms_) {
        double product = term.coefficient;
        for (std::size_t d = 0; d < last; ++d) {
          product *= factors_[d][static_cast<std::size_t>(term.factor[d])](i[d], columns[column][d]);
        }
        weights[column * kinds + static_cast<std::size_t>(term.factor[last])] += product;
      }
    }
    for (int k = 0; k < n; ++k) {
      const int length = pattern.length(last, k), skip = pattern.first(last, k) - k + p;
      const double* from = band.data() + static_cast<std::size_t>(k * width + skip);
      const Runs runs{from, static_cast<std::size_t>(n * width), weights.data(), kinds, columns.size()};
      switch (length) {
        case 3:
          to = runs.write<3>(to);
          break;
        case 5:
          to = runs.write<5>(to);
          break;
        case 7:
          to = runs.write<7>(to);
          break;
        default:
          to = runs.write(to, length);
      }
    }
  }
  return matrix;
}

template class Stiffness<1>;
template class Stiffness<2>;
template class Stiffness<3>;

}  // namespace knead
