#pragma once

#include <algorithm>
#include <concepts>
#include <limits>
#include <span>

#include "tool_load.hpp"

namespace knead {

/// The Gauss points of one span per direction, the first control points that affect it, and the span's number.
template <int D>
struct ToolLoad<D>::Element {
  std::array<int, D> begin, end, first, span;
};

/// One Gauss point.
template <int D>
struct ToolLoad<D>::Sample {
  std::array<int, 3> at{};
  double weight, inverse;  // Gauss weight, 1 / denominator
  Point place;
  int part = -1;  // as in `ContactPoint`
};

template <int D>
typename ToolLoad<D>::Element ToolLoad<D>::element(std::array<std::size_t, D> span) const {
  Element e;
  for (std::size_t d = 0; d < D; ++d) {
    e.begin[d] = spans_[d][span[d]];
    e.end[d] = spans_[d][span[d] + 1];
    e.first[d] = quadrature_[d].basis.first[static_cast<std::size_t>(e.begin[d])];
    e.span[d] = static_cast<int>(span[d]);
  }
  return e;
}

/// By its number, in the order of `for_each_element`.
template <int D>
typename ToolLoad<D>::Element ToolLoad<D>::element(int number) const {
  std::array<std::size_t, D> span;
  auto rest = static_cast<std::size_t>(number);
  for (std::size_t d = D; d-- > 0;) {
    const std::size_t count = spans_[d].size() - 1;
    span[d] = rest % count;
    rest /= count;
  }
  return element(span);
}

template <int D>
template <class F>
void ToolLoad<D>::for_each_element(const F& f) const {
  std::array<std::size_t, D> end;
  for (std::size_t d = 0; d < D; ++d) end[d] = spans_[d].size() - 1;
  for_each_element({}, end, f);
}

/// The same for the spans from `begin` to before `end` in every direction.
template <int D>
template <class F>
void ToolLoad<D>::for_each_element(const std::array<std::size_t, D>& begin, const std::array<std::size_t, D>& end,
                                   const F& f) const {
  for (std::size_t d = 0; d < D; ++d) {
    if (begin[d] >= end[d]) return;
  }
  std::array<std::size_t, D> k = begin;
  while (true) {
    f(element(k));
    std::size_t d = D;
    while (d-- > 0) {
      if (++k[d] < end[d]) break;
      k[d] = begin[d];
      if (d == 0) return;
    }
  }
}

/// f(row) for every control point that affects the element.
template <int D>
template <class F>
void ToolLoad<D>::for_each_control_point(const Element& element, const F& f) const {
  const auto direction = [&](auto self, std::size_t d, int row) -> void {
    const int base = row * net_[d] + element.first[d];
    for (int r = 0; r <= quadrature_[d].basis.degree; ++r) {
      if (d + 1 < D) {
        self(self, d + 1, base + r);
      } else {
        f(base + r);
      }
    }
  };
  direction(direction, 0, 0);
}

template <int D>
void ToolLoad<D>::box_of(const Element& element, const Points& x, int first, Point& lower, Point& upper) const {
  lower.setConstant(std::numeric_limits<double>::infinity());
  upper = -lower;
  for_each_control_point(element, [&](int row) {
    const double* p = x.data() + 3 * static_cast<std::ptrdiff_t>(first + row);
    for (int c = 0; c < 3; ++c) {
      lower[c] = std::min(lower[c], p[c]);
      upper[c] = std::max(upper[c], p[c]);
    }
  });
}

/// The values of the basis functions of direction d at one Gauss point, or at the visible part of its cell.
template <int D>
const double* ToolLoad<D>::values(const std::array<int, 3>& at, int part, std::size_t d) const {
  if (part < 0) return quadrature_[d].basis.row(at[d], 0);
  std::size_t width = 0, before = 0;
  for (std::size_t e = 0; e < D; ++e) {
    if (e == d) before = width;
    width += static_cast<std::size_t>(quadrature_[e].basis.degree + 1);
  }
  return part_values_.data() + static_cast<std::size_t>(part) * width + before;
}

/// f(row of the control point, value of its basis function times its weight) at one Gauss point, or at the visible part
/// of its cell.
template <int D>
template <class F>
void ToolLoad<D>::for_each_function(const std::array<int, 3>& at, int part, const F& f) const {
  const auto direction = [&](auto self, std::size_t d, int row, double product) -> void {
    const BasisTable& table = quadrature_[d].basis;
    const double* n = values(at, part, d);
    const int base = row * net_[d] + table.first[static_cast<std::size_t>(at[d])];
    for (int r = 0; r <= table.degree; ++r) {
      if (d + 1 == D) {
        f(base + r, weights_.empty() ? product * n[r] : product * n[r] * weights_[static_cast<std::size_t>(base + r)]);
      } else {
        self(self, d + 1, base + r, product * n[r]);
      }
    }
  };
  direction(direction, 0, 0, 1.0);
}

/// The longest step between neighbours in a row of control points.
template <int D>
double ToolLoad<D>::longest_step(std::span<const Homogeneous> row) {
  double longest = 0;
  for (std::size_t r = 1; r < row.size(); ++r) {
    double squared = 0;
    for (std::size_t c = 0; c < 3; ++c) squared += (row[r][c] - row[r - 1][c]) * (row[r][c] - row[r - 1][c]);
    longest = std::max(longest, squared);
  }
  return std::sqrt(longest);
}

/// The last of the points k … end − 1 in a row of direction d that lies within `clear` of point k, in one span.
template <int D>
int ToolLoad<D>::last_within(double clear, std::size_t d, int k, int end, std::span<const Homogeneous> row) const {
  constexpr double safe = 1 - 1e-6;
  const double enough = progress_[d][static_cast<std::size_t>(k)] + safe * clear / longest_step(row);
  while (k + 1 < end && progress_[d][static_cast<std::size_t>(k + 1)] < enough) ++k;
  return k;
}

/// f(sample) for every Gauss point of the element. The control points, homogeneous, are contracted one direction at a
/// time. Left out are the points of a row or a layer if skip(its control points) is true; it is asked only where
/// weights are positive, and where points are more than twice as many as control points: else asking takes as long.
/// Left out, too, are points of a polynomial within the distance that f(sample) returns.
template <int D>
template <class F, class Skip>
void ToolLoad<D>::for_each_point(const Element& element, const Points& x, int first, Workspace& workspace, const F& f,
                                 const Skip& skip) const {
  std::array<std::size_t, D + 1> sizes;
  sizes[D] = 1;
  for (std::size_t d = D; d-- > 0;) sizes[d] = sizes[d + 1] * static_cast<std::size_t>(quadrature_[d].basis.degree + 1);
  std::array<bool, D + 1> asked{};  // in row d
  if constexpr (!std::same_as<Skip, KeepAll>) {
    std::size_t points = 1;
    for (std::size_t d = D; d-- > 1;) {
      points *= static_cast<std::size_t>(element.end[d] - element.begin[d]);
      asked[d] = in_hull_ && points > 2 * sizes[d];
    }
    if (std::ranges::find(asked, true) == asked.end()) return for_each_point(element, x, first, workspace, f);
  }
  auto& level = workspace;  // level[d]: directions d … D−1 are still control points
  for (std::size_t d = 0; d <= D; ++d) level[d].resize(sizes[d]);
  std::size_t to = 0;
  for_each_control_point(element, [&](int row) {
    const double w = weights_.empty() ? 1 : weights_[static_cast<std::size_t>(row)];
    const double* p = x.data() + 3 * static_cast<std::ptrdiff_t>(first + row);
    level[0][to++] = {w * p[0], w * p[1], w * p[2], w};
  });
  Sample sample;
  const auto contract = [&](auto self, std::size_t d, double weight) -> double {
    if (d == D) {
      const Homogeneous& h = level[D][0];
      sample.weight = weight;
      sample.inverse = weights_.empty() ? 1 : 1 / h[3];
      sample.place = sample.inverse * Point(h[0], h[1], h[2]);
      return f(sample);
    }
    if constexpr (!std::same_as<Skip, KeepAll>) {
      if (asked[d] && skip(std::span<const Homogeneous>(level[d]))) return 0;
    }
    const BasisQuadrature& q = quadrature_[d];
    for (int k = element.begin[d]; k < element.end[d]; ++k) {
      const double* n = q.basis.row(k, 0);
      sample.at[d] = k;
      for (std::size_t i = 0; i < sizes[d + 1]; ++i) {
        Homogeneous sum = {0, 0, 0, 0};
        for (int r = 0; r <= q.basis.degree; ++r) {
          const Homogeneous& from = level[d][static_cast<std::size_t>(r) * sizes[d + 1] + i];
          for (std::size_t c = 0; c < 4; ++c) sum[c] += n[r] * from[c];
        }
        level[d + 1][i] = sum;
      }
      const double clear = self(self, d + 1, weight * q.weights[static_cast<std::size_t>(k)]);
      if (d + 1 == D && clear > 0 && weights_.empty() && k + 1 < element.end[d])
        k = last_within(clear, d, k, element.end[d], level[d]);
    }
    return 0;
  };
  contract(contract, 0, 1.0);
}

/// `VisibleMask::state` of the element.
template <int D>
int ToolLoad<D>::visibility(const Element& element) const {
  if constexpr (D == 2) {
    return mask_->state(element.begin, element.end);
  } else {
    return VisibleMask::full;
  }
}

/// The same for every visible point, where edges cut the cell of a Gauss point for the visible part of it. What is seen
/// of a cell may lie beside the row of its Gauss point: of an element that edges cut no row is left out.
template <int D>
template <class F, class Skip>
void ToolLoad<D>::for_each_visible_point(const Element& element, const Points& x, int first, Workspace& workspace,
                                         const F& f, const Skip& skip) const {
  const int all = visibility(element);
  if (all == VisibleMask::hidden) return;
  if (all == VisibleMask::full) return for_each_point(element, x, first, workspace, f, skip);
  for_each_point(element, x, first, workspace, [&](const Sample& whole) -> double {
    const int state = mask_->state(whole.at[0], whole.at[1]);
    if (state == VisibleMask::hidden) return 0;
    if (state == VisibleMask::full) f(whole);
    if (state == VisibleMask::full) return 0;
    Sample s = whole;
    s.part = state;
    s.weight *= mask_->parts()[static_cast<std::size_t>(state)].share;
    double denominator = 0;
    s.place.setZero();
    for_each_function(s.at, s.part, [&](int row, double n) {
      denominator += n;
      s.place += n * x.row(first + row).transpose();
    });
    s.inverse = weights_.empty() ? 1 : 1 / denominator;
    s.place *= s.inverse;
    f(s);
    return 0;  // the next point may stand elsewhere than its Gauss point
  });
}

}  // namespace knead
