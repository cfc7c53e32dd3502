#include "knead/spline/evaluate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "base/parallel_for.hpp"
#include "homogeneous.hpp"
#include "local_contraction.hpp"
#include "point_evaluator.hpp"

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
    detail::LocalContraction<D> contraction(net, tables, order);
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
  detail::PointEvaluator<D> point(spline, 0);
  if (auto status = point.at(u); !status) return std::unexpected(std::move(status.error()));
  return point.derivative(0);
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
