#pragma once

#include <algorithm>
#include <limits>

#include "tool_load.hpp"

namespace knead {

/// The Gauss points of one span per direction, the first control points it sees, and the span's number.
template <int D>
struct ToolLoad<D>::Element {
  std::array<int, D> begin, end, first, span;
};

template <int D>
template <class F>
void ToolLoad<D>::for_each_element(const F& f) const {
  std::array<std::size_t, D> k{};
  while (true) {
    Element e;
    for (std::size_t d = 0; d < D; ++d) {
      e.begin[d] = spans_[d][k[d]];
      e.end[d] = spans_[d][k[d] + 1];
      e.first[d] = quadrature_[d].basis.first[static_cast<std::size_t>(e.begin[d])];
      e.span[d] = static_cast<int>(k[d]);
    }
    f(e);
    std::size_t d = D;
    while (d-- > 0) {
      if (++k[d] + 1 < spans_[d].size()) break;
      k[d] = 0;
      if (d == 0) return;
    }
  }
}

/// f(row) for every control point that the element sees.
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

}  // namespace knead
