// Every entry of the thesis' tables and matrices against exact values: those that the project
// carries (21 digits, held here against quadruple precision), and those published, where a foreign
// folder has them.
#include "figures/tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "figures/digits.hpp"
#include "figures/thesis_knots.hpp"
#include "support/foreign_files.hpp"
#include "support/quad_gramian.hpp"

namespace knead::figures {
namespace {

using testing::Quad;

const std::string data = KNEAD_FIGURES_DATA;

/// 21 digits are carried: what the rounding of the two numbers read may make of them.
constexpr long double carried = 2e-19L;

/// The entry of the thesis' Gramian with 10^-r as the exact decimal number, which no double is.
Quad quad_entry(const std::string& term, int p, int r, bool normalised, int i, int j) {
  std::vector<Quad> x(static_cast<std::size_t>(p), Quad(0));
  Quad power = 1;
  for (int k = 0; k < r; ++k) power *= 10;
  for (int k = 0; k <= 13; ++k) x.push_back(k == 7 ? 6 + 1 / power : Quad(k));
  x.insert(x.end(), static_cast<std::size_t>(p), Quad(13));
  if (normalised) {
    for (Quad& knot : x) knot /= 13;
  }
  Quad sum = 0;
  const testing::QuadRule rule = testing::quad_rule(p + 1);
  for (int s = std::max(i, j); s <= std::min(i, j) + p; ++s) {
    const auto at = static_cast<std::size_t>(s);
    const Quad h = x[at + 1] - x[at];
    if (s < p || !(h > 0)) continue;
    for (std::size_t g = 0; g < rule.t.size(); ++g) {
      const Quad u = x[at] + h * rule.t[g];
      const auto f = testing::quad_span_basis(x, p, term[1] - '0', s, u);
      const auto k = testing::quad_span_basis(x, p, term[2] - '0', s, u);
      sum += h * rule.weight[g] * f[static_cast<std::size_t>(i - s + p)] *
             k[static_cast<std::size_t>(j - s + p)];
    }
  }
  return sum;
}

TEST(Tables, hold_every_published_row) {
  EXPECT_EQ(table_rows(data).size(), 176u);
  EXPECT_EQ(table_5_15(data).size(), 8u);
  EXPECT_EQ(table_5_16(data).size(), 4 * 12u);
  EXPECT_EQ(read_csv(data + "/figures_5_50_to_5_57.csv").size(), 4 * 58u);
}

TEST(Tables, carry_exact_values_that_are_those_of_quadruple_precision) {
  for (const TableRow& row : table_rows(data)) {
    const Quad exact = quad_entry(row.term, row.degree, row.r, row.normalised(), row.i, row.j);
    // G10 vanishes on the diagonal; what cancels there is of size 1.
    const long double size = row.exact == 0 ? 1e-10L : std::abs(row.exact);
    EXPECT_LE(static_cast<long double>(testing::magnitude(exact - Quad(row.exact))), carried * size)
        << row.table << ", r = " << row.r;
  }
  for (const CsvRow& row : read_csv(data + "/figures_5_50_to_5_57.csv")) {
    const long double carried_value = std::stold(row.at("exact"));
    const Quad exact =
        quad_entry(row.at("term"), 3, 0, false, std::stoi(row.at("i")), std::stoi(row.at("j")));
    const long double size = carried_value == 0 ? 1e-10L : std::abs(carried_value);
    EXPECT_LE(static_cast<long double>(testing::magnitude(exact - Quad(carried_value))),
              carried * size)
        << row.at("term") << " " << row.at("i") << " " << row.at("j");
  }
}

TEST(Tables, agree_with_the_exact_values_by_gauss_and_recurrence) {
  for (const TableRow& row : table_rows(data)) {
    for (std::size_t k = 0; k < all_methods.size(); ++k) {
      if (all_methods[k] == GramianMethod::analytic) continue;
      EXPECT_LE(row.error(k), 1e-14) << "Table " << row.table << ", r = " << row.r;
    }
  }
}

TEST(Tables, agree_with_the_exact_values_by_the_analytic_method_but_for_a_digit_per_r) {
  for (const TableRow& row : table_rows(data)) {
    EXPECT_LE(row.error(1), 1e-14 + 1e-15 * std::pow(10, row.r))
        << "Table " << row.table << ", r = " << row.r;
  }
}

TEST(Tables, mark_the_wrong_digits_of_the_thesis_exact_columns_and_no_others) {
  std::set<std::string> wrong;
  for (const TableRow& row : table_rows(data)) {
    if (!is_right(row.printed_exact, row.exact))
      wrong.insert(row.table + " r=" + std::to_string(row.r));
  }
  EXPECT_EQ(wrong, (std::set<std::string>{"5.4 r=6", "5.9 r=7", "5.12 r=4", "5.12 r=7", "5.17 r=4",
                                          "5.18 r=5", "5.18 r=7"}));
}

TEST(Tables, of_integrals_and_dirac_weights_agree_with_the_exact_values) {
  for (const CheckedValue& value : table_5_15(data)) {
    EXPECT_NEAR(value.ours, static_cast<double>(value.exact),
                static_cast<double>(1e-14L * std::abs(value.exact)))
        << value.row;
    EXPECT_TRUE(is_right(value.printed_exact, value.exact)) << value.row;
  }
  // 6 + 1e-10 is off by up to half an ulp of 6 as a double, which is 4e-6 of the gap.
  for (const CheckedValue& value : table_5_16(data)) {
    EXPECT_NEAR(value.ours, static_cast<double>(value.exact),
                static_cast<double>(5e-6L * std::abs(value.exact)))
        << value.row << " " << value.column;
  }
}

TEST(Tables, mark_the_three_slips_of_table_5_16) {
  std::set<std::string> slips;
  for (const CheckedValue& value : table_5_16(data)) {
    if (value.printed_analytic.empty()) continue;
    const long double printed = std::stold(value.printed_analytic);
    if (std::abs(printed - value.exact) > 1e-4L * std::abs(value.exact))
      slips.insert(value.row + " " + value.column);
  }
  EXPECT_EQ(slips,
            (std::set<std::string>{"12 11th integral", "16 10th derivative (left of the knot)",
                                   "6 + 10⁻¹⁰ product"}));
}

TEST(Tables, are_carried_as_they_were_published) {
  struct Pair {
    const char *file, *carried, *published;
  };
  constexpr const char *tables = "tables_5_3_to_5_20.csv", *integrals = "table_5_15.csv",
                       *diracs = "table_5_16.csv", *matrices = "figures_5_50_to_5_57.csv";
  const std::filesystem::path reference = testing::foreign("reference");
  for (const char* file : {tables, integrals, diracs, matrices}) KNEAD_NEEDS(reference / file);
  // Numbers to 21 digits, what the thesis prints letter by letter.
  for (const Pair& pair : {Pair{tables, "exact", "exact"},
                           {tables, "printed_exact", "thesis_exact"},
                           {tables, "printed_gauss", "thesis_gauss"},
                           {tables, "printed_analytic", "thesis_analytic"},
                           {integrals, "exact", "exact"},
                           {integrals, "printed_exact", "thesis_exact"},
                           {integrals, "printed_analytic", "thesis_analytic"},
                           {diracs, "integral", "integral11"},
                           {diracs, "dirac_weight", "dirac_weight"},
                           {diracs, "product", "product"},
                           {matrices, "exact", "exact"},
                           {matrices, "printed_gauss", "thesis_gauss"},
                           {matrices, "printed_analytic", "thesis_analytic"}}) {
    const auto ours = read_csv(data + "/" + pair.file),
               published = read_csv((reference / pair.file).string());
    ASSERT_EQ(ours.size(), published.size()) << pair.file;
    const bool letters = std::string(pair.carried).starts_with("printed");
    for (std::size_t k = 0; k < ours.size(); ++k) {
      for (const char* key : {"i", "j", "r", "term", "table", "degree", "knot", "knot_index"}) {
        if (!ours[k].contains(key)) continue;
        EXPECT_EQ(ours[k].at(key), published[k].at(key)) << pair.file << " " << k;
      }
      const std::string &here = ours[k].at(pair.carried), &there = published[k].at(pair.published);
      if (letters) {
        EXPECT_EQ(here, there) << pair.file << " " << k;
      } else {
        EXPECT_LE(std::abs(std::stold(here) - std::stold(there)),
                  carried * std::abs(std::stold(there)))
            << pair.file << " " << pair.carried << " " << k;
      }
    }
  }
}

TEST(Digits, are_marked_from_the_first_wrong_one) {
  EXPECT_EQ(marked("0.4613", 0.46126L), "0.4613");
  EXPECT_EQ(marked("0.4612", 0.46126L), "0.461**2**");
  EXPECT_EQ(marked("0.4612", 0.46126L, Cut::truncated), "0.4612");
  EXPECT_EQ(marked("0.4713", 0.46126L), "0.4**713**");
  EXPECT_EQ(marked("-1.25e-9", 1.25e-9L), "**-1.25**e-9");
  EXPECT_EQ(marked("3.31e-9", 3.30e-9L), "3.3**1**e-9");
  EXPECT_EQ(marked("1.5e-17", 0), "**1.5**e-17");
  EXPECT_EQ(marked("0", 0), "0");
  EXPECT_EQ(marked("", 1), "");
  EXPECT_EQ(marked("0.12", 0.12501L, Cut::rounded, 0.001), "0.12");
  EXPECT_EQ(marked("0.12", 0.12501L), "0.1**2**");
}

TEST(Digits, are_printed_like_the_pattern) {
  EXPECT_EQ(printed_like("0.123", 2.0 / 3), "0.667");
  EXPECT_EQ(printed_like("1.23e-4", 12345.0), "1.23e4");
  EXPECT_EQ(printed_like("1.23e-4", 0.00012345), "1.23e-4");
}

}  // namespace
}  // namespace knead::figures
