#include "knead/spline/evaluate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "base/parallel_for.hpp"
#include "homogeneous.hpp"

namespace knead {
namespace {

template <int D>
void append_indices(MultiIndex<D>& a, std::size_t direction, int left,
                    std::vector<MultiIndex<D>>& out) {
  if (direction + 1 == D) {
    a[direction] = left;
    out.push_back(a);
    return;
  }
  for (int k = left; k >= 0; --k) {
    a[direction] = k;
    append_indices<D>(a, direction + 1, left - k, out);
  }
}

/// Σ_r values[r] from[r · stride + c], r < terms, for c < size: `Fixed` terms if known at compile
/// time, else 0.
template <std::size_t Fixed>
void sum_terms(const double* values, const double* from, std::size_t stride, std::size_t terms,
               std::size_t size, double* to) {
  if constexpr (Fixed > 0) terms = Fixed;
  for (std::size_t c = 0; c < size; ++c) {
    double sum = values[0] * from[c];
    for (std::size_t r = 1; r < terms; ++r) sum += values[r] * from[r * stride + c];
    to[c] = sum;
  }
}

/// Contracts the (p + 1)^D control points that affect one parameter point, first direction first.
/// Sums are formed in the same order as on grids, so that both give the same bits.
template <int D>
class LocalContraction {
 public:
  LocalContraction(const detail::HomogeneousNet<D>& net,
                   const std::array<const BasisTable*, D>& tables, int order)
      : net_(net), tables_(tables), order_(order) {
    std::size_t block = net.width();
    for (std::size_t d = D; d-- > 0;) {
      reduced_[d].resize(block);
      block *= static_cast<std::size_t>(tables[d]->degree + 1);
    }
    if (gathers()) local_.resize(block);
  }

  /// out[k · width + c] for multi-index k at point `row` of every table.
  void point(int row, double* out) {
    MultiIndex<D> a{};
    if (gathers()) {
      double* end = local_.data();
      gather(0, row, 0, end);
      contract(0, row, local_.data(), reduced_[0].size(), order_, a, out);
    } else {  // the control points of one line of the last direction are neighbours in the net, too
      const double* from = net_.data();
      for (std::size_t d = 0; d < D; ++d) {
        from += static_cast<std::size_t>(tables_[d]->first[static_cast<std::size_t>(row)]) *
                net_.stride(d);
      }
      contract(0, row, from, net_.stride(0), order_, a, out);
    }
  }

 private:
  [[nodiscard]] bool gathers() const { return D > 2 || !net_.whole(); }

  void gather(std::size_t d, int row, std::size_t from, double*& to) const {
    const BasisTable& table = *tables_[d];
    from += static_cast<std::size_t>(table.first[static_cast<std::size_t>(row)]) * net_.stride(d);
    if (d + 1 == D) {
      to = net_.copy(from / net_.width(), static_cast<std::size_t>(table.degree + 1), to);
      return;
    }
    for (int r = 0; r <= table.degree; ++r, from += net_.stride(d)) gather(d + 1, row, from, to);
  }

  void contract(std::size_t d, int row, const double* from, std::size_t stride, int left,
                MultiIndex<D>& a, double* out) {
    const BasisTable& table = *tables_[d];
    const std::size_t size = reduced_[d].size(), terms = static_cast<std::size_t>(table.degree + 1);
    for (int m = 0; m <= left; ++m) {
      a[d] = m;
      double* to = d + 1 == D ? out + static_cast<std::size_t>(multi_index_position<D>(a)) * size
                              : reduced_[d].data();
      const double* values = table.row(row, m);
      switch (terms) {
        case 3:
          sum_terms<3>(values, from, stride, terms, size, to);
          break;
        case 4:
          sum_terms<4>(values, from, stride, terms, size, to);
          break;
        default:
          sum_terms<0>(values, from, stride, terms, size, to);
      }
      if (d + 1 < D) contract(d + 1, row, to, reduced_[d + 1].size(), left - m, a, out);
    }
    a[d] = 0;
  }

  const detail::HomogeneousNet<D>& net_;
  const std::array<const BasisTable*, D>& tables_;
  int order_;
  std::vector<double>
      local_;  ///< of volumes, whose lines are not in one place, and of nets left apart
  std::array<std::vector<double>, D> reduced_;  ///< the remainder after direction d
};

}  // namespace

template <int D>
std::vector<MultiIndex<D>> multi_indices(int order) {
  std::vector<MultiIndex<D>> result;
  MultiIndex<D> a{};
  for (int total = 0; total <= order; ++total) append_indices<D>(a, 0, total, result);
  return result;
}

template <int D>
int multi_index_position(MultiIndex<D> a) {
  // Indices of smaller total order, then those of the same order whose first entry is larger,
  // direction by direction: the combinatorial number system, binom(total − 1 + k, k) for the last k
  // directions.
  int position = 0, total = 0;
  for (int k = 1; k <= D; ++k) {
    total += a[static_cast<std::size_t>(D - k)];
    int choices = 1;
    for (int i = 1; i <= k; ++i) choices = choices * (total - 1 + i) / i;
    position += choices;
  }
  return position;
}

namespace {

template <int D>
Expected<void> write_points(const Spline<D>& spline, const std::array<const BasisTable*, D>& tables,
                            int order, std::span<double* const> out) {
  const std::ptrdiff_t rows = tables[0]->size();
  const auto indices = multi_indices<D>(order);
  double terms = 1;  // control points that affect a point
  for (const BasisTable* table : tables) {
    assert(table->order >= order && table->size() == rows);
    terms *= table->degree + 1;
  }
  const detail::HomogeneousNet<D> net(spline, static_cast<double>(rows) * terms >= spline.size());
  const detail::QuotientRule<D> quotient(spline.rational() ? order : 0);
  const double work = terms * static_cast<double>(net.width() * indices.size());
  const std::ptrdiff_t size = detail::block_size(rows, work);
  std::vector<std::ptrdiff_t> failed(static_cast<std::size_t>((rows + size - 1) / size), -1);
  detail::parallel_for(rows, size, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    LocalContraction<D> contraction(net, tables, order);
    std::vector<double> homogeneous(indices.size() * net.width());
    for (std::ptrdiff_t row = begin; row < end; ++row) {
      contraction.point(static_cast<int>(row), homogeneous.data());
      if (!spline.rational()) {
        for (std::size_t k = 0; k < indices.size(); ++k) {
          std::copy_n(homogeneous.data() + k * 3, 3, out[k] + row * 3);
        }
      } else if (!detail::divide_point<D>(quotient, homogeneous.data(), net.width(), row, out)) {
        failed[static_cast<std::size_t>(begin / size)] = row;
        return;
      }
    }
  });
  for (const std::ptrdiff_t row : failed) {
    if (row >= 0) return detail::denominator_error<1>({static_cast<std::size_t>(row)});
  }
  return {};
}

}  // namespace

template <int D>
std::vector<double*> detail::memory_of(Evaluation<D>& result, int order, Eigen::Index points) {
  result.order = order;
  result.derivatives.resize(multi_indices<D>(order).size());
  std::vector<double*> out;
  for (Points& derivative : result.derivatives) {
    derivative.resize(points, 3);
    out.push_back(derivative.data());
  }
  return out;
}

template <int D>
std::vector<double*> detail::checked_memory(DerivativeMemory memory, [[maybe_unused]] int order,
                                            [[maybe_unused]] Eigen::Index points) {
  assert(memory.size() == multi_indices<D>(order).size());
  std::vector<double*> out;
  for (const std::span<double> part : memory) {
    assert(std::ssize(part) == 3 * points);
    out.push_back(part.data());
  }
  return out;
}

template <int D>
Expected<void> evaluate(const Spline<D>& spline, const std::array<const BasisTable*, D>& tables,
                        int order, Evaluation<D>& result) {
  return write_points<D>(spline, tables, order,
                         detail::memory_of<D>(result, order, tables[0]->size()));
}

template <int D>
Expected<void> evaluate_into(const Spline<D>& spline,
                             const std::array<const BasisTable*, D>& tables, int order,
                             DerivativeMemory out) {
  return write_points<D>(spline, tables, order,
                         detail::checked_memory<D>(out, order, tables[0]->size()));
}

template <int D>
Expected<Evaluation<D>> evaluate(const Spline<D>& spline, const Parameters<D>& parameters,
                                 int order, Side side) {
  std::array<BasisTable, D> tables;
  std::array<const BasisTable*, D> pointers;
  for (std::size_t d = 0; d < D; ++d) {
    const Eigen::VectorXd column = parameters.col(static_cast<Eigen::Index>(d));
    auto table = tabulate_basis(
        spline.knots()[d], {column.data(), static_cast<std::size_t>(column.size())}, order, side);
    if (!table) return std::unexpected(table.error().within(fmt::format("direction {}", d)));
    tables[d] = std::move(*table);
    pointers[d] = &tables[d];
  }
  Evaluation<D> result;
  auto status = evaluate<D>(spline, pointers, order, result);
  if (!status) return std::unexpected(std::move(status.error()));
  return result;
}

template <int D>
Expected<Point> evaluate_point(const Spline<D>& spline, std::array<double, D> u) {
  Parameters<D> parameters(1, D);
  for (int d = 0; d < D; ++d) parameters(0, d) = u[static_cast<std::size_t>(d)];
  auto result = evaluate<D>(spline, parameters);
  if (!result) return std::unexpected(result.error());
  return Point(result->points().row(0).transpose());
}

#define KNEAD_INSTANTIATE(D)                                                                       \
  template std::vector<MultiIndex<D>> multi_indices<D>(int);                                       \
  template int multi_index_position<D>(MultiIndex<D>);                                             \
  template Expected<void> evaluate<D>(const Spline<D>&, const std::array<const BasisTable*, D>&,   \
                                      int, Evaluation<D>&);                                        \
  template Expected<void> evaluate_into<D>(                                                        \
      const Spline<D>&, const std::array<const BasisTable*, D>&, int, DerivativeMemory);           \
  template std::vector<double*> detail::memory_of<D>(Evaluation<D>&, int, Eigen::Index);           \
  template std::vector<double*> detail::checked_memory<D>(DerivativeMemory, int, Eigen::Index);    \
  template Expected<Evaluation<D>> evaluate<D>(const Spline<D>&, const Parameters<D>&, int, Side); \
  template Expected<Point> evaluate_point<D>(const Spline<D>&, std::array<double, D>);
KNEAD_INSTANTIATE(1)
KNEAD_INSTANTIATE(2)
KNEAD_INSTANTIATE(3)
#undef KNEAD_INSTANTIATE

}  // namespace knead
