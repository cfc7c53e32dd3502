#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>

#include "base/parallel_for.hpp"
#include "homogeneous.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

// Two doubles side by side: available on every 64-bit target. All arithmetic is lane by lane, in the order of the
// scalar code, so results do not depend on the vector width.
// A typedef: Clang ignores the alignment in an alias declaration, and then loads from odd addresses trap.
typedef double Pair __attribute__((vector_size(16), aligned(8), may_alias));  // NOLINT(modernize-use-using)
static_assert(alignof(Pair) == alignof(double));

/// The last direction's basis with parameters side by side, so that neighbouring points of one span are computed at
/// once: values(d, r)[k] = N^(d)_{first[k]+r}(u_k).
class TransposedBasis {
 public:
  TransposedBasis(const BasisTable& table, int order)
      : count_(static_cast<std::size_t>(table.size())), width_(static_cast<std::size_t>(table.degree + 1)) {
    values_.resize(static_cast<std::size_t>(order + 1) * width_ * count_);
    for (std::size_t k = 0; k < count_; ++k) {
      for (int d = 0; d <= order; ++d) {
        const double* row = table.row(static_cast<int>(k), d);
        for (std::size_t r = 0; r < width_; ++r)
          values_[(static_cast<std::size_t>(d) * width_ + r) * count_ + k] = row[r];
      }
      if (k == 0 || table.first[k] != table.first[k - 1])
        runs_.push_back({static_cast<std::size_t>(table.first[k]), k});
    }
  }

  /// Parameters begin … (begin of the next run) − 1 lie in one span, whose first function is `first`.
  struct Run {
    std::size_t first, begin;
  };
  [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }
  [[nodiscard]] std::size_t end(std::size_t run) const {
    return run + 1 < runs_.size() ? runs_[run + 1].begin : count_;
  }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] const double* values(int d) const {
    return values_.data() + static_cast<std::size_t>(d) * width_ * count_;
  }

 private:
  std::size_t count_, width_;
  std::vector<double> values_;
  std::vector<Run> runs_;
};

/// Σ_r basis[r · stride + k] coefficients[3 r + c] for k = 0 … count − 1, written to out[3 k + c].
/// `Fixed` is the number of terms if known at compile time, else 0 and `terms` holds it.
template <std::size_t Fixed>
void sum_run(const double* coefficients, const double* basis, std::size_t stride, std::size_t terms, std::size_t count,
             double* out) {
  if constexpr (Fixed > 0) terms = Fixed;
  std::size_t k = 0;
  for (; k + 2 <= count; k += 2) {
    Pair n = *reinterpret_cast<const Pair*>(basis + k);
    Pair x = n * coefficients[0], y = n * coefficients[1], z = n * coefficients[2];
    for (std::size_t r = 1; r < terms; ++r) {
      n = *reinterpret_cast<const Pair*>(basis + r * stride + k);
      const double* c = coefficients + 3 * r;
      x += n * c[0];
      y += n * c[1];
      z += n * c[2];
    }
    double* to = out + 3 * k;
    *reinterpret_cast<Pair*>(to) = Pair{x[0], y[0]};
    *reinterpret_cast<Pair*>(to + 2) = Pair{z[0], x[1]};
    *reinterpret_cast<Pair*>(to + 4) = Pair{y[1], z[1]};
  }
  for (; k < count; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = basis[k] * coefficients[c];
      for (std::size_t r = 1; r < terms; ++r) sum += basis[r * stride + k] * coefficients[3 * r + c];
      out[3 * k + c] = sum;
    }
  }
}

/// The same with four numbers per control point.
void sum_homogeneous_run(const double* coefficients, const double* basis, std::size_t stride, std::size_t terms,
                         std::size_t count, double* out) {
  for (std::size_t k = 0; k < count; ++k) {
    Pair xy{}, zw{};
    for (std::size_t r = 0; r < terms; ++r) {
      const Pair* c = reinterpret_cast<const Pair*>(coefficients + 4 * r);
      const Pair a = basis[r * stride + k] * c[0], b = basis[r * stride + k] * c[1];
      xy = r == 0 ? a : xy + a;
      zw = r == 0 ? b : zw + b;
    }
    *reinterpret_cast<Pair*>(out + 4 * k) = xy;
    *reinterpret_cast<Pair*>(out + 4 * k + 2) = zw;
  }
}

using SumRun = void (*)(const double*, const double*, std::size_t, std::size_t, std::size_t, double*);

SumRun sum_run_for(std::size_t width, std::size_t terms) {
  if (width == 4) return sum_homogeneous_run;
  switch (terms) {
    case 2:
      return sum_run<2>;
    case 3:
      return sum_run<3>;
    case 4:
      return sum_run<4>;
    case 5:
      return sum_run<5>;
    case 6:
      return sum_run<6>;
    default:
      return sum_run<0>;
  }
}

/// What all parts of a grid share.
template <int D>
struct GridTask {
  GridTask(const Spline<D>& spline, const std::array<const BasisTable*, D>& given, int derivatives,
           Evaluation<D>& evaluation)
      : rational(spline.rational()),
        net(spline),
        tables(given),
        order(derivatives),
        basis(*given[D - 1], derivatives),
        quotient(rational ? derivatives : 0),
        sum_run(sum_run_for(net.width(), basis.width())),
        result(evaluation) {}

  bool rational;
  detail::HomogeneousNet<D> net;
  const std::array<const BasisTable*, D>& tables;
  int order;
  TransposedBasis basis;
  detail::QuotientRule<D> quotient;
  SumRun sum_run;
  Evaluation<D>& result;
};

/// Walks a part of the grid row by row. At every parameter of a direction but the last, the net is contracted once for
/// every derivative needed further in, leaving a smaller net. In the last direction whole rows are summed.
template <int D>
class GridWalk {
 public:
  explicit GridWalk(const GridTask<D>& task) : task_(task) {
    for (std::size_t d = 0; d + 1 < D; ++d) nets_[d].resize(multi_indices<D>(task.order).size() * task.net.stride(d));
    if (task.rational) homogeneous_.resize(task.result.derivatives.size() * task.basis.size() * 4);
  }

  /// At parameters begin … end − 1 of the first direction; all of it where that is also the last. False if a
  /// denominator is not positive; `at()` then gives the point.
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

  bool walk(std::size_t d, std::size_t begin, std::size_t end, const std::vector<Partial>& partials) {
    if (d + 1 == D) return sum_row(partials);
    const BasisTable& table = *task_.tables[d];
    const std::size_t stride = task_.net.stride(d), inner = static_cast<std::size_t>(task_.tables[d + 1]->size());
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
          contract(table.row(static_cast<int>(k), m), table.degree, from, stride, to);
          contracted.push_back({a, to});
        }
      }
      if (!walk(d + 1, 0, inner, contracted)) return false;
    }
    return true;
  }

  static void contract(const double* values, int degree, const double* from, std::size_t stride, double* to) {
    for (std::size_t c = 0; c < stride; ++c) to[c] = values[0] * from[c];
    for (int r = 1; r <= degree; ++r) {
      from += stride;
      for (std::size_t c = 0; c < stride; ++c) to[c] += values[r] * from[c];
    }
  }

  bool sum_row(const std::vector<Partial>& partials) {
    const TransposedBasis& basis = task_.basis;
    const std::size_t n = basis.size(), width = task_.net.width();
    for (const Partial& partial : partials) {
      MultiIndex<D> a = partial.a;
      int left = task_.order;
      for (const int order : a) left -= order;
      for (int m = 0; m <= left; ++m) {
        a[D - 1] = m;
        const auto k = static_cast<std::size_t>(multi_index_position<D>(a));
        double* to = task_.rational ? homogeneous_.data() + k * n * 4 : task_.result.derivatives[k].data() + row_ * 3;
        for (std::size_t run = 0; run < basis.runs().size(); ++run) {
          const auto [first, begin] = basis.runs()[run];
          task_.sum_run(partial.net + first * width, basis.values(m) + begin, n, basis.width(), basis.end(run) - begin,
                        to + begin * width);
        }
      }
    }
    for (std::size_t k = 0; task_.rational && k < n; ++k) {
      at_[D - 1] = k;
      if (!task_.quotient.apply(homogeneous_.data() + k * 4, n * 4, static_cast<Eigen::Index>(row_ + k),
                                task_.result.derivatives)) {
        return false;
      }
    }
    row_ += n;
    return true;
  }

  const GridTask<D>& task_;
  std::array<std::vector<double>, D> nets_;  ///< the net remaining after direction d, one per derivative
  std::vector<double> homogeneous_;          ///< one row of a rational spline, by derivative and point
  std::size_t row_ = 0;
  std::array<std::size_t, D> at_{};
};

/// Multiplications per parameter of the first direction, roughly; none where that is the only one, which is not
/// divided.
template <int D>
double work_of_a_slab(const GridTask<D>& task, Eigen::Index points) {
  if constexpr (D == 1) return 0;
  const double numbers = static_cast<double>(points) / task.tables[0]->size() *
                         static_cast<double>(task.result.derivatives.size() * task.net.width());
  return numbers * (task.tables[D - 1]->degree + 1 + (task.rational ? 4 : 0));
}

/// The whole grid, by several threads where it is large.
template <int D>
Expected<void> walk_all(const GridTask<D>& task, Eigen::Index points) {
  const std::ptrdiff_t slabs = task.tables[0]->size(), size = detail::block_size(slabs, work_of_a_slab(task, points));
  std::vector<std::optional<std::array<std::size_t, D>>> failed(static_cast<std::size_t>((slabs + size - 1) / size));
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

}  // namespace

template <int D>
Expected<void> evaluate_grid(const Spline<D>& spline, const std::array<const BasisTable*, D>& tables, int order,
                             Evaluation<D>& result) {
  Eigen::Index rows = 1;
  for (std::size_t d = 0; d < D; ++d) {
    assert(tables[d]->order >= order && tables[d]->degree == spline.knots()[d].degree());
    rows *= tables[d]->size();
  }
  result.order = order;
  result.derivatives.resize(multi_indices<D>(order).size());
  for (Points& derivative : result.derivatives) derivative.resize(rows, 3);
  if (rows == 0) return {};
  return walk_all(GridTask<D>(spline, tables, order, result), rows);
}

template <int D>
Expected<Evaluation<D>> evaluate_grid(const Spline<D>& spline, const std::array<const BasisTable*, D>& tables,
                                      int order) {
  Evaluation<D> result;
  auto done = evaluate_grid<D>(spline, tables, order, result);
  if (!done) return std::unexpected(std::move(done.error()));
  return result;
}

template <int D>
Expected<Evaluation<D>> evaluate_grid(const Spline<D>& spline, const std::array<std::span<const double>, D>& parameters,
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

#define KNEAD_INSTANTIATE(D)                                                                                         \
  template Expected<void> evaluate_grid<D>(const Spline<D>&, const std::array<const BasisTable*, D>&, int,           \
                                           Evaluation<D>&);                                                          \
  template Expected<Evaluation<D>> evaluate_grid<D>(const Spline<D>&, const std::array<const BasisTable*, D>&, int); \
  template Expected<Evaluation<D>> evaluate_grid<D>(const Spline<D>&, const std::array<std::span<const double>, D>&, \
                                                    int, Side);
KNEAD_INSTANTIATE(1)
KNEAD_INSTANTIATE(2)
KNEAD_INSTANTIATE(3)
#undef KNEAD_INSTANTIATE

}  // namespace knead
