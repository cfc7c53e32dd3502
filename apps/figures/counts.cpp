#include <fmt/format.h>

#include <algorithm>

#include "figures/figures.hpp"
#include "figures/svg.hpp"
#include "figures/tables.hpp"
#include "figures/thesis_methods.hpp"

namespace knead::figures {
namespace {

constexpr int highest_degree = 10, highest_kernel = 7;  // the Gauss kernels end at degree 7
constexpr ThesisMethod both[] = {ThesisMethod::gaussian, ThesisMethod::analytic};

std::string label(ThesisMethod method) {
  return method == ThesisMethod::gaussian ? "Gaussian" : "analytic";
}
int colour(ThesisMethod method) { return method == ThesisMethod::gaussian ? 0 : 1; }

Work work(int degree, int count, ThesisMethod method, Reuse reuse = Reuse::all_in_one) {
  return thesis_gramians(*KnotVector::clamped_uniform(degree, count), method, reuse).work;
}

double operations(int degree, int count, GramianMethod method) {
  return static_cast<double>(
      count_operations(*KnotVector::clamped_uniform(degree, count), method).total());
}

/// The cost of each further span, away from the ends.
template <class Count>
double per_span(Count count) {
  return static_cast<double>(count(200) - count(100)) / 100;
}

enum class Over { points, degree };

/// A chart of something counted (solid) and expected by formula (dashed) of both thesis' methods.
template <class Counted, class Expected>
Chart compared(const std::string& title, const std::string& y, Over over, int most, Counted counted,
               Expected expected) {
  Chart chart(
      title,
      over == Over::points ? "number of control points (cubic)" : "degree (100 control points)", y);
  for (const ThesisMethod method : both) {
    Points solid, dashed;
    for (int k = 1; k <= most; ++k) {
      const int p = over == Over::points ? 3 : k, n = over == Over::points ? 100 * k : 100;
      const double x = over == Over::points ? n : p;
      solid.emplace_back(x, static_cast<double>(counted(p, n, method)));
      dashed.emplace_back(x, expected(p, n, method));
    }
    chart.line(label(method) + ", counted", solid, {.colour = colour(method), .markers = true});
    chart.line(label(method) + ", formula", dashed, {.colour = colour(method) + 4, .dashed = true});
  }
  return chart;
}

void add_samples(Report& report) {
  Chart chart("Fig. 5.31: samples of the basis functions per span", "degree", "samples");
  for (const ThesisMethod method : both) {
    Points counted, formula;
    for (int p = 1; p <= highest_degree; ++p) {
      counted.emplace_back(p, per_span([&](int n) { return work(p, n, method).samples; }));
      formula.emplace_back(p, expected::samples_per_span(p, method));
    }
    chart.line(label(method) + ", counted", counted, {.colour = colour(method), .markers = true});
    chart.line(label(method) + ", formula", formula,
               {.colour = colour(method) + 4, .dashed = true});
  }
  report.picture(
      "figure_5_31.svg", chart.svg(),
      "Fig. 5.31: samples per span: ⌈(2p + 1)/2⌉ against one. `recurrence` takes none at all.");
}

void add_evaluations(Report& report) {
  for (int k = 0; k < 4; ++k) {
    const Over over = k % 2 == 0 ? Over::points : Over::degree;
    const Reuse reuse = k < 2 ? Reuse::none : Reuse::all_in_one;
    const Chart chart = compared(
        fmt::format("Fig. 5.{}: basis functions evaluated{}", 32 + k,
                    k < 2 ? "" : ", values re-used"),
        "evaluations", over, 10,
        [&](int p, int n, ThesisMethod method) { return work(p, n, method, reuse).evaluations; },
        [&](int p, int n, ThesisMethod method) {
          return expected::evaluations(p, n, method, reuse);
        });
    report.picture(
        fmt::format("figure_5_{}.svg", 32 + k), chart.svg(),
        fmt::format(
            "Fig. 5.{}: evaluations against the {}, {}. The formula has n + 1 where the knots have "
            "n − p spans: hence the distance at high degrees.",
            32 + k, over == Over::points ? "number of points" : "degree",
            k < 2 ? "each function from its own triangle of values (three for the Gaussian method, "
                    "five for the analytic)"
                  : "one triangle for all four Gramians"));
  }
}

void add_recursions(Report& report) {
  for (int k = 0; k < 3; ++k) {
    const Over over = k == 0 ? Over::points : Over::degree;
    const Chart chart = compared(
        fmt::format("Fig. 5.{}: operations to evaluate the basis functions{}", 36 + k,
                    k == 2 ? ", low degrees" : ""),
        "operations", over, k == 2 ? 5 : 10,
        [](int p, int n, ThesisMethod method) { return work(p, n, method).recursions.total(); },
        [](int p, int n, ThesisMethod method) { return expected::recursions(p, n, method); });
    report.picture(
        fmt::format("figure_5_{}.svg", 36 + k), chart.svg(),
        fmt::format(
            "Fig. 5.{}: operations inside the triangles of values and derivatives, against the {}. "
            "The formula counts branches of whole triangles (five operations forward, three "
            "backward); "
            "what is run leaves out what is zero or outside of the trapezium of Fig. 5.26.",
            36 + k, k == 0 ? "number of points" : "degree"));
  }
}

void add_totals(Report& report) {
  const auto total = [](int p, int n, ThesisMethod method) {
    return work(p, n, method).operations.total();
  };
  const auto formula = [](int p, int n, ThesisMethod method) {
    return expected::operations(p, n, method);
  };
  for (const Over over : {Over::points, Over::degree}) {
    const int number = over == Over::points ? 39 : 40;
    Chart chart =
        compared(fmt::format("Fig. 5.{}: operations for all four Gramians", number), "operations",
                 over, over == Over::points ? 10 : highest_degree, total, formula);
    chart.logarithmic(false, true);
    for (const GramianMethod method : all_methods) {
      Points points;
      for (int k = 1; k <= 10; ++k) {
        const int p = over == Over::points ? 3 : k, n = over == Over::points ? 100 * k : 100;
        if (method == GramianMethod::gauss && p > highest_kernel) break;
        points.emplace_back(over == Over::points ? n : p, operations(p, n, method));
      }
      const int colour = method == GramianMethod::gauss      ? 6
                         : method == GramianMethod::analytic ? 3
                                                             : 2;
      chart.line("ours: " + std::string(name(method)), points, {.colour = colour, .markers = true});
    }
    report.picture(
        fmt::format("figure_5_{}.svg", number), chart.svg(),
        fmt::format("Fig. 5.{}: all operations against the {}. *Gaussian* and *analytic* are the "
                    "thesis' Algs. 5.1 and 5.5; *ours* are the methods of the library: kernels for "
                    "`gauss` (to degree 7) and `recurrence`, and an `analytic` that is written for "
                    "every multiplicity of knots, not for speed.",
                    number, over == Over::points ? "number of points" : "degree"));
  }

  std::vector<Surface> surfaces = {
      {"Gaussian (Alg. 5.1)", {}}, {"analytic (Alg. 5.5)", {}}, {"recurrence", {}}};
  std::vector<std::string> degrees, counts;
  for (int n = 100; n <= 1000; n += 150) counts.push_back(fmt::format("{}", n));
  for (int p = 1; p <= highest_kernel; ++p) {
    degrees.push_back(fmt::format("{}", p));
    for (Surface& surface : surfaces) surface.heights.emplace_back();
    for (int n = 100; n <= 1000; n += 150) {
      surfaces[0].heights.back().push_back(static_cast<double>(total(p, n, both[0])));
      surfaces[1].heights.back().push_back(static_cast<double>(total(p, n, both[1])));
      surfaces[2].heights.back().push_back(operations(p, n, GramianMethod::recurrence));
    }
  }
  report.picture("figure_5_41.svg",
                 surface_svg("Fig. 5.41: operations against points and degree, counted", "degree",
                             "number of control points", degrees, counts, surfaces),
                 "Fig. 5.41: both at once. The ratio of the surfaces does not depend on the number "
                 "of points.");

  report.text(
      "\n### Operations per span, all four Gramians\n\nCounted: the difference of 200 and 100 "
      "functions. *formula* is "
      "what "
      "the text of thesis § 5.9.1 adds up to per span.\n\n"
      "| degree | Gaussian: formula | Alg. 5.1 counted | analytic: formula | Alg. 5.5 counted | "
      "Alg. 5.1 / Alg. 5.5 | "
      "kernel gauss | kernel recurrence | gauss / recurrence | Alg. 5.5 / recurrence | analytic, "
      "every multiplicity |\n"
      "|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  for (int p = 1; p <= highest_degree; ++p) {
    double algorithm[2], by_formula[2];
    for (int m = 0; m < 2; ++m) {
      algorithm[m] = per_span([&](int n) { return static_cast<double>(total(p, n, both[m])); });
      by_formula[m] = per_span([&](int n) { return formula(p, n, both[m]); });
    }
    const auto kernel = [&](GramianMethod method) {
      return per_span([&](int n) { return operations(p, n, method); });
    };
    const double gauss = kernel(GramianMethod::gauss),
                 recurrence = kernel(GramianMethod::recurrence);
    const auto or_none = [&](const std::string& text) {
      return p <= highest_kernel ? text : std::string("–");
    };
    report.text(
        fmt::format("| {} | {:.0f} | {:.0f} | {:.0f} | {:.0f} | {:.2f} | {} | {:.0f} | {} | {:.2f} "
                    "| {:.0f} |\n",
                    p, by_formula[0], algorithm[0], by_formula[1], algorithm[1],
                    algorithm[0] / algorithm[1], or_none(fmt::format("{:.0f}", gauss)), recurrence,
                    or_none(fmt::format("{:.2f}", gauss / recurrence)), algorithm[1] / recurrence,
                    kernel(GramianMethod::analytic)));
  }
}

}  // namespace

void add_counts(Report& report) {
  report.text(
      "\n## Cost: Figs. 5.31 to 5.41\n\n"
      "Solid lines are counted while the thesis' Algs. 5.1 and 5.5 run on numbers that count every "
      "operation; dashed "
      "lines "
      "are the formulas of thesis § 5.9.1. Uniform clamped knots; 100 control points where the "
      "degree varies, cubic "
      "where "
      "the number of points does. The results of those runs are compared with `recurrence` in the "
      "tests.\n");
  add_samples(report);
  add_evaluations(report);
  add_recursions(report);
  add_totals(report);
}

}  // namespace knead::figures
