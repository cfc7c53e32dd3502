#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "figures/figures.hpp"
#include "figures/svg.hpp"
#include "knead/gramian/gramian.hpp"

namespace knead::figures {
namespace {

constexpr int repeats = 5, last_degree = 7, most_points = 500, step = 100;

/// Nanoseconds for all four Gramians: the shortest of a few runs.
double time_of(int degree, int count, GramianMethod method) {
  const KnotVector knots = *KnotVector::clamped_uniform(degree, count);
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < repeats; ++k) {
    const auto start = std::chrono::steady_clock::now();
    const auto set = gramians(knots, method);
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    if (set) best = std::min(best, taken.count());
  }
  return best;
}

struct Method {
  GramianMethod method;
  const char* name;
};
constexpr Method methods[] = {{GramianMethod::gauss, "Gauss"},
                              {GramianMethod::analytic, "analytic"},
                              {GramianMethod::recurrence, "recurrence"}};

}  // namespace

void add_times(Report& report) {
  report.text(
      "\n## Times: Figs. 5.42 to 5.45\n\n"
      "Of this library on this machine, the shortest of five runs. The thesis' are of its Java "
      "program on a laptop; "
      "its "
      "gain of 2.7 to 4.3 by the analytic method does not carry over to vectorised code.\n");
  Chart by_points("Fig. 5.42: time for all four Gramians, cubic", "number of control points", "ns");
  Chart by_degree("Fig. 5.43: time for all four Gramians, 100 control points", "degree", "ns");
  by_points.logarithmic(false, true);
  by_degree.logarithmic(false, true);
  for (const auto& [method, name] : methods) {
    Points over_points, over_degree;
    for (int n = step; n <= most_points; n += step)
      over_points.emplace_back(n, time_of(3, n, method));
    for (int p = 1; p <= last_degree; ++p) over_degree.emplace_back(p, time_of(p, 100, method));
    by_points.line(name, over_points, {.markers = true});
    by_degree.line(name, over_degree, {.markers = true});
  }
  report.picture("figure_5_42.svg", by_points.svg(),
                 "Fig. 5.42: time against the number of control points.");
  report.picture("figure_5_43.svg", by_degree.svg(), "Fig. 5.43: time against the degree.");
  std::vector<Surface> times = {{"Gauss", {}}, {"analytic", {}}};
  std::vector<std::string> rows, columns;
  Chart ratio("Fig. 5.45: time of the analytic method, divided by that of Gauss",
              "number of control points", "ratio");
  ratio.logarithmic(false, true);
  for (int n = step; n <= most_points; n += step) rows.push_back(std::to_string(n));
  for (int p = 1; p <= last_degree; ++p) columns.push_back(std::to_string(p));
  std::vector<Points> ratios(last_degree);
  for (int n = step; n <= most_points; n += step) {
    for (Surface& s : times) s.heights.emplace_back();
    for (int p = 1; p <= last_degree; ++p) {
      const double gauss = time_of(p, n, GramianMethod::gauss),
                   analytic = time_of(p, n, GramianMethod::analytic);
      times[0].heights.back().push_back(gauss);
      times[1].heights.back().push_back(analytic);
      ratios[static_cast<std::size_t>(p - 1)].emplace_back(n, analytic / gauss);
    }
  }
  for (int p = 1; p <= last_degree; ++p) {
    ratio.line(fmt::format("degree {}", p), ratios[static_cast<std::size_t>(p - 1)]);
  }
  report.picture("figure_5_44.svg",
                 surface_svg("Fig. 5.44: time in ns against points and degree", "control points",
                             "degree", rows, columns, times),
                 "Fig. 5.44: time against the number of control points and the degree.");
  report.picture("figure_5_45.svg", ratio.svg(),
                 "Fig. 5.45: the ratio of the times, above 1 where the analytic method takes "
                 "longer; the thesis has 0.23 to 0.37, "
                 "of two programs of the same kind, where Gauss' rule is vectorised here.");
}

}  // namespace knead::figures
