#pragma once

#include <algorithm>
#include <vector>

#include "span_basis.hpp"

namespace knead::detail {

constexpr int order_limit = max_degree + 1;

/// Repeated integrals and jumps of all basis functions, knot by knot from the left.
template <class Real = double>
class Analytic {
 public:
  explicit Analytic(const KnotVector& knots)
      : knots_(knots), p_(knots.degree()), extended_(knots.knots().begin(), knots.knots().end()) {
    // Thesis Thm 5.2 needs knots extended at the end; any will do, and repetitions of the last keep
    // differences small.
    extended_.insert(extended_.end(), static_cast<std::size_t>(p_ + 2), extended_.back());
  }

  /// Adds the upper half of G^ab: rows i <= columns j.
  template <class Add>
  void accumulate(int a, int b, Add add) {
    const std::vector<int> spans = knots_.spans();
    const Interval domain = knots_.domain();
    // The start of the domain: the functions jump from zero to their values.
    tabulate_values(spans.front(), domain.lower);
    jump(-1, spans.front());
    contribute(spans.front(), a, b, 0, add);
    for (std::size_t k = 0; k < spans.size(); ++k) {
      const int span = spans[k], next = k + 1 < spans.size() ? spans[k + 1] : -1;
      const double u = knots_[span + 1];
      tabulate_values(span, u);
      jump(span, next);
      // A knot of multiplicity m leaves derivatives below p − m + 1 continuous: their computed
      // jumps would be noise.
      contribute(span, a, b, next < 0 ? 0 : std::max(0, p_ - knots_.multiplicity(u) + 1), add);
    }
  }

 private:
  /// values_[q][r] = N_{span-q+r,q}(u) on the extended knots, q = 0 … 2p + 1.
  void tabulate_values(int span, double u) {
    values_[0][0] = 1;
    for (int q = 1; q <= 2 * p_ + 1; ++q) {
      Real saved = 0;
      for (int r = 0; r < q; ++r) {
        // Functions that begin left of the first one on the span are never needed.
        const int first = span + 1 - q + r;
        if (first < 0) continue;
        const Real upper = x(span + 1 + r), lower = x(first),
                   quotient = values_[q - 1][r] / (upper - lower);
        values_[q][r] = saved + (upper - Real(u)) * quotient;
        saved = (Real(u) - lower) * quotient;
      }
      values_[q][q] = saved;
    }
  }

  /// jump_[r][c] = [N_{first-p+c}^(r)] at the knot between spans `left` and `right` (-1: outside
  /// the domain), for the functions of the left span, or of the right one where there is no left.
  void jump(int left, int right) {
    SpanValues<Real> side[order_limit];
    int orders[order_limit] = {};
    for (int r = 0; r <= p_; ++r) {
      orders[r] = r;
      std::fill_n(jump_[r], p_ + 1, Real(0));
    }
    const int first = left >= 0 ? left : right;
    if (right >= 0) {
      span_basis(knots_, right, Real(0), Real(1), orders, p_ + 1, side);
      for (int c = std::max(0, right - first); c <= p_; ++c) {
        for (int r = 0; r <= p_; ++r) jump_[r][c] = side[r][c - (right - first)];
      }
    }
    if (left >= 0) {
      span_basis(knots_, left, Real(1), Real(0), orders, p_ + 1, side);
      for (int c = 0; c <= p_; ++c) {
        for (int r = 0; r <= p_; ++r) jump_[r][c] -= side[r][c];
      }
    }
  }

  /// integral_[m] = (I^m N_j^(b))(u), m = 1 … highest, u being the point of `tabulate_values(span,
  /// u)`.
  void integrate(int j, int b, int span, int highest) {
    // N_j^(b), span by span, as B-splines of degree q = p − b: the usual differences, where a
    // function without support (which stands for a Dirac) is dropped.
    Real c[2 * order_limit] = {1};
    int q = p_;
    for (int d = 1; d <= b; ++d, --q) {
      for (int k = d; k >= 0; --k) {
        const Real length = Real(x(j + k + q)) - Real(x(j + k));
        c[k] = length > Real(0) ? Real(q) * (k > 0 ? c[k] - c[k - 1] : c[k]) / length : Real(0);
      }
    }
    // Thm 5.2 once per integration: ∫ Σ c_k N_{k,q} = Σ_k (Σ_{i<=k} c_i d(i,q+1)/(q+1)) N_{k,q+1}.
    // Only k <= span counts at u.
    for (int m = 1; m <= highest; ++m) {
      ++q;
      Real sum = 0, result = 0;
      for (int k = 0; j + k <= span; ++k) {
        sum += c[k] * (Real(x(j + k + q)) - Real(x(j + k))) / Real(q);
        c[k] = sum;
        // Functions that end left of the span, such as the first ones of a lowered degree, are zero
        // at u.
        if (const int at = q - (span - j - k); at >= 0) result += sum * values_[q][at];
      }
      integral_[m] = result;
    }
  }

  template <class Add>
  void contribute(int span, int a, int b, int lowest, Add add) {
    const int from = std::max(a, lowest);
    for (int cj = 0; cj <= p_; ++cj) {
      const int j = span - p_ + cj;
      integrate(j, b, span, p_ - a + 1);
      for (int ci = 0; ci <= cj; ++ci) {
        Real sum = 0;
        for (int r = from; r <= p_; ++r) {
          const Real term = jump_[r][ci] * integral_[r - a + 1];
          sum += (r - a) % 2 == 0 ? -term : term;
        }
        add(span - p_ + ci, j, sum);
      }
    }
  }

  [[nodiscard]] double x(int i) const { return extended_[static_cast<std::size_t>(i)]; }

  const KnotVector& knots_;
  int p_;
  std::vector<double> extended_;
  Real values_[2 * order_limit][2 * order_limit] = {};
  Real jump_[order_limit][order_limit] = {};
  Real integral_[order_limit + 1] = {};
};

}  // namespace knead::detail
