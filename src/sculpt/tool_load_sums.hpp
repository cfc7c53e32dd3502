#pragma once

#include <algorithm>
#include <cstddef>

#include "tool_load_elements.hpp"

namespace knead {

/// Where sums over Gauss points stand that are made one direction at a time. Points that agree in their first d indices
/// share what directions d … D−1 of the net have been summed to: with points in the order of `for_each_point`, a point
/// costs p + 1 terms and not (p + 1)^D. Any order gives the same sums to rounding.
template <int D>
class ToolLoad<D>::PointSums {
 protected:
  explicit PointSums(const ToolLoad& load) : load_(load) {
    sizes_[D] = 1;
    for (std::size_t d = D; d-- > 0;) {
      sizes_[d] = sizes_[d + 1] * static_cast<std::size_t>(load.quadrature_[d].basis.degree + 1);
    }
    for (std::size_t d = 0; d <= D; ++d) level_[d].resize(sizes_[d], Homogeneous{});
    last_.fill(-1);
  }

  /// The first direction in which a point differs from the last one; −1: other control points affect it.
  [[nodiscard]] int differs(const std::array<int, 3>& at) const {
    int first = D;
    for (std::size_t d = D; d-- > 0;) {
      if (at[d] == last_[d]) continue;
      if (last_[d] < 0) return -1;
      const std::vector<int>& starts = load_.quadrature_[d].basis.first;
      if (starts[static_cast<std::size_t>(at[d])] != starts[static_cast<std::size_t>(last_[d])]) return -1;
      first = static_cast<int>(d);
    }
    return first;
  }

  /// f(row) for the control points that affect the last point.
  template <class F>
  void for_each_row(const F& f) const {
    Element element;
    for (std::size_t d = 0; d < D; ++d) {
      element.first[d] = load_.quadrature_[d].basis.first[static_cast<std::size_t>(last_[d])];
    }
    load_.for_each_control_point(element, f);
  }

  [[nodiscard]] double weight(int row) const {
    return load_.weights_.empty() ? 1 : load_.weights_[static_cast<std::size_t>(row)];
  }

  const ToolLoad& load_;
  std::array<std::size_t, D + 1> sizes_;
  std::array<std::vector<Homogeneous>, D + 1> level_;  // directions d … D−1 of level d are control points
  std::array<int, D> last_;
};

/// Σ w_i N_i v_i at Gauss points, of vectors v at the control points: rows `first` … of an array.
template <int D>
class ToolLoad<D>::FieldAtPoints : private PointSums {
 public:
  FieldAtPoints(const ToolLoad& load, const Points& v, int first)
      : PointSums(load), v_(v.data() + 3 * static_cast<std::ptrdiff_t>(first)) {}

  [[nodiscard]] Point at(const std::array<int, 3>& at) {
    int d = this->differs(at);
    std::copy_n(at.begin(), D, this->last_.begin());
    if (d < 0) {
      std::size_t to = 0;
      this->for_each_row([&](int row) {
        const double w = this->weight(row), *from = v_ + 3 * static_cast<std::ptrdiff_t>(row);
        this->level_[0][to++] = {w * from[0], w * from[1], w * from[2], 0};
      });
      d = 0;
    }
    for (auto e = static_cast<std::size_t>(d); e < D; ++e) {
      const BasisTable& table = this->load_.quadrature_[e].basis;
      const double* n = table.row(at[e], 0);
      const std::size_t size = this->sizes_[e + 1];
      const Homogeneous* from = this->level_[e].data();
      Homogeneous* to = this->level_[e + 1].data();
      for (std::size_t i = 0; i < size; ++i) {
        Homogeneous sum = {0, 0, 0, 0};
        for (std::size_t r = 0; r <= static_cast<std::size_t>(table.degree); ++r) {
          for (std::size_t c = 0; c < 4; ++c) sum[c] += n[r] * from[r * size + i][c];
        }
        to[i] = sum;
      }
    }
    const Homogeneous& h = this->level_[D][0];
    return {h[0], h[1], h[2]};
  }

 private:
  const double* v_;
};

/// Adds Σ w_i N_i f to the control points, of vectors f at Gauss points. All is added when it ends.
template <int D>
class ToolLoad<D>::ForcesOfPoints : private PointSums {
 public:
  ForcesOfPoints(const ToolLoad& load, int first, Points& to)
      : PointSums(load), to_(to.data() + 3 * static_cast<std::ptrdiff_t>(first)) {}
  ForcesOfPoints(const ForcesOfPoints&) = delete;
  ForcesOfPoints& operator=(const ForcesOfPoints&) = delete;
  ~ForcesOfPoints() {
    if (this->last_[0] >= 0) sum_from(-1);
  }

  void add(const std::array<int, 3>& at, double factor, const Point& f) {
    const int d = this->differs(at);
    if (d < D) {
      if (this->last_[0] >= 0) sum_from(d);
      std::copy_n(at.begin(), D, this->last_.begin());
    }
    Homogeneous& here = this->level_[D][0];
    for (std::size_t c = 0; c < 3; ++c) here[c] += factor * f[static_cast<Eigen::Index>(c)];
  }

 private:
  /// Adds levels behind d to those before; −1: to the control points.
  void sum_from(int d) {
    for (std::size_t e = D; e-- > static_cast<std::size_t>(std::max(d, 0));) {
      const BasisTable& table = this->load_.quadrature_[e].basis;
      const double* n = table.row(this->last_[e], 0);
      const std::size_t size = this->sizes_[e + 1];
      Homogeneous* from = this->level_[e + 1].data();
      Homogeneous* to = this->level_[e].data();
      for (std::size_t r = 0; r <= static_cast<std::size_t>(table.degree); ++r) {
        for (std::size_t i = 0; i < size; ++i) {
          for (std::size_t c = 0; c < 4; ++c) to[r * size + i][c] += n[r] * from[i][c];
        }
      }
      std::fill_n(from, size, Homogeneous{});
    }
    if (d >= 0) return;
    std::size_t from = 0;
    this->for_each_row([&](int row) {
      const double w = this->weight(row);
      const Homogeneous& h = this->level_[0][from++];
      double* to = to_ + 3 * static_cast<std::ptrdiff_t>(row);
      for (std::size_t c = 0; c < 3; ++c) to[c] += w * h[c];
    });
    std::ranges::fill(this->level_[0], Homogeneous{});
  }

  double* to_;
};

}  // namespace knead
