#include "knead/spline/basis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/gauss_legendre.hpp"
#include "base/parallel_for.hpp"

namespace knead {
namespace {

constexpr int max_order = max_degree + 1;

/// The triangle of A2.3: ndu[j][r], r <= j, holds N_{s-j+r,j}(u); ndu[r][j], r < j, the knot
/// difference used to compute it. `Fixed` is the degree if known at compile time, else −1 and `p`
/// is it.
template <int Fixed>
void fill_triangle(const double* knots, int p, double u, double ndu[max_order][max_order]) {
  if constexpr (Fixed >= 0) p = Fixed;
  double left[max_order], right[max_order];
  ndu[0][0] = 1;
  for (int j = 1; j <= p; ++j) {
    left[j] = u - knots[1 - j];
    right[j] = knots[j] - u;
    double saved = 0;
    for (int r = 0; r < j; ++r) {
      // Positive: the difference of two knots on either side of a span of positive length.
      const double difference = knots[r + 1] - knots[1 - j + r];
      ndu[r][j] = difference;
      const double quotient = ndu[j - 1][r] / difference;
      ndu[j][r] = saved + right[r + 1] * quotient;
      saved = left[j - r] * quotient;
    }
    ndu[j][j] = saved;
  }
}

void fill_triangle(const KnotVector& knots, int span, double u, double ndu[max_order][max_order]) {
  const double* const here = knots.knots().data() + span;
  const int p = knots.degree();
  switch (p) {
    case 2:
      return fill_triangle<2>(here, p, u, ndu);
    case 3:
      return fill_triangle<3>(here, p, u, ndu);
    default:
      return fill_triangle<-1>(here, p, u, ndu);
  }
}

/// N'_{s-p+r,p}, r = 0 … p: what A2.3 computes for k = 1, every reciprocal once instead of twice.
void first_derivatives(int p, const double ndu[max_order][max_order], double* out) {
  double before = 0;
  for (int r = 0; r <= p; ++r) {
    double d = before;
    if (r < p) {
      before = 1 / ndu[r][p] * ndu[p - 1][r];
      d -= before;
    }
    out[r] = p * d;
  }
}

}  // namespace

void basis_values(const KnotVector& knots, int span, double u, double* out) {
  double ndu[max_order][max_order];
  fill_triangle(knots, span, u, ndu);
  std::copy_n(ndu[knots.degree()], knots.degree() + 1, out);
}

void basis_derivatives(const KnotVector& knots, int span, double u, int order, double* out) {
  const int p = knots.degree(), width = p + 1;
  assert(knots[span] < knots[span + 1]);
  double ndu[max_order][max_order];
  fill_triangle(knots, span, u, ndu);
  std::copy_n(ndu[p], width, out);
  std::fill(out + width, out + static_cast<std::ptrdiff_t>(width) * (order + 1), 0.0);

  const int highest = std::min(order, p);
  if (highest == 1) return first_derivatives(p, ndu, out + width);
  double a[2][max_order];
  for (int r = 0; r <= p; ++r) {
    int s1 = 0, s2 = 1;
    a[0][0] = 1;
    double factor = 1;
    for (int k = 1; k <= highest; ++k) {
      factor *= p - k + 1;
      double d = 0;
      const int rk = r - k, pk = p - k;
      if (rk >= 0) {
        a[s2][0] = a[s1][0] / ndu[rk][pk + 1];
        d = a[s2][0] * ndu[pk][rk];
      }
      const int j1 = rk >= -1 ? 1 : -rk;
      const int j2 = r - 1 <= pk ? k - 1 : p - r;
      for (int j = j1; j <= j2; ++j) {
        a[s2][j] = (a[s1][j] - a[s1][j - 1]) / ndu[rk + j][pk + 1];
        d += a[s2][j] * ndu[pk][rk + j];
      }
      if (r <= pk) {
        a[s2][k] = -a[s1][k - 1] / ndu[r][pk + 1];
        d += a[s2][k] * ndu[pk][r];
      }
      out[k * width + r] = factor * d;
      std::swap(s1, s2);
    }
  }
}

Expected<BasisTable> tabulate_basis(const KnotVector& knots, std::span<const double> parameters,
                                    int order, Side side) {
  if (order < 0) return usage_error(fmt::format("the derivative order {} is negative", order));
  const Interval domain = knots.domain();
  BasisTable table{knots.degree(), order, std::vector<int>(parameters.size()), {}};
  const std::size_t stride =
      static_cast<std::size_t>(order + 1) * static_cast<std::size_t>(knots.degree() + 1);
  table.derivatives.resize(parameters.size() * stride);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (domain.contains(parameters[k])) continue;  // which no NaN is
    return input_error(
        fmt::format("{} is outside the domain [{}, {}]", parameters[k], domain.lower, domain.upper),
        fmt::format("parameter {}", k));
  }
  const auto count = static_cast<std::ptrdiff_t>(parameters.size());
  const double work = 3.0 * static_cast<double>(stride) * (knots.degree() + 1);
  detail::parallel_for(
      count, detail::block_size(count, work), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
          const int span = knots.find_span(parameters[k], side);
          table.first[k] = span - knots.degree();
          basis_derivatives(knots, span, parameters[k], order,
                            table.derivatives.data() + k * stride);
        }
      });
  return table;
}

BasisQuadrature gauss_basis(const KnotVector& knots, int points_per_piece, int order,
                            std::span<const int> pieces) {
  const GaussRule rule = gauss_legendre(points_per_piece);
  const std::vector<int> spans = knots.spans();
  assert(pieces.empty() || pieces.size() == spans.size());
  BasisQuadrature result;
  result.basis.degree = knots.degree();
  result.basis.order = order;
  const std::size_t stride =
      static_cast<std::size_t>(order + 1) * static_cast<std::size_t>(knots.degree() + 1);
  for (std::size_t k = 0; k < spans.size(); ++k) {
    const int span = spans[k], count = pieces.empty() ? 1 : pieces[k];
    const double a = knots[span], b = knots[span + 1], half = (b - a) / (2 * count);
    for (int piece = 0; piece < count; ++piece) {
      const double middle = a + half * (2 * piece + 1);
      for (std::size_t g = 0; g < rule.abscissae.size(); ++g) {
        const double u = std::clamp(middle + half * rule.abscissae[g], a, b);
        result.parameters.push_back(u);
        result.weights.push_back(half * rule.weights[g]);
        result.basis.first.push_back(span - knots.degree());
        result.basis.derivatives.resize(result.basis.derivatives.size() + stride);
        basis_derivatives(
            knots, span, u, order,
            result.basis.derivatives.data() + result.basis.derivatives.size() - stride);
      }
    }
  }
  return result;
}

}  // namespace knead
