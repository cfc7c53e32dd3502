#include "figures/digits.hpp"

#include <fmt/format.h>

#include <cmath>

namespace knead::figures {
namespace {

/// mantissa · 10^exponent, with so many decimals in the mantissa.
struct Printed {
  std::string mantissa, exponent;
  int decimals = 0;
  long double scale = 1;
};

Printed parsed(const std::string& text) {
  Printed printed;
  const std::size_t e = text.find('e'), point = text.find('.');
  printed.mantissa = text.substr(0, e);
  if (e != std::string::npos) {
    printed.exponent = text.substr(e);
    printed.scale = std::pow(10.0L, std::stoi(text.substr(e + 1)));
  }
  if (point != std::string::npos)
    printed.decimals = static_cast<int>(printed.mantissa.size() - point - 1);
  return printed;
}

std::string cut_to(const Printed& form, long double exact, Cut cut) {
  long double value = exact / form.scale;
  if (cut == Cut::truncated) {
    const long double unit = std::pow(10.0L, -form.decimals);
    // 21 carried digits: the exact number may be a hair below a round one.
    value = std::trunc(value / unit * (1 + 1e-18L)) * unit;
  }
  return fmt::format("{:.{}f}", value, form.decimals);
}

}  // namespace

bool is_right(const std::string& printed, long double exact, Cut cut, double slack) {
  const Printed form = parsed(printed);
  const long double number = std::stold(form.mantissa);
  for (const long double near : {exact, exact * (1 - slack), exact * (1 + slack)}) {
    if (number == std::stold(cut_to(form, near, cut))) return true;
  }
  return false;
}

std::string marked(const std::string& printed, long double exact, Cut cut, double slack) {
  if (printed.empty() || is_right(printed, exact, cut, slack)) return printed;
  const Printed form = parsed(printed);
  const std::string right = cut_to(form, exact, cut);
  std::size_t k = 0;
  if (exact != 0 && right.size() == form.mantissa.size()) {
    while (right[k] == form.mantissa[k]) ++k;
  }
  return form.mantissa.substr(0, k) + "**" + form.mantissa.substr(k) + "**" + form.exponent;
}

std::string printed_like(const std::string& pattern, double value) {
  const Printed form = parsed(pattern);
  if (form.exponent.empty()) return fmt::format("{:.{}f}", value, form.decimals);
  // Without the plus and the leading zero that the standard puts into exponents.
  const std::string text = fmt::format("{:.{}e}", value, form.decimals);
  const std::size_t e = text.find('e');
  return text.substr(0, e) + fmt::format("e{}", std::stoi(text.substr(e + 1)));
}

}  // namespace knead::figures
