#pragma once

#include <map>
#include <string>

namespace knead::figures {

/// File names and their text.
using Files = std::map<std::string, std::string>;

/// Figs. 5.1, 5.9, 5.21 to 5.25: basis functions, derivatives, Dirac weights and integrals on {0⁴, 1, …, 5, 6⁴}.
void add_curves(Files& files);
/// Figs. 5.31 to 5.35 (samples and evaluations) and 5.39 to 5.41 (operations, counted as they are done).
void add_counts(Files& files);
/// Figs. 5.46 to 5.49: the error against the distance of two knots, and the terms it comes from.
void add_errors(Files& files, const std::string& data);
/// Figs. 5.50 to 5.57: the cubic Gramians on {0⁴, 1, …, 12, 13⁴} by all methods, as pictures and numbers.
void add_matrices(Files& files);

}  // namespace knead::figures
