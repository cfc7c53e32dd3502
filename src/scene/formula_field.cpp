#include "formula_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "energy/formula.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

constexpr std::string_view formula_variables[] = {"s", "t", "x", "y", "z"};
constexpr int formula_degree = 3;
constexpr int most_coefficients = 1 << 14;

/// A formula on a surface; remembers the first value outside of the range.
class FormulaOnSurface {
 public:
  FormulaOnSurface(const Formula& formula, const Surface& surface,
                   const std::optional<Interval>& range)
      : formula_(formula), surface_(surface), range_(range) {
    for (std::size_t k = 2; k < std::size(formula_variables); ++k)
      places_ = places_ || formula.uses(k);
  }

  double operator()(const std::array<double, 2>& u) {
    std::array<double, std::size(formula_variables)> at{};
    for (std::size_t d = 0; d < 2; ++d) {
      const Interval domain = surface_.knots()[d].domain();
      at[d] = (u[d] - domain.lower) / domain.length();
    }
    if (places_) {
      const auto place = evaluate(surface_, Parameters<2>{{u[0], u[1]}});
      if (!place) return std::numeric_limits<double>::quiet_NaN();
      for (std::size_t k = 0; k < 3; ++k)
        at[2 + k] = place->points()(0, static_cast<Eigen::Index>(k));
    }
    const double value = formula_(at);
    if (!range_ || !(value < range_->lower || value > range_->upper)) return value;
    if (!outside_)
      outside_ =
          fmt::format("the formula is {:.6g} at s = {:.4g}, t = {:.4g}", value, at[0], at[1]);
    return std::numeric_limits<double>::quiet_NaN();  // ends the fit
  }

  [[nodiscard]] const std::optional<std::string>& outside() const { return outside_; }

 private:
  const Formula& formula_;
  const Surface& surface_;
  const std::optional<Interval>& range_;
  bool places_ = false;
  std::optional<std::string> outside_;
};

/// The largest |value| on a grid; infinite where one is not finite.
double largest_value(FormulaOnSurface& f, const Surface& surface) {
  constexpr int intervals = 32;
  double largest = 0;
  for (int i = 0; i <= intervals; ++i) {
    for (int j = 0; j <= intervals; ++j) {
      const Interval u = surface.knots()[0].domain(), v = surface.knots()[1].domain();
      const double value = std::abs(f({std::lerp(u.lower, u.upper, i / double(intervals)),
                                       std::lerp(v.lower, v.upper, j / double(intervals))}));
      largest = std::max(largest, std::isfinite(value) ? value : 0);
    }
  }
  return largest;
}

}  // namespace

// A formula in s, t and x, y, z becomes a cubic spline by adaptive fit to a tolerance, so that
// everything after it is the exact integration of splines. The default tolerance is 1e-6 of the
// largest value on a grid of 33 × 33; a value outside of the range stops the fit by a not-a-number
// and is reported with its place.
Expected<SplineField<2>> formula_field(const std::string& text, const Surface& surface,
                                       std::optional<double> tolerance,
                                       const std::optional<Interval>& range) {
  const auto formula = Formula::parse(text, formula_variables);
  if (!formula) return std::unexpected(formula.error());
  FormulaOnSurface f(*formula, surface, range);
  FitOptions options;
  const double largest = largest_value(f, surface);
  options.tolerance = tolerance.value_or(largest > 0 ? 1e-6 * largest : 1e-6);
  options.range = range;
  options.max_coefficients = most_coefficients;
  std::vector<KnotVector> hint;
  for (const KnotVector& knots : surface.knots()) {
    const Interval domain = knots.domain();
    std::vector<double> ends(formula_degree + 1, domain.lower);
    ends.resize(2 * (formula_degree + 1), domain.upper);
    auto made = KnotVector::create(formula_degree, std::move(ends));
    if (!made) return std::unexpected(made.error());
    hint.push_back(std::move(*made));
  }
  auto fit = fit_field<2>([&f](const std::array<double, 2>& u) { return f(u); }, {hint[0], hint[1]},
                          options);
  if (f.outside())
    return input_error(*f.outside(), "", fmt::format("values are {} or more", range->lower));
  if (!fit) return std::unexpected(fit.error());
  return std::move(fit->field);
}

}  // namespace knead
