#include <fmt/format.h>

#include <array>
#include <cmath>

#include "figures/digits.hpp"
#include "figures/figures.hpp"
#include "figures/svg.hpp"
#include "figures/tables.hpp"
#include "figures/thesis_knots.hpp"

namespace knead::figures {

void add_matrices(Report& report, const std::string& data) {
  const KnotVector knots = thesis_knots(3, 0);  // r = 0: the knots 0 … 13
  const std::array<GramianSet, 3> ours = {*gramians(knots, GramianMethod::gauss),
                                          *gramians(knots, GramianMethod::analytic),
                                          *gramians(knots, GramianMethod::recurrence)};
  report.text(
      "\n## Matrices: Figs. 5.50 to 5.57\n\n"
      "Cubic Gramians on {0⁴, 1, …, 12, 13⁴}. The pictures are ours; the tables hold what the "
      "thesis prints (its two "
      "G00 "
      "figures truncate the last digit, the others round) beside our three methods to 15 digits. "
      "**Bold digits are not "
      "those of the exact value.** Of the analytic figures only that of G00 can be read as "
      "text.\n");
  const auto rows = read_csv(data + "/figures_5_50_to_5_57.csv");
  constexpr const char* names[] = {"G00", "G11", "G22", "G10"};
  for (int t = 0; t < 4; ++t) {
    const std::string term = names[t];
    const int number = 50 + 2 * t;
    report.text(fmt::format("\n### Figs. 5.{} and 5.{}: {}\n", number, number + 1, term));
    for (const std::size_t k : {1, 0, 2}) {
      const BandMatrix& matrix = matrix_of(ours[k], term);
      std::vector<std::vector<double>> entries(static_cast<std::size_t>(knots.count()));
      double largest = 0;
      for (int i = 0; i < knots.count(); ++i) {
        for (int j = 0; j < knots.count(); ++j) {
          entries[static_cast<std::size_t>(i)].push_back(matrix(i, j));
          largest = std::max(largest, std::abs(matrix(i, j)));
        }
      }
      const std::string method(name(all_methods[k]));
      const std::string title =
          k == 2 ? fmt::format("{} by recurrence", term)
                 : fmt::format("Fig. 5.{}: {} by {}", number + (k == 0), term, method);
      const std::string file = k == 2 ? fmt::format("matrix_{}_recurrence.svg", term)
                                      : fmt::format("figure_5_{}.svg", number + (k == 0));
      // Entries of rounding alone are left white.
      report.picture(file, matrix_svg(title, entries, 1e-12 * largest), title + ".");
    }
    report.text(
        "\n| i | j | exact | thesis: Gaussian | thesis: analytic | gauss | analytic | recurrence "
        "|\n"
        "|--:|--:|---|---|---|---|---|---|\n");
    for (const CsvRow& row : rows) {
      if (row.at("term") != term) continue;
      const int i = std::stoi(row.at("i")), j = std::stoi(row.at("j"));
      const long double exact = std::stold(row.at("exact"));
      const Cut cut = term == "G00" ? Cut::truncated : Cut::rounded;
      report.text(fmt::format("| {} | {} | {:.17g} | {} | {} |", i, j, static_cast<double>(exact),
                              marked(row.at("printed_gauss"), exact, cut),
                              marked(row.at("printed_analytic"), exact, cut)));
      for (const GramianSet& set : ours) {
        report.text(" " +
                    marked(fmt::format("{:.14e}", matrix_of(set, term)(i, j)), exact, Cut::rounded,
                           two_ulp) +
                    " |");
      }
      report.text("\n");
    }
  }
}

}  // namespace knead::figures
