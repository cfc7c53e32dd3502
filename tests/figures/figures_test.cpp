#include "figures/figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "figures/by_parts.hpp"
#include "figures/svg.hpp"
#include "figures/tables.hpp"
#include "figures/thesis_knots.hpp"

namespace knead::figures {
namespace {

const std::string data = KNEAD_FIGURES_DATA;

const Report& report() {
  static const Report report = whole_report(data);
  return report;
}

TEST(Figures, are_all_there_and_whole) {
  for (const char* number :
       {"01",   "04", "12", "13", "15",     "17",     "19",   "14_1", "14_4", "16_3", "18_2",
        "20_3", "42", "43", "44", "45",     "09_1",   "09_2", "09_3", "09_4", "21",   "22",
        "23",   "24", "25", "31", "32",     "33",     "34",   "35",   "36",   "37",   "38",
        "39",   "40", "41", "46", "47_g11", "47_g22", "48_a", "48_b", "48_c", "49",   "50",
        "51",   "52", "53", "54", "55",     "56",     "57"}) {
    EXPECT_TRUE(report().pictures.contains("figure_5_" + std::string(number) + ".svg")) << number;
  }
  for (const auto& [name, text] : report().pictures) {
    EXPECT_TRUE(text.starts_with("<svg") && text.ends_with("</svg>\n")) << name;
    EXPECT_EQ(text.find("nan"), std::string::npos) << name;
    EXPECT_EQ(text.find("inf"), std::string::npos) << name;
    EXPECT_NE(report().page.find("](" + name + ")"), std::string::npos)
        << name << " is not on the page";
  }
}

TEST(ByParts, keeps_the_integral_in_every_step) {
  const KnotVector knots = *KnotVector::create(3, {0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 6, 6, 6});
  EXPECT_TRUE(report().pictures.contains("figure_4_02.svg"));
  const GramianSet set = *gramians(knots);
  for (const auto& [a, b, entry] : {std::tuple{0, 0, set.g00(4, 4)},
                                    {1, 1, set.g11(4, 4)},
                                    {2, 2, set.g22(4, 4)},
                                    {0, 1, 0.0}}) {
    const auto steps = by_parts(knots, 4, a, b);
    ASSERT_EQ(static_cast<int>(steps.size()), 4 - b);
    double sign = 1;
    for (std::size_t k = 0; k < steps.size(); ++k, sign = -sign) {
      EXPECT_NEAR(sign * steps[k].whole, entry, 1e-14) << a << b << " step " << k;
      EXPECT_NEAR(steps[k].whole, steps[k].boundary - steps[k].rest, 1e-13)
          << a << b << " step " << k;
      if (k + 1 < steps.size()) {
        EXPECT_EQ(steps[k].rest, steps[k + 1].whole);
      }
    }
  }
}

TEST(Figures, page_has_every_table_with_the_columns_of_the_thesis_beside_ours) {
  for (int table = 3; table <= 20; ++table) {
    const std::size_t at = report().page.find("### Table 5." + std::to_string(table) + ":");
    ASSERT_NE(at, std::string::npos) << table;
    const std::string head = report().page.substr(at, 400);
    EXPECT_NE(head.find("thesis: analytic"), std::string::npos) << table;
    if (table == 15 || table == 16) continue;  // not Gramians
    EXPECT_NE(head.find("| gauss | analytic | recurrence |"), std::string::npos) << table;
  }
  EXPECT_NE(report().page.find("0.62222234074060**3** | 0.622222340740602"),
            std::string::npos);  // Table 5.4, r = 6
}

TEST(Figures, of_the_cubic_matrices_have_the_exact_entries_by_all_methods) {
  const KnotVector knots = thesis_knots(3, 0);  // r = 0: the knots 0 … 13
  const auto rows = read_csv(data + "/figures_5_50_to_5_57.csv");
  ASSERT_EQ(rows.size(), 4 * 58u);
  for (const GramianMethod method : all_methods) {
    const GramianSet set = *gramians(knots, method);
    for (const CsvRow& row : rows) {
      const double exact = std::stod(row.at("exact"));
      const double ours =
          matrix_of(set, row.at("term"))(std::stoi(row.at("i")), std::stoi(row.at("j")));
      EXPECT_NEAR(ours, exact, 2e-15 * std::max(1.0, std::abs(exact)))
          << row.at("term") << " " << row.at("i") << " " << row.at("j") << " by " << name(method);
    }
  }
}

TEST(Figures, that_the_docs_show_are_those_that_are_written) {
  for (const char* name : {"figure_5_48_a.svg", "figure_5_48_b.svg", "figure_5_48_c.svg"}) {
    std::ifstream file(std::string(KNEAD_SOURCE_DIR) + "/docs/gramians/" + name);
    const std::string shown((std::istreambuf_iterator<char>(file)),
                            std::istreambuf_iterator<char>());
    EXPECT_EQ(shown, report().pictures.at(name))
        << name << ": copy it from out/figures to docs/gramians";
  }
}

TEST(Chart, leaves_out_what_a_logarithmic_axis_cannot_show) {
  Chart chart("t", "x", "y");
  chart.logarithmic(true, true).line("a", {{1, 1}, {2, 0}, {-1, 5}, {10, 100}});
  EXPECT_EQ(chart.svg().find("nan"), std::string::npos);
  EXPECT_EQ(chart.svg().find("inf"), std::string::npos);
}

TEST(Chart, escapes_what_is_markup) {
  Chart chart("a < b & c", "x", "y");
  chart.line("p", {{0, 0}, {1, 1}});
  EXPECT_NE(chart.svg().find("a &lt; b &amp; c"), std::string::npos);
}

TEST(Chart, of_nothing_is_still_a_picture) {
  EXPECT_TRUE(Chart("t", "x", "y").svg().ends_with("</svg>\n"));
}

}  // namespace
}  // namespace knead::figures
