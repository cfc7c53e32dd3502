#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gramian/rational_elements.hpp"
#include "gramian/rational_rule.hpp"
#include "rational_element.hpp"
#include "tensor_pattern.hpp"

namespace knead {
namespace {

using detail::RationalPiece;

/// K, element by element.
template <int D>
class RationalAssembly {
 public:
  RationalAssembly(const Spline<D>& spline, const FieldEnergy<D>& energy,
                   const StiffnessOptions& options)
      : spline_(spline),
        options_(options),
        coefficients_(energy),
        elements_(knots_of(spline), spline.weights(), breaks_of(coefficients_)) {
    pattern_.net = spline.net();
    for (std::size_t d = 0; d < D; ++d) pattern_.degree[d] = spline.knots()[d].degree();
  }

  // No finite rule is exact for rational functions. `RationalRule` chooses points, and halves
  // elements, until a proven bound of the error is below the tolerance, relative to the diagonal of
  // K: |δK_ij| <= tol √(K_ii K_jj). The diagonal is not known before K is; a first pass estimates
  // it by few points, and the second replaces it. If the estimate was too large by so much that the
  // bound then fails, a pass is repeated with the better one.
  [[nodiscard]] Expected<RationalStiffness> run() {
    RationalStiffness result{pattern_.allocate(), std::numeric_limits<double>::infinity()};
    const bool certified =
        options_.rational_gauss_points == 0 && options_.denominator == RationalDenominator::exact;
    if (!certified) {
      if (auto status = sum_up(result.matrix, false); !status)
        return std::unexpected(status.error());
      return result;
    }
    if (auto status = estimate_sizes(); !status) return std::unexpected(status.error());
    // The sizes by few points may have been too large for the tolerance to be kept; those of this
    // pass are not.
    for (int pass = 0; pass < 4 && !(result.error_bound <= options_.rational_tolerance); ++pass) {
      if (auto status = sum_up(result.matrix, true); !status)
        return std::unexpected(status.error());
      result.error_bound = 0;
      for (Eigen::Index i = 0; i < size_.size(); ++i) {
        if (errors_[i] > 0)
          result.error_bound = std::max(result.error_bound, errors_[i] / diagonal_[i]);
      }
      size_ = diagonal_;
    }
    return result;
  }

 private:
  static std::array<const KnotVector*, D> knots_of(const Spline<D>& spline) {
    std::array<const KnotVector*, D> knots;
    for (std::size_t d = 0; d < D; ++d) knots[d] = &spline.knots()[d];
    return knots;
  }

  static std::array<std::vector<double>, D> breaks_of(const RationalCoefficients<D>& coefficients) {
    std::array<std::vector<double>, D> breaks;
    for (const auto& varying : coefficients.varying()) {
      for (std::size_t d = 0; d < D; ++d) {
        const auto knots = varying.field->knots()[d].knots();
        breaks[d].insert(breaks[d].end(), knots.begin(), knots.end());
      }
    }
    return breaks;
  }

  /// visit(piece) for every element, until one fails.
  template <class Visit>
  [[nodiscard]] Expected<void> for_elements(const Visit& visit) {
    Expected<void> status;
    elements_.for_each([&](const RationalPiece<D>& piece) {
      coefficients_.enter(piece.axes());
      status = visit(piece);
      return status.has_value();
    });
    return status;
  }

  /// The diagonal of K for |C|, roughly: what errors are relative to.
  [[nodiscard]] Expected<void> estimate_sizes() {
    size_ = Eigen::VectorXd::Zero(spline_.size());
    RationalElement<D> sums(coefficients_, functions());
    return for_elements([&](const RationalPiece<D>& piece) -> Expected<void> {
      std::array<int, D> points;
      for (std::size_t d = 0; d < D; ++d) points[d] = pattern_.degree[d] + 2;
      sums.clear();
      if (auto status = sums.add(piece, points, false); !status) return status;
      for (std::size_t r = 0; r < functions(); ++r)
        size_[elements_.rows()[r]] += sums.diagonal()[static_cast<Eigen::Index>(r)];
      return {};
    });
  }

  [[nodiscard]] Expected<void> sum_up(SparseMatrix& matrix, bool certified) {
    std::fill(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(), 0.0);
    diagonal_ = errors_ = Eigen::VectorXd::Zero(spline_.size());
    RationalElement<D> sums(coefficients_, functions());
    detail::RationalRule<D> rule(RationalPiece<D>::orders_up_to(coefficients_.order()), limits());
    return for_elements([&](const RationalPiece<D>& piece) -> Expected<void> {
      sums.clear();
      auto status = certified ? integrate(piece, rule, sums) : integrate_by_count(piece, sums);
      if (status) add(sums, matrix);
      return status;
    });
  }

  [[nodiscard]] detail::RationalLimits limits() const {
    double usual = 1;
    int most = D == 3 ? 16 : 24;
    for (const int degree : pattern_.degree) {
      usual *= degree + 8;
      most = std::max(most, degree + 8);
    }
    return {.most_points = most,
            .all_points = 8 * elements_.count() * usual + 3e8 / static_cast<double>(functions())};
  }

  [[nodiscard]] Expected<void> integrate(const RationalPiece<D>& piece,
                                         detail::RationalRule<D>& rule, RationalElement<D>& sums) {
    // An entry sums as many spans as there are functions on one; a part of a span has its share.
    const double allowed = options_.rational_tolerance / static_cast<double>(functions()) *
                           detail::RationalElements<D>::share(piece);
    Expected<void> status;
    double error = 0;
    const bool kept = rule.integrate(
        piece, allowed,
        [&](const double* bounds, std::size_t d, double rho) { return size(bounds, d, rho); },
        [&](const RationalPiece<D>& part, const std::array<int, D>& points, double part_error) {
          error += part_error;
          status = sums.add(part, points, true);
          return status.has_value();
        });
    if (!status) return status;
    if (!kept) return too_uneven();
    for (const int row : elements_.rows()) errors_[row] += error * size_[row];
    return {};
  }

  /// With as many points as the options say, or the thesis' denominator (§ 5.8), whose products are
  /// polynomials.
  [[nodiscard]] Expected<void> integrate_by_count(const RationalPiece<D>& piece,
                                                  RationalElement<D>& sums) {
    std::array<int, D> points;
    double constant = 0;
    const bool exact = options_.denominator == RationalDenominator::exact;
    for (std::size_t d = 0; d < D; ++d) {
      int field = 0;
      for (const auto& v : coefficients_.varying())
        field = std::max(field, v.field->knots()[d].degree());
      const int gauss_points = exact ? options_.rational_gauss_points : pattern_.degree[d] + 1;
      points[d] = std::min(gauss_points + (field + 1) / 2, max_rational_gauss_points);
    }
    if (!exact) {
      constant = piece.middle_denominator();
      if (!(constant > 0)) {
        return numerical_error("the rational denominator is not positive", "stiffness",
                               "use positive weights");
      }
    }
    return sums.add(piece, points, true, constant);
  }

  /// The integrand's bound, relative to the sizes of its two functions. With r_a = Σ_b |C_ab|, by
  /// Cauchy's inequality Σ |C_ab| x_a y_b <= √(Σ r_a x_a²) √(Σ r_a y_a²).
  [[nodiscard]] double size(const double* bounds, std::size_t direction, double rho) {
    coefficients_.row_sums(direction, rho, row_sums_);
    double largest = 0;
    for (std::size_t r = 0; r < functions(); ++r) {
      double square = 0;
      for (std::size_t a = 0; a < coefficients_.used().size(); ++a) {
        const double bound = bounds[coefficients_.used()[a] * functions() + r];
        square += row_sums_[static_cast<Eigen::Index>(a)] * bound * bound;
      }
      if (square > 0) largest = std::max(largest, square / size_[elements_.rows()[r]]);
    }
    return largest;
  }

  [[nodiscard]] Expected<void> too_uneven() const {
    const auto [least, most] = std::ranges::minmax(elements_.weights());
    return numerical_error(fmt::format("the weights of one element, {} to {}, differ so much that "
                                       "its energy cannot be integrated to {} of the diagonal",
                                       least, most, options_.rational_tolerance),
                           "stiffness", "use weights that differ less, or a larger tolerance");
  }

  // One element after the other in one order: sums have the same bits whatever the number of
  // threads.
  void add(const RationalElement<D>& sums, SparseMatrix& matrix) {
    for (std::size_t r = 0; r < functions(); ++r) {
      diagonal_[elements_.rows()[r]] += sums.diagonal()[static_cast<Eigen::Index>(r)];
      for (std::size_t c = 0; c <= r; ++c) {
        const double value =
            sums.block()(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
        entry(matrix, r, c) += value;
        if (c < r) entry(matrix, c, r) += value;
      }
    }
  }

  [[nodiscard]] std::size_t functions() const { return elements_.functions(); }

  [[nodiscard]] double& entry(SparseMatrix& matrix, std::size_t r, std::size_t c) const {
    return matrix.valuePtr()[matrix.outerIndexPtr()[elements_.rows()[r]] +
                             pattern_.offset(elements_.indices()[r], elements_.indices()[c])];
  }

  const Spline<D>& spline_;
  const StiffnessOptions& options_;
  RationalCoefficients<D> coefficients_;
  TensorPattern<D> pattern_;
  detail::RationalElements<D> elements_;
  Eigen::VectorXd size_;      ///< what the errors of a row are relative to
  Eigen::VectorXd diagonal_;  ///< of K for |C|
  Eigen::VectorXd errors_;    ///< bounds of the errors of the diagonal
  Eigen::VectorXd row_sums_;
};

template <int D>
Expected<void> check(const Spline<D>& spline, const FieldEnergy<D>& energy,
                     const StiffnessOptions& options) {
  if (!(options.rational_tolerance > 0)) {
    return usage_error(fmt::format("the tolerance {} is not positive", options.rational_tolerance),
                       {}, "use a fraction such as 1e-10");
  }
  if (options.rational_gauss_points < 0 ||
      options.rational_gauss_points > max_rational_gauss_points) {
    return usage_error(
        fmt::format("{} Gauss points are not available", options.rational_gauss_points), {},
        fmt::format("use 1 to {}, or 0 for as many as the tolerance needs",
                    max_rational_gauss_points));
  }
  for (const FieldTerm<D>& term : energy) {
    int a = 0, b = 0;
    for (std::size_t d = 0; d < D; ++d) {
      a += term.a[d];
      b += term.b[d];
    }
    if (std::max(a, b) > detail::rational_order) {
      return usage_error(fmt::format("an energy term of order {} is not available", std::max(a, b)),
                         {}, "use total orders 0 to 2 for rational shapes");
    }
    const auto* field = std::get_if<SplineField<D>>(&term.coefficient);
    for (std::size_t d = 0; d < D && field != nullptr; ++d) {
      const Interval range = spline.knots()[d].domain(), other = field->knots()[d].domain();
      if (range.lower != other.lower || range.upper != other.upper) {
        return input_error(fmt::format("the domains [{}, {}] and [{}, {}] differ", range.lower,
                                       range.upper, other.lower, other.upper),
                           {}, "give a field over the domain of the spline");
      }
    }
  }
  return {};
}

}  // namespace

template <int D>
Expected<RationalStiffness> assemble_rational(const Spline<D>& spline, const FieldEnergy<D>& energy,
                                              const StiffnessOptions& options) {
  if (auto good = check<D>(spline, energy, options); !good) return std::unexpected(good.error());
  return RationalAssembly<D>(spline, energy, options).run();
}

template <int D>
Expected<RationalStiffness> assemble_rational(const Spline<D>& spline, const Energy<D>& energy,
                                              const StiffnessOptions& options) {
  FieldEnergy<D> constant;
  for (const EnergyTerm<D>& term : energy)
    constant.push_back({1, term.coefficient, term.a, term.b});
  return assemble_rational<D>(spline, constant, options);
}

#define KNEAD_INSTANTIATE(D)                                                                    \
  template Expected<RationalStiffness> assemble_rational<D>(                                    \
      const Spline<D>&, const FieldEnergy<D>&, const StiffnessOptions&);                        \
  template Expected<RationalStiffness> assemble_rational<D>(const Spline<D>&, const Energy<D>&, \
                                                            const StiffnessOptions&);
KNEAD_INSTANTIATE(1)
KNEAD_INSTANTIATE(2)
KNEAD_INSTANTIATE(3)
#undef KNEAD_INSTANTIATE

}  // namespace knead
