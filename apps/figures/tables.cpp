#include "figures/tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "knead/spline/basis_integral.hpp"
#include "knead/spline/jumps.hpp"

namespace knead::figures {
namespace {

double entry(const GramianSet& set, const std::string& term, int i, int j) {
  const BandMatrix& matrix = term == "G00" ? set.g00 : term == "G11" ? set.g11 : term == "G22" ? set.g22 : set.g10;
  return matrix(i, j);
}

std::string scientific(double error) { return error == 0 ? "0" : fmt::format("{:.0e}", error); }

}  // namespace

std::vector<CsvRow> read_csv(const std::string& path) {
  std::ifstream file(path);
  std::vector<CsvRow> rows;
  std::vector<std::string> names;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::vector<std::string> cells;
    std::istringstream cut(line);
    for (std::string cell; std::getline(cut, cell, ',');) cells.push_back(cell);
    if (names.empty()) {
      names = cells;
      continue;
    }
    CsvRow row;
    for (std::size_t k = 0; k < names.size(); ++k) row[names[k]] = k < cells.size() ? cells[k] : "";
    rows.push_back(std::move(row));
  }
  return rows;
}

KnotVector thesis_knots(int degree, int r, double scale, int last) {
  std::vector<double> knots(static_cast<std::size_t>(degree), 0.0);
  for (int k = 0; k <= last; ++k) knots.push_back((k == 7 ? 6 + std::pow(10.0, -r) : k) * scale);
  knots.insert(knots.end(), static_cast<std::size_t>(degree), last * scale);
  return *KnotVector::create(degree, std::move(knots));
}

double TableRow::error(std::size_t k) const {
  return std::abs(ours[k] - exact) / (term == "G10" ? 1 : std::abs(exact));
}

std::vector<TableRow> table_rows(const std::vector<CsvRow>& published) {
  std::vector<TableRow> rows;
  for (const CsvRow& from : published) {
    TableRow row;
    row.table = from.at("table");
    row.term = from.at("term");
    row.degree = std::stoi(from.at("degree"));
    row.r = std::stoi(from.at("r"));
    row.i = std::stoi(from.at("i"));
    row.j = std::stoi(from.at("j"));
    row.exact = std::stod(from.at("exact"));
    row.thesis_exact = from.at("thesis_exact");
    row.thesis_gauss = from.at("thesis_gauss");
    row.thesis_analytic = from.at("thesis_analytic");
    row.thesis_exact_is_right = from.at("thesis_exact_ok") != "0";
    const bool normalised = std::stoi(row.table.substr(2)) >= 17;
    const KnotVector knots = thesis_knots(row.degree, row.r, normalised ? 1.0 / 13 : 1.0);
    for (std::size_t k = 0; k < all_methods.size(); ++k) {
      row.ours[k] = entry(*gramians(knots, all_methods[k]), row.term, row.i, row.j);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<CheckedValue> table_5_15(const std::vector<CsvRow>& published) {
  std::vector<CheckedValue> values;
  for (const CsvRow& row : published) {
    const KnotVector knots = thesis_knots(3, std::stoi(row.at("r")));
    const std::string& at = row.at("knot");
    const double u = at == "6+10^-r" ? knots[10] : std::stod(at);
    values.push_back({"r = " + row.at("r") + ", knot " + at, "fourth integral", std::stod(row.at("exact")),
                      basis_integral(knots, std::stoi(row.at("i")), 4, u)});
  }
  return values;
}

std::vector<CheckedValue> table_5_16(const std::vector<CsvRow>& published) {
  std::vector<CheckedValue> values;
  const KnotVector knots = thesis_knots(10, 10, 1, 17);
  for (const CsvRow& row : published) {
    const int i = std::stoi(row.at("i")), k = std::stoi(row.at("knot_index"));
    const double u = knots[i + k], weight = derivative_jumps(knots, i)[static_cast<std::size_t>(k)].jumps.back();
    const double integral = basis_integral(knots, i, 11, u);
    const std::string name = fmt::format("knot {} ({:.10g})", k, u);
    values.push_back({name, "integral", std::stod(row.at("integral11")), integral});
    values.push_back({name, "derivative", std::stod(row.at("derivative10_right")), basis_function(knots, i, 10, u)});
    values.push_back({name, "Dirac weight", std::stod(row.at("dirac_weight")), weight});
    values.push_back({name, "product", std::stod(row.at("product")), integral * weight});
  }
  return values;
}

std::string tables_markdown(const std::string& data) {
  std::string out =
      "# The tables of thesis 5.9, published and computed\n\n"
      "Exact values by rational arithmetic, the thesis' columns as printed (**bold** where the printed exact value is "
      "wrong in\nits last digits), and the relative errors of our three methods; for G10, whose diagonal is zero, the "
      "errors themselves.\nKnots: 0 … 13 with 7 replaced by 6 + 10^-r, divided by 13 in Tables 5.17 to 5.20; the entry "
      "is (p + 5, p + 5).\n";
  std::string table;
  for (const TableRow& row : table_rows(read_csv(data + "/tables_5_3_to_5_20.csv"))) {
    if (row.table != table) {
      table = row.table;
      out += fmt::format(
          "\n## Table {}: {}, degree {}\n\n| r | exact | thesis exact | thesis Gauss | thesis analytic | gauss | "
          "analytic | recurrence |\n|---|---|---|---|---|---|---|---|\n",
          table, row.term, row.degree);
    }
    const char* mark = row.thesis_exact_is_right ? "" : "**";
    out += fmt::format("| {} | {:.16g} | {}{}{} | {} | {} | {} | {} | {} |\n", row.r, row.exact, mark, row.thesis_exact,
                       mark, row.thesis_gauss, row.thesis_analytic, scientific(row.error(0)), scientific(row.error(1)),
                       scientific(row.error(2)));
  }
  const auto add = [&](const char* title, const std::vector<CheckedValue>& values) {
    out += fmt::format("\n## {}\n\n| | | exact | ours |\n|---|---|---|---|\n", title);
    for (const CheckedValue& value : values) {
      out += fmt::format("| {} | {} | {:.16g} | {:.16g} |\n", value.row, value.column, value.exact, value.ours);
    }
  };
  add("Table 5.15: the fourth integral of N_8, degree 3", table_5_15(read_csv(data + "/table_5_15.csv")));
  add("Table 5.16: what the Dirac formula adds up for N_15, degree 10, r = 10",
      table_5_16(read_csv(data + "/table_5_16.csv")));
  return out;
}

}  // namespace knead::figures
