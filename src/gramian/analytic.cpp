#include <algorithm>
#include <vector>

#include "knead/spline/basis.hpp"
#include "methods.hpp"

namespace knead::detail {
namespace {

constexpr int order_limit = max_degree + 1;

/// Repeated integrals and jumps of all basis functions, knot by knot from the left.
class Analytic {
 public:
  explicit Analytic(const KnotVector& knots)
      : knots_(knots), p_(knots.degree()), extended_(knots.knots().begin(), knots.knots().end()) {
    // Thm 5.2 holds on knots that go on at the end; any will do, and repetitions of the last keep differences small.
    extended_.insert(extended_.end(), static_cast<std::size_t>(p_ + 2), extended_.back());
  }

  /// Adds the upper half of G^ab: rows i <= columns j.
  template <class Add>
  void accumulate(int a, int b, Add add) {
    const std::vector<int> spans = knots_.spans();
    const Interval domain = knots_.domain();
    // The start of the domain: the functions jump from nothing to what they are.
    tabulate_values(spans.front(), domain.lower);
    jump(-1, spans.front(), domain.lower);
    contribute(spans.front(), a, b, 0, add);
    for (std::size_t k = 0; k < spans.size(); ++k) {
      const int span = spans[k], next = k + 1 < spans.size() ? spans[k + 1] : -1;
      const double u = knots_[span + 1];
      tabulate_values(span, u);
      jump(span, next, u);
      // A knot of multiplicity m leaves derivatives below p − m + 1 continuous: their computed jumps would be noise.
      contribute(span, a, b, next < 0 ? 0 : std::max(0, p_ - knots_.multiplicity(u) + 1), add);
    }
  }

 private:
  /// values_[q][r] = N_{span-q+r,q}(u) on the extended knots, q = 0 … 2p + 1.
  void tabulate_values(int span, double u) {
    values_[0][0] = 1;
    for (int q = 1; q <= 2 * p_ + 1; ++q) {
      double saved = 0;
      for (int r = 0; r < q; ++r) {
        // Functions that begin left of the first one that lives on the span are never asked for.
        const int first = span + 1 - q + r;
        if (first < 0) continue;
        const double upper = x(span + 1 + r), lower = x(first), quotient = values_[q - 1][r] / (upper - lower);
        values_[q][r] = saved + (upper - u) * quotient;
        saved = (u - lower) * quotient;
      }
      values_[q][q] = saved;
    }
  }

  /// jump_[r][c] = [N_{first-p+c}^(r)] at u between spans `left` and `right` (-1: outside of the domain), for the
  /// functions of the left span, or of the right one where there is no left.
  void jump(int left, int right, double u) {
    const int width = p_ + 1;
    double side[order_limit * order_limit];
    for (auto& row : jump_) std::fill_n(row, width, 0.0);
    const int first = left >= 0 ? left : right;
    if (right >= 0) {
      basis_derivatives(knots_, right, u, p_, side);
      for (int c = std::max(0, right - first); c <= p_; ++c) {
        for (int r = 0; r <= p_; ++r) jump_[r][c] = side[r * width + c - (right - first)];
      }
    }
    if (left >= 0) {
      basis_derivatives(knots_, left, u, p_, side);
      for (int c = 0; c <= p_; ++c) {
        for (int r = 0; r <= p_; ++r) jump_[r][c] -= side[r * width + c];
      }
    }
  }

  /// integral_[m] = (I^m N_j^(b))(u), m = 1 … highest, u being the point of `tabulate_values(span, u)`.
  void integrate(int j, int b, int span, int highest) {
    // N_j^(b), span by span, as B-splines of degree q = p − b: the usual differences, where a function without support
    // (which stands for a Dirac) is dropped.
    double c[2 * order_limit] = {1};
    int q = p_;
    for (int d = 1; d <= b; ++d, --q) {
      for (int k = d; k >= 0; --k) {
        const double length = x(j + k + q) - x(j + k);
        c[k] = length > 0 ? q * (c[k] - (k > 0 ? c[k - 1] : 0)) / length : 0;
      }
    }
    // Thm 5.2 once per integration: ∫ Σ c_k N_{k,q} = Σ_k (Σ_{i<=k} c_i d(i,q+1)/(q+1)) N_{k,q+1}. Only k <= span
    // counts at u.
    for (int m = 1; m <= highest; ++m) {
      ++q;
      double sum = 0, result = 0;
      for (int k = 0; j + k <= span; ++k) {
        sum += c[k] * (x(j + k + q) - x(j + k)) / q;
        c[k] = sum;
        result += sum * values_[q][q - (span - j - k)];
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
        double sum = 0;
        for (int r = from; r <= p_; ++r) {
          const double term = jump_[r][ci] * integral_[r - a + 1];
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
  double values_[2 * order_limit][2 * order_limit] = {};
  double jump_[order_limit][order_limit] = {};
  double integral_[order_limit + 1] = {};
};

}  // namespace

BandMatrix analytic_gramian(const KnotVector& knots, int a, int b) {
  const int p = knots.degree();
  BandMatrix result(knots.count(), p, symmetry_of(a, b));
  if (a > p || b > p) return result;
  Analytic analytic(knots);
  analytic.accumulate(a, b, [&](int i, int j, double value) { result.at(i, j) += value; });
  // Integrals of j reach only from the left, so the formula serves i <= j; the lower half is the upper one of G^ba.
  if (a != b) {
    analytic.accumulate(b, a, [&](int i, int j, double value) {
      if (i != j) result.at(j, i) += value;
    });
  }
  return result;
}

}  // namespace knead::detail
