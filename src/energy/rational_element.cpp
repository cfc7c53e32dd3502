#include "rational_element.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "gramian/simd/rational_kernels.hpp"
#include "gramian/unit_gauss.hpp"

namespace knead {

using detail::RationalAxis;
using detail::RationalPiece;

namespace {

/// How many points, at least, have their products made together; it leaves both factors in the
/// cache.
/// ∫ Σ_ab C_ab ∂^a R_I ∂^b R_J is the matrix product XᵀY over points and derivatives, X the
/// derivatives and Y those times weights and C. Collected over several lines of points, it is done
/// by a kernel that keeps a block of the result in registers; point by point it would be bound by
/// memory. Of a sum of squares (C diagonal and nowhere negative) X = Y with the root of both
/// factors, half of the memory and a symmetric result.
constexpr Eigen::Index chunk = 48;

}  // namespace

template <int D>
RationalCoefficients<D>::RationalCoefficients(const FieldEnergy<D>& energy) {
  for (const FieldTerm<D>& term : energy) {
    for (const MultiIndex<D>& order : {term.a, term.b}) {
      const auto at = static_cast<std::size_t>(multi_index_position<D>(order));
      if (std::ranges::find(used_, at) == used_.end()) used_.push_back(at);
      order_ = std::max(order_, std::accumulate(order.begin(), order.end(), 0));
    }
  }
  std::ranges::sort(used_);
  constant_ = Eigen::MatrixXd::Zero(count(), count());
  for (const FieldTerm<D>& term : energy) {
    const int a = position(term.a), b = position(term.b);
    if (const double* c = std::get_if<double>(&term.coefficient)) {
      constant_(a, b) += term.factor * *c;
    } else {
      varying_.push_back({&std::get<SplineField<D>>(term.coefficient), a, b, term.factor, 0, {}});
    }
    const auto* field = std::get_if<SplineField<D>>(&term.coefficient);
    sum_of_squares_ = sum_of_squares_ && a == b &&
                      term.factor * (field != nullptr ? field->range().lower
                                                      : std::get<double>(term.coefficient)) >=
                          0;
  }
}

template <int D>
int RationalCoefficients<D>::position(const MultiIndex<D>& order) const {
  const auto at = static_cast<std::size_t>(multi_index_position<D>(order));
  return static_cast<int>(std::ranges::find(used_, at) - used_.begin());
}

// A spline is bounded by its coefficients; on one span, by the (q + 1)^D that belong to it.
template <int D>
void RationalCoefficients<D>::enter(const std::array<const RationalAxis*, D>& axes) {
  for (Varying& v : varying_) {
    const auto& knots = v.field->knots();
    const std::array<int, D> net = v.field->net();
    std::array<int, D> first, at{};
    for (std::size_t d = 0; d < D; ++d)
      first[d] = knots[d].find_span(axes[d]->lower) - knots[d].degree();
    v.largest = 0;
    for (;;) {
      int index = 0;
      for (std::size_t d = 0; d < D; ++d) index = index * net[d] + first[d] + at[d];
      v.largest =
          std::max(v.largest, std::abs(v.field->coefficients()[static_cast<std::size_t>(index)]));
      std::size_t d = D;
      while (d-- > 0 && ++at[d] > knots[d].degree()) at[d] = 0;
      if (d >= D) break;
    }
  }
}

template <int D>
Expected<void> RationalCoefficients<D>::sample(
    const std::array<std::vector<double>, D>& parameters) {
  std::array<std::span<const double>, D> spans;
  for (std::size_t d = 0; d < D; ++d) spans[d] = parameters[d];
  for (Varying& v : varying_) {
    auto values = v.field->on_grid(spans);
    if (!values) return std::unexpected(values.error());
    v.values = std::move(*values);
  }
  return {};
}

template <int D>
bool RationalCoefficients<D>::at(int a, int b, std::size_t k, std::span<double> out) const {
  std::ranges::fill(out, constant_(a, b));
  bool any = constant_(a, b) != 0;
  for (const Varying& v : varying_) {
    if (v.a != a || v.b != b) continue;
    for (std::size_t g = 0; g < out.size(); ++g) out[g] += v.factor * v.values[k + g];
    any = true;
  }
  return any;
}

template <int D>
void RationalCoefficients<D>::row_sums(std::size_t direction, double rho,
                                       Eigen::VectorXd& sums) const {
  sums = constant_.cwiseAbs().rowwise().sum();
  for (const Varying& v : varying_) {
    sums[v.a] +=
        std::abs(v.factor) * v.largest * std::pow(rho, v.field->knots()[direction].degree());
  }
}

template <int D>
RationalElement<D>::RationalElement(RationalCoefficients<D>& coefficients, std::size_t functions)
    : coefficients_(coefficients),
      functions_(static_cast<Eigen::Index>(functions)),
      rows_((chunk + detail::max_unit_gauss_points) * coefficients.count()),
      left_(static_cast<std::size_t>(rows_) * functions),
      right_(coefficients.sum_of_squares() ? 0 : left_.size()),
      block_(functions_, functions_),
      diagonal_(functions_) {}

template <int D>
void RationalElement<D>::clear() {
  block_.setZero();
  diagonal_.setZero();
}

template <int D>
Expected<void> RationalElement<D>::add(const RationalPiece<D>& piece,
                                       const std::array<int, D>& points, bool whole,
                                       double constant) {
  if (auto ok = tabulate(piece, points); !ok) return ok;
  detail::RationalLine<D> line{{}, {}};
  for (std::size_t d = 0; d < D; ++d) line.points[d] = &points_[d];
  const std::size_t n = line.size(), orders = RationalPiece<D>::orders_up_to(coefficients_.order());
  values_.resize(orders * piece.functions() * n);
  factor_.resize(n);
  std::size_t k = 0;
  do {
    if (constant > 0) {
      piece.evaluate_polynomial(line, constant, orders, values_.data());
    } else if (!piece.evaluate(line, orders, values_.data())) {
      return numerical_error("the rational denominator is not positive", "stiffness",
                             "use positive weights");
    }
    if (!whole) {
      add_diagonal(line, k);
    } else if (coefficients_.sum_of_squares()) {
      add_squares(line, k);
    } else {
      add_diagonal(line, k);
      add_products(line, k);
    }
    k += n;
  } while (line.next());
  flush();
  if (whole && coefficients_.sum_of_squares()) diagonal_ = block_.diagonal();
  return {};
}

template <int D>
Expected<void> RationalElement<D>::tabulate(const RationalPiece<D>& piece,
                                            const std::array<int, D>& points) {
  for (std::size_t d = 0; d < D; ++d) points_[d].tabulate(piece.axis(d), points[d], d + 1 == D);
  if (coefficients_.varying().empty()) return {};
  std::array<std::vector<double>, D> parameters;
  for (std::size_t d = 0; d < D; ++d) {
    const RationalAxis& axis = piece.axis(d);
    for (const double t : detail::unit_gauss<double>(points[d]).t) {
      // Strictly inside, so that the span to the right is the intended one; a piece of a single ulp
      // has no interior.
      parameters[d].push_back(std::clamp(axis.lower + t * axis.length(), axis.lower,
                                         std::nextafter(axis.upper, axis.lower)));
    }
    parameters[d].resize(points_[d].size(), parameters[d].back());
  }
  return coefficients_.sample(parameters);
}

template <int D>
void RationalElement<D>::add_diagonal(const detail::RationalLine<D>& line, std::size_t k) {
  const std::size_t n = line.size();
  const double outer = line.outer_weight();
  std::vector<double>& size = factor_;
  double c[detail::max_unit_gauss_points];
  for (int a = 0; a < coefficients_.count(); ++a) {
    std::ranges::fill(size, 0.0);
    for (int b = 0; b < coefficients_.count(); ++b) {
      if (!coefficients_.at(a, b, k, {c, n})) continue;
      for (std::size_t g = 0; g < n; ++g) size[g] += std::abs(c[g]);
    }
    for (std::size_t g = 0; g < n; ++g) size[g] *= outer * line.points[D - 1]->weights[g];
    const double* x = derivative(a);
    for (Eigen::Index r = 0; r < functions_; ++r, x += n) {
      double sum = 0;
      for (std::size_t g = 0; g < n; ++g) sum += size[g] * (x[g] * x[g]);
      diagonal_[r] += sum;
    }
  }
}

template <int D>
void RationalElement<D>::add_squares(const detail::RationalLine<D>& line, std::size_t k) {
  const auto n = static_cast<std::ptrdiff_t>(line.size());
  const double outer = line.outer_weight();
  for (int a = 0; a < coefficients_.count(); ++a) {
    if (!coefficients_.at(a, a, k, factor_)) std::ranges::fill(factor_, 0.0);
    for (std::size_t g = 0; g < factor_.size(); ++g) {
      factor_[g] = std::sqrt(factor_[g] * (outer * line.points[D - 1]->weights[g]));
    }
    detail::rational_kernels().scale(factor_.data(), derivative(a), functions_, n, rows_,
                                     left_.data() + filled_);
    filled_ += n;
  }
  if (filled_ >= chunk * coefficients_.count()) flush();
}

template <int D>
void RationalElement<D>::add_products(const detail::RationalLine<D>& line, std::size_t k) {
  const auto n = static_cast<Eigen::Index>(line.size());
  const double outer = line.outer_weight();
  const Eigen::Map<const Eigen::ArrayXd> weights(line.points[D - 1]->weights.data(), n);
  const Eigen::Map<const Eigen::ArrayXd> factor(factor_.data(), n);
  for (int a = 0; a < coefficients_.count(); ++a) {
    next_rows(left_, n) = Eigen::Map<const Eigen::MatrixXd>(derivative(a), n, functions_);
    auto right = next_rows(right_, n);
    right.setZero();
    for (int b = 0; b < coefficients_.count(); ++b) {
      if (!coefficients_.at(a, b, k, factor_)) continue;
      right.array() += Eigen::Map<const Eigen::ArrayXXd>(derivative(b), n, functions_).colwise() *
                       (outer * factor * weights);
    }
    filled_ += n;
  }
  if (filled_ >= chunk * coefficients_.count()) flush();
}

template <int D>
void RationalElement<D>::flush() {
  const double* right = coefficients_.sum_of_squares() ? left_.data() : right_.data();
  detail::rational_kernels().lower_products(left_.data(), right, rows_, filled_, functions_,
                                            block_.data());
  filled_ = 0;
}

template class RationalCoefficients<1>;
template class RationalCoefficients<2>;
template class RationalCoefficients<3>;
template class RationalElement<1>;
template class RationalElement<2>;
template class RationalElement<3>;

}  // namespace knead
