#include "knead/energy/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/parallel_for.hpp"
#include "simd/tensor_kernels.hpp"
#include "tensor_pattern.hpp"

namespace knead {
namespace {

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
        return usage_error(fmt::format("an energy term of order {} is not available",
                                       std::max(term.a[d], term.b[d])),
                           {}, "use orders 0 to 2 per direction");
      }
    }
  }
  return {};
}

/// What writes the rows of K, some outer indices at a time.
template <int D, class Term>
struct RowWriter {
  static constexpr std::size_t last = D - 1;
  static constexpr auto spare = detail::TensorKernels::spare;

  RowWriter(const TensorPattern<D>& entries, const std::array<std::vector<BandMatrix>, D>& matrices,
            const std::vector<Term>& list)
      : pattern(entries),
        factors(matrices),
        terms(list),
        n(pattern.net[last]),
        p(pattern.degree[last]),
        kinds(factors[last].size()) {
    // One row of zeros where the energy has no terms, so that there is something to point into.
    band.assign(std::max<std::size_t>(kinds, 1) * static_cast<std::size_t>(stride()), 0.0);
    for (std::size_t g = 0; g < kinds; ++g) {
      double* to = band.data() + static_cast<std::ptrdiff_t>(g) * stride();
      for (int s = -p; s <= p; ++s) {
        double* entry = to + std::max(0, -s) * static_cast<std::ptrdiff_t>(width()) + s + p;
        for (const double value : factors[last][g].diagonal(s)) {
          *entry = value;
          entry += width();
        }
      }
    }
  }

  [[nodiscard]] int width() const { return 2 * p + 1; }
  [[nodiscard]] std::ptrdiff_t stride() const {
    return static_cast<std::ptrdiff_t>(n) * width() + spare;
  }

  /// For a pair of outer indices the terms collapse to one coefficient per factor of the last
  /// direction.
  void find_weights(const std::array<int, D>& i, const std::vector<std::array<int, D>>& columns,
                    std::vector<double>& weights) const {
    weights.assign(columns.size() * kinds, 0.0);
    for (const Term& term : terms) {
      double* to = weights.data() + term.factor[last];
      for (const std::array<int, D>& column : columns) {
        double product = term.coefficient;
        for (std::size_t d = 0; d < last; ++d) {
          product *= factors[d][static_cast<std::size_t>(term.factor[d])](i[d], column[d]);
        }
        *to += product;
        to += kinds;
      }
    }
  }

  /// Those of the outer indices begin … end − 1, and nothing else.
  void write(int begin, int end, SparseMatrix& matrix) const {
    const TensorPattern<D> rows = pattern.outer();
    const detail::TensorKernels& kernels = detail::tensor_kernels();
    std::vector<double> weights, last_values;
    double* to = matrix.valuePtr() + matrix.outerIndexPtr()[begin * n];
    const double* const behind = matrix.valuePtr() + matrix.outerIndexPtr()[end * n];
    for (int row = begin; row < end; ++row) {
      const std::array<int, D> i = rows.unpack(row);
      const std::vector<std::array<int, D>> columns = rows.columns(i);
      const auto count = static_cast<std::ptrdiff_t>(columns.size());
      find_weights(i, columns, weights);
      for (int line = 0; line < n;) {
        // Away from the ends all rows are alike.
        const int alike = line == p && n > 2 * p ? n - 2 * p : 1;
        const std::ptrdiff_t length = pattern.length(last, line), values = alike * count * length;
        const double* from = band.data() + static_cast<std::ptrdiff_t>(line) * width() +
                             pattern.first(last, line) - line + p;
        const bool past_the_end = behind - to < values + spare;
        if (past_the_end) last_values.resize(static_cast<std::size_t>(values + spare));
        kernels.write_runs(from, stride(), width(), alike, weights.data(),
                           static_cast<std::ptrdiff_t>(kinds), count, length,
                           past_the_end ? last_values.data() : to);
        if (past_the_end) std::copy_n(last_values.data(), values, to);
        to += values;
        line += alike;
      }
    }
  }

  /// All, by several threads where there are many.
  void write_all(SparseMatrix& matrix) const {
    const int count = pattern.outer().size();
    const double work = static_cast<double>(matrix.nonZeros()) / count * static_cast<double>(kinds);
    detail::parallel_for(count, detail::block_size(count, work),
                         [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                           write(static_cast<int>(begin), static_cast<int>(end), matrix);
                         });
  }

  TensorPattern<D> pattern;
  const std::array<std::vector<BandMatrix>, D>& factors;
  const std::vector<Term>& terms;
  int n, p;                  // of the last direction
  std::size_t kinds;         // its factors
  std::vector<double> band;  // as full rows of 2p + 1 numbers, row j from column j − p on
};

}  // namespace

template <int D>
Expected<Stiffness<D>> Stiffness<D>::create(const std::array<KnotVector, D>& knots,
                                            const Energy<D>& given,
                                            const StiffnessOptions& options) {
  if (auto checked = check_orders<D>(given); !checked) return std::unexpected(checked.error());
  // Terms with a != b come in mirrored pairs. Summed first, a pair gives x + y above the diagonal
  // and y + x below, the same number: K is symmetric to the last bit.
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
      const auto [it, added] =
          known.try_emplace({a, b}, static_cast<int>(result.factors_[d].size()));
      if (added) {
        // G^ab with a < b is the transpose of G^ba, so that the two halves of a symmetric pair
        // agree to the last bit.
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
  auto matrix = assemble_rational<D>(spline, energy, options);
  if (!matrix) return std::unexpected(matrix.error());
  return of_matrix(spline, std::move(matrix->matrix), matrix->error_bound);
}

template <int D>
Stiffness<D> Stiffness<D>::of_matrix(const Spline<D>& spline, SparseMatrix matrix,
                                     double error_bound) {
  assert(matrix.rows() == spline.size() && matrix.cols() == spline.size());
  Stiffness result;
  result.net_ = spline.net();
  result.degree_ = degrees<D>(spline.knots());
  result.size_ = spline.size();
  result.assembled_ = std::make_shared<const SparseMatrix>(std::move(matrix));
  result.error_bound_ = error_bound;
  return result;
}

template <int D>
double Stiffness<D>::energy(const Points& x) const {
  return x.cwiseProduct(apply(x)).sum();
}

template <int D>
SparseMatrix Stiffness<D>::assemble() const {
  if (assembled_) return *assembled_;
  SparseMatrix matrix = TensorPattern<D>{net_, degree_}.allocate();
  refresh(matrix);
  return matrix;
}

template <int D>
void Stiffness<D>::refresh(SparseMatrix& matrix) const {
  if (assembled_) {
    assert(matrix.nonZeros() == assembled_->nonZeros());
    std::copy_n(assembled_->valuePtr(), assembled_->nonZeros(), matrix.valuePtr());
    return;
  }
  const RowWriter<D, Term> rows({net_, degree_}, factors_, terms_);
  rows.write_all(matrix);
}

template class Stiffness<1>;
template class Stiffness<2>;
template class Stiffness<3>;

}  // namespace knead
