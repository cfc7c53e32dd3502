#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "knead/gramian/gramian.hpp"

namespace knead::figures {

inline constexpr std::array<GramianMethod, 3> all_methods = {GramianMethod::gauss, GramianMethod::analytic,
                                                             GramianMethod::recurrence};

using CsvRow = std::map<std::string, std::string>;
/// Rows of a comma-separated file by the names of its first line; empty where there is no such file.
[[nodiscard]] std::vector<CsvRow> read_csv(const std::string& path);

/// The knots of the thesis' tables: 0 … last with 7 replaced by 6 + 10^-r, every knot times `scale`, clamped.
[[nodiscard]] KnotVector thesis_knots(int degree, int r, double scale = 1, int last = 13);

/// One row of Tables 5.3 to 5.14 and 5.17 to 5.20, published and computed.
struct TableRow {
  std::string table, term;
  int degree = 0, r = 0, i = 0, j = 0;
  double exact = 0;                                         ///< by exact rational arithmetic
  std::string thesis_exact, thesis_gauss, thesis_analytic;  ///< as printed
  bool thesis_exact_is_right = true;                        ///< to its last digit
  std::array<double, 3> ours{};                             ///< by all_methods

  /// Relative error of method k; on the diagonal of G10, which is zero, the error itself.
  [[nodiscard]] double error(std::size_t k) const;
};
[[nodiscard]] std::vector<TableRow> table_rows(const std::vector<CsvRow>& published);

/// Table 5.15 (fourth integrals) and 5.16 (Dirac weights and integrals), published and computed: name of the column,
/// exact value, ours.
struct CheckedValue {
  std::string row, column;
  double exact = 0, ours = 0;
};
[[nodiscard]] std::vector<CheckedValue> table_5_15(const std::vector<CsvRow>& published);
[[nodiscard]] std::vector<CheckedValue> table_5_16(const std::vector<CsvRow>& published);

/// All tables as Markdown.
[[nodiscard]] std::string tables_markdown(const std::string& data);

}  // namespace knead::figures
