#include "figures/tables.hpp"

#include <fmt/format.h>

#include <cmath>

#include "figures/digits.hpp"
#include "figures/thesis_knots.hpp"
#include "knead/spline/basis.hpp"

namespace knead::figures {
namespace {

std::string scientific(double error) { return error == 0 ? "0" : fmt::format("{:.0e}", error); }

/// Our value in the form in which the thesis prints this entry. Values that should be zero have no
/// such form.
std::string in_the_form_of(const TableRow& row, double value) {
  return row.exact == 0 ? fmt::format("{:.14g}", value) : printed_like(row.printed_exact, value);
}

}  // namespace

const BandMatrix& matrix_of(const GramianSet& set, const std::string& term) {
  return term == "G00" ? set.g00 : term == "G11" ? set.g11 : term == "G22" ? set.g22 : set.g10;
}

double TableRow::error_of(long double value) const {
  return static_cast<double>(std::abs(value - exact) / (exact == 0 ? 1 : std::abs(exact)));
}

std::vector<TableRow> table_rows(const std::string& data) {
  std::vector<TableRow> rows;
  for (const CsvRow& from : read_csv(data + "/tables_5_3_to_5_20.csv")) {
    TableRow row;
    row.table = from.at("table");
    row.term = from.at("term");
    row.degree = std::stoi(from.at("degree"));
    row.r = std::stoi(from.at("r"));
    row.i = std::stoi(from.at("i"));
    row.j = std::stoi(from.at("j"));
    row.exact = std::stold(from.at("exact"));
    row.printed_exact = from.at("printed_exact");
    row.printed_gauss = from.at("printed_gauss");
    row.printed_analytic = from.at("printed_analytic");
    const KnotVector knots = thesis_knots(row.degree, row.r, row.normalised() ? 1.0 / 13 : 1.0);
    for (std::size_t k = 0; k < all_methods.size(); ++k) {
      row.ours[k] = matrix_of(*gramians(knots, all_methods[k]), row.term)(row.i, row.j);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<CheckedValue> table_5_15(const std::string& data) {
  std::vector<CheckedValue> values;
  for (const CsvRow& row : read_csv(data + "/table_5_15.csv")) {
    const KnotVector knots = thesis_knots(3, std::stoi(row.at("r")));
    const std::string& at = row.at("knot");
    const double u = at == "6+10^-r" ? knots[10] : std::stod(at);
    values.push_back({"r = " + row.at("r") + ", knot " + at, "fourth integral",
                      std::stold(row.at("exact")), row.at("printed_exact"),
                      row.at("printed_analytic"),
                      basis_integral(knots, std::stoi(row.at("i")), 4, u)});
  }
  return values;
}

std::vector<CheckedValue> table_5_16(const std::string& data) {
  std::vector<CheckedValue> values;
  const KnotVector knots = thesis_knots(10, 10, 1, 17);
  for (const CsvRow& row : read_csv(data + "/table_5_16.csv")) {
    const int i = std::stoi(row.at("i")), k = std::stoi(row.at("knot_index"));
    const double u = knots[i + k],
                 weight = derivative_jumps(knots, i)[static_cast<std::size_t>(k)].jumps.back();
    const double integral = basis_integral(knots, i, 11, u);
    const std::string name = k == 2 ? "6 + 10⁻¹⁰" : fmt::format("{:.10g}", u);
    const auto add = [&](const char* column, const char* printed, double ours) {
      std::string label = column;
      if (label == "derivative_left") label = "10th derivative (left of the knot)";
      if (label == "integral") label = "11th integral";
      if (label == "dirac_weight") label = "Dirac weight";
      values.push_back({name, label, std::stold(row.at(column)), "", row.at(printed), ours});
    };
    add("integral", "printed_integral", integral);
    add("derivative_left", "printed_derivative", basis_function(knots, i, 10, u, Side::left));
    add("dirac_weight", "printed_dirac_weight", weight);
    add("product", "printed_product", integral * weight);
  }
  return values;
}

std::string tables_markdown(const std::string& data) {
  std::string out;
  std::string table;
  for (const TableRow& row : table_rows(data)) {
    if (row.table != table) {
      table = row.table;
      const std::string term = row.term;
      const auto order = [](char d) { return d == '0' ? "" : d == '1' ? "′" : "″"; };
      out += fmt::format(
          "\n### Table {}: {} = ∫ N{} N{}, degree {}, entry ({}, {}){}\n\n"
          "| r | exact | thesis: exact | thesis: Gaussian | thesis: analytic | gauss | analytic | "
          "recurrence | error "
          "of "
          "gauss | of analytic | of recurrence |\n|--:|---|---|---|---|---|---|---|---|---|---|\n",
          table, term, order(term[1]), order(term[2]), row.degree, row.i, row.j,
          row.normalised() ? ", knots divided by 13" : "");
    }
    out += fmt::format("| {} | {:.17g} | {} | {} | {} |", row.r, static_cast<double>(row.exact),
                       marked(row.printed_exact, row.exact), marked(row.printed_gauss, row.exact),
                       marked(row.printed_analytic, row.exact));
    for (const double value : row.ours)
      out += " " + marked(in_the_form_of(row, value), row.exact, Cut::rounded, two_ulp) + " |";
    for (std::size_t k = 0; k < all_methods.size(); ++k)
      out += " " + scientific(row.error(k)) + " |";
    out += "\n";
  }
  const auto add = [&](const char* title, const std::vector<CheckedValue>& values) {
    const bool has_exact = !values.empty() && !values.front().printed_exact.empty();
    out += fmt::format(
        "\n### {}\n\n| {}| | exact | {}thesis: analytic | ours |\n|---|---|---|{}---|---|\n", title,
        has_exact ? "" : "knot ", has_exact ? "thesis: exact | " : "", has_exact ? "---|" : "");
    for (const CheckedValue& value : values) {
      if (value.printed_analytic.empty())
        continue;  // the thesis leaves out the first knot, where nothing is summed
      out += fmt::format("| {} | {} | {:.17g} | {}{} | {} |\n", value.row, value.column,
                         static_cast<double>(value.exact),
                         has_exact ? marked(value.printed_exact, value.exact) + " | " : "",
                         marked(value.printed_analytic, value.exact),
                         marked(printed_like(value.printed_analytic, value.ours), value.exact,
                                Cut::rounded, two_ulp));
    }
  };
  add("Table 5.15: the fourth integral of N_8, degree 3", table_5_15(data));
  add("Table 5.16: what the Dirac rule adds up for N_15, degree 10, r = 10", table_5_16(data));
  return out;
}

}  // namespace knead::figures
