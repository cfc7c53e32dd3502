#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figures/cancellation.hpp"
#include "figures/figures.hpp"
#include "figures/svg.hpp"
#include "figures/tables.hpp"

namespace knead::figures {
namespace {

constexpr double epsilon = 2.2e-16, half_ulp = 1.1e-16;

double percent(double error) {
  return 100 * std::max(error, half_ulp);
}  // an entry without error: half an ulp

/// The worst of several degrees at each r, for methods whose error does not depend on r.
Points worst(const std::vector<TableRow>& rows, const std::string& term, bool normalised,
             std::size_t method) {
  Points points;
  for (int r = 0; r <= 10; ++r) {
    double error = 0;
    for (const TableRow& row : rows) {
      if (row.term == term && row.r == r && row.normalised() == normalised)
        error = std::max(error, row.error(method));
    }
    points.emplace_back(std::pow(10, -r), percent(error));
  }
  return points;
}

Points by_analytic(const std::vector<TableRow>& rows, const std::string& term, int degree,
                   bool normalised, bool ours) {
  Points points;
  for (const TableRow& row : rows) {
    if (row.term != term || row.degree != degree || row.normalised() != normalised) continue;
    const double error = ours ? row.error(1) : row.error_of(std::stold(row.printed_analytic));
    points.emplace_back(std::pow(10, -row.r), ours ? percent(error) : 100 * error);
  }
  // The thesis prints 15 digits: differences within their rounding count as no error, as in its
  // figures.
  if (!ours) std::erase_if(points, [](const auto& point) { return point.second < 100 * 2e-15; });
  return points;
}

Chart against_spacing(const std::string& title) {
  Chart chart(title, "distance of the two knots, 10⁻ʳ", "relative error, %");
  chart.logarithmic(true, true);
  return chart;
}

void add_by_degree(Report& report, const std::vector<TableRow>& rows, const std::string& term,
                   const std::string& file, int number) {
  Chart chart = against_spacing(
      fmt::format("Fig. 5.{}: error against the distance of two knots, {}", number, term));
  for (int p = 3; p <= 5; ++p) {
    chart.line(fmt::format("analytic, p = {}", p), by_analytic(rows, term, p, false, true),
               {.colour = p - 3, .markers = true});
    chart.line(fmt::format("thesis, p = {}", p), by_analytic(rows, term, p, false, false),
               {.colour = p - 3, .dashed = true, .markers = true});
  }
  chart.line("gauss, worst p", worst(rows, term, false, 0), {.colour = 6});
  chart.line("recurrence, worst p", worst(rows, term, false, 2), {.colour = 9});
  report.picture(
      file, chart.svg(),
      fmt::format(
          "Fig. 5.{}: {}, the entries of the tables. Dashed: what the thesis' analytic column has, "
          "where its 15 digits show an error. No error is drawn as half an ulp.",
          number, term));
}

void add_terms(Report& report) {
  constexpr int degrees[] = {3, 6, 10};
  struct Part {
    const char *file, *what;
  };
  constexpr Part parts[] = {{"figure_5_48_a.svg", "Dirac weights, absolute"},
                            {"figure_5_48_b.svg", "repeated integrals"},
                            {"figure_5_48_c.svg", "products of weight and integral, absolute"}};
  for (int part = 0; part < 3; ++part) {
    Chart chart(fmt::format("Fig. 5.48 ({}): {}", static_cast<char>('a' + part), parts[part].what),
                "distance of the two knots, 10⁻ʳ", "size");
    chart.logarithmic(true, true);
    for (std::size_t d = 0; d < 3; ++d) {
      for (std::size_t k = 0; k < 2; ++k) {
        Points points;
        for (int r = 0; r <= 10; ++r) {
          const Cancellation at = cancellation(degrees[d], r);
          const double value = part == 0   ? at.weight[k]
                               : part == 1 ? at.integral[k]
                                           : at.weight[k] * at.integral[k];
          points.emplace_back(std::pow(10, -r), std::abs(value));
        }
        chart.line(fmt::format("p = {}, at {}", degrees[d], k == 0 ? "6" : "6 + 10⁻ʳ"), points,
                   {.colour = static_cast<int>(d + 3 * k), .dashed = k == 1, .markers = k == 0});
      }
    }
    report.picture(
        parts[part].file, chart.svg(),
        fmt::format(
            "Fig. 5.48 ({}): {} at the two close knots, for N_8, N_11 and N_15. The two of a "
            "degree lie over each other as the knots meet{}",
            static_cast<char>('a' + part), parts[part].what,
            part == 0 ? ", and have opposite signs."
            : part == 1
                ? ": the integrals fall with the degree."
                : "; their difference is what counts, and the entry it belongs to is of size "
                  "0.5 to 0.3."));
  }
}

void add_normalised(Report& report, const std::vector<TableRow>& rows) {
  constexpr const char* terms[] = {"G00", "G11", "G22"};
  Chart chart = against_spacing("Fig. 5.49: error on knots divided by 13, cubic");
  for (int t = 0; t < 3; ++t) {
    chart.line(std::string(terms[t]) + ", normalised", by_analytic(rows, terms[t], 3, true, true),
               {.colour = t, .markers = true});
    chart.line(std::string(terms[t]) + ", as it was", by_analytic(rows, terms[t], 3, false, true),
               {.colour = t, .dashed = true});
  }
  chart.line("thesis: G00, normalised", by_analytic(rows, "G00", 3, true, false),
             {.colour = 3, .dashed = true, .markers = true});
  report.picture("figure_5_49.svg", chart.svg(),
                 "Fig. 5.49: the analytic method on normalised knots. The errors are others, not "
                 "smaller ones: the thesis' improvement is the luck of one entry.");
}

void add_cancellation(Report& report) {
  report.text(
      "\n### Why the Dirac rule loses digits\n\n"
      "The entry (p + 5, p + 5) of G00 as the sum of weight × integral over its knots. Σ|t|/|Σt| "
      "is what rounding is "
      "multiplied by. Kahan's summation and knots divided by 13 do not help; integrals from the "
      "right are "
      "worse for this entry, as they are larger where the knots are close; see "
      "`docs/gramians/error-analysis.md`.\n\n"
      "| p | r | Σ\\|t\\| / entry | ε Σ\\|t\\| / entry | error, plain sum | Kahan sum | knots / 13 "
      "| from the right |\n"
      "|--:|--:|---|---|---|---|---|---|\n");
  for (const int p : {3, 5, 10}) {
    for (int r = 0; r <= 10; r += 2) {
      const Cancellation at = cancellation(p, r);
      report.text(fmt::format("| {} | {} | {:.2g} | {:.0e} | {:.0e} | {:.0e} | {:.0e} | {:.0e} |\n",
                              p, r, at.condition, epsilon * at.condition, at.plain, at.kahan,
                              at.normalised, at.mirrored));
    }
  }
  report.text(
      "\nThe entry of the tables is a lucky one. The largest relative error of *any* entry of G00 "
      "by the analytic method, against recurrence:\n\n| p | r = 6 | r = 8 | r = 10 | r = 10, "
      "better side for each entry | three knots 1e-8 apart |\n|--:|---|---|---|---|---|\n");
  for (const int p : {1, 2, 3, 5, 7, 10}) {
    report.text(fmt::format("| {} | {:.0e} | {:.0e} | {:.0e} | {:.0e} | {:.0e} |\n", p,
                            worst_on_thesis_knots(p, 6), worst_on_thesis_knots(p, 8),
                            worst_on_thesis_knots(p, 10), worst_by_better_side(p, 10),
                            worst_on_cluster(p)));
  }
}

}  // namespace

void add_errors(Report& report, const std::string& data) {
  report.text("\n## Errors: Figs. 5.46 to 5.49\n");
  const auto rows = table_rows(data);
  add_by_degree(report, rows, "G00", "figure_5_46.svg", 46);
  add_by_degree(report, rows, "G11", "figure_5_47_g11.svg", 47);
  add_by_degree(report, rows, "G22", "figure_5_47_g22.svg", 47);
  add_terms(report);
  add_normalised(report, rows);
  add_cancellation(report);
}

}  // namespace knead::figures
