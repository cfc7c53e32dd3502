#include <fmt/format.h>

#include <algorithm>
#include <cassert>

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

/// Walks the grid row by row. At every parameter of a direction but the last, the net is contracted once for every
/// derivative needed further in, leaving a smaller net. In the last direction whole rows are summed.
template <int D>
class GridWalk {
 public:
  GridWalk(const Spline<D>& spline, const std::array<const BasisTable*, D>& tables, int order, Evaluation<D>& result)
      : rational_(spline.rational()),
        net_(spline),
        tables_(tables),
        order_(order),
        basis_(*tables[D - 1], order),
        quotient_(rational_ ? order : 0),
        sum_run_(sum_run_for(net_.width(), basis_.width())),
        result_(result) {
    for (std::size_t d = 0; d + 1 < D; ++d) nets_[d].resize(multi_indices<D>(order).size() * net_.stride(d));
    if (rational_) homogeneous_.resize(result.derivatives.size() * basis_.size() * 4);
  }

  /// False if a denominator is not positive; `at()` then gives the point.
  bool run() { return walk(0, {{MultiIndex<D>{}, net_.data()}}); }
  [[nodiscard]] const std::array<std::size_t, D>& at() const { return at_; }

 private:
  /// The net contracted in the directions before the present one, with these derivative orders.
  struct Partial {
    MultiIndex<D> a;
    const double* net;
  };

  bool walk(std::size_t d, const std::vector<Partial>& partials) {
    if (d + 1 == D) return sum_row(partials);
    const BasisTable& table = *tables_[d];
    const std::size_t stride = net_.stride(d);
    std::vector<Partial> contracted;
    for (std::size_t k = 0; k < static_cast<std::size_t>(table.size()); ++k) {
      at_[d] = k;
      contracted.clear();
      double* to = nets_[d].data();
      for (const Partial& partial : partials) {
        const double* from = partial.net + static_cast<std::size_t>(table.first[k]) * stride;
        MultiIndex<D> a = partial.a;
        int left = order_;
        for (const int order : a) left -= order;
        for (int m = 0; m <= left; ++m, to += stride) {
          a[d] = m;
          contract(table.row(static_cast<int>(k), m), table.degree, from, stride, to);
          contracted.push_back({a, to});
        }
      }
      if (!walk(d + 1, contracted)) return false;
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
    const std::size_t n = basis_.size(), width = net_.width();
    for (const Partial& partial : partials) {
      MultiIndex<D> a = partial.a;
      int left = order_;
      for (const int order : a) left -= order;
      for (int m = 0; m <= left; ++m) {
        a[D - 1] = m;
        const auto k = static_cast<std::size_t>(multi_index_position<D>(a));
        double* to = rational_ ? homogeneous_.data() + k * n * 4 : result_.derivatives[k].data() + row_ * 3;
        for (std::size_t run = 0; run < basis_.runs().size(); ++run) {
          const auto [first, begin] = basis_.runs()[run];
          sum_run_(partial.net + first * width, basis_.values(m) + begin, n, basis_.width(), basis_.end(run) - begin,
                   to + begin * width);
        }
      }
    }
    for (std::size_t k = 0; rational_ && k < n; ++k) {
      at_[D - 1] = k;
      if (!quotient_.apply(homogeneous_.data() + k * 4, n * 4, static_cast<Eigen::Index>(row_ + k),
                           result_.derivatives)) {
        return false;
      }
    }
    row_ += n;
    return true;
  }

  bool rational_;
  detail::HomogeneousNet<D> net_;
  const std::array<const BasisTable*, D>& tables_;
  int order_;
  TransposedBasis basis_;
  detail::QuotientRule<D> quotient_;
  SumRun sum_run_;
  Evaluation<D>& result_;
  std::array<std::vector<double>, D> nets_;  ///< the net remaining after direction d, one per derivative
  std::vector<double> homogeneous_;          ///< one row of a rational spline, by derivative and point
  std::size_t row_ = 0;
  std::array<std::size_t, D> at_{};
};

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
  GridWalk<D> walk(spline, tables, order, result);
  if (!walk.run()) return detail::denominator_error<D>(walk.at());
  return {};
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
