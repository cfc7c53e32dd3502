#pragma once

#include <map>
#include <string>

namespace knead::figures {

/// The output: pictures by their file names, and the page that shows them beside the numbers.
struct Report {
  std::map<std::string, std::string> pictures;
  std::string page;  ///< Markdown

  void text(const std::string& markdown) { page += markdown; }
  /// A picture under its file name, and a line on the page of what it shows.
  void picture(const std::string& file, const std::string& svg, const std::string& caption) {
    pictures[file] = svg;
    page += "\n![" + caption + "](" + file + ")\n\n" + caption + "\n";
  }
};

/// Figs. 5.1, 5.9, 5.21 to 5.25: basis functions, derivatives, Dirac weights and integrals on {0⁴,
/// 1, …, 5, 6⁴}.
void add_curves(Report& report);
/// Figs. 4.2, 5.4, 5.12 to 5.20: a curve, Gauss points, integration by parts as areas
/// (figures/by_parts.hpp).
void add_by_parts(Report& report);
/// Figs. 5.42 to 5.45: times of the methods on this machine.
void add_times(Report& report);
/// Figs. 5.31 to 5.41: samples, evaluations and operations, counted while running, beside the
/// thesis' formulas.
void add_counts(Report& report);
/// Tables 5.3 to 5.20.
void add_tables(Report& report, const std::string& data);
/// Figs. 5.46 to 5.49: the error against the distance of two knots, the terms that cause it, and
/// remedies that do not help.
void add_errors(Report& report, const std::string& data);
/// Figs. 5.50 to 5.57: the cubic Gramians on {0⁴, 1, …, 12, 13⁴}, the printed entries beside ours.
void add_matrices(Report& report, const std::string& data);

/// All of it. `data` is the folder with the thesis' published numbers.
[[nodiscard]] Report whole_report(const std::string& data);

}  // namespace knead::figures
