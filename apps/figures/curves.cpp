#include <fmt/format.h>

#include "figures/figures.hpp"
#include "figures/svg.hpp"
#include "knead/spline/basis_integral.hpp"
#include "knead/spline/jumps.hpp"

namespace knead::figures {
namespace {

constexpr int samples_per_span = 40;

const KnotVector& knots() {
  static const KnotVector knots = *KnotVector::create(3, {0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 6, 6, 6});
  return knots;
}

/// f(u, side) over the domain, both limits at every knot.
template <class F>
Points sampled(F f) {
  Points points;
  for (const int span : knots().spans()) {
    for (int k = 0; k <= samples_per_span; ++k) {
      const double u = knots()[span] + static_cast<double>(k) / samples_per_span;
      points.emplace_back(u, f(u, k == samples_per_span ? Side::left : Side::right));
    }
  }
  return points;
}

Chart all_functions(const std::string& title, int derivative) {
  Chart chart(title, "u", derivative == 0 ? "N" : fmt::format("derivative {}", derivative));
  for (int i = 0; i < knots().count(); ++i) {
    chart.line(fmt::format("N_{}", i),
               sampled([&](double u, Side side) { return basis_function(knots(), i, derivative, u, side); }));
  }
  return chart;
}

Points dirac_weights(int i) {
  Points points;
  for (const KnotJumps& at : derivative_jumps(knots(), i)) points.emplace_back(at.knot, at.jumps.back());
  return points;
}

}  // namespace

void add_curves(Files& files) {
  files["figure_5_01.svg"] = all_functions("Fig. 5.1: cubic basis functions", 0).svg();
  for (int d = 1; d <= 3; ++d) {
    files[fmt::format("figure_5_09_{}.svg", d)] =
        all_functions(fmt::format("Fig. 5.9: derivatives of order {}", d), d).svg();
  }
  {
    Chart chart("Fig. 5.21: samples of the fourth integral of N_4, weighted by Diracs", "u", "");
    chart.line("fourth integral", sampled([](double u, Side) { return basis_integral(knots(), 4, 4, u); }));
    Points products;
    for (const auto& [u, weight] : dirac_weights(4))
      products.emplace_back(u, weight * basis_integral(knots(), 4, 4, u));
    chart.impulses("weight × integral", products);
    files["figure_5_21.svg"] = chart.svg();
  }
  {
    Chart chart("Fig. 5.22: N_4 and its derivatives; the fourth is impulses", "u", "");
    for (int d = 0; d <= 3; ++d) {
      chart.line(d == 0 ? "N_4" : fmt::format("derivative {}", d),
                 sampled([&](double u, Side side) { return basis_function(knots(), 4, d, u, side); }));
    }
    chart.impulses("Dirac weights", dirac_weights(4));
    files["figure_5_22.svg"] = chart.svg();
  }
  {
    Chart chart("Fig. 5.23: N_4 and its integral", "u", "");
    chart.line("N_4", sampled([](double u, Side) { return basis_function(knots(), 4, 0, u); }));
    chart.line("integral", sampled([](double u, Side) { return basis_integral(knots(), 4, 1, u); }));
    files["figure_5_23.svg"] = chart.svg();
  }
  {
    Chart chart("Fig. 5.24: the integrals of all basis functions", "u", "integral");
    for (int i = 0; i < knots().count(); ++i) {
      chart.line(fmt::format("N_{}", i), sampled([&](double u, Side) { return basis_integral(knots(), i, 1, u); }));
    }
    files["figure_5_24.svg"] = chart.svg();
  }
  {
    Chart chart("Fig. 5.25: repeated integrals of N_4", "u", "");
    for (int m = 0; m <= 4; ++m) {
      chart.line(m == 0 ? "N_4" : fmt::format("integral {}", m),
                 sampled([&](double u, Side) { return basis_integral(knots(), 4, m, u); }));
    }
    files["figure_5_25.svg"] = chart.svg();
  }
}

}  // namespace knead::figures
