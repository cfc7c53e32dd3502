#include "figures/figures.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "figures/svg.hpp"
#include "figures/tables.hpp"

namespace knead::figures {
namespace {

const std::string data = KNEAD_FIGURES_DATA;

Files all_files() {
  Files files;
  add_curves(files);
  add_counts(files);
  add_errors(files, data);
  add_matrices(files);
  return files;
}

TEST(Figures, are_all_there_and_whole) {
  const Files files = all_files();
  for (const char* number :
       {"01", "09_1", "09_2", "09_3", "21", "22", "23", "24", "25", "31", "32", "33", "34", "35", "39",
        "40", "41",   "46",   "47",   "48", "49", "50", "51", "52", "53", "54", "55", "56", "57"}) {
    EXPECT_TRUE(files.contains("figure_5_" + std::string(number) + ".svg")) << number;
  }
  for (const auto& [name, text] : files) {
    if (!name.ends_with(".svg")) continue;
    EXPECT_TRUE(text.starts_with("<svg") && text.ends_with("</svg>\n")) << name;
    EXPECT_EQ(text.find("nan"), std::string::npos) << name;
    EXPECT_EQ(text.find("inf"), std::string::npos) << name;
  }
}

TEST(Figures, of_the_cubic_matrices_have_the_published_entries) {
  for (const CsvRow& row : read_csv(data + "/figures_5_50_to_5_57.csv")) {
    const GramianSet set = *gramians(thesis_knots(3, 0), GramianMethod::recurrence);  // r = 0: the knots 0 … 13
    const std::string& term = row.at("term");
    const BandMatrix& matrix = term == "G00" ? set.g00 : term == "G11" ? set.g11 : term == "G22" ? set.g22 : set.g10;
    const double exact = std::stod(row.at("exact"));
    EXPECT_NEAR(matrix(std::stoi(row.at("i")), std::stoi(row.at("j"))), exact, 2e-15 * std::max(1.0, std::abs(exact)));
  }
}

TEST(Chart, leaves_out_what_a_logarithmic_axis_cannot_show) {
  Chart chart("t", "x", "y");
  chart.logarithmic(true, true).line("a", {{1, 1}, {2, 0}, {-1, 5}, {10, 100}});
  EXPECT_EQ(chart.svg().find("nan"), std::string::npos);
  EXPECT_EQ(chart.svg().find("inf"), std::string::npos);
}

}  // namespace
}  // namespace knead::figures
