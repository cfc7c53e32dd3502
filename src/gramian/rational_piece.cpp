#include "rational_piece.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "simd/rational_kernels.hpp"
#include "unit_gauss.hpp"

namespace knead::detail {
namespace {

template <int D>
const QuotientRule<D>& quotient_rule() {
  static const QuotientRule<D> rule(rational_order);
  return rule;
}

template <int D>
const std::vector<MultiIndex<D>>& all_orders() {
  static const std::vector<MultiIndex<D>> indices = multi_indices<D>(rational_order);
  return indices;
}

constexpr std::size_t longest_line = max_unit_gauss_points;
static_assert(longest_line % RationalKernels::line_step == 0);

/// The functions of a piece one after the other, last direction fastest: which one it is in every
/// direction.
template <int D>
class FunctionCounter {
 public:
  explicit FunctionCounter(const std::array<const RationalAxis*, D>& axes) {
    for (std::size_t d = 0; d < D; ++d) width_[d] = static_cast<std::size_t>(axes[d]->degree() + 1);
  }
  [[nodiscard]] std::size_t operator[](std::size_t d) const { return at_[d]; }
  void next() {
    for (std::size_t d = D; d-- > 0 && ++at_[d] == width_[d];) at_[d] = 0;
  }

 private:
  std::array<std::size_t, D> at_{}, width_;
};

std::ptrdiff_t to_signed(std::size_t n) { return static_cast<std::ptrdiff_t>(n); }

/// grow[k] >= |T_k| on the ellipse: (ρ^k + ρ^−k)/2.
void fill_growth(double rho, int degree, double* grow) {
  double power = 1;
  for (int k = 0; k <= degree; ++k, power *= rho) grow[k] = 0.5 * (power + 1 / power);
}

}  // namespace

// Chebyshev coefficients of the basis on [lower, upper] by values at p + 1 Chebyshev points, exact
// for polynomials of degree p: on a Bernstein ellipse |T_k| <= (ρ^k + ρ^−k)/2, so that sums of
// their magnitudes bound polynomials there.
RationalAxis::RationalAxis(const KnotVector& knot_vector, int own_span, double a, double b)
    : knots(&knot_vector), span(own_span), lower(a), upper(b) {
  const int width = degree() + 1;
  chebyshev.assign(static_cast<std::size_t>(3 * width * width), 0.0);
  SpanValues<double> at[3];
  for (int m = 0; m < width; ++m) {
    const double angle = std::numbers::pi * (m + 0.5) / width;
    // cos² and sin² of the half angle: both t and 1 − t without cancellation.
    const double c = std::cos(angle / 2), s = std::sin(angle / 2);
    values(c * c, s * s, at);
    for (int k = 0; k < width; ++k) {
      const double factor = (k == 0 ? 1.0 : 2.0) / width * std::cos(k * angle);
      for (int d = 0; d < 3; ++d) {
        for (int r = 0; r < width; ++r) {
          chebyshev[static_cast<std::size_t>((d * width + r) * width + k)] += factor * at[d][r];
        }
      }
    }
  }
}

void RationalAxis::values(double t, double complement, SpanValues<double>* out) const {
  const int all[3] = {0, 1, 2};
  span_basis(*knots, span, lower, upper, t, complement, all, 3, out);
}

const RationalKernels& rational_kernels(InstructionSet set) {
  return avx2_rational_kernels != nullptr && set >= InstructionSet::avx2
             ? *avx2_rational_kernels
             : *vector128_rational_kernels;
}

void RationalPoints::tabulate(const RationalAxis& axis, int n, bool line) {
  const UnitGaussRule<double> rule = unit_gauss<double>(n);
  constexpr std::size_t step = RationalKernels::line_step;
  const std::size_t width = static_cast<std::size_t>(axis.degree() + 1);
  const std::size_t count = line ? (rule.t.size() + step - 1) / step * step : rule.t.size();
  values.resize(3 * width * count);
  weights.resize(count);
  SpanValues<double> at[3];
  for (std::size_t g = 0; g < count; ++g) {
    const bool more = g < rule.t.size();
    if (more) axis.values(rule.t[g], rule.complement[g], at);
    for (std::size_t d = 0; d < 3; ++d) {
      for (std::size_t r = 0; r < width; ++r) values[(d * width + r) * count + g] = at[d][r];
    }
    weights[g] = more ? axis.length() * rule.weights[g] : 0;
  }
}

RationalAxis RationalAxis::half(int which) const {
  const double middle = lower + 0.5 * (upper - lower);
  return {*knots, span, which == 0 ? lower : middle, which == 0 ? middle : upper};
}

/// to = from with direction d taken from functions to Chebyshev coefficients of their derivative.
template <int D>
void RationalPiece<D>::transform(std::size_t d, int order, const double* from, double* to) const {
  std::size_t outer = 1, inner = 1;
  for (std::size_t e = 0; e < D; ++e)
    (e < d ? outer : inner) *= static_cast<std::size_t>(axes_[e]->degree() + 1);
  const auto width = static_cast<std::size_t>(axes_[d]->degree() + 1);
  inner /= width;
  const double* table =
      axes_[d]->chebyshev.data() + static_cast<std::size_t>(order) * width * width;
  std::fill_n(to, functions_, 0.0);
  for (std::size_t i = 0; i < outer; ++i) {
    for (std::size_t r = 0; r < width; ++r) {
      const double* x = from + (i * width + r) * inner;
      for (std::size_t k = 0; k < width; ++k) {
        double* y = to + (i * width + k) * inner;
        for (std::size_t c = 0; c < inner; ++c) y[c] += table[r * width + k] * x[c];
      }
    }
  }
}

template <int D>
RationalPiece<D>::RationalPiece(std::array<const RationalAxis*, D> axes, const double* weights)
    : axes_(axes), weights_(weights), functions_(1) {
  for (const RationalAxis* axis : axes_) functions_ *= static_cast<std::size_t>(axis->degree() + 1);
  denominator_.resize((orders + 3 * D + 1) * functions_);
  double* spare = denominator_.data() + (orders + 3 * D) * functions_;
  for (std::size_t d = 0; d < D; ++d) {
    for (int order = 0; order < 3; ++order) transform(d, order, weights, along(d, order));
  }
  for (std::size_t o = 0; o < orders; ++o) {
    const MultiIndex<D>& a = all_orders<D>()[o];
    double* to = denominator_.data() + o * functions_;
    std::copy_n(along(0, a[0]), functions_, to);
    for (std::size_t d = 1; d < D; ++d) {
      std::copy_n(to, functions_, spare);
      transform(d, a[d], spare, to);
    }
  }
}

template <int D>
double RationalPiece<D>::measure() const {
  double product = 1;
  for (const RationalAxis* axis : axes_) product *= axis->length();
  return product;
}

/// out[(a functions + r) n + g] = w_r Π N^(a_d)_{r_d}, and the sums over r.
template <int D>
void RationalPiece<D>::numerators(const RationalLine<D>& line, std::size_t count, double* out,
                                  double* sums) const {
  const auto width = static_cast<std::size_t>(axes_[D - 1]->degree() + 1), n = line.size();
  const RationalKernels& kernels = rational_kernels();
  std::vector<double> factors(functions_);
  for (std::size_t o = 0; o < count; ++o) {
    const MultiIndex<D>& a = all_orders<D>()[o];
    for (std::size_t row = 0; row < functions_; row += width) {
      double factor = 1;
      std::size_t rest = row / width;
      for (std::size_t d = D - 1; d-- > 0;) {
        const auto m = static_cast<std::size_t>(axes_[d]->degree() + 1);
        const RationalPoints& points = *line.points[d];
        factor *= points.values[(static_cast<std::size_t>(a[d]) * m + rest % m) * points.size() +
                                line.at[d]];
        rest /= m;
      }
      for (std::size_t s = row; s < row + width; ++s) factors[s] = weights_[s] * factor;
    }
    const double* last =
        line.points[D - 1]->values.data() + static_cast<std::size_t>(a[D - 1]) * width * n;
    kernels.numerators(last, factors.data(), to_signed(width), to_signed(functions_), to_signed(n),
                       out + o * functions_ * n, sums + o * n);
  }
}

// ∂^a R = (∂^a A − Σ C ∂^b W ∂^{a−b} R) / W in the order of rising derivatives (Leibniz; The NURBS
// Book, § 4.3), all points of a line and all functions at once.
template <int D>
bool RationalPiece<D>::evaluate(const RationalLine<D>& line, std::size_t count, double* out) const {
  const std::size_t n = line.size();
  const RationalKernels& kernels = rational_kernels();
  double w[orders * longest_line], inverse[longest_line], factor[longest_line];
  numerators(line, count, out, w);
  for (std::size_t g = 0; g < n; ++g) {
    if (!(w[g] > 0)) return false;
    inverse[g] = 1 / w[g];
  }
  const QuotientRule<D>& rule = quotient_rule<D>();
  for (std::size_t o = 0; o < count; ++o) {
    double* to = out + o * functions_ * n;
    for (const auto& term : rule.terms(o)) {
      for (std::size_t g = 0; g < n; ++g) factor[g] = term.factor * w[term.denominator * n + g];
      kernels.subtract(factor, out + term.rest * functions_ * n, to_signed(functions_),
                       to_signed(n), to);
    }
    kernels.scale(inverse, to, to_signed(functions_), to_signed(n), to_signed(n), to);
  }
  return true;
}

template <int D>
void RationalPiece<D>::evaluate_polynomial(const RationalLine<D>& line, double denominator,
                                           std::size_t count, double* out) const {
  double w[orders * longest_line];
  numerators(line, count, out, w);
  for (std::size_t k = 0; k < count * functions_ * line.size(); ++k) out[k] /= denominator;
}

template <int D>
double RationalPiece<D>::middle_denominator() const {
  SpanValues<double> values[D][3];
  for (std::size_t d = 0; d < D; ++d) axes_[d]->values(0.5, 0.5, values[d]);
  double sum = 0;
  for (std::size_t row = 0; row < functions_; ++row) {
    double product = weights_[row];
    std::size_t rest = row;
    for (std::size_t d = D; d-- > 0;) {
      const auto m = static_cast<std::size_t>(axes_[d]->degree() + 1);
      product *= values[d][0][rest % m];
      rest /= m;
    }
    sum += product;
  }
  return sum;
}

/// Upper bounds of |∂^a W| and a lower one of |W|.
///
/// By Chebyshev coefficients in all directions; and, of W and its derivatives in the direction of
/// the ellipse, by those in that direction alone: functions of the others are not negative and sum
/// to one, so that W lies in the convex hull of what stands with them. The first is sharp on small
/// pieces, the second on whole spans.
template <int D>
std::array<double, RationalPiece<D>::orders> RationalPiece<D>::denominator_bounds(
    std::size_t direction, std::size_t count, const std::array<SpanValues<double>, D>& growth,
    double& lowest) const {
  std::array<double, orders> w{};
  std::size_t inner = 1;
  for (std::size_t d = direction + 1; d < D; ++d)
    inner *= static_cast<std::size_t>(axes_[d]->degree() + 1);
  FunctionCounter<D> at(axes_);
  for (std::size_t row = 0; row < functions_; ++row, at.next()) {
    double product = 1;
    for (std::size_t d = D; d-- > 0;) product *= growth[d][at[d]];
    for (std::size_t o = 0; o < count; ++o)
      w[o] += std::abs(denominator_[o * functions_ + row]) * product;
  }
  // |W| >= the mean coefficient minus all others.
  lowest = 2 * denominator_[0] - w[0];
  const auto width = static_cast<std::size_t>(axes_[direction]->degree() + 1);
  for (int order = 0; order < 3; ++order) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    // The rows whose function in this direction is the first.
    for (std::size_t row = 0; row < functions_;
         row += row % inner + 1 == inner ? (width - 1) * inner + 1 : 1) {
      const double* c = along(direction, order) + row;
      double sum = 0;
      for (std::size_t k = 0; k < width; ++k) sum += std::abs(c[k * inner]) * growth[direction][k];
      least = std::min(least, 2 * c[0] - sum);
      most = std::max(most, sum);
    }
    if (order == 0) lowest = std::max(lowest, least);
    MultiIndex<D> a{};
    a[direction] = order;
    double& bound = w[static_cast<std::size_t>(multi_index_position<D>(a))];
    bound = std::min(bound, most);
  }
  return w;
}

// The same recurrence with magnitudes: a sum of bounds in the numerator, the lower bound of |W|
// below. It exists only on ellipses without a root of W, and the caller tries several ρ.
template <int D>
bool RationalPiece<D>::bounds(std::size_t direction, double rho, std::size_t count,
                              double* out) const {
  std::array<SpanValues<double>, D> growth;
  for (std::size_t d = 0; d < D; ++d)
    fill_growth(d == direction ? rho : 1, axes_[d]->degree(), growth[d]);
  double lowest = 0;
  const std::array<double, orders> w = denominator_bounds(direction, count, growth, lowest);
  if (!(lowest > 0)) return false;
  SpanValues<double> table[D][3];  // of |N^(d)|
  for (std::size_t d = 0; d < D; ++d) {
    const int width = axes_[d]->degree() + 1;
    for (int r = 0; r < 3 * width; ++r) {
      const double* c = axes_[d]->chebyshev.data() + static_cast<std::ptrdiff_t>(r * width);
      double sum = 0;
      for (int k = 0; k < width; ++k) sum += std::abs(c[k]) * growth[d][k];
      table[d][r / width][r % width] = sum;
    }
  }
  const std::vector<MultiIndex<D>>& derivatives = all_orders<D>();
  FunctionCounter<D> at(axes_);
  for (std::size_t row = 0; row < functions_; ++row, at.next()) {
    for (std::size_t o = 0; o < count; ++o) {
      double product = std::abs(weights_[row]);
      for (std::size_t d = 0; d < D; ++d) product *= table[d][derivatives[o][d]][at[d]];
      out[o * functions_ + row] = product;
    }
  }
  const QuotientRule<D>& rule = quotient_rule<D>();
  for (std::size_t o = 0; o < count; ++o) {
    double* to = out + o * functions_;
    for (const auto& term : rule.terms(o)) {
      const double factor = term.factor * w[term.denominator];
      const double* rest = out + term.rest * functions_;
      for (std::size_t r = 0; r < functions_; ++r) to[r] += factor * rest[r];
    }
    for (std::size_t r = 0; r < functions_; ++r) to[r] /= lowest;
  }
  return true;
}

template <int D>
double RationalPiece<D>::variation(std::size_t direction) const {
  double sum = 0;
  for (std::size_t row = 0; row < functions_; ++row) {
    std::size_t rest = row;
    for (std::size_t d = D; d-- > direction + 1;)
      rest /= static_cast<std::size_t>(axes_[d]->degree() + 1);
    if (rest % static_cast<std::size_t>(axes_[direction]->degree() + 1) > 0)
      sum += std::abs(denominator_[row]);
  }
  return sum;
}

template class RationalPiece<1>;
template class RationalPiece<2>;
template class RationalPiece<3>;

}  // namespace knead::detail
