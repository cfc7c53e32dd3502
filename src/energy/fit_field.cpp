#include "knead/energy/paint.hpp"

#include <fmt/format.h>

#include <string>

#include "span_samples.hpp"
#include "spline/interpolation/greville_interpolation.hpp"

namespace knead {
namespace {

// Interpolation on a net that is refined where it is wrong. Errors are measured on 2 p + 3 samples
// per span and direction at least; an element that exceeds the tolerance marks the directions to
// halve by their differences of order p + 1, which are h^{p+1} f^{(p+1)}, the term that
// interpolation of degree p leaves out. So a function of one variable is refined in that one.
// Tensor nets refine whole rows: only the worst directions are marked. 0.9 of the tolerance leaves
// room for what lies between samples.
constexpr double headroom = 0.9;

template <int D>
std::size_t product(const std::array<std::size_t, D>& sizes) {
  std::size_t n = 1;
  for (const std::size_t s : sizes) n *= s;
  return n;
}

/// f on a grid, last direction fastest.
template <int D>
Expected<std::vector<double>> values_on(const ParameterFunction<D>& f,
                                        const std::array<std::span<const double>, D>& at) {
  std::array<std::size_t, D> sizes;
  for (std::size_t d = 0; d < D; ++d) sizes[d] = at[d].size();
  std::vector<double> values(product<D>(sizes));
  for (std::size_t k = 0; k < values.size(); ++k) {
    std::array<double, D> u;
    for (std::size_t d = D, rest = k; d-- > 0;) {
      u[d] = at[d][rest % sizes[d]];
      rest /= sizes[d];
    }
    values[k] = f(u);
    if (!std::isfinite(values[k])) {
      std::string place;
      for (const double x : u) place += fmt::format("{}{}", place.empty() ? "" : ", ", x);
      return input_error("the function has no finite value", fmt::format("parameters ({})", place));
    }
  }
  return values;
}

template <int D>
Expected<SplineField<D>> interpolate(const ParameterFunction<D>& f,
                                     const std::array<KnotVector, D>& knots,
                                     const std::optional<Interval>& range) {
  std::vector<GrevilleInterpolation> interpolation;
  std::array<std::vector<double>, D> places;
  std::array<std::span<const double>, D> at;
  interpolation.reserve(D);
  for (std::size_t d = 0; d < D; ++d) {
    auto made = GrevilleInterpolation::create(knots[d]);
    if (!made) return std::unexpected(made.error());
    interpolation.push_back(std::move(*made));
    places[d] = interpolation[d].abscissae();
    const double lower = knots[d].domain().lower, upper = knots[d].domain().upper;
    for (std::size_t i = 0; i < places[d].size(); ++i) {
      // The limit from the left of a function known only by its values; at the end of the domain it
      // is the value itself.
      if (interpolation[d].sides()[i] == Side::left && places[d][i] < upper)
        places[d][i] = std::nextafter(places[d][i], lower);
    }
    at[d] = places[d];
  }
  auto values = values_on<D>(f, at);
  if (!values) return std::unexpected(values.error());
  std::size_t outer = 1, inner = values->size();
  for (std::size_t d = 0; d < D; ++d) {
    inner /= at[d].size();
    interpolation[d].solve(values->data(), outer, inner);
    outer *= at[d].size();
  }
  if (range) {
    for (double& c : *values) c = std::clamp(c, range->lower, range->upper);
  }
  return SplineField<D>::create(knots, std::move(*values));
}

/// Errors and differences of one set of samples, and the spans to halve.
template <int D>
struct Judgement {
  double error = 0;
  bool any = false;
  std::array<std::vector<bool>, D> marked;
};

/// The largest |Δ^{p+1}| of the values of one element along every direction, at a stride that spans
/// the element.
template <int D>
std::array<double, D> differences(const std::vector<double>& f, std::size_t corner,
                                  const std::array<std::size_t, D>& strides,
                                  const std::array<int, D>& counts,
                                  const std::array<int, D>& degrees) {
  std::array<double, D> largest{};
  std::size_t total = 1;
  for (const int c : counts) total *= static_cast<std::size_t>(c);
  std::vector<double> line;
  for (std::size_t k = 0; k < total; ++k) {
    std::array<int, D> at;
    std::size_t index = corner;
    for (std::size_t d = D, rest = k; d-- > 0;) {
      at[d] = static_cast<int>(rest % static_cast<std::size_t>(counts[d]));
      rest /= static_cast<std::size_t>(counts[d]);
      index += static_cast<std::size_t>(at[d]) * strides[d];
    }
    for (std::size_t d = 0; d < D; ++d) {
      if (at[d] != 0) continue;
      const int order = degrees[d] + 1, step = (counts[d] - 1) / order;
      for (int begin = 0; begin + order * step < counts[d]; begin += step) {
        line.clear();
        for (int i = 0; i <= order; ++i)
          line.push_back(f[index + static_cast<std::size_t>(begin + i * step) * strides[d]]);
        for (int level = order; level > 0; --level) {
          for (int i = 0; i < level; ++i)
            line[static_cast<std::size_t>(i)] =
                line[static_cast<std::size_t>(i) + 1] - line[static_cast<std::size_t>(i)];
        }
        largest[d] = std::max(largest[d], std::abs(line[0]));
      }
    }
  }
  return largest;
}

template <int D>
Judgement<D> judge(const std::vector<double>& f, const std::vector<double>& approximation,
                   const std::vector<detail::SpanSamples>& samples,
                   const std::array<KnotVector, D>& knots, double tolerance) {
  Judgement<D> result;
  std::array<std::size_t, D> strides;
  std::array<int, D> counts, degrees;
  std::size_t stride = 1, elements = 1;
  for (std::size_t d = D; d-- > 0;) {
    strides[d] = stride;
    stride *= samples[d].parameters.size();
    counts[d] = samples[d].per_span;
    degrees[d] = knots[d].degree();
    elements *= samples[d].spans.size();
    result.marked[d].assign(samples[d].spans.size(), false);
  }
  std::array<std::size_t, D> worst{};
  for (std::size_t e = 0; e < elements; ++e) {
    std::array<std::size_t, D> span;
    std::size_t corner = 0, total = 1;
    for (std::size_t d = D, rest = e; d-- > 0;) {
      span[d] = rest % samples[d].spans.size();
      rest /= samples[d].spans.size();
      corner += span[d] * static_cast<std::size_t>(counts[d]) * strides[d];
      total *= static_cast<std::size_t>(counts[d]);
    }
    double error = 0;
    for (std::size_t k = 0; k < total; ++k) {
      std::size_t index = corner;
      for (std::size_t d = D, rest = k; d-- > 0;) {
        index += rest % static_cast<std::size_t>(counts[d]) * strides[d];
        rest /= static_cast<std::size_t>(counts[d]);
      }
      error = std::max(error, std::abs(f[index] - approximation[index]));
    }
    if (error > result.error) result.error = error, worst = span;
    if (error <= headroom * tolerance) continue;
    const std::array<double, D> size = differences<D>(f, corner, strides, counts, degrees);
    const double largest = *std::ranges::max_element(size);
    // Differences far below the error cannot be its cause, which is then a neighbour, itself
    // marked.
    if (largest < 0.1 * error) continue;
    for (std::size_t d = 0; d < D; ++d) {
      if (size[d] >= 0.2 * largest) result.marked[d][span[d]] = result.any = true;
    }
  }
  if (!result.any) {
    for (std::size_t d = 0; d < D; ++d) result.marked[d][worst[d]] = true;
  }
  return result;
}

}  // namespace

template <int D>
Expected<FieldFit<D>> fit_field(const ParameterFunction<D>& f,
                                const std::array<KnotVector, D>& hint, const FitOptions& options) {
  if (!(options.tolerance > 0) || !std::isfinite(options.tolerance)) {
    return input_error(fmt::format("{} is not a tolerance", options.tolerance), "tolerance",
                       "use a finite number > 0");
  }
  std::array<KnotVector, D> knots = hint;
  double best = std::numeric_limits<double>::infinity();
  std::string best_net = "no";
  while (true) {
    long long count = 1;
    std::string net;
    for (const KnotVector& k : knots) {
      count *= k.count();
      net += fmt::format("{}{}", net.empty() ? "" : " x ", k.count());
    }
    if (count > options.max_coefficients) {
      return numerical_error(
          fmt::format(
              "the function is met to {:.3g} only, on {} coefficients; {} would be too many", best,
              best_net, net),
          "tolerance",
          "use a larger tolerance, a wider fall-off, or knots at the function's kinks");
    }
    auto field = interpolate<D>(f, knots, options.range);
    if (!field) return std::unexpected(field.error());
    std::vector<detail::SpanSamples> samples;
    std::array<std::span<const double>, D> at;
    samples.reserve(D);
    long long points = 1;
    for (std::size_t d = 0; d < D; ++d) {
      samples.emplace_back(knots[d], 2 * knots[d].degree() + 3, options.min_samples);
      at[d] = samples[d].parameters;
      points *= static_cast<long long>(at[d].size());
    }
    const auto exact = values_on<D>(f, at);
    if (!exact) return std::unexpected(exact.error());
    const Judgement<D> judgement =
        judge<D>(*exact, *field->on_grid(at), samples, knots, options.tolerance);
    if (judgement.error <= headroom * options.tolerance)
      return FieldFit<D>{std::move(*field), judgement.error, points};
    if (judgement.error < best) best = judgement.error, best_net = net;
    bool changed = false;
    for (std::size_t d = 0; d < D; ++d)
      changed = detail::halve(knots[d], judgement.marked[d]) || changed;
    if (!changed) {
      return numerical_error(
          fmt::format(
              "the function is met to {:.3g} only, on {} coefficients; its spans are too short "
              "to halve",
              best, best_net),
          "tolerance", "use a larger tolerance, or knots repeated where the function jumps");
    }
  }
}

template Expected<FieldFit<1>> fit_field<1>(const ParameterFunction<1>&,
                                            const std::array<KnotVector, 1>&, const FitOptions&);
template Expected<FieldFit<2>> fit_field<2>(const ParameterFunction<2>&,
                                            const std::array<KnotVector, 2>&, const FitOptions&);
template Expected<FieldFit<3>> fit_field<3>(const ParameterFunction<3>&,
                                            const std::array<KnotVector, 3>&, const FitOptions&);

}  // namespace knead
