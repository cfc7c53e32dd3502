#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace knead::house {

/// What is wrong with the tables of docs/thesis.md below `root`, one line each,
/// "docs/thesis.md:line: what"; empty where all is well. Of a row's four cells
///  - the first names numbers of the thesis: § for sections, Eq., Alg., Thm, Fig., Table; "Eqs. 4.9
///  to 4.12" is a
///    range;
///  - the third and the fourth name code and tests: `name`, `name` in [label](path), the path
///  relative to docs, two
///    links at most. The file exists; a function or type occurs in it as a word; `Suite.name` is a
///    test of it;
///  - the third is empty only where the list of differences says "Not …" of the row.
/// An item of that list, "- **Eq. 4.8**: text", begins with the first cell of a row.
[[nodiscard]] std::vector<std::string> thesis_page_errors(const std::filesystem::path& root);

/// Citations of the thesis in code and pages that are not of this form ("thesis § 5.8", "thesis
/// Eqs. 4.23, 4.25", "the thesis' Alg. 5.1") or cite a number that has no row in docs/thesis.md. A
/// section has a row where one of its subsections has.
[[nodiscard]] std::vector<std::string> citation_errors(const std::filesystem::path& root);

/// Links of the pages (README.md and the like, docs, examples) to files or headings that are not
/// there, "docs/step.md: x.md#y". Addresses in the web are not looked at.
[[nodiscard]] std::vector<std::string> dead_links(const std::filesystem::path& root);

}  // namespace knead::house
