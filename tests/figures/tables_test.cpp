// Every entry of the thesis' tables against the published exact values that the project carries.
#include "figures/tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace knead::figures {
namespace {

const std::string data = KNEAD_FIGURES_DATA;

TEST(Tables, hold_every_published_row) {
  EXPECT_EQ(table_rows(read_csv(data + "/tables_5_3_to_5_20.csv")).size(), 176u);
  EXPECT_EQ(read_csv(data + "/table_5_15.csv").size(), 8u);
  EXPECT_EQ(read_csv(data + "/table_5_16.csv").size(), 12u);
}

TEST(Tables, agree_with_the_exact_values_by_gauss_and_recurrence) {
  for (const TableRow& row : table_rows(read_csv(data + "/tables_5_3_to_5_20.csv"))) {
    for (std::size_t k = 0; k < all_methods.size(); ++k) {
      if (all_methods[k] == GramianMethod::analytic) continue;
      EXPECT_LE(row.error(k), 1e-14) << "Table " << row.table << ", r = " << row.r;
    }
  }
}

TEST(Tables, agree_with_the_exact_values_by_the_analytic_method_but_for_a_digit_per_r) {
  for (const TableRow& row : table_rows(read_csv(data + "/tables_5_3_to_5_20.csv"))) {
    EXPECT_LE(row.error(1), 1e-14 + 1e-15 * std::pow(10, row.r)) << "Table " << row.table << ", r = " << row.r;
  }
}

// A printed value is wrong where it is not the rounding of the exact one: more than half a unit of its last digit away.
TEST(Tables, mark_the_wrong_digits_of_the_thesis_and_no_others) {
  int marked = 0;
  for (const CsvRow& row : read_csv(data + "/tables_5_3_to_5_20.csv")) {
    const std::string& printed = row.at("thesis_exact");
    const auto decimals = static_cast<int>(printed.size() - printed.find('.') - 1);
    // More digits than doubles hold are at stake.
    const long double units = std::abs(std::stold(printed) - std::stold(row.at("exact"))) * std::pow(10.0L, decimals);
    if (row.at("thesis_exact_ok") == "0") {
      ++marked;
      EXPECT_GT(units, 0.5L) << row.at("table") << ", r = " << row.at("r");
    } else {
      EXPECT_LE(units, 0.5001L) << row.at("table") << ", r = " << row.at("r");
    }
  }
  EXPECT_EQ(marked, 7);
}

TEST(Tables, of_integrals_and_dirac_weights_agree_with_the_exact_values) {
  for (const CheckedValue& value : table_5_15(read_csv(data + "/table_5_15.csv"))) {
    EXPECT_NEAR(value.ours, value.exact, 1e-14 * std::abs(value.exact)) << value.row;
  }
  // 6 + 1e-10 is off by up to half an ulp of 6 as a double, which is 4e-6 of the gap.
  for (const CheckedValue& value : table_5_16(read_csv(data + "/table_5_16.csv"))) {
    EXPECT_NEAR(value.ours, value.exact, 5e-6 * std::abs(value.exact)) << value.row << " " << value.column;
  }
}

TEST(Tables, are_carried_as_they_were_published) {
  const std::string reference = std::string(KNEAD_SHARED_DIR) + "/reference/";
  for (const char* name : {"tables_5_3_to_5_20.csv", "table_5_15.csv", "table_5_16.csv"}) {
    const auto published = read_csv(reference + name);
    if (published.empty()) GTEST_SKIP() << "the published values are not at " << reference;
    EXPECT_EQ(published, read_csv(data + "/" + name)) << name;
  }
}

}  // namespace
}  // namespace knead::figures
