#include <fmt/format.h>

#include <cmath>

#include "figures/figures.hpp"
#include "figures/svg.hpp"
#include "figures/tables.hpp"
#include "knead/gramian/operation_count.hpp"
#include "knead/spline/basis_integral.hpp"
#include "knead/spline/jumps.hpp"

namespace knead::figures {
namespace {

constexpr int highest_counted = 7;  // the Gauss kernels end there

long operations(int degree, int count, GramianMethod method) {
  return count_operations(*KnotVector::clamped_uniform(degree, count), method).total();
}

std::string label(GramianMethod method) { return std::string(name(method)); }

/// Functions evaluated at all samples: samples per span × functions on a span × spans.
void evaluations(Chart& chart, bool by_degree, bool reused) {
  for (const GramianMethod method : {GramianMethod::gauss, GramianMethod::analytic}) {
    Points points;
    for (int k = 1; k <= 10; ++k) {
      const int p = by_degree ? k : 3, n = by_degree ? 100 : 100 * k;
      const int samples = method == GramianMethod::gauss ? p + 1 : 1;
      // All four terms want the functions with their derivatives (Gauss: three tables; analytic: four integrals); one
      // triangle of values gives them all.
      const int tables = reused ? 1 : method == GramianMethod::gauss ? 3 : 4;
      points.emplace_back(by_degree ? p : n, static_cast<double>(samples * tables * (p + 1)) * (n - p));
    }
    chart.line(label(method), points);
  }
}

}  // namespace

void add_counts(Files& files) {
  {
    Chart chart("Fig. 5.31: samples of the basis functions per span", "degree", "samples");
    for (const GramianMethod method : all_methods) {
      Points points;
      for (int p = 1; p <= 10; ++p) {
        points.emplace_back(p, method == GramianMethod::gauss ? p + 1 : method == GramianMethod::analytic ? 1 : 0);
      }
      chart.line(label(method), points);
    }
    files["figure_5_31.svg"] = chart.svg();
  }
  for (int k = 0; k < 4; ++k) {
    const bool by_degree = k % 2 == 1, reused = k >= 2;
    Chart chart(fmt::format("Fig. 5.{}: evaluations of basis functions{}", 32 + k, reused ? ", values re-used" : ""),
                by_degree ? "degree (100 functions)" : "functions (cubic)", "evaluations");
    evaluations(chart, by_degree, reused);
    files[fmt::format("figure_5_{}.svg", 32 + k)] = chart.svg();
  }
  Chart by_count("Fig. 5.39: operations for all four Gramians, counted", "functions (cubic)", "operations");
  Chart by_degree("Fig. 5.40: operations for all four Gramians, counted", "degree (100 functions)", "operations");
  Chart by_both("Fig. 5.41: operations for all four Gramians, counted", "functions", "operations");
  by_degree.logarithmic(false, true);
  by_both.logarithmic(true, true);
  std::string table =
      "# Operations per row of all four Gramians\n\nCounted by running each method on numbers that count, 200 against "
      "100 functions on uniform knots.\n\n| degree | gauss | analytic | recurrence | gauss / recurrence |\n"
      "|---|---|---|---|---|\n";
  for (const GramianMethod method : all_methods) {
    Points count, degree;
    for (int n = 20; n <= 200; n += 20) count.emplace_back(n, static_cast<double>(operations(3, n, method)));
    for (int p = 1; p <= highest_counted; ++p) degree.emplace_back(p, static_cast<double>(operations(p, 100, method)));
    by_count.line(label(method), count);
    by_degree.line(label(method), degree);
    for (const int p : {1, 3, 5, 7}) {
      Points both;
      for (int n = 16; n <= 1024; n *= 2) both.emplace_back(n, static_cast<double>(operations(p, n, method)));
      by_both.line(fmt::format("{}, p = {}", label(method), p), both);
    }
  }
  for (int p = 1; p <= highest_counted; ++p) {
    double row[3];
    for (std::size_t k = 0; k < 3; ++k) {
      row[k] = static_cast<double>(operations(p, 200, all_methods[k]) - operations(p, 100, all_methods[k])) / 100;
    }
    table += fmt::format("| {} | {:.0f} | {:.0f} | {:.0f} | {:.2f} |\n", p, row[0], row[1], row[2], row[0] / row[2]);
  }
  files["figure_5_39.svg"] = by_count.svg();
  files["figure_5_40.svg"] = by_degree.svg();
  files["figure_5_41.svg"] = by_both.svg();
  files["operations.md"] = table;
}

void add_errors(Files& files, const std::string& data) {
  const auto rows = table_rows(read_csv(data + "/tables_5_3_to_5_20.csv"));
  const auto chart = [&](const std::string& title, const std::vector<std::string>& terms, bool normalised) {
    Chart result(title, "distance of the two knots", "relative error, %");
    result.logarithmic(true, true);
    for (std::size_t k = 0; k < all_methods.size(); ++k) {
      for (const std::string& term : terms) {
        for (const int p : normalised ? std::vector<int>{3} : std::vector<int>{3, 4, 5}) {
          Points points;
          for (const TableRow& row : rows) {
            const bool is_normalised = std::stoi(row.table.substr(2)) >= 17;
            // An entry without error is shown at half an ulp.
            if (row.term == term && row.degree == p && is_normalised == normalised) {
              points.emplace_back(std::pow(10, -row.r), 100 * std::max(row.error(k), 1.1e-16));
            }
          }
          if (!points.empty()) result.line(fmt::format("{} {} p={}", label(all_methods[k]), term, p), points);
        }
      }
    }
    return result.svg();
  };
  files["figure_5_46.svg"] = chart("Fig. 5.46: error against the distance of two knots, G00", {"G00"}, false);
  files["figure_5_47.svg"] = chart("Fig. 5.47: the same for G00, G11 and G22", {"G00", "G11", "G22"}, false);
  files["figure_5_49.svg"] = chart("Fig. 5.49: the same on knots divided by 13", {"G00", "G11", "G22"}, true);

  Chart terms("Fig. 5.48: the terms of the Dirac formula and the entry they add up to", "knot of N_8", "size");
  terms.logarithmic(false, true);
  for (const int r : {0, 4, 8, 10}) {
    const KnotVector knots = thesis_knots(3, r);
    Points points;
    int k = 0;
    for (const KnotJumps& at : derivative_jumps(knots, 8)) {
      points.emplace_back(k++, std::abs(at.jumps.back() * basis_integral(knots, 8, 4, at.knot)));
    }
    points.emplace_back(5, std::abs(gramian(knots, 0, 0)->operator()(8, 8)));
    terms.line(fmt::format("r = {} (last: the entry)", r), points);
  }
  files["figure_5_48.svg"] = terms.svg();
}

void add_matrices(Files& files) {
  std::vector<double> x(3, 0.0);
  for (int k = 0; k <= 13; ++k) x.push_back(k);
  x.insert(x.end(), 3, 13.0);
  const KnotVector knots = *KnotVector::create(3, std::move(x));
  std::string text = "# Figs. 5.50 to 5.57: cubic Gramians on {0⁴, 1, …, 12, 13⁴}\n";
  const char* names[] = {"G00", "G11", "G22", "G10"};
  for (const GramianMethod method : all_methods) {
    const GramianSet set = *gramians(knots, method);
    const BandMatrix* matrices[] = {&set.g00, &set.g11, &set.g22, &set.g10};
    for (int t = 0; t < 4; ++t) {
      std::vector<std::vector<double>> rows(static_cast<std::size_t>(knots.count()));
      text +=
          fmt::format("\n## {} by {}\n\n| i | G(i, i) | G(i, i+1) | G(i, i+2) | G(i, i+3) |\n|---|---|---|---|---|\n",
                      names[t], label(method));
      for (int i = 0; i < knots.count(); ++i) {
        text += fmt::format("| {} ", i);
        for (int j = 0; j < knots.count(); ++j) rows[static_cast<std::size_t>(i)].push_back((*matrices[t])(i, j));
        for (int s = 0; s <= 3; ++s) {
          text += i + s < knots.count() ? fmt::format("| {:.15g} ", (*matrices[t])(i, i + s)) : "| ";
        }
        text += "|\n";
      }
      const int number = 50 + 2 * t + (method == GramianMethod::gauss ? 1 : 0);
      const std::string file = method == GramianMethod::recurrence ? fmt::format("matrix_{}_recurrence.svg", names[t])
                                                                   : fmt::format("figure_5_{}.svg", number);
      files[file] = matrix_svg(fmt::format("{} by {}", names[t], label(method)), rows);
    }
  }
  files["matrices.md"] = text;
}

}  // namespace knead::figures
