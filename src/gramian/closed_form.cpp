#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "knead/gramian/rational_gramian.hpp"
#include "methods.hpp"
#include "rational_pairs.hpp"

namespace knead {
namespace {

/// Coefficients of powers of x, lowest first.
template <class Real>
using Polynomial = std::vector<Real>;

template <class Real>
Polynomial<Real> product(const Polynomial<Real>& a, const Polynomial<Real>& b) {
  if (a.empty() || b.empty()) return {};
  Polynomial<Real> result(a.size() + b.size() - 1, Real(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) result[i + j] += a[i] * b[j];
  }
  return result;
}

template <class Real>
Polynomial<Real> derivative(const Polynomial<Real>& a) {
  Polynomial<Real> result;
  for (std::size_t i = 1; i < a.size(); ++i) result.push_back(Real(i) * a[i]);
  return result;
}

/// The numerator of the derivative of a/w^k, over w^(k + 1): a' w − k a w'.
template <class Real>
Polynomial<Real> quotient_numerator(const Polynomial<Real>& a, const Polynomial<Real>& w, int k) {
  Polynomial<Real> first = product(derivative(a), w);
  const Polynomial<Real> second = product(a, derivative(w));
  first.resize(std::max(first.size(), second.size()), Real(0));
  for (std::size_t i = 0; i < second.size(); ++i) first[i] -= Real(k) * second[i];
  return first;
}

/// a = quotient b + rest; `rest` is a at first.
template <class Real>
Polynomial<Real> divide(Polynomial<Real>& rest, const Polynomial<Real>& b) {
  Polynomial<Real> quotient;
  while (rest.size() >= b.size()) {
    const Real factor = rest.back() / b.back();
    quotient.insert(quotient.begin(), factor);
    const std::size_t shift = rest.size() - b.size();
    for (std::size_t i = 0; i < b.size(); ++i) rest[shift + i] -= factor * b[i];
    rest.pop_back();
  }
  return quotient;
}

/// The coefficients 0 … count − 1 of a polynomial about z.
template <class Real>
std::vector<std::complex<Real>> taylor(const Polynomial<Real>& a, std::complex<Real> z,
                                       std::size_t count) {
  std::vector<std::complex<Real>> work(a.begin(), a.end());
  work.resize(std::max(work.size(), count), Real(0));
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = work.size() - 1; i-- > k;) work[i] += z * work[i + 1];
  }
  work.resize(count);
  return work;
}

/// All roots at once (Aberth's iteration), from points on a circle about zero.
template <class Real>
std::vector<std::complex<Real>> roots_of(const Polynomial<Real>& a) {
  using Complex = std::complex<Real>;
  const std::size_t n = a.size() - 1;
  const Real radius = std::pow(std::abs(a[0] / a[n]), Real(1) / Real(n)) + Real(0.1);
  std::vector<Complex> z;
  for (std::size_t k = 0; k < n; ++k) {
    z.push_back(std::polar(radius, Real(2 * std::numbers::pi) * (Real(k) + Real(0.3)) / Real(n)));
  }
  for (int step = 0; step < 200; ++step) {
    Real moved = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const std::vector<Complex> value = taylor(a, z[k], 2);
      if (value[0] == Complex(0)) continue;
      const Complex newton = value[1] / value[0];
      Complex others = 0;
      for (std::size_t l = 0; l < n; ++l) {
        if (l != k && z[k] != z[l]) others += Real(1) / (z[k] - z[l]);
      }
      // Newton's step deflated by all other approximations, 1/(P'/P − Σ 1/(z_k − z_l)): cubic
      // convergence to simple roots (Aberth, Iteration methods for finding all zeros of a
      // polynomial simultaneously, 1973). The circle is turned, so that no start lies on the axis
      // of symmetry of a real polynomial.
      const Complex change = Real(1) / (newton - others);
      z[k] -= change;
      moved = std::max(moved, std::abs(change) / (Real(1) + std::abs(z[k])));
    }
    if (moved < 4 * std::numeric_limits<Real>::epsilon()) break;
  }
  return z;
}

/// The polynomials of one span over x in [−1, 1]: numerators of the functions' derivatives and the
/// denominator.
template <class Real>
class SpanFractions {
 public:
  using Complex = std::complex<Real>;

  SpanFractions(const detail::RationalPiece<1>& piece, int a, int b) : power_(a + b + 2) {
    const detail::RationalAxis& axis = piece.axis(0);
    const auto width = static_cast<std::size_t>(axis.degree() + 1);
    left_ = functions(axis);
    w_.assign(width, Real(0));
    std::vector<Real> size(width, Real(0));
    for (std::size_t r = 0; r < width; ++r) {
      for (std::size_t i = 0; i < width; ++i) {
        left_[r][i] *= Real(piece.weights()[r]);
        w_[i] += left_[r][i];
        size[i] += std::abs(left_[r][i]);
      }
    }
    // A leading coefficient that is nothing but rounding would be a root far away.
    while (w_.size() > 1 &&
           std::abs(w_.back()) <= 64 * std::numeric_limits<Real>::epsilon() * size[w_.size() - 1]) {
      w_.pop_back();
    }
    right_ = left_;
    for (int k = 0; k < a; ++k) raise(left_, k + 1);
    for (int k = 0; k < b; ++k) raise(right_, k + 1);
    // dx/du and du/dx
    const Real half = Real(axis.length()) / 2;
    scale_ = half * std::pow(half, Real(-(a + b)));
  }

  /// ∫ R_i^(a) R_j^(b) du for all pairs, row by row.
  /// R_i^(a) R_j^(b) on a span is P/W^m with m = a + b + 2: a polynomial, and partial fractions at
  /// the complex roots of W, whose integrals are powers and one logarithm. Exact but for rounding,
  /// which is large where roots nearly coincide or lie near the span, since fractions then cancel.
  /// The computation is done in numbers of 53 and of 64 bits, and their difference estimates what
  /// is lost; where that is too much the span is integrated by certified Gauss rules instead.
  [[nodiscard]] std::vector<Real> integrals() const {
    const std::size_t count = left_.size();
    std::vector<Real> result(count * count, Real(0));
    Polynomial<Real> all{Real(1)};
    for (int k = 0; k < power_; ++k) all = product(all, w_);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        Polynomial<Real> rest = product(left_[i], right_[j]);
        const Polynomial<Real> whole = divide(rest, all);
        for (std::size_t k = 0; k < whole.size(); k += 2)
          result[i * count + j] += 2 * whole[k] / Real(k + 1);
      }
    }
    if (w_.size() > 1) add_fractions(result);
    for (Real& x : result) x *= scale_;
    return result;
  }

 private:
  static std::vector<Polynomial<Real>> chebyshev_polynomials(std::size_t count) {
    std::vector<Polynomial<Real>> result{{Real(1)}};
    if (count > 1) result.push_back({Real(0), Real(1)});
    while (result.size() < count) {
      Polynomial<Real> next(result.size() + 1, Real(0));
      for (std::size_t i = 0; i < result.size(); ++i) next[i + 1] = 2 * result.back()[i];
      const Polynomial<Real>& before = result[result.size() - 2];
      for (std::size_t i = 0; i < before.size(); ++i) next[i] -= before[i];
      result.push_back(std::move(next));
    }
    return result;
  }

  /// N_r as polynomials in x, from their values at Chebyshev points.
  static std::vector<Polynomial<Real>> functions(const detail::RationalAxis& axis) {
    const auto width = static_cast<std::size_t>(axis.degree() + 1);
    const std::vector<Polynomial<Real>> chebyshev = chebyshev_polynomials(width);
    std::vector<Polynomial<Real>> result(width, Polynomial<Real>(width, Real(0)));
    const int none[1] = {0};
    detail::SpanValues<Real> n[1];
    for (std::size_t m = 0; m < width; ++m) {
      const Real angle = std::numbers::pi_v<Real> * (Real(m) + Real(0.5)) / Real(width);
      const Real c = std::cos(angle / 2), s = std::sin(angle / 2);
      detail::span_basis<Real>(*axis.knots, axis.span, axis.lower, axis.upper, c * c, s * s, none,
                               1, n);
      for (std::size_t k = 0; k < width; ++k) {
        const Real factor = Real(k == 0 ? 1 : 2) / Real(width) * std::cos(Real(k) * angle);
        for (std::size_t r = 0; r < width; ++r) {
          for (std::size_t i = 0; i <= k; ++i) result[r][i] += factor * n[0][r] * chebyshev[k][i];
        }
      }
    }
    return result;
  }

  void raise(std::vector<Polynomial<Real>>& numerators, int k) const {
    for (Polynomial<Real>& n : numerators) n = quotient_numerator(n, w_, k);
  }

  /// The terms c/(x − z)^l, l = 1 … m, of every root: c_{m−s} is coefficient s of P(z + y) (W(z +
  /// y)/y)^−m.
  void add_fractions(std::vector<Real>& result) const {
    const auto m = static_cast<std::size_t>(power_);
    const std::size_t count = left_.size();
    for (const Complex z : roots_of(w_)) {
      const std::vector<Complex> inverse = inverse_power(z, m), terms = antiderivatives(z, m);
      std::vector<std::vector<Complex>> p, q;
      for (std::size_t i = 0; i < count; ++i) {
        p.push_back(taylor(left_[i], z, m));
        q.push_back(taylor(right_[i], z, m));
      }
      for (std::size_t i = 0; i < count; ++i) {
        const std::vector<Complex> first = truncated(p[i], inverse);
        for (std::size_t j = 0; j < count; ++j) {
          const std::vector<Complex> c = truncated(first, q[j]);
          Complex sum = 0;
          for (std::size_t s = 0; s < m; ++s) sum += c[s] * terms[m - s];
          result[i * count + j] += sum.real();
        }
      }
    }
  }

  static std::vector<Complex> truncated(const std::vector<Complex>& a,
                                        const std::vector<Complex>& b) {
    std::vector<Complex> result(a.size(), Complex(0));
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t j = 0; i + j < a.size(); ++j) result[i + j] += a[i] * b[j];
    }
    return result;
  }

  /// (W(z + y)/y)^−m to y^(m−1), by Miller's recurrence.
  [[nodiscard]] std::vector<Complex> inverse_power(Complex z, std::size_t m) const {
    std::vector<Complex> v = taylor(w_, z, m + 1);
    v.erase(v.begin());
    std::vector<Complex> f(m, Complex(0));
    f[0] = Real(1);
    for (std::size_t k = 0; k < m; ++k) f[0] /= v[0];
    for (std::size_t s = 1; s < m; ++s) {
      for (std::size_t q = 1; q <= s; ++q) {
        f[s] += (-Real(m) * Real(q) - Real(s - q)) * v[q] * f[s - q];
      }
      f[s] /= Real(s) * v[0];
    }
    return f;
  }

  /// ∫ (x − z)^−l dx over [−1, 1] at [l]: a logarithm, whose imaginary part is an arctangent, and
  /// powers.
  static std::vector<Complex> antiderivatives(Complex z, std::size_t m) {
    const Complex upper = Real(1) / (Real(1) - z), lower = Real(1) / (Real(-1) - z);
    std::vector<Complex> result(m + 1, Complex(0));
    result[1] = std::log(lower / upper);
    Complex at_upper = upper, at_lower = lower;
    for (std::size_t l = 2; l <= m; ++l) {
      result[l] = (at_lower - at_upper) / Real(l - 1);
      at_upper *= upper;
      at_lower *= lower;
    }
    return result;
  }

  int power_;
  std::vector<Polynomial<Real>> left_, right_;
  Polynomial<Real> w_;
  Real scale_ = 1;
};

}  // namespace

Expected<ClosedFormGramian> closed_form_rational_gramian(const KnotVector& knots,
                                                         std::span<const double> weights, int a,
                                                         int b, double tolerance) {
  if (const auto good = detail::check_rational(weights, knots.count(), {a, 0}, {b, 0}, tolerance);
      !good) {
    return std::unexpected(good.error());
  }
  ClosedFormGramian result{BandMatrix(knots.count(), knots.degree(), detail::symmetry_of(a, b))};
  detail::RationalElements<1> elements({&knots}, weights);
  const double size = detail::size_of_pairs<1>(elements, weights.size(), {a}, {b});
  const auto functions = elements.functions();
  const double allowed = size > 0 ? tolerance * size / static_cast<double>(functions) : 1;
  detail::PairRule<1> rule({a}, {b}, functions);
  const bool positive = elements.for_each([&](const detail::RationalPiece<1>& piece) {
    const std::vector<long double> fine = SpanFractions<long double>(piece, a, b).integrals();
    const std::vector<double> coarse = SpanFractions<double>(piece, a, b).integrals();
    // What a number of 53 bits loses, one of 64 loses too, 2048 times smaller.
    double lost = 0;
    for (std::size_t k = 0; k < fine.size(); ++k) {
      lost = std::max(lost, std::abs(coarse[k] - static_cast<double>(fine[k])) / 256);
    }
    const bool closed = lost <= allowed;  // false for what is not a number
    ++(closed ? result.closed : result.integrated);
    if (!closed && !rule.integrate(piece, allowed)) return false;
    if (closed)
      result.estimated_error =
          std::max(result.estimated_error, lost * static_cast<double>(functions));
    for (std::size_t i = 0; i < functions; ++i) {
      for (std::size_t j = 0; j < functions; ++j) {
        const int row = elements.rows()[i], column = elements.rows()[j];
        if (a == b && row > column) continue;
        result.matrix.at(row, column) +=
            closed ? static_cast<double>(fine[i * functions + j]) : rule.sums()(i, j);
      }
    }
    return true;
  });
  if (!positive) return detail::no_lower_bound();
  return result;
}

}  // namespace knead
