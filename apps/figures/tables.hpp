#pragma once

#include <array>
#include <string>
#include <vector>

#include "figures/csv.hpp"
#include "knead/gramian/gramian.hpp"

namespace knead::figures {

inline constexpr std::array<GramianMethod, 3> all_methods = {
    GramianMethod::gauss, GramianMethod::analytic, GramianMethod::recurrence};

/// G00, G11, G22 or G10 by its name.
[[nodiscard]] const BandMatrix& matrix_of(const GramianSet& set, const std::string& term);

/// One row of Tables 5.3 to 5.14 and 5.17 to 5.20, published and computed.
struct TableRow {
  std::string table, term;
  int degree = 0, r = 0, i = 0, j = 0;
  long double exact = 0;                                       ///< to 21 digits
  std::string printed_exact, printed_gauss, printed_analytic;  ///< as the thesis prints them
  std::array<double, 3> ours{};                                ///< by all_methods

  /// Knots divided by 13, as in Tables 5.17 to 5.20.
  [[nodiscard]] bool normalised() const { return std::stoi(table.substr(2)) >= 17; }
  /// Relative error of a value; on the diagonal of G10, which is zero, the error itself.
  [[nodiscard]] double error_of(long double value) const;
  [[nodiscard]] double error(std::size_t method) const { return error_of(ours[method]); }
};
[[nodiscard]] std::vector<TableRow> table_rows(const std::string& data);

/// A number of Table 5.15 (fourth integrals) or 5.16 (what the Dirac rule adds up), published and
/// computed.
struct CheckedValue {
  std::string row, column;
  long double exact = 0;
  std::string printed_exact, printed_analytic;  ///< empty where the thesis has none
  double ours = 0;
};
[[nodiscard]] std::vector<CheckedValue> table_5_15(const std::string& data);
[[nodiscard]] std::vector<CheckedValue> table_5_16(const std::string& data);

/// All tables as Markdown, the thesis' columns beside ours.
[[nodiscard]] std::string tables_markdown(const std::string& data);

}  // namespace knead::figures
