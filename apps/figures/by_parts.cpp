#include "figures/by_parts.hpp"

#include <fmt/format.h>

#include <cassert>

#include "figures/figures.hpp"
#include "figures/svg.hpp"
#include "figures/thesis_knots.hpp"
#include "knead/spline/basis.hpp"

namespace knead::figures {
namespace {

constexpr int chords = 40;   // per span
constexpr int function = 4;  // of the thesis' example

/// Over the support of N₄, 1 to 5, both limits at every knot.
template <class F>
Points over_support(F f) {
  Points points;
  for (int span = 1; span < 5; ++span) {
    for (int k = 0; k <= chords; ++k) {
      points.push_back(
          f(span + static_cast<double>(k) / chords, k == chords ? Side::left : Side::right));
    }
  }
  return points;
}

struct Term {
  int a, b;
  int first;  // number of its first figure
  const char* name;
};
constexpr Term parts_of_integrals[] = {{0, 0, 13, "∫ N₄ N₄"},
                                       {1, 1, 15, "∫ N₄′ N₄′"},
                                       {2, 2, 17, "∫ N₄″ N₄″"},
                                       {0, 1, 19, "∫ N₄′ N₄"}};

void add_term(Report& report, const Term& t) {
  const auto product = [&](double u, Side side) {
    return std::pair(u, basis_function(example_knots(), function, t.a, u, side) *
                            basis_function(example_knots(), function, t.b, u, side));
  };
  Points integral;
  const BasisQuadrature rule = gauss_basis(example_knots(), 4, 2);
  for (const auto& [u, value] : over_support(product)) {
    double sum = 0;  // by Gauss' rule on every part of a span up to u
    for (int span = 1; span < 5 && span < u; ++span) {
      const double length = std::min(1.0, u - span);
      for (int k = 0; k < rule.basis.size(); ++k) {
        const double x = rule.parameters[static_cast<std::size_t>(k)];
        if (x < 1 || x > 2) continue;  // the points of one span serve for all
        sum += length * rule.weights[static_cast<std::size_t>(k)] *
               product(span + length * (x - 1), Side::right).second;
      }
    }
    integral.emplace_back(u, sum);
  }
  Chart chart(fmt::format("Fig. 5.{}: the product of {}, and its integral", t.first, t.name), "u",
              "");
  chart.line("product", over_support(product));
  chart.line("integral up to u", integral);
  const auto steps = by_parts(example_knots(), function, t.a, t.b);
  report.picture(fmt::format("figure_5_{}.svg", t.first), chart.svg(),
                 fmt::format("Fig. 5.{}: {} = {:.15g}.", t.first, t.name, steps[0].whole));
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const int m = static_cast<int>(k);
    const auto place = [&](double u, Side side) {
      return std::pair(basis_function(example_knots(), function, t.b + m, u, side),
                       integrated(example_knots(), function, t.a, m + 1, u, side));
    };
    const int order = m + 1 - t.a;  // of the integral; below 0 a derivative
    const std::string other = order == 1   ? std::string("integral of N₄")
                              : order > 1  ? fmt::format("{}-fold integral of N₄", order)
                              : order == 0 ? std::string("N₄")
                                           : fmt::format("derivative of order {} of N₄", -order);
    Chart parts(fmt::format("Fig. 5.{}: step {} of {}", t.first + 1, k + 1, t.name),
                t.b + m == 0 ? "N₄" : fmt::format("derivative of order {} of N₄", t.b + m), other);
    parts.line("u from 1 to 5", over_support(place));
    report.picture(
        fmt::format("figure_5_{}_{}.svg", t.first + 1, k + 1), parts.svg(),
        fmt::format(
            "Fig. 5.{}, step {}: ∫ f dg = {:.15g}, [f g] = {:.15g}, ∫ g df = {:.15g}{}.",
            t.first + 1, k + 1, steps[k].whole, steps[k].boundary, steps[k].rest,
            k + 1 == steps.size() ? ", a sum over the jumps of f: Dirac impulses are left" : ""));
  }
}

void add_curve(Report& report) {
  const std::array<std::pair<double, double>, 9> polygon = {
      {{0, 0}, {1, 3}, {3, 4}, {4, 1}, {6, 0}, {8, 2}, {7, 5}, {10, 6}, {12, 3}}};
  Points curve;
  for (const int span : example_knots().spans()) {
    for (int k = 0; k <= chords; ++k) {
      const double u = example_knots()[span] + static_cast<double>(k) / chords;
      std::pair<double, double> at = {0, 0};
      for (int i = 0; i < example_knots().count(); ++i) {
        const double n =
            basis_function(example_knots(), i, 0, u, k == chords ? Side::left : Side::right);
        at.first += n * polygon[static_cast<std::size_t>(i)].first;
        at.second += n * polygon[static_cast<std::size_t>(i)].second;
      }
      curve.push_back(at);
    }
  }
  Chart chart("Fig. 4.2: a cubic B-spline curve", "x", "y");
  chart.line("curve", curve);
  chart.line("control points", Points(polygon.begin(), polygon.end()),
             {.dashed = true, .markers = true});
  report.picture("figure_4_02.svg", chart.svg(),
                 "Fig. 4.2: a cubic B-spline curve on U and its control points; the thesis does "
                 "not print its own.");
}

void add_gauss_points(Report& report) {
  const auto square = [](double u, Side side) {
    const double n = basis_function(example_knots(), function, 0, u, side);
    return std::pair(u, n * n);
  };
  Chart chart("Fig. 5.4: Gauss points of ∫ N₄ N₄", "u", "N₄ N₄");
  chart.line("N₄ N₄", over_support(square));
  const BasisQuadrature rule = gauss_basis(example_knots(), 4, 0);
  Points points;
  double sum = 0;
  for (std::size_t k = 0; k < rule.parameters.size(); ++k) {
    const auto at = square(rule.parameters[k], Side::right);
    if (at.first < 1 || at.first > 5) continue;
    points.push_back(at);
    sum += rule.weights[k] * at.second;
  }
  chart.impulses("Gauss points", points);
  report.picture("figure_5_04.svg", chart.svg(),
                 fmt::format("Fig. 5.4: the product has degree 6 on each of p + 1 spans, so 4 "
                             "points on each are exact: {:.15g}, the entry 151/315 = {:.15g}.",
                             sum, 151.0 / 315));
}

void add_areas(Report& report) {
  const auto place = [](double u) {
    return std::pair(basis_function(example_knots(), function, 0, u),
                     basis_integral(example_knots(), function, 1, u));
  };
  constexpr double end = 3;  // where N₄ is largest
  Points curve;
  for (int k = 0; k <= 2 * chords; ++k) curve.push_back(place(1 + (end - 1) * k / (2.0 * chords)));
  const auto [f, g] = place(end);
  Chart chart("Fig. 5.12: integration by parts as areas", "f = N₄", "g = ∫ N₄");
  chart.line("g over f, u from 1 to 3", curve);
  chart.line("f g", {{0, g}, {f, g}, {f, 0}}, {.dashed = true});
  double under = 0;  // ∫ g df: fine enough for the caption's digits
  constexpr int fine = 20000;
  for (int k = 0; k < fine; ++k) {
    const auto a = place(1 + (end - 1) * k / fine), b = place(1 + (end - 1) * (k + 1.0) / fine);
    under += (a.second + b.second) / 2 * (b.first - a.first);
  }
  report.picture("figure_5_12.svg", chart.svg(),
                 fmt::format("Fig. 5.12: the rectangle f g = {:.6f} is the area below the curve, ∫ "
                             "g df = {:.6f}, and that beside it, ∫ f dg = {:.6f}.",
                             f * g, under, f * g - under));
}

}  // namespace

double integrated(const KnotVector& knots, int i, int a, int m, double u, Side side) {
  return m < a ? basis_function(knots, i, a - m, u, side) : basis_integral(knots, i, m - a, u);
}

std::vector<ByParts> by_parts(const KnotVector& knots, int i, int a, int b) {
  const int p = knots.degree();
  assert(a <= p && b <= p);
  const double begin = knots[i], end = knots[i + p + 1];
  const BasisQuadrature rule = gauss_basis(knots, p + 3, 0);  // degree up to 2p + 1 and more
  const auto integral = [&](const auto& f) {
    double sum = 0;
    for (std::size_t k = 0; k < rule.parameters.size(); ++k) {
      const double u = rule.parameters[k];
      if (u > begin && u < end) sum += rule.weights[k] * f(u);
    }
    return sum;
  };
  std::vector<ByParts> steps;
  for (int k = 0; b + k <= p; ++k) {
    ByParts step;
    const auto f = [&](double u, Side side) { return basis_function(knots, i, b + k, u, side); };
    const auto g = [&](double u, Side side) { return integrated(knots, i, a, k + 1, u, side); };
    step.whole = integral(
        [&](double u) { return f(u, Side::right) * integrated(knots, i, a, k, u, Side::right); });
    step.boundary =
        f(end, Side::left) * g(end, Side::left) - f(begin, Side::right) * g(begin, Side::right);
    if (b + k < p) {
      step.rest = integral(
          [&](double u) { return g(u, Side::right) * basis_function(knots, i, b + k + 1, u); });
    } else {
      // Impulses inside the support; those at its ends are in the boundary term.
      for (const KnotJumps& at : derivative_jumps(knots, i)) {
        if (at.knot > begin && at.knot < end)
          step.rest += at.of_order(p, p) * g(at.knot, Side::right);
      }
    }
    steps.push_back(step);
  }
  return steps;
}

void add_by_parts(Report& report) {
  report.text("\n## Curve, Gauss points and integration by parts: Figs. 4.2, 5.4, 5.12 to 5.20\n");
  add_curve(report);
  add_gauss_points(report);
  add_areas(report);
  for (const Term& term : parts_of_integrals) add_term(report, term);
}

}  // namespace knead::figures
