// Gathers what the benchmarks measured: knead_bench_report DIRECTORY reads the results in it,
// writes summary.json, the figures by name, and report.md, and prints the latter. A figure that no
// result has is omitted.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

namespace {

using Figures = std::map<std::string, double>;

/// "contact/64" and its counter → the figure's name.
struct Source {
  const char *file, *benchmark, *counter, *figure;
};

constexpr Source sources[] = {
    {"contact.json", "contact/32", "ms", "contact_ms_32"},
    {"contact.json", "contact/64", "ms", "contact_ms_64"},
    {"contact.json", "contact/128", "ms", "contact_ms_128"},
    {"contact.json", "contact/256", "ms", "contact_ms_256"},
    {"contact.json", "contact_iterative/128", "ms", "contact_iterative_ms_128"},
    {"contact.json", "contact_iterative/256", "ms", "contact_iterative_ms_256"},
    {"contact.json", "contact/256", "made_ms", "made_ms_256"},
    {"contact.json", "contact_iterative/256", "made_ms", "made_iterative_ms_256"},
    {"contact.json", "stroke/32", "ms", "stroke_ms_32"},
    {"contact.json", "stroke/64", "ms", "stroke_ms_64"},
    {"contact.json", "shell_contact/32", "ms", "shell_contact_ms_32"},
    {"contact.json", "shell_contact/64", "ms", "shell_contact_ms_64"},
    {"contact.json", "shell_contact_exact/32", "ms", "shell_contact_exact_ms_32"},
    {"contact.json", "shell_contact_exact/64", "ms", "shell_contact_exact_ms_64"},
    {"contact.json", "contact_exact/32", "ms", "contact_exact_ms_32"},
    {"contact.json", "contact_exact/64", "ms", "contact_exact_ms_64"},
    {"contact.json", "contact_exact/128", "ms", "contact_exact_ms_128"},
    {"contact.json", "contact_exact/256", "ms", "contact_exact_ms_256"},
    {"contact.json", "contact_free/64", "ms", "free_ms_64"},
    {"contact.json", "contact_free/128", "ms", "free_ms_128"},
    {"contact.json", "contact_free/256", "ms", "free_ms_256"},
    {"memory.json", "contact/256", "memory_mb", "memory_mb_256"},
    {"memory_iterative.json", "contact_iterative/256", "memory_mb", "memory_iterative_mb_256"},
    {"assembly.json", "assembly_over_write/128", "ratio", "assembly_over_write_128"},
    {"assembly.json", "assembly_over_write/256", "ratio", "assembly_over_write_256"},
    {"assembly.json", "assembly_of_degree/2", "ratio", "assembly_over_write_256_p2"},
    {"assembly.json", "assembly_of_degree/5", "ratio", "assembly_over_write_256_p5"},
    {"assembly.json", "apply_beside_product/128", "ratio", "apply_vs_csr_128"},
    {"occt.json", "evaluation/points", "ratio", "evaluation_points_vs_occt"},
    {"occt.json", "evaluation/d1_normal", "ratio", "evaluation_d1_normal_vs_occt"},
    {"occt.json", "evaluation/rational_points", "ratio", "evaluation_rational_points_vs_occt"},
    {"occt.json", "evaluation/rational_d1_normal", "ratio",
     "evaluation_rational_d1_normal_vs_occt"},
    {"occt.json", "scattered/points", "ratio", "scattered_points_vs_occt"},
    {"occt.json", "scattered/d1", "ratio", "scattered_d1_vs_occt"},
    {"occt.json", "scattered/rational_points", "ratio", "scattered_rational_points_vs_occt"},
    {"occt.json", "scattered/rational_d1", "ratio", "scattered_rational_d1_vs_occt"},
    {"occt.json", "closest/points", "ratio", "closest_points_vs_occt"},
    {"occt.json", "closest/rational", "ratio", "closest_rational_points_vs_occt"},
    {"cholmod.json", "solve/64", "ratio", "solve_vs_cholmod_64"},
    {"cholmod.json", "solve/128", "ratio", "solve_vs_cholmod_128"},
    {"cholmod.json", "solve/256", "ratio", "solve_vs_cholmod_256"},
    {"threads.json", "grid/first_derivatives", "ratio", "two_threads_evaluation"},
    {"threads.json", "scattered", "ratio", "two_threads_scattered"},
    {"threads.json", "assembly/256", "ratio", "two_threads_assembly_256"},
    {"threads.json", "apply/256", "ratio", "two_threads_apply_256"},
    {"threads.json", "factor/256", "ratio", "two_threads_factor_256"},
    {"threads.json", "solve/256", "ratio", "two_threads_solve_256"},
    {"threads.json", "shell_hessian/64", "ratio", "two_threads_shell_hessian_64"},
    {"info.json", "info", "mb_per_s", "info_mb_per_s"},
};

void read(const std::string& directory, const Source& source, Figures& figures) {
  std::ifstream file(directory + "/" + source.file);
  if (!file) return;
  const auto results = nlohmann::json::parse(file, nullptr, false);
  if (results.is_discarded()) return;
  for (const auto& result : results.value("benchmarks", nlohmann::json::array())) {
    if (result.value("name", "") == source.benchmark && result.contains(source.counter))
      figures[source.figure] = result[source.counter].get<double>();
  }
}

/// Cells of "| a | b |".
std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream text(line);
  std::string cell;
  std::getline(text, cell, '|');
  while (std::getline(text, cell, '|')) {
    const auto first = cell.find_first_not_of(' '), last = cell.find_last_not_of(' ');
    result.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return result;
}

/// Of the table of Gramians: cubic, 10,000 functions, the last instruction set, which is the
/// fastest.
void read_gramians(const std::string& directory, Figures& figures) {
  std::ifstream file(directory + "/gramian.md");
  for (std::string line; std::getline(file, line);) {
    const auto row = cells(line);
    if (row.size() < 8 || row[0] != "3" || row[1] != "10000") continue;
    const auto figure = [&](const std::string& suffix) {
      figures["gramian_vs_gauss_p3" + suffix] = std::atof(row[6].c_str());
      figures["gramian_vs_gauss_reduced_p3" + suffix] = std::atof(row[7].c_str());
    };
    if (row[2] == "equal lengths") figure("");
    if (row[2] == "random lengths, exponential") figure("_random");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: knead_bench_report DIRECTORY\n";
    return 2;
  }
  const std::string directory = argv[1];
  Figures figures;
  for (const Source& source : sources) read(directory, source, figures);
  read_gramians(directory, figures);
  if (figures.contains("contact_ms_64") && figures.contains("contact_ms_256")) {
    figures["growth_exponent"] =
        std::log(figures["contact_ms_256"] / figures["contact_ms_64"]) / std::log(16.0);
  }
  if (figures.empty()) {
    std::cerr << "knead_bench_report: no results in " << directory << "\n";
    return 3;
  }
  std::string report =
      "# Benchmarks\n\nMedians; times in milliseconds of the processor. docs/performance.md says "
      "what each figure is.\n\n| figure | value |\n|---|---|\n";
  for (const auto& [name, value] : figures)
    report += fmt::format("| `{}` | {:.4g} |\n", name, value);
  std::ofstream(directory + "/summary.json") << nlohmann::json(figures).dump(2) << "\n";
  std::ofstream(directory + "/report.md") << report;
  std::cout << report;
}
