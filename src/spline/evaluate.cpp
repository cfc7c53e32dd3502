#include "knead/spline/evaluate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace knead {
namespace {

constexpr double binomial_table_limit = 2 * max_degree;

double binomial(int n, int k) {
  assert(n <= binomial_table_limit);
  double value = 1;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return std::round(value);
}

template <int D>
void append_indices(MultiIndex<D>& a, std::size_t direction, int left, std::vector<MultiIndex<D>>& out) {
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

/// Homogeneous derivatives at one point: `width` numbers (wx, wy, wz, w, or x, y, z) for each multi-index. Rows of a
/// tensor-product net are contracted direction by direction, the first one outermost.
template <int D>
class Contraction {
 public:
  Contraction(const Spline<D>& spline, int order)
      : net_(spline.net()), order_(order), width_(spline.rational() ? 4 : 3), indices_(multi_indices<D>(order)) {
    const auto n = static_cast<std::size_t>(spline.size()), w = static_cast<std::size_t>(width_);
    if (spline.rational()) {
      homogeneous_.resize(n * w);
      for (std::size_t i = 0; i < n; ++i) {
        const double weight = spline.weights()[i];
        for (int c = 0; c < 3; ++c) {
          homogeneous_[i * w + static_cast<std::size_t>(c)] =
              weight * spline.control_points()(static_cast<Eigen::Index>(i), c);
        }
        homogeneous_[i * w + 3] = weight;
      }
      data_ = homogeneous_.data();
    } else {
      data_ = spline.control_points().data();
    }
    std::size_t block = w;
    for (std::size_t d = D; d-- > 0;) {
      stride_[d] = block;
      block *= static_cast<std::size_t>(net_[d]);
    }
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] const std::vector<MultiIndex<D>>& indices() const { return indices_; }
  [[nodiscard]] std::size_t stride(std::size_t direction) const { return stride_[direction]; }
  [[nodiscard]] const double* data() const { return data_; }

  /// out[k · width + c] for multi-index k at the point number `at[d]` of table d.
  void point(const std::array<const BasisTable*, D>& tables, const std::array<int, D>& at, double* out) const {
    for (std::size_t k = 0; k < indices_.size(); ++k) {
      double sum[4] = {0, 0, 0, 0};
      accumulate(tables, at, indices_[k], 0, data_, 1.0, sum);
      std::copy_n(sum, width_, out + k * static_cast<std::size_t>(width_));
    }
  }

 private:
  void accumulate(const std::array<const BasisTable*, D>& tables, const std::array<int, D>& at, const MultiIndex<D>& a,
                  std::size_t d, const double* net, double factor, double* sum) const {
    const BasisTable& table = *tables[d];
    const auto k = static_cast<std::size_t>(at[d]);
    const double* values = table.row(at[d], a[d]);
    const double* from = net + static_cast<std::size_t>(table.first[k]) * stride_[d];
    for (int r = 0; r <= table.degree; ++r, from += stride_[d]) {
      const double product = factor * values[r];
      if (d + 1 == D) {
        for (int c = 0; c < width_; ++c) sum[c] += product * from[c];
      } else {
        accumulate(tables, at, a, d + 1, from, product, sum);
      }
    }
  }

  std::array<int, D> net_;
  int order_, width_;
  std::vector<MultiIndex<D>> indices_;
  std::vector<double> homogeneous_;
  const double* data_ = nullptr;
  std::array<std::size_t, D> stride_{};
};

/// Writes the Cartesian derivatives of one point from the homogeneous ones; false where the denominator is not
/// positive.
template <int D>
bool project(const std::vector<MultiIndex<D>>& indices, int width, const double* homogeneous, Eigen::Index row,
             std::vector<Points>& out) {
  if (width == 3) {
    for (std::size_t k = 0; k < indices.size(); ++k) {
      for (int c = 0; c < 3; ++c) out[k](row, c) = homogeneous[k * 3 + static_cast<std::size_t>(c)];
    }
    return true;
  }
  const double denominator = homogeneous[3];
  if (!(denominator > 0)) return false;
  // The NURBS Book, Eq. 4.20: ∂^a S = (∂^a A − Σ_{0 < b <= a} binom(a, b) ∂^b w ∂^{a−b} S) / w.
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const MultiIndex<D>& a = indices[k];
    double value[3];
    for (std::size_t c = 0; c < 3; ++c) value[c] = homogeneous[k * 4 + c];
    for (std::size_t l = 1; l <= k; ++l) {
      const MultiIndex<D>& b = indices[l];
      MultiIndex<D> rest;
      double factor = homogeneous[l * 4 + 3];
      bool below = true;
      for (std::size_t d = 0; d < D; ++d) {
        rest[d] = a[d] - b[d];
        below = below && rest[d] >= 0;
        if (below) factor *= binomial(a[d], b[d]);
      }
      if (!below) continue;
      const Points& lower = out[static_cast<std::size_t>(multi_index_position<D>(rest))];
      for (int c = 0; c < 3; ++c) value[c] -= factor * lower(row, c);
    }
    for (int c = 0; c < 3; ++c) out[k](row, c) = value[c] / denominator;
  }
  return true;
}

std::unexpected<Error> bad_denominator() {
  return numerical_error("the rational denominator is not positive", "evaluation", "use positive weights");
}

template <int D>
Evaluation<D> empty_evaluation(int order, Eigen::Index rows) {
  Evaluation<D> result{order, {}};
  result.derivatives.assign(multi_indices<D>(order).size(), Points(rows, 3));
  return result;
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
  // Indices of smaller total order, then those of the same order whose first entry is larger, direction by direction.
  int position = 0, total = 0;
  for (std::size_t d = D; d-- > 0;) {
    total += a[d];
    const int variables = D - static_cast<int>(d);
    position += static_cast<int>(binomial(total - 1 + variables, variables));
  }
  return position;
}

template <int D>
Expected<Evaluation<D>> evaluate(const Spline<D>& spline, const Parameters<D>& parameters, int order, Side side) {
  std::array<BasisTable, D> tables;
  std::array<const BasisTable*, D> pointers;
  for (std::size_t d = 0; d < D; ++d) {
    const Eigen::VectorXd column = parameters.col(static_cast<Eigen::Index>(d));
    auto table =
        tabulate_basis(spline.knots()[d], {column.data(), static_cast<std::size_t>(column.size())}, order, side);
    if (!table) return std::unexpected(table.error().within(fmt::format("direction {}", d)));
    tables[d] = std::move(*table);
    pointers[d] = &tables[d];
  }
  const Contraction<D> contraction(spline, order);
  auto result = empty_evaluation<D>(order, parameters.rows());
  std::vector<double> homogeneous(contraction.indices().size() * static_cast<std::size_t>(contraction.width()));
  for (Eigen::Index row = 0; row < parameters.rows(); ++row) {
    std::array<int, D> at;
    at.fill(static_cast<int>(row));
    contraction.point(pointers, at, homogeneous.data());
    if (!project<D>(contraction.indices(), contraction.width(), homogeneous.data(), row, result.derivatives)) {
      return bad_denominator();
    }
  }
  return result;
}

namespace {

/// Contracts the net along direction `d` at every parameter of its table and goes on with the smaller net that is left;
/// `a` collects the derivative orders chosen so far.
template <int D>
struct GridWalk {
  const std::array<const BasisTable*, D>& tables;
  const Contraction<D>& contraction;
  int order;
  std::vector<std::vector<double>>& homogeneous;  // per multi-index, N × width

  void walk(std::size_t d, const double* net, MultiIndex<D>& a, int left, std::size_t row) const {
    const BasisTable& table = *tables[d];
    const std::size_t stride = contraction.stride(d);
    std::vector<double> reduced(d + 1 == D ? 0 : stride);
    for (int k = 0; k < table.size(); ++k) {
      const double* from = net + static_cast<std::size_t>(table.first[static_cast<std::size_t>(k)]) * stride;
      const std::size_t at = row * static_cast<std::size_t>(table.size()) + static_cast<std::size_t>(k);
      for (int m = 0; m <= left; ++m) {
        const double* values = table.row(k, m);
        a[d] = m;
        if (d + 1 == D) {
          const std::size_t width = stride;
          double* to = homogeneous[static_cast<std::size_t>(multi_index_position<D>(a))].data() + at * width;
          for (std::size_t c = 0; c < width; ++c) {
            double sum = 0;
            for (int r = 0; r <= table.degree; ++r) sum += values[r] * from[static_cast<std::size_t>(r) * width + c];
            to[c] = sum;
          }
        } else {
          for (std::size_t c = 0; c < stride; ++c) reduced[c] = values[0] * from[c];
          for (int r = 1; r <= table.degree; ++r) {
            const double* row_from = from + static_cast<std::size_t>(r) * stride;
            for (std::size_t c = 0; c < stride; ++c) reduced[c] += values[r] * row_from[c];
          }
          walk(d + 1, reduced.data(), a, left - m, at);
        }
      }
    }
    a[d] = 0;
  }
};

}  // namespace

template <int D>
Expected<Evaluation<D>> evaluate_grid(const Spline<D>& spline, const std::array<const BasisTable*, D>& tables,
                                      int order) {
  const Contraction<D> contraction(spline, order);
  std::size_t rows = 1;
  for (std::size_t d = 0; d < D; ++d) {
    assert(tables[d]->order >= order && tables[d]->degree == spline.knots()[d].degree());
    rows *= static_cast<std::size_t>(tables[d]->size());
  }
  const auto width = static_cast<std::size_t>(contraction.width());
  std::vector<std::vector<double>> homogeneous(contraction.indices().size(), std::vector<double>(rows * width));
  MultiIndex<D> a{};
  GridWalk<D>{tables, contraction, order, homogeneous}.walk(0, contraction.data(), a, order, 0);

  auto result = empty_evaluation<D>(order, static_cast<Eigen::Index>(rows));
  if (!spline.rational()) {
    for (std::size_t k = 0; k < homogeneous.size(); ++k) {
      std::copy(homogeneous[k].begin(), homogeneous[k].end(), result.derivatives[k].data());
    }
    return result;
  }
  std::vector<double> point(homogeneous.size() * width);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t k = 0; k < homogeneous.size(); ++k) {
      std::copy_n(homogeneous[k].data() + row * width, width, point.data() + k * width);
    }
    if (!project<D>(contraction.indices(), contraction.width(), point.data(), static_cast<Eigen::Index>(row),
                    result.derivatives)) {
      return bad_denominator();
    }
  }
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

template <int D>
Expected<Point> evaluate_point(const Spline<D>& spline, std::array<double, D> u) {
  Parameters<D> parameters(1, D);
  for (int d = 0; d < D; ++d) parameters(0, d) = u[static_cast<std::size_t>(d)];
  auto result = evaluate<D>(spline, parameters);
  if (!result) return std::unexpected(result.error());
  return Point(result->points().row(0).transpose());
}

#define KNEAD_INSTANTIATE(D)                                                                                         \
  template std::vector<MultiIndex<D>> multi_indices<D>(int);                                                         \
  template int multi_index_position<D>(MultiIndex<D>);                                                               \
  template Expected<Evaluation<D>> evaluate<D>(const Spline<D>&, const Parameters<D>&, int, Side);                   \
  template Expected<Evaluation<D>> evaluate_grid<D>(const Spline<D>&, const std::array<const BasisTable*, D>&, int); \
  template Expected<Evaluation<D>> evaluate_grid<D>(const Spline<D>&, const std::array<std::span<const double>, D>&, \
                                                    int, Side);                                                      \
  template Expected<Point> evaluate_point<D>(const Spline<D>&, std::array<double, D>);
KNEAD_INSTANTIATE(1)
KNEAD_INSTANTIATE(2)
KNEAD_INSTANTIATE(3)
#undef KNEAD_INSTANTIATE

}  // namespace knead
