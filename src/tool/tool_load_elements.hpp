#pragma once

#include "tool_load.hpp"

namespace knead {

/// The Gauss points of one span per direction, the first control points that affect it, and the
/// span's number.
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
    e.first[d] = starts_[d][span[d]];
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

/// Its number, in the order of `for_each_element`.
template <int D>
int ToolLoad<D>::number(const Element& element) const {
  int result = 0;
  for (std::size_t d = 0; d < D; ++d)
    result = result * static_cast<int>(starts_[d].size()) + element.span[d];
  return result;
}

/// The place of a Gauss point among those of its element.
template <int D>
std::ptrdiff_t ToolLoad<D>::index(const Element& element, const std::array<int, 3>& at) {
  std::ptrdiff_t result = 0;
  for (std::size_t d = 0; d < D; ++d)
    result = result * (element.end[d] - element.begin[d]) + at[d] - element.begin[d];
  return result;
}

template <int D>
std::ptrdiff_t ToolLoad<D>::points(const Element& element) {
  std::ptrdiff_t result = 1;
  for (std::size_t d = 0; d < D; ++d) result *= element.end[d] - element.begin[d];
  return result;
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
void ToolLoad<D>::for_each_element(const std::array<std::size_t, D>& begin,
                                   const std::array<std::size_t, D>& end, const F& f) const {
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

/// f(its first control point) for every line, along the last direction, of the control points of an
/// element.
template <int D>
template <class F>
void ToolLoad<D>::for_each_line(const std::array<int, D>& first, const F& f) const {
  const auto direction = [&](auto self, std::size_t d, std::ptrdiff_t row) -> void {
    const std::ptrdiff_t base = row * net_[d] + first[d];
    if (d + 1 == D) return f(base);
    for (int r = 0; r <= quadrature_[d].basis.degree; ++r) self(self, d + 1, base + r);
  };
  direction(direction, 0, 0);
}

/// The values of the basis functions of direction d at one Gauss point, or at the visible part of
/// its cell.
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

/// f(row of the control point, value of its basis function times its weight) at one Gauss point, or
/// at the visible part of its cell.
template <int D>
template <class F>
void ToolLoad<D>::for_each_function(const std::array<int, 3>& at, int part, const F& f) const {
  const auto direction = [&](auto self, std::size_t d, int row, double product) -> void {
    const BasisTable& table = quadrature_[d].basis;
    const double* n = values(at, part, d);
    const int base = row * net_[d] + table.first[static_cast<std::size_t>(at[d])];
    for (int r = 0; r <= table.degree; ++r) {
      if (d + 1 == D) {
        f(base + r, weights_.empty()
                        ? product * n[r]
                        : product * n[r] * weights_[static_cast<std::size_t>(base + r)]);
      } else {
        self(self, d + 1, base + r, product * n[r]);
      }
    }
  };
  direction(direction, 0, 0, 1.0);
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

/// What stands for a Gauss point where edges cut its cell: a visible part of that.
template <int D>
typename ToolLoad<D>::Sample ToolLoad<D>::visible_part(const Sample& whole, int part,
                                                       const Points& x, int first) const {
  Sample s = whole;
  s.part = part;
  s.weight *= mask_->cut_cells()[static_cast<std::size_t>(part)].share;
  double denominator = 0;
  s.place.setZero();
  for_each_function(s.at, s.part, [&](int row, double n) {
    denominator += n;
    s.place += n * x.row(first + row).transpose();
  });
  s.inverse = weights_.empty() ? 1 : 1 / denominator;
  s.place *= s.inverse;
  return s;
}

/// f(sample) for what stands for a Gauss point of an element that edges cut: the point, the visible
/// part of its cell, or nothing.
template <int D>
template <class F>
void ToolLoad<D>::for_what_is_seen(const Sample& whole, const Points& x, int first,
                                   const F& f) const {
  const int state = mask_->state(whole.at[0], whole.at[1]);
  if (state == VisibleMask::full) f(whole);
  if (state >= 0) f(visible_part(whole, state, x, first));
}

}  // namespace knead
