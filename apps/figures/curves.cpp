#include <fmt/format.h>

#include "figures/figures.hpp"
#include "figures/svg.hpp"
#include "figures/thesis_knots.hpp"
#include "knead/spline/basis.hpp"

namespace knead::figures {
namespace {

constexpr int samples_per_span = 40;
constexpr const char* primes[] = {"", "′", "″", "‴"};

/// N₀, N₁, …
std::string function_name(int i) {
  constexpr const char* digits[] = {"₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"};
  return std::string("N") + digits[i];
}

/// f(u, side) over the domain, both limits at every knot.
template <class F>
Points sampled(F f) {
  Points points;
  for (const int span : example_knots().spans()) {
    for (int k = 0; k <= samples_per_span; ++k) {
      const double u = example_knots()[span] + static_cast<double>(k) / samples_per_span;
      points.emplace_back(u, f(u, k == samples_per_span ? Side::left : Side::right));
    }
  }
  return points;
}

Points dirac_weights(int i) {
  Points points;
  for (const KnotJumps& at : derivative_jumps(example_knots(), i))
    points.emplace_back(at.knot, at.jumps.back());
  return points;
}

Chart of_all(const std::string& title, const std::string& y, int derivative) {
  Chart chart(title, "u", y);
  for (int i = 0; i < example_knots().count(); ++i) {
    Points points = sampled([&](double u, Side side) {
      return basis_function(example_knots(), i, derivative, u, side);
    });
    // Only on its support, so that the last one drawn does not cover the axis; from zero and back
    // to it where it jumps.
    const double from = example_knots()[i], to = example_knots()[i + 4];
    std::erase_if(points, [&](const auto& point) {
      return point.first < from || point.first > to ||
             (from > 0 && point.first == from && point.second == 0) ||
             (to < 6 && point.first == to && point.second == 0);
    });
    if (from > 0) points.insert(points.begin(), {from, 0});
    if (to < 6) points.emplace_back(to, 0);
    chart.line(function_name(i), points);
  }
  return chart;
}

}  // namespace

void add_curves(Report& report) {
  report.text(
      "\n## Basis functions: Figs. 5.1, 5.9, 5.21 to 5.25\n\n"
      "Cubic, on the thesis' example U = {0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 6, 6, 6}.\n");
  report.picture(
      "figure_5_01.svg", of_all("Fig. 5.1: cubic basis functions", "N", 0).svg(),
      "Fig. 5.1: cubic basis functions. At u = 6 the last one is 1: the limit from inside.");
  for (int d = 1; d <= 3; ++d) {
    report.picture(fmt::format("figure_5_09_{}.svg", d),
                   of_all(fmt::format("Fig. 5.9: derivatives of order {}", d),
                          fmt::format("N{}", primes[d]), d)
                       .svg(),
                   fmt::format("Fig. 5.9: derivatives of order {}, {}.", d,
                               d == 1   ? "piecewise quadratic"
                               : d == 2 ? "piecewise linear"
                                        : "sums of steps"));
  }
  {
    Chart chart("Fig. 5.9: derivatives of order 4 are Dirac impulses", "u", "weight");
    for (int i = 0; i < example_knots().count(); ++i)
      chart.impulses(function_name(i), dirac_weights(i));
    report.picture("figure_5_09_4.svg", chart.svg(),
                   "Fig. 5.9: the steps differentiated, by their weights; those of one knot stand "
                   "side by side. At the "
                   "clamped ends lower derivatives jump too, which this picture leaves out.");
  }
  {
    Chart chart("Fig. 5.21: the fourth integral of N₄, sampled by the Dirac weights of N₄", "u",
                "");
    chart.line("I⁴ N₄",
               sampled([](double u, Side) { return basis_integral(example_knots(), 4, 4, u); }));
    Points products;
    double sum = 0;
    for (const auto& [u, weight] : dirac_weights(4)) {
      products.emplace_back(u, weight * basis_integral(example_knots(), 4, 4, u));
      sum += products.back().second;
    }
    chart.impulses("Dirac weights of N₄", dirac_weights(4));
    chart.impulses("weight × I⁴ N₄", products);
    report.picture("figure_5_21.svg", chart.svg(),
                   fmt::format("Fig. 5.21: weighted samples of the fourth integral. The products "
                               "add up to {:.15g}, the entry ∫ N₄ N₄ = 151/315 = {:.15g}.",
                               sum, 151.0 / 315));
  }
  {
    Chart chart("Fig. 5.22: N₄ and its derivatives; the fourth is impulses", "u", "");
    for (int d = 0; d <= 3; ++d) {
      chart.line(fmt::format("N₄{}", primes[d]), sampled([&](double u, Side side) {
                   return basis_function(example_knots(), 4, d, u, side);
                 }));
    }
    chart.impulses("Dirac weights", dirac_weights(4));
    report.picture("figure_5_22.svg", chart.svg(),
                   "Fig. 5.22: N₄ and its derivatives; the weights are 1, −4, 6, −4, 1.");
  }
  {
    Chart chart("Fig. 5.23: the integral of N₄ is a sum of functions of degree 4", "u", "");
    chart.line("N₄",
               sampled([](double u, Side) { return basis_function(example_knots(), 4, 0, u); }));
    chart.line("∫ N₄",
               sampled([](double u, Side) { return basis_integral(example_knots(), 4, 1, u); }));
    // Thm 5.2 on the same knots, once more at the end.
    const KnotVector higher = *KnotVector::create(4, {0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 6, 6, 6, 6});
    for (int j = 4; j < higher.count(); ++j) {
      chart.line(function_name(j) + " of degree 4", sampled([&](double u, Side side) {
                   return basis_function(higher, j, 0, u, side);
                 }),
                 {.dashed = true});
    }
    report.picture("figure_5_23.svg", chart.svg(),
                   "Fig. 5.23: ∫ N₄ = d(4, 4)/4 (N₄ + N₅ + … of degree 4) on the same knots (Thm "
                   "5.2); d(4, 4) = 4.");
  }
  {
    Chart chart("Fig. 5.24: integrals of the basis functions", "u", "∫ N");
    for (int i = 0; i < example_knots().count(); ++i) {
      chart.line(function_name(i),
                 sampled([&](double u, Side) { return basis_integral(example_knots(), i, 1, u); }));
    }
    report.picture("figure_5_24.svg", chart.svg(),
                   "Fig. 5.24: integrals. They end at (x_{i+4} − x_i)/4: 1 inside, 1/4, 1/2, 3/4 "
                   "towards the ends.");
  }
  {
    Chart chart("Fig. 5.25: repeated integrals of N₄", "u", "");
    constexpr const char* names[] = {"N₄", "∫ N₄", "∫∫ N₄", "∫∫∫ N₄", "∫∫∫∫ N₄"};
    for (int m = 0; m <= 4; ++m) {
      chart.line(names[m],
                 sampled([&](double u, Side) { return basis_integral(example_knots(), 4, m, u); }));
    }
    report.picture("figure_5_25.svg", chart.svg(),
                   "Fig. 5.25: repeated integrals, zero at the first knot of N₄; right of its last "
                   "knot they would be polynomials.");
  }
}

}  // namespace knead::figures
