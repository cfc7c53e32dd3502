#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>

#include "base/parallel_for.hpp"
#include "evaluate_grid_by.hpp"
#include "homogeneous.hpp"

namespace knead {

const detail::GridKernels& detail::grid_kernels(InstructionSet set) {
  if (avx512_grid_kernels != nullptr && set >= InstructionSet::avx512) return *avx512_grid_kernels;
  if (avx2_grid_kernels != nullptr && set >= InstructionSet::avx2) return *avx2_grid_kernels;
  return *vector128_grid_kernels;
}

namespace {

/// The last direction's basis with parameters side by side, so that neighbouring points of one span
/// are computed at once.
class TransposedBasis {
 public:
  TransposedBasis(const BasisTable& table, int order)
      : count_(static_cast<std::size_t>(table.size())),
        stride_(count_ + detail::GridKernels::spare),
        width_(static_cast<std::size_t>(table.degree + 1)) {
    values_.resize(static_cast<std::size_t>(order + 1) * width_ * stride_);
    for (std::size_t k = 0; k < count_; ++k) {
      for (int d = 0; d <= order; ++d) {
        const double* row = table.row(static_cast<int>(k), d);
        for (std::size_t r = 0; r < width_; ++r)
          values_[(static_cast<std::size_t>(d) * width_ + r) * stride_ + k] = row[r];
      }
      const auto at = static_cast<std::ptrdiff_t>(k);
      if (k == 0 || table.first[k] != table.first[k - 1]) runs_.push_back({table.first[k], at, at});
      runs_.back().end = at + 1;
    }
  }

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] std::size_t stride() const { return stride_; }
  [[nodiscard]] detail::GridRow row() const {
    return {runs_.data(), std::ssize(runs_), static_cast<std::ptrdiff_t>(count_),
            static_cast<std::ptrdiff_t>(stride_), static_cast<std::ptrdiff_t>(width_)};
  }
  /// The values of derivative d, as `GridRow` describes them.
  [[nodiscard]] const double* values(int d) const {
    return values_.data() + static_cast<std::size_t>(d) * width_ * stride_;
  }

 private:
  std::size_t count_, stride_, width_;
  std::vector<double> values_;
  std::vector<detail::SpanRun> runs_;
};

/// The terms of the quotient rule, one after the other; none for order 0, where there is only the
/// division.
class ListedQuotientRule {
 public:
  template <int D>
  explicit ListedQuotientRule(const detail::QuotientRule<D>& rule) {
    for (std::size_t a = 0; a < rule.size(); ++a) {
      begin_.push_back(terms_.size());
      for (const auto& term : rule.terms(a))
        terms_.push_back({term.denominator, term.rest, term.factor});
    }
    begin_.push_back(terms_.size());
  }

  [[nodiscard]] detail::QuotientTerms terms() const {
    return {terms_.data(), begin_.data(), begin_.size() - 1};
  }

 private:
  std::vector<detail::QuotientTerm> terms_;
  std::vector<std::size_t> begin_;
};

/// What all parts of a grid share.
template <int D>
struct GridTask {
  GridTask(const detail::GridKernels& chosen, const Spline<D>& spline,
           const std::array<const BasisTable*, D>& given, int derivatives, std::vector<double*> to)
      : kernels(chosen),
        rational(spline.rational()),
        net(spline),
        tables(given),
        order(derivatives),
        basis(*given[D - 1], derivatives),
        quotient(detail::QuotientRule<D>(rational ? derivatives : 0)),
        out(std::move(to)) {}

  const detail::GridKernels& kernels;
  bool rational;
  detail::HomogeneousNet<D> net;
  const std::array<const BasisTable*, D>& tables;
  int order;
  TransposedBasis basis;
  ListedQuotientRule quotient;
  std::vector<double*> out;  ///< by derivative
};

/// Walks a part of the grid row by row. At every parameter of a direction but the last, the net is
/// contracted once for every derivative needed further in, leaving a smaller net. In the last
/// direction whole rows are summed.
template <int D>
class GridWalk {
 public:
  explicit GridWalk(const GridTask<D>& task) : task_(task) {
    for (std::size_t d = 0; d + 1 < D; ++d)
      nets_[d].resize(multi_indices<D>(task.order).size() * task.net.stride(d));
    if (!task.rational) return;
    constexpr auto spare = static_cast<std::size_t>(detail::GridKernels::spare);
    homogeneous_.resize(task.out.size() * task.basis.stride() * 4 + spare);
    work_.resize(task.out.size() * 3 * spare);
  }

  /// At parameters begin … end − 1 of the first direction; all of it where that is also the last.
  /// False if a denominator is not positive; `at()` then gives the point.
  bool run(std::size_t begin, std::size_t end) {
    row_ = begin;
    for (std::size_t d = 1; d < D; ++d) row_ *= static_cast<std::size_t>(task_.tables[d]->size());
    return walk(0, begin, end, {{MultiIndex<D>{}, task_.net.data()}});
  }
  [[nodiscard]] const std::array<std::size_t, D>& at() const { return at_; }

 private:
  /// The net contracted in the directions before the present one, with these derivative orders.
  struct Partial {
    MultiIndex<D> a;
    const double* net;
  };

  bool walk(std::size_t d, std::size_t begin, std::size_t end,
            const std::vector<Partial>& partials) {
    if (d + 1 == D) return sum_row(partials);
    const BasisTable& table = *task_.tables[d];
    const std::size_t stride = task_.net.stride(d),
                      inner = static_cast<std::size_t>(task_.tables[d + 1]->size());
    std::vector<Partial> contracted;
    for (std::size_t k = begin; k < end; ++k) {
      at_[d] = k;
      contracted.clear();
      double* to = nets_[d].data();
      for (const Partial& partial : partials) {
        const double* from = partial.net + static_cast<std::size_t>(table.first[k]) * stride;
        MultiIndex<D> a = partial.a;
        int left = task_.order;
        for (const int order : a) left -= order;
        for (int m = 0; m <= left; ++m, to += stride) {
          a[d] = m;
          task_.kernels.contract(table.row(static_cast<int>(k), m), table.degree + 1, from,
                                 static_cast<std::ptrdiff_t>(stride), to);
          contracted.push_back({a, to});
        }
      }
      if (!walk(d + 1, 0, inner, contracted)) return false;
    }
    return true;
  }

  bool sum_row(const std::vector<Partial>& partials) {
    const TransposedBasis& basis = task_.basis;
    const auto sum = task_.rational ? task_.kernels.homogeneous : task_.kernels.points;
    for (const Partial& partial : partials) {
      MultiIndex<D> a = partial.a;
      int left = task_.order;
      for (const int order : a) left -= order;
      for (int m = 0; m <= left; ++m) {
        a[D - 1] = m;
        const auto k = static_cast<std::size_t>(multi_index_position<D>(a));
        double* to =
            task_.rational ? homogeneous_.data() + k * basis.stride() * 4 : task_.out[k] + row_ * 3;
        sum(basis.row(), basis.values(m), partial.net, to);
      }
    }
    if (task_.rational && !divide_row()) return false;
    row_ += basis.size();
    return true;
  }

  bool divide_row() {
    const auto size = static_cast<std::ptrdiff_t>(task_.basis.size());
    const std::ptrdiff_t evaluated =
        task_.kernels.divide(task_.quotient.terms(), homogeneous_.data(),
                             static_cast<std::ptrdiff_t>(task_.basis.stride()), size, work_.data(),
                             task_.out.data(), static_cast<std::ptrdiff_t>(row_));
    at_[D - 1] = static_cast<std::size_t>(evaluated);
    return evaluated == size;
  }

  const GridTask<D>& task_;
  std::array<std::vector<double>, D>
      nets_;  ///< the net remaining after direction d, one per derivative
  std::vector<double>
      homogeneous_;           ///< one row of a rational spline, by derivative, coordinate and point
  std::vector<double> work_;  ///< of the division
  std::size_t row_ = 0;
  std::array<std::size_t, D> at_{};
};

/// Multiplications per parameter of the first direction, roughly; none where that is the only one,
/// which is not divided.
template <int D>
double work_of_a_slab(const GridTask<D>& task, Eigen::Index points) {
  if constexpr (D == 1) return 0;
  const double numbers = static_cast<double>(points) / task.tables[0]->size() *
                         static_cast<double>(task.out.size() * task.net.width());
  return numbers * (task.tables[D - 1]->degree + 1 + (task.rational ? 4 : 0));
}

/// The fastest for so many points in a span: vectors of eight pay where a span has more than fit
/// into one, in the mean.
const detail::GridKernels& kernels_for(const BasisTable& last) {
  std::ptrdiff_t runs = last.size() > 0 ? 1 : 0;
  for (std::size_t k = 1; k < last.first.size(); ++k)
    runs += last.first[k] != last.first[k - 1] ? 1 : 0;
  const InstructionSet best = best_instruction_set();
  return detail::grid_kernels(last.size() > 8 * runs ? best : std::min(best, InstructionSet::avx2));
}

template <int D>
Eigen::Index points_of(const std::array<const BasisTable*, D>& tables) {
  Eigen::Index rows = 1;
  for (const BasisTable* table : tables) rows *= table->size();
  return rows;
}

/// The whole grid, by several threads where it is large.
template <int D>
Expected<void> walk_all(const GridTask<D>& task, Eigen::Index points) {
  const std::ptrdiff_t slabs = task.tables[0]->size(),
                       size = detail::block_size(slabs, work_of_a_slab(task, points));
  std::vector<std::optional<std::array<std::size_t, D>>> failed(
      static_cast<std::size_t>((slabs + size - 1) / size));
  detail::parallel_for(slabs, size, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    GridWalk<D> walk(task);
    if (!walk.run(static_cast<std::size_t>(begin), static_cast<std::size_t>(end))) {
      failed[static_cast<std::size_t>(begin / size)] = walk.at();
    }
  });
  for (const auto& at : failed) {
    if (at) return detail::denominator_error<D>(*at);
  }
  return {};
}

template <int D>
Expected<void> write_grid(const detail::GridKernels& kernels, const Spline<D>& spline,
                          const std::array<const BasisTable*, D>& tables, int order,
                          std::vector<double*> out) {
  for (std::size_t d = 0; d < D; ++d) {
    assert(tables[d]->order >= order && tables[d]->degree == spline.knots()[d].degree());
  }
  const Eigen::Index points = points_of<D>(tables);
  if (points == 0) return {};
  return walk_all(GridTask<D>(kernels, spline, tables, order, std::move(out)), points);
}

}  // namespace

template <int D>
Expected<void> detail::evaluate_grid_by(const GridKernels& kernels, const Spline<D>& spline,
                                        const std::array<const BasisTable*, D>& tables, int order,
                                        Evaluation<D>& result) {
  return write_grid<D>(kernels, spline, tables, order,
                       detail::memory_of<D>(result, order, points_of<D>(tables)));
}

template <int D>
Expected<void> evaluate_grid(const Spline<D>& spline,
                             const std::array<const BasisTable*, D>& tables, int order,
                             Evaluation<D>& result) {
  return detail::evaluate_grid_by<D>(kernels_for(*tables[D - 1]), spline, tables, order, result);
}

template <int D>
Expected<void> evaluate_grid_into(const Spline<D>& spline,
                                  const std::array<const BasisTable*, D>& tables, int order,
                                  DerivativeMemory out) {
  return write_grid<D>(kernels_for(*tables[D - 1]), spline, tables, order,
                       detail::checked_memory<D>(out, order, points_of<D>(tables)));
}

template <int D>
Expected<Evaluation<D>> evaluate_grid(const Spline<D>& spline,
                                      const std::array<const BasisTable*, D>& tables, int order) {
  Evaluation<D> result;
  auto status = evaluate_grid<D>(spline, tables, order, result);
  if (!status) return std::unexpected(std::move(status.error()));
  return result;
}

template <int D>
Expected<Evaluation<D>> evaluate_grid(const Spline<D>& spline,
                                      const std::array<std::span<const double>, D>& parameters,
                                      int order, Side side) {
  std::array<BasisTable, D> tables;
  std::array<const BasisTable*, D> pointers;
  for (std::size_t d = 0; d < D; ++d) {
    auto table = tabulate_basis(spline.knots()[d], parameters[d], order, side);
    if (!table) return std::unexpected(table.error().within(fmt::format("direction {}", d)));
    tables[d] = std::move(*table);
    pointers[d] = &tables[d];
  }
  return evaluate_grid<D>(spline, pointers, order);
}

#define KNEAD_INSTANTIATE(D)                                                                       \
  template Expected<void> detail::evaluate_grid_by<D>(const GridKernels&, const Spline<D>&,        \
                                                      const std::array<const BasisTable*, D>&,     \
                                                      int, Evaluation<D>&);                        \
  template Expected<void> evaluate_grid<D>(                                                        \
      const Spline<D>&, const std::array<const BasisTable*, D>&, int, Evaluation<D>&);             \
  template Expected<void> evaluate_grid_into<D>(                                                   \
      const Spline<D>&, const std::array<const BasisTable*, D>&, int, DerivativeMemory);           \
  template Expected<Evaluation<D>> evaluate_grid<D>(const Spline<D>&,                              \
                                                    const std::array<const BasisTable*, D>&, int); \
  template Expected<Evaluation<D>> evaluate_grid<D>(                                               \
      const Spline<D>&, const std::array<std::span<const double>, D>&, int, Side);
KNEAD_INSTANTIATE(1)
KNEAD_INSTANTIATE(2)
KNEAD_INSTANTIATE(3)
#undef KNEAD_INSTANTIATE

}  // namespace knead
