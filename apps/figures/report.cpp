#include "figures/figures.hpp"
#include "figures/tables.hpp"

namespace knead::figures {

void add_tables(Report& report, const std::string& data) {
  report.text(
      "\n## Tables 5.3 to 5.20: the methods against exact values\n\n"
      "Clamped knots 0 … 13 with 7 replaced by 6 + 10^-r, in Tables 5.17 to 5.20 divided by 13. "
      "*exact* is the value "
      "by "
      "rational arithmetic; then what the thesis prints, then our three methods cut to as many "
      "digits as "
      "the "
      "thesis has, and their relative errors (for G10, whose diagonal is zero, the errors "
      "themselves). **Bold digits "
      "are "
      "wrong**: they are not those of the exact value rounded. The thesis underlines such digits "
      "in its Gaussian and "
      "analytic columns; those in its *exact* column are its slips. In our columns a digit is "
      "right, too, where it is that of a number within two ulp of the exact one.\n");
  report.text(tables_markdown(data));
  report.text(
      "\nIn Table 5.16 the printed integral at 12 is that at 9 over again, the printed product at "
      "6 + 10⁻¹⁰ has the sign and the first digit wrong, and the printed derivative at 16 is a "
      "hundred times too large. Our deviations there, like the thesis' in the weights, come from 6 "
      "+ 10⁻¹⁰ itself, which as a double is off by 8 units of the tenth digit of the gap.\n");
}

Report whole_report(const std::string& data) {
  Report report;
  report.text(
      "# The thesis' evaluation of Gramians, regenerated\n\n"
      "P. Moore's thesis, chapter 5, by this library; written by `make figures`. What differs, and "
      "why, is told in "
      "`docs/gramians/README.md` and `docs/gramians/error-analysis.md`.\n\n"
      "- [Basis functions: Figs. 5.1, 5.9, 5.21 to 5.25](#basis-functions-figs-51-59-521-to-525)\n"
      "- [Curve, Gauss points and integration by parts: Figs. 4.2, 5.4, 5.12 to "
      "5.20](#curve-gauss-points-and-integration-by-parts-figs-42-54-512-to-520)\n"
      "- [Cost: Figs. 5.31 to 5.41](#cost-figs-531-to-541)\n"
      "- [Times: Figs. 5.42 to 5.45](#times-figs-542-to-545)\n"
      "- [Tables 5.3 to 5.20](#tables-53-to-520-the-methods-against-exact-values)\n"
      "- [Errors: Figs. 5.46 to 5.49](#errors-figs-546-to-549)\n"
      "- [Matrices: Figs. 5.50 to 5.57](#matrices-figs-550-to-557)\n");
  add_curves(report);
  add_by_parts(report);
  add_counts(report);
  add_times(report);
  add_tables(report, data);
  add_errors(report, data);
  add_matrices(report, data);
  return report;
}

}  // namespace knead::figures
