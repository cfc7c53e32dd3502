#pragma once

#include <algorithm>
#include <bit>

#include "base/interruption.hpp"
#include "tool_load_sums.hpp"

namespace knead {

/// The Gauss points of one element after another, from control points contracted one direction at a
/// time, of a rational spline in homogeneous coordinates.
template <int D>
class ToolLoad<D>::Sweep {
 public:
  /// \param x all points; those of the patch are rows `first` …
  Sweep(const ToolLoad& load, const Points& x, int first)
      : load_(load),
        x_(x.data() + 3 * static_cast<std::ptrdiff_t>(first)),
        rational_(!load.weights_.empty()),
        levels_(load, rational_ ? 4 : 3),
        functions_(levels_.functions) {}

  /// Turns to an element, and measures the box of its control points.
  void enter(const Element& element, Point& lower, Point& upper) {
    element_ = element;
    levels_.gather(element.first, x_);
    levels_.box(lower, upper);
    levels_.multiply_by_weights(element.first);
  }

  /// `visitor` is asked
  ///   skip(lower, upper): whether a row or a layer of points, whose control points lie in a box,
  ///   may be left out; only
  ///     where points are more than twice as many as control points, else asking takes as long;
  ///   reached(places, count): at which of some points, a bit each, it wants to
  ///   act(sample), which returns how far around no point is acted on: points of a polynomial
  ///   within that are left out; clear(place): the same where it did not want to act.
  template <class Visitor>
  void run(Visitor& visitor) {
    std::size_t points = 1, controls = 1;
    for (std::size_t d = D; d-- > 0;) {
      points *= static_cast<std::size_t>(element_.end[d] - element_.begin[d]);
      controls *= static_cast<std::size_t>(load_.quadrature_[d].basis.degree + 1);
      asked_[d] = d > 0 && load_.in_hull_ && points > 2 * controls;
    }
    descend(0, 1.0, visitor);
  }

 private:
  using Kernels = detail::ElementKernels;

  /// The points below one of direction d − 1, whose control points level d holds.
  template <class Visitor>
  void descend(std::size_t d, double weight, Visitor& visitor) {
    if (asked_[d] && skips(d, visitor)) return;
    if (d + 1 == D) return run_along_line(weight, visitor);
    const BasisQuadrature& q = load_.quadrature_[d];
    const std::ptrdiff_t count = q.basis.degree + 1;
    for (int k = element_.begin[d]; k < element_.end[d]; ++k) {
      sample_.at[d] = k;
      kernels_.combine(q.basis.row(k, 0), count, levels_[d], levels_.sizes[d + 1], levels_[d + 1]);
      descend(d + 1, weight * q.weights[static_cast<std::size_t>(k)], visitor);
    }
  }

  template <class Visitor>
  [[nodiscard]] bool skips(std::size_t d, const Visitor& visitor) const {
    Point lower, upper;
    levels_.bounds(d, lower, upper);
    return visitor.skip(lower, upper);
  }

  template <class Visitor>
  void run_along_line(double weight, Visitor& visitor) {
    constexpr std::size_t d = D - 1;
    const int begin = element_.begin[d], end = element_.end[d];
    const TransposedBasis& basis = load_.transposed_[static_cast<std::size_t>(element_.span[d])];
    double places[4 * Kernels::most_points];
    longest_step_ = -1;
    for (int k = begin; k < end;) {
      const int count = std::min<int>(end - k, Kernels::most_points);
      kernels_.places(levels_[d], rational_, functions_, basis.values.data() + (k - begin),
                      basis.stride, Kernels::rounded_up(count), places);
      const unsigned all = (1U << count) - 1;
      unsigned left = visitor.reached(places, Kernels::rounded_up(count)) & all;
      int next = k + count;
      const bool tell = next < end && !rational_ && (left >> (count - 1) & 1U) == 0;
      if (left != 0 && Interruption::asked_for()) return;
      while (left != 0) {
        const int g = std::countr_zero(left);
        left &= left - 1;
        take_up(k + g, weight, places + g);
        const double clear = visitor.act(sample_);
        if (!(clear > 0) || rational_) continue;
        const int after = last_within(clear, k + g) + 1;
        next = std::max(next, after);
        left &= after - k > count ? 0U : ~((1U << (after - k)) - 1);
      }
      if (tell && next == k + count) {
        take_up(next - 1, weight, places + count - 1);
        const double clear = visitor.clear(sample_);
        if (clear > 0) next = last_within(clear, next - 1) + 1;
      }
      k = next;
    }
  }

  void take_up(int k, double weight, const double* place) {
    sample_.at[D - 1] = k;
    sample_.weight = weight * load_.quadrature_[D - 1].weights[static_cast<std::size_t>(k)];
    sample_.inverse = rational_ ? place[3 * Kernels::most_points] : 1;
    sample_.place = {place[0], place[Kernels::most_points], place[2 * Kernels::most_points]};
  }

  /// The last point of the line that lies within `clear` of point k.
  [[nodiscard]] int last_within(double clear, int k) {
    constexpr double safe = 1 - 1e-6;
    if (longest_step_ < 0) longest_step_ = levels_.longest_step();
    const std::vector<double>& progress = load_.progress_;
    const double enough = progress[static_cast<std::size_t>(k)] + safe * clear / longest_step_;
    while (k + 1 < element_.end[D - 1] && progress[static_cast<std::size_t>(k + 1)] < enough) ++k;
    return k;
  }

  const ToolLoad& load_;
  const double* x_;
  bool rational_;
  ElementLevels levels_;
  std::ptrdiff_t functions_;     // of a line
  std::array<bool, D> asked_{};  // whether rows of a level may be left out
  double longest_step_ = -1;     // from control point to control point of the line, once known
  Element element_{};
  Sample sample_{};
  const Kernels& kernels_ = detail::element_kernels();
};

}  // namespace knead
