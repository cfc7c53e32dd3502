#include "rational_option.hpp"

#include <fmt/format.h>

#include <cmath>

namespace knead::cli {

void RationalOption::add_to(CLI::App& command) {
  command.add_option(
      "--tolerance", tolerance,
      "with weights: the largest error of an entry, relative to its diagonal (default 1e-10)");
  command.add_option("--denominator", denominator,
                     "with weights: exact, or constant on every element as in the thesis, whose "
                     "error has no bound");
}

Expected<StiffnessOptions> RationalOption::read() const {
  const double wanted = tolerance.value_or(default_rational_tolerance);
  const std::string kind = denominator.value_or("exact");
  if (!(wanted >= 1e-14 && wanted < 1)) {
    return usage_error(fmt::format("the tolerance {} cannot be kept", wanted), "--tolerance",
                       "use a fraction from 1e-14 to 1");
  }
  if (kind != "exact" && kind != "constant") {
    return usage_error(fmt::format("\"{}\" is no kind of denominator", kind), "--denominator",
                       "write exact or constant");
  }
  StiffnessOptions options;
  options.rational_tolerance = wanted;
  options.denominator =
      kind == "exact" ? RationalDenominator::exact : RationalDenominator::constant;
  return options;
}

std::string RationalOption::describe(double error_bound) {
  if (!std::isfinite(error_bound))
    return "the denominator is constant on every element: the error has no bound";
  return fmt::format("no entry errs by more than {:.2g} of its diagonal", error_bound);
}

}  // namespace knead::cli
