#include "step_print.hpp"

#include "part21_text.hpp"

namespace knead::step {

PrintedKnots print_knots(const KnotVector& knots, const std::function<std::string(double)>& number) {
  PrintedKnots result;
  const auto x = knots.knots();
  for (std::size_t k = 0; k < x.size();) {
    std::size_t end = k + 1;
    while (end < x.size() && x[end] == x[k]) ++end;
    const char* separator = k == 0 ? "(" : ",";
    result.multiplicities += separator + std::to_string(end - k);
    result.values += separator + number(x[k]);
    k = end;
  }
  result.multiplicities += ")";
  result.values += ")";
  return result;
}

std::string print_net(int rows, int columns, const std::function<std::string(int)>& item, std::string_view line_break) {
  std::string text = "(";
  for (int i = 0; i < rows; ++i) {
    if (i > 0) text.append(",").append(line_break);
    for (int j = 0; j < columns; ++j) text.append(j == 0 ? "(" : ",").append(item(i * columns + j));
    text += ")";
  }
  return text + ")";
}

std::string print_point(std::string_view name, const double* coordinates) {
  std::string text(name);
  text += "=CARTESIAN_POINT('',(";
  for (int k = 0; k < 3; ++k) text.append(k == 0 ? "" : ",").append(format_real(coordinates[k]));
  return text + "));";
}

}  // namespace knead::step
