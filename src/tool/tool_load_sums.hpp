#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "simd/element_kernels.hpp"
#include "tool_load_elements.hpp"

namespace knead {

/// Numbers that stand for the control points of an element or, of some first directions, for one
/// index: by the indices of the other directions but the last, then coordinate, then index of the
/// last. Level d holds those of directions d … D − 1; a line is level D − 1.
template <int D>
class ToolLoad<D>::ElementLevels {
 public:
  /// \param coordinates 3, or 4 of homogeneous coordinates.
  ElementLevels(const ToolLoad& load, std::ptrdiff_t coordinates)
      : functions(load.quadrature_[D - 1].basis.degree + 1),
        load_(load),
        homogeneous_(coordinates == 4) {
    sizes[D - 1] = detail::ElementKernels::rounded_up(coordinates * functions);
    for (std::size_t d = D - 1; d-- > 0;)
      sizes[d] = sizes[d + 1] * (load.quadrature_[d].basis.degree + 1);
    for (std::size_t d = 0; d < D; ++d) numbers[d].resize(static_cast<std::size_t>(sizes[d]));
  }

  [[nodiscard]] double* operator[](std::size_t d) { return numbers[d].data(); }
  [[nodiscard]] const double* operator[](std::size_t d) const { return numbers[d].data(); }
  [[nodiscard]] std::ptrdiff_t line() const { return sizes[D - 1]; }

  /// f(row of its first control point, line of level 0) for the lines of control points from
  /// `first` on.
  template <class F>
  void for_each_line(const std::array<int, D>& first, const F& f) {
    double* line = numbers[0].data();
    load_.for_each_line(first, [&](std::ptrdiff_t row) {
      f(row, line);
      line += this->line();
    });
  }

  /// Fills level 0 with vectors at control points.
  void gather(const std::array<int, D>& first, const double* vectors) {
    for_each_line(first, [&](std::ptrdiff_t row, double* line) {
      const double* from = vectors + 3 * row;
      for (std::ptrdiff_t j = 0; j < functions; ++j, from += 3) {
        for (std::ptrdiff_t c = 0; c < 3; ++c) line[c * functions + j] = from[c];
      }
    });
  }

  /// The box of what was gathered.
  void box(Point& lower, Point& upper) const {
    constexpr auto most =
        static_cast<std::size_t>(detail::ElementKernels::rounded_up(4 * (max_degree + 1)));
    std::array<double, most> least, greatest;
    kernels_.bounds(numbers[0].data(), sizes[0] / line(), line(), least.data(), greatest.data());
    for (std::ptrdiff_t c = 0; c < 3; ++c) {
      lower[c] =
          *std::min_element(least.data() + c * functions, least.data() + (c + 1) * functions);
      upper[c] =
          *std::max_element(greatest.data() + c * functions, greatest.data() + (c + 1) * functions);
    }
  }

  /// Multiplies what was gathered by the weights, which become the fourth coordinate, if there is
  /// one.
  void multiply_by_weights(const std::array<int, D>& first) {
    if (load_.weights_.empty() && !homogeneous_) return;
    for_each_line(first, [&](std::ptrdiff_t row, double* line) {
      for (std::ptrdiff_t j = 0; j < functions; ++j) {
        const double w = load_.weight(row + j);
        for (std::ptrdiff_t c = 0; c < 3; ++c) line[c * functions + j] *= w;
        if (homogeneous_) line[3 * functions + j] = w;
      }
    });
  }

  /// The box of the points of level d.
  void bounds(std::size_t d, Point& lower, Point& upper) const {
    lower.setConstant(std::numeric_limits<double>::infinity());
    upper = -lower;
    for (const double* line = numbers[d].data(); line < numbers[d].data() + sizes[d];
         line += this->line()) {
      for (std::ptrdiff_t j = 0; j < functions; ++j) {
        const double w = homogeneous_ ? line[3 * functions + j] : 1;
        const Point p = Point(line[j], line[functions + j], line[2 * functions + j]) / w;
        lower = lower.cwiseMin(p);
        upper = upper.cwiseMax(p);
      }
    }
  }

  /// The longest step from point to point of a line of three coordinates.
  [[nodiscard]] double longest_step() const {
    const double* line = numbers[D - 1].data();
    double longest = 0;
    for (std::ptrdiff_t j = 1; j < functions; ++j) {
      double squared = 0;
      for (std::ptrdiff_t c = 0; c < 3; ++c) {
        const double step = line[c * functions + j] - line[c * functions + j - 1];
        squared += step * step;
      }
      longest = std::max(longest, squared);
    }
    return std::sqrt(longest);
  }

  std::ptrdiff_t functions;             // of a line
  std::array<std::ptrdiff_t, D> sizes;  // numbers of a level
  std::array<std::vector<double, CacheLineAllocator<double>>, D> numbers;

 private:
  const ToolLoad& load_;
  const detail::ElementKernels& kernels_ = detail::element_kernels();
  bool homogeneous_;
};

/// Where sums over Gauss points stand that are made one direction at a time. Points that agree in
/// their first d indices share what directions d … D−1 of the net have been summed to: with points
/// in the order of `Sweep`, a point costs p + 1 terms and not (p + 1)^D. Any order gives the same
/// sums to rounding.
template <int D>
class ToolLoad<D>::PointSums {
 protected:
  explicit PointSums(const ToolLoad& load) : load_(load), levels_(load, 3) { last_.fill(-1); }

  /// The first direction in which a point differs from the last one; −1: other control points
  /// affect it.
  [[nodiscard]] int differs(const std::array<int, 3>& at) const {
    int first = D;
    for (std::size_t d = D; d-- > 0;) {
      if (at[d] == last_[d]) continue;
      if (last_[d] < 0) return -1;
      const std::vector<int>& starts = load_.quadrature_[d].basis.first;
      if (starts[static_cast<std::size_t>(at[d])] != starts[static_cast<std::size_t>(last_[d])])
        return -1;
      first = static_cast<int>(d);
    }
    return first;
  }

  /// Of the control points that affect the last point, the first in every direction.
  [[nodiscard]] std::array<int, D> first_control_point() const {
    std::array<int, D> first;
    for (std::size_t d = 0; d < D; ++d)
      first[d] = load_.quadrature_[d].basis.first[static_cast<std::size_t>(last_[d])];
    return first;
  }
  /// The values of the functions of direction d at the last point.
  [[nodiscard]] const double* functions(std::size_t d) const {
    return load_.quadrature_[d].basis.row(last_[d], 0);
  }
  [[nodiscard]] std::ptrdiff_t count(std::size_t d) const {
    return load_.quadrature_[d].basis.degree + 1;
  }

  const ToolLoad& load_;
  const detail::ElementKernels& kernels_ = detail::element_kernels();
  ElementLevels levels_;
  std::array<int, D> last_;
};

/// Σ w_i N_i v_i at Gauss points, of vectors v at the control points: rows `first` … of an array.
template <int D>
class ToolLoad<D>::FieldAtPoints : private PointSums {
 public:
  FieldAtPoints(const ToolLoad& load, const Points& v, int first)
      : PointSums(load), v_(v.data() + 3 * static_cast<std::ptrdiff_t>(first)) {}

  [[nodiscard]] Point at(const std::array<int, 3>& at) {
    const int d = this->differs(at);
    std::copy_n(at.begin(), D, this->last_.begin());
    auto& levels = this->levels_;
    const std::ptrdiff_t functions = levels.functions;
    if (d < 0) {
      levels.gather(this->first_control_point(), v_);
      levels.multiply_by_weights(this->first_control_point());
    }
    for (auto e = static_cast<std::size_t>(std::max(d, 0)); e + 1 < D; ++e) {
      this->kernels_.combine(this->functions(e), this->count(e), levels[e], levels.sizes[e + 1],
                             levels[e + 1]);
    }
    const double *n = this->functions(D - 1), *line = levels[D - 1];
    Point sum = Point::Zero();
    for (std::ptrdiff_t j = 0; j < functions; ++j, ++line) {
      sum += n[j] * Point(line[0], line[functions], line[2 * functions]);
    }
    return sum;
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
      if (d + 1 < D && this->last_[0] >= 0) sum_from(d);
      std::copy_n(at.begin(), D, this->last_.begin());
    }
    const std::ptrdiff_t functions = this->levels_.functions;
    const double* n = this->functions(D - 1);
    double* to = this->levels_[D - 1];
    for (Eigen::Index c = 0; c < 3; ++c, to += functions) {
      const double share = factor * f[c];
      for (std::ptrdiff_t j = 0; j < functions; ++j) to[j] += n[j] * share;
    }
  }

 private:
  /// Adds levels behind d to those before; −1: to the control points.
  void sum_from(int d) {
    auto& levels = this->levels_;
    for (std::size_t e = D - 1; e-- > static_cast<std::size_t>(std::max(d, 0));) {
      this->kernels_.spread(this->functions(e), this->count(e), levels[e + 1], levels.sizes[e + 1],
                            levels[e]);
      std::ranges::fill(levels.numbers[e + 1], 0.0);
    }
    if (d >= 0) return;
    const std::ptrdiff_t functions = levels.functions;
    levels.for_each_line(this->first_control_point(), [&](std::ptrdiff_t row, double* line) {
      double* to = to_ + 3 * row;
      for (std::ptrdiff_t j = 0; j < functions; ++j, to += 3) {
        const double w = this->load_.weight(row + j);
        for (std::ptrdiff_t c = 0; c < 3; ++c) to[c] += w * line[c * functions + j];
      }
    });
    std::ranges::fill(levels.numbers[0], 0.0);
  }

  double* to_;
};

}  // namespace knead
