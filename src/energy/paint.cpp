#include "knead/energy/paint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "span_samples.hpp"

namespace knead {
namespace {

// From 1 to 0 by the polynomial of degree 5 whose first and second derivatives vanish at both ends.
double fade(double s) {
  return s <= 0 ? 1 : s >= 1 ? 0 : 1 - s * s * s * (10 - 15 * s + 6 * s * s);
}

/// Distance from u to the interval, the shorter way around if closed.
double outside(double u, double lower, double upper, double period, bool closed) {
  const double direct = std::max({lower - u, u - upper, 0.0});
  if (!closed || direct == 0) return direct;
  const double up = std::max({lower - (u + period), u + period - upper, 0.0});
  const double down = std::max({lower - (u - period), u - period - upper, 0.0});
  return std::min({direct, up, down});
}

/// The nearest distance from [a, b] to [lower, upper].
double gap(double a, double b, double lower, double upper, double period, bool closed) {
  const auto apart = [&](double shift) {
    return std::max({lower - (b + shift), a + shift - upper, 0.0});
  };
  return closed ? std::min({apart(0), apart(period), apart(-period)}) : apart(0);
}

/// Sets coefficients of functions on whose whole support the weight is 0, or 1, to that number:
/// interpolation is off by some ten-thousandths there. On such a support the fit only improves, as
/// all coefficients lie in [0, 1].
template <int D>
std::vector<double> settled(const SplineField<D>& fit, const Region<D>& region) {
  std::vector<double> c = fit.coefficients();
  const auto* box = std::get_if<ParameterBox<D>>(&region.shape);
  const auto* ball = std::get_if<ParameterBall<D>>(&region.shape);
  const double radius = ball ? ball->radius : 0;
  const std::array<int, D> net = fit.net();
  for (std::size_t k = 0; k < c.size(); ++k) {
    double nearest = 0, farthest = 0;
    for (std::size_t d = D, rest = k; d-- > 0;) {
      const KnotVector& knots = fit.knots()[d];
      const Interval domain = knots.domain();
      const int i = static_cast<int>(rest % static_cast<std::size_t>(net[d]));
      rest /= static_cast<std::size_t>(net[d]);
      const double a = std::max(knots[i], domain.lower),
                   b = std::min(knots[i + knots.degree() + 1], domain.upper);
      const double lower = box ? box->lower[d] : ball->centre[d],
                   upper = box ? box->upper[d] : ball->centre[d];
      const double near =
          region.factors[d] * gap(a, b, lower, upper, domain.length(), region.closed[d]);
      // The direct distance, which is no shorter than the way around.
      const double far = region.factors[d] * std::max({lower - a, b - upper, 0.0});
      nearest += near * near;
      farthest += far * far;
    }
    if (std::sqrt(nearest) >= radius + region.falloff) c[k] = 0;
    if (std::sqrt(farthest) <= radius) c[k] = 1;
  }
  return c;
}

template <int D>
std::array<Interval, D> domain_of(const std::array<KnotVector, D>& knots) {
  std::array<Interval, D> domain;
  for (std::size_t d = 0; d < D; ++d) domain[d] = knots[d].domain();
  return domain;
}

template <int D>
Expected<void> check(const Region<D>& region) {
  if (!(region.falloff > 0) || !std::isfinite(region.falloff)) {
    return input_error(fmt::format("{} is not a width", region.falloff), "falloff",
                       "use a finite number > 0");
  }
  for (const double f : region.factors) {
    if (!(f > 0) || !std::isfinite(f))
      return input_error(fmt::format("{} is not a scale", f), "factors");
  }
  if (const auto* box = std::get_if<ParameterBox<D>>(&region.shape)) {
    for (std::size_t d = 0; d < D; ++d) {
      if (!std::isfinite(box->lower[d]) || !std::isfinite(box->upper[d]) ||
          box->lower[d] > box->upper[d]) {
        return input_error(fmt::format("[{}, {}] is not an interval", box->lower[d], box->upper[d]),
                           "region", "give lower <= upper");
      }
    }
    return {};
  }
  const auto& ball = std::get<ParameterBall<D>>(region.shape);
  for (const double c : ball.centre) {
    if (!std::isfinite(c)) return input_error("the centre is not finite", "region");
  }
  if (!(ball.radius >= 0) || !std::isfinite(ball.radius)) {
    return input_error(fmt::format("{} is not a radius", ball.radius), "region",
                       "use a finite number >= 0");
  }
  return {};
}

/// One blend of coefficients towards values, on the knots of a weight.
/// Coefficients are blended, not values: a product of two splines is none on these knots, and a
/// blend of coefficients in an interval stays in it, as those of a material must. The two agree
/// where the old field is constant, and else the better the finer the knots are; so knots are
/// halved where samples differ.
template <int D>
class Blend {
 public:
  Blend(std::span<const Coefficient<D>> old, std::span<const double> values,
        const std::vector<Interval>& ranges, double tolerance)
      : old_(old), values_(values), ranges_(ranges), tolerance_(tolerance) {}

  /// The fields; no value if some are off by more than the tolerance: then the spans are marked.
  Expected<std::optional<std::vector<SplineField<D>>>> on(const std::array<KnotVector, D>& grid,
                                                          const std::vector<double>& weight) {
    samples_.clear();
    samples_.reserve(D);
    for (std::size_t d = 0; d < D; ++d) {
      samples_.emplace_back(grid[d], 2 * grid[d].degree() + 3, 0);
      at_[d] = samples_[d].parameters;
      marked_[d].assign(samples_[d].spans.size(), false);
    }
    const auto soft = SplineField<D>::create(grid, weight);
    if (!soft) return std::unexpected(soft.error());
    const std::vector<double> softness = *soft->on_grid(at_);
    std::vector<SplineField<D>> result;
    bool met = true;
    for (std::size_t k = 0; k < old_.size(); ++k) {
      const auto before = on_knots<D>(old_[k], grid);
      if (!before) return std::unexpected(before.error());
      auto after = blended(*before, k, weight);
      if (!after) return std::unexpected(after.error());
      result.push_back(std::move(*after));
      // Of a constant c: Σ ((1 − w_i) c + w_i v) N_i = (1 − w) c + w v.
      if (std::holds_alternative<double>(old_[k])) continue;
      met = mark_misses(*before, result.back(), k, softness) && met;
    }
    if (!met) return std::nullopt;
    return result;
  }

  /// Halves the marked spans; false if none can be.
  [[nodiscard]] bool halve(std::array<KnotVector, D>& grid) const {
    bool changed = false;
    for (std::size_t d = 0; d < D; ++d) changed = detail::halve(grid[d], marked_[d]) || changed;
    return changed;
  }

 private:
  [[nodiscard]] Expected<SplineField<D>> blended(const SplineField<D>& before, std::size_t k,
                                                 const std::vector<double>& weight) const {
    std::vector<double> c = before.coefficients();
    for (std::size_t i = 0; i < c.size(); ++i) {
      c[i] = std::clamp(std::lerp(c[i], values_[k], weight[i]), ranges_[k].lower, ranges_[k].upper);
    }
    return SplineField<D>::create(before.knots(), std::move(c));
  }

  /// Blended coefficients against blended values, where the old field varies.
  bool mark_misses(const SplineField<D>& before, const SplineField<D>& after, std::size_t k,
                   const std::vector<double>& softness) {
    bool met = true;
    const double allowed = 0.5 * tolerance_ * ranges_[k].length();
    const std::vector<double> from = *before.on_grid(at_), to = *after.on_grid(at_);
    for (std::size_t i = 0; i < to.size(); ++i) {
      if (std::abs(to[i] - std::lerp(from[i], values_[k], softness[i])) <= allowed) continue;
      met = false;
      for (std::size_t d = D, rest = i; d-- > 0;) {
        marked_[d][rest % at_[d].size() / static_cast<std::size_t>(samples_[d].per_span)] = true;
        rest /= at_[d].size();
      }
    }
    return met;
  }

  std::span<const Coefficient<D>> old_;
  std::span<const double> values_;
  const std::vector<Interval>& ranges_;
  double tolerance_;
  std::vector<detail::SpanSamples> samples_;
  std::array<std::span<const double>, D> at_;
  std::array<std::vector<bool>, D> marked_;
};

/// The range of the painted coefficients: between those of the old field and the new value.
template <int D>
Interval range_of(const Coefficient<D>& old, double value) {
  if (const auto* field = std::get_if<SplineField<D>>(&old)) {
    return {std::min(value, field->range().lower), std::max(value, field->range().upper)};
  }
  return {std::min(value, std::get<double>(old)), std::max(value, std::get<double>(old))};
}

}  // namespace

template <int D>
double Region<D>::weight(const std::array<double, D>& u,
                         const std::array<Interval, D>& domain) const {
  double square = 0;
  const auto* box = std::get_if<ParameterBox<D>>(&shape);
  const auto* ball = std::get_if<ParameterBall<D>>(&shape);
  for (std::size_t d = 0; d < D; ++d) {
    const double lower = box ? box->lower[d] : ball->centre[d],
                 upper = box ? box->upper[d] : ball->centre[d];
    const double distance = factors[d] * outside(u[d], lower, upper, domain[d].length(), closed[d]);
    square += distance * distance;
  }
  return fade((std::sqrt(square) - (ball ? ball->radius : 0)) / falloff);
}

template <int D>
Expected<std::vector<SplineField<D>>> paint(std::span<const Coefficient<D>> old,
                                            std::span<const double> values, const Region<D>& region,
                                            const std::array<KnotVector, D>& hint,
                                            const PaintOptions& options) {
  if (old.size() != values.size() || old.empty()) {
    return usage_error(
        fmt::format("{} values do not fit {} coefficients", values.size(), old.size()));
  }
  if (auto ok = check<D>(region); !ok) return std::unexpected(ok.error());
  const std::array<Interval, D> domain = domain_of<D>(hint);
  std::vector<std::array<KnotVector, D>> knots = {hint};
  std::vector<Interval> ranges;
  for (std::size_t k = 0; k < old.size(); ++k) {
    if (!std::isfinite(values[k])) return input_error("the value is not a finite number");
    if (const auto* field = std::get_if<SplineField<D>>(&old[k])) knots.push_back(field->knots());
    ranges.push_back(range_of<D>(old[k], values[k]));
  }
  auto base = common_knots<D>(std::span<const std::array<KnotVector, D>>(knots));
  if (!base) return std::unexpected(base.error());

  FitOptions fit;
  // Half for the fit of the weight, half for the blend.
  fit.tolerance = 0.5 * options.tolerance;
  fit.max_coefficients = options.max_coefficients;
  fit.range = Interval{0, 1};
  std::array<KnotVector, D> start = *base;
  Blend<D> blend(old, values, ranges, options.tolerance);
  while (true) {
    const auto weight = fit_field<D>(
        [&](const std::array<double, D>& u) { return region.weight(u, domain); }, start, fit);
    if (!weight) return std::unexpected(weight.error());
    auto fields = blend.on(weight->field.knots(), settled<D>(weight->field, region));
    if (!fields) return std::unexpected(fields.error());
    if (*fields) return **std::move(fields);
    start = weight->field.knots();
    if (!blend.halve(start))
      return numerical_error("the old field changes too fast to be blended", "tolerance",
                             "use a larger one");
  }
}

template <int D>
Expected<SplineField<D>> paint(const Coefficient<D>& old, double value, const Region<D>& region,
                               const std::array<KnotVector, D>& hint, const PaintOptions& options) {
  auto made = paint<D>(std::span(&old, 1), std::span(&value, 1), region, hint, options);
  if (!made) return std::unexpected(made.error());
  return std::move(made->front());
}

template <int D>
Expected<MaterialFieldOf<D>> paint(const MaterialFieldOf<D>& material,
                                   const MaterialPaint<D>& values, const Region<D>& region,
                                   const std::array<KnotVector, D>& hint,
                                   const PaintOptions& options) {
  MaterialFieldOf<D> result = material;
  std::vector<Coefficient<D>*> painted;
  std::vector<Coefficient<D>> old;
  std::vector<double> targets;
  const auto add = [&](Coefficient<D>& c, const std::optional<double>& value) {
    if (!value) return;
    painted.push_back(&c);
    old.push_back(c);
    targets.push_back(*value);
  };
  for (std::size_t k = 0; k < values.alpha.size(); ++k) add(result.alpha[k], values.alpha[k]);
  for (std::size_t k = 0; k < values.beta.size(); ++k) add(result.beta[k], values.beta[k]);
  add(result.mass, values.mass);
  add(result.damping, values.damping);
  if (painted.empty())
    return usage_error("there is no value to paint", "material",
                       "give one of alpha, beta, mass and damping");
  auto made = paint<D>(std::span<const Coefficient<D>>(old), targets, region, hint, options);
  if (!made) return std::unexpected(made.error());
  for (std::size_t k = 0; k < painted.size(); ++k) *painted[k] = std::move((*made)[k]);
  if (auto ok = validated<D>(result); !ok) return std::unexpected(ok.error());
  return result;
}

#define KNEAD_INSTANTIATE(D)                                                                  \
  template struct Region<D>;                                                                  \
  template Expected<std::vector<SplineField<D>>> paint<D>(                                    \
      std::span<const Coefficient<D>>, std::span<const double>, const Region<D>&,             \
      const std::array<KnotVector, D>&, const PaintOptions&);                                 \
  template Expected<SplineField<D>> paint<D>(const Coefficient<D>&, double, const Region<D>&, \
                                             const std::array<KnotVector, D>&,                \
                                             const PaintOptions&);                            \
  template Expected<MaterialFieldOf<D>> paint<D>(                                             \
      const MaterialFieldOf<D>&, const MaterialPaint<D>&, const Region<D>&,                   \
      const std::array<KnotVector, D>&, const PaintOptions&);
KNEAD_INSTANTIATE(1)
KNEAD_INSTANTIATE(2)
KNEAD_INSTANTIATE(3)
#undef KNEAD_INSTANTIATE

}  // namespace knead
