#pragma once

#include <array>
#include <vector>

#include "homogeneous.hpp"
#include "knead/spline/basis.hpp"

namespace knead::detail {

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
  LocalContraction(const HomogeneousNet<D>& net, const std::array<const BasisTable*, D>& tables,
                   int order)
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

  const HomogeneousNet<D>& net_;
  const std::array<const BasisTable*, D>& tables_;
  int order_;
  std::vector<double>
      local_;  ///< of volumes, whose lines are not in one place, and of nets left apart
  std::array<std::vector<double>, D> reduced_;  ///< the remainder after direction d
};

}  // namespace knead::detail
