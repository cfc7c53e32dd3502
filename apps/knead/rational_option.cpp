#include "rational_option.hpp"

#include <fmt/format.h>

#include <cmath>

namespace knead::cli {

void RationalOption::add_to(CLI::App& command) {
  command.add_option("--tolerance", tolerance,
                     "with weights: the largest error of an entry, relative to its diagonal (default 1e-10)");
  command.add_option("--denominator", denominator,
                     "with weights: exact, or constant on every element as in the thesis, whose error has no bound");
}

Expected<StiffnessOptions> RationalOption::read() const {
  if (!(tolerance >= 1e-14 && tolerance < 1)) {
    return usage_error(fmt::format("the tolerance {} cannot be kept", tolerance), "--tolerance",
                       "use a fraction from 1e-14 to 1");
  }
  if (denominator != "exact" && denominator != "constant") {
    return usage_error(fmt::format("\"{}\" is no kind of denominator", denominator), "--denominator",
                       "write exact or constant");
  }
  StiffnessOptions options;
  options.rational_tolerance = tolerance;
  options.denominator = denominator == "exact" ? RationalDenominator::exact : RationalDenominator::constant;
  return options;
}

std::string RationalOption::describe(double error_bound) {
  if (!std::isfinite(error_bound)) return "the denominator is constant on every element: the error has no bound";
  return fmt::format("no entry errs by more than {:.2g} of its diagonal", error_bound);
}

}  // namespace knead::cli
