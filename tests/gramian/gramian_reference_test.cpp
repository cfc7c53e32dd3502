// The published tables: thesis Tables 5.3 to 5.14 and 5.17 to 5.20 and Figs. 5.50 to 5.57, against
// their exact values.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "figures/csv.hpp"
#include "knead/gramian/gramian.hpp"
#include "support/knot_families.hpp"

namespace knead {
namespace {

const std::string published = KNEAD_SOURCE_DIR "/apps/figures/data/";

const BandMatrix& term(const GramianSet& set, const std::string& name) {
  return name == "G00" ? set.g00 : name == "G11" ? set.g11 : name == "G22" ? set.g22 : set.g10;
}

struct TableEntry {
  std::string table;
  int degree, r;
  bool vanishes;  ///< G10 on the diagonal, exactly zero; its error is measured beside 1
  double exact, value;
  [[nodiscard]] double error() const {
    return std::abs(value - exact) / (vanishes ? 1 : std::abs(exact));
  }
};

std::vector<TableEntry> table_entries(GramianMethod method) {
  std::vector<TableEntry> entries;
  for (const auto& row : figures::read_csv(published + "tables_5_3_to_5_20.csv")) {
    const std::string& table = row.at("table");
    const int p = std::stoi(row.at("degree")), r = std::stoi(row.at("r"));
    // These tables divide every knot by 13.
    const bool normalised = std::stoi(table.substr(2)) >= 17;
    const GramianSet set =
        *gramians(testing::thesis_knots(p, r, normalised ? 1.0 / 13 : 1.0), method);
    entries.push_back({table, p, r, row.at("term") == "G10", std::stod(row.at("exact")),
                       term(set, row.at("term"))(std::stoi(row.at("i")), std::stoi(row.at("j")))});
  }
  return entries;
}

TEST(ThesisTables, gauss_gives_every_exact_entry_to_the_last_digits) {
  const auto entries = table_entries(GramianMethod::gauss);
  ASSERT_FALSE(entries.empty());
  for (const auto& entry : entries)
    EXPECT_LE(entry.error(), 1e-14) << entry.table << ", r = " << entry.r;
}

// Its rounding errors are divided by the distance 10^-r of the two knots, as thesis § 5.9.2 found.
TEST(ThesisTables, analytic_gives_every_exact_entry_but_loses_up_to_a_digit_with_each_r) {
  const auto entries = table_entries(GramianMethod::analytic);
  ASSERT_FALSE(entries.empty());
  for (const auto& entry : entries) {
    EXPECT_LE(entry.error(), 1e-14 + 1e-15 * std::pow(10, entry.r))
        << entry.table << ", r = " << entry.r;
  }
}

TEST(ThesisFigures, both_methods_give_the_cubic_matrices_of_figures_5_50_to_5_57) {
  const auto rows = figures::read_csv(published + "figures_5_50_to_5_57.csv");
  ASSERT_FALSE(rows.empty());
  const KnotVector knots = testing::uniform_clamped(3, 13);
  for (const GramianMethod method : {GramianMethod::gauss, GramianMethod::analytic}) {
    const GramianSet set = *gramians(knots, method);
    for (const auto& row : rows) {
      const int i = std::stoi(row.at("i")), j = std::stoi(row.at("j"));
      const double exact = std::stod(row.at("exact"));
      EXPECT_NEAR(term(set, row.at("term"))(i, j), exact, 2e-15 * std::max(1.0, std::abs(exact)))
          << row.at("term") << " " << i << " " << j << " by " << name(method);
    }
  }
}

}  // namespace
}  // namespace knead
