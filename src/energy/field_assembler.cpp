#include "knead/energy/field_assembler.hpp"

#include <algorithm>

#include "tensor_pattern.hpp"

namespace knead {
namespace {

/// Adds one term to the entries on and above the diagonal, direction by direction.
/// K_IJ = Σ_kl α_kl T_u[k, i, j] T_v[l, i', j'] with the triple Gramians T[k, i, j] = ∫ B_k N_i^(a)
/// N_j^(b). Direction by direction (sum factorisation): for each pair (i, j) of the first direction
/// the coefficients are contracted along k, over the few k with supports in common, and the shorter
/// array goes on to the next direction. For degree p and coefficients of degree q that is O(N p^D
/// (p + q)) in all, against O(N p^3D) of plain loops over Gauss points. Entries on and above the
/// diagonal alone are formed; an entry is below it only if the first direction whose indices differ
/// says so.
template <int D>
class TermWriter {
 public:
  TermWriter(const TensorPattern<D>& pattern, const std::array<const TripleGramian*, D>& triple,
             SparseMatrix& matrix)
      : pattern_(pattern),
        triple_(triple),
        start_(matrix.outerIndexPtr()),
        values_(matrix.valuePtr()) {
    std::size_t inner = 1;
    for (std::size_t d = D; d-- > 0;) {
      inner_[d] = inner;
      buffer_[d].resize(inner);
      inner *= static_cast<std::size_t>(triple[d]->coefficient_count());
    }
  }

  void add(const double* coefficients) { contract<0>(coefficients, false, 0, 0); }

 private:
  /// `above`: an earlier direction has put the entry above the diagonal; else all were on it.
  template <std::size_t d>
  void contract(const double* coefficients, bool above, int row, int offset) {
    const int n = pattern_.net[d];
    for (int i = 0; i < n; ++i) {
      const int first = pattern_.first(d, i), length = pattern_.length(d, i);
      const int next_row = row * n + i;
      for (int j = above ? first : i; j < first + length; ++j) {
        const TripleGramian::Run run = triple_[d]->run(i, j);
        const int next_offset = offset * length + (j - first);
        const double* from = coefficients + static_cast<std::size_t>(run.first) * inner_[d];
        if constexpr (d + 1 == D) {
          double sum = 0;
          for (std::size_t k = 0; k < run.values.size(); ++k) sum += run.values[k] * from[k];
          values_[start_[next_row] + next_offset] += sum;
        } else {
          if (run.values.empty()) continue;
          std::vector<double>& sum = buffer_[d];
          std::ranges::fill(sum, 0.0);
          for (const double value : run.values) {
            for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += value * from[c];
            from += sum.size();
          }
          contract<d + 1>(sum.data(), above || j > i, next_row, next_offset);
        }
      }
    }
  }

  const TensorPattern<D>& pattern_;
  std::array<const TripleGramian*, D> triple_;
  const SparseMatrix::StorageIndex* start_;
  double* values_;
  std::array<std::size_t, D> inner_{};
  std::array<std::vector<double>, D> buffer_;
};

/// Copies the upper half to the lower one. The pattern is symmetric and columns are sorted: walking
/// the rows in order, the entries of a row below the diagonal arrive in the order in which they are
/// stored.
void mirror(SparseMatrix& matrix) {
  const auto* start = matrix.outerIndexPtr();
  const auto* column = matrix.innerIndexPtr();
  double* values = matrix.valuePtr();
  const auto rows = static_cast<int>(matrix.outerSize());
  std::vector<SparseMatrix::StorageIndex> next(start, start + rows);
  for (int i = 0; i < rows; ++i) {
    for (auto k = start[i]; k < start[i + 1]; ++k) {
      if (column[k] > i) values[next[static_cast<std::size_t>(column[k])]++] = values[k];
    }
  }
}

}  // namespace

// Triple Gramians depend on knots and orders, not on coefficients: they serve the next material on
// the same knots.
template <int D>
Expected<const TripleGramian*> FieldAssembler<D>::triple(std::size_t direction,
                                                         const KnotVector& knots, int a, int b) {
  for (Kept& kept : kept_[direction]) {
    if (kept.a == a && kept.b == b && kept.knots == knots) {
      kept.used = true;
      return kept.triple.get();
    }
  }
  auto made = triple_gramian(knots, spline_.knots()[direction], a, b);
  if (!made) return std::unexpected(made.error());
  kept_[direction].push_back(
      {knots, a, b, std::make_shared<const TripleGramian>(std::move(*made)), true});
  return kept_[direction].back().triple.get();
}

template <int D>
void FieldAssembler<D>::begin() {
  for (auto& kept : kept_) {
    for (Kept& one : kept) one.used = false;
  }
}

template <int D>
void FieldAssembler<D>::drop_unused() {
  for (auto& kept : kept_) std::erase_if(kept, [](const Kept& one) { return !one.used; });
}

template <int D>
Expected<SparseMatrix> FieldAssembler<D>::assemble_kept(const FieldEnergy<D>& energy,
                                                        double& error_bound) {
  if (spline_.rational()) {
    auto made = assemble_rational<D>(spline_, energy, options_);
    if (!made) return std::unexpected(made.error());
    error_bound = std::max(error_bound, made->error_bound);
    return std::move(made->matrix);
  }
  Energy<D> constant;
  for (const FieldTerm<D>& term : energy) {
    if (const double* c = std::get_if<double>(&term.coefficient))
      constant.push_back({term.factor * *c, term.a, term.b});
  }
  auto stiffness = Stiffness<D>::create(spline_.knots(), constant, options_);
  if (!stiffness) return std::unexpected(stiffness.error());
  SparseMatrix matrix = stiffness->assemble();
  if (constant.size() == energy.size()) return matrix;

  TensorPattern<D> pattern;
  pattern.net = spline_.net();
  for (std::size_t d = 0; d < D; ++d) pattern.degree[d] = spline_.knots()[d].degree();
  std::vector<double> scaled;
  for (const FieldTerm<D>& term : energy) {
    const auto* field = std::get_if<SplineField<D>>(&term.coefficient);
    if (field == nullptr) continue;
    std::array<const TripleGramian*, D> triples;
    for (std::size_t d = 0; d < D; ++d) {
      if (term.a[d] > 2 || term.b[d] > 2) {
        return usage_error("an energy term of an order above 2 is not available", {},
                           "use orders 0 to 2 per direction");
      }
      const auto made = triple(d, field->knots()[d], term.a[d], term.b[d]);
      if (!made) return std::unexpected(made.error());
      triples[d] = *made;
    }
    scaled = field->coefficients();
    for (double& c : scaled) c *= term.factor;
    TermWriter<D>(pattern, triples, matrix).add(scaled.data());
  }
  mirror(matrix);
  return matrix;
}

template <int D>
Expected<SparseMatrix> FieldAssembler<D>::assemble(const FieldEnergy<D>& energy) {
  begin();
  double error_bound = 0;
  auto result = assemble_kept(energy, error_bound);
  drop_unused();
  return result;
}

template <int D>
Expected<FieldMatrices<D>> FieldAssembler<D>::assemble(const MaterialFieldOf<D>& material,
                                                       const std::array<double, D>& factors) {
  begin();
  FieldMatrices<D> result;
  const std::pair<FieldEnergy<D>, SparseMatrix*> parts[] = {
      {stretch_energy<D>(material), &result.stretch},
      {bend_energy<D>(material), &result.bend},
      {weighted_mass_energy<D>(material.mass), &result.mass},
      {weighted_mass_energy<D>(material.damping), &result.damping},
  };
  for (const auto& [energy, matrix] : parts) {
    auto made = assemble_kept(on_scaled_domain<D>(energy, factors), result.error_bound);
    if (!made) return std::unexpected(made.error());
    *matrix = std::move(*made);
  }
  drop_unused();
  return result;
}

template class FieldAssembler<1>;
template class FieldAssembler<2>;
template class FieldAssembler<3>;

}  // namespace knead
