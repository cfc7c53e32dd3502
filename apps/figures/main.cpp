// Regenerates the figures and tables of the thesis' evaluation of Gramians: knead_figures [FOLDER].
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "figures/csv.hpp"
#include "figures/figures.hpp"
#include "figures/roofline.hpp"

int main(int argc, char** argv) {
  namespace fs = std::filesystem;
  using namespace knead::figures;
  const fs::path folder = argc > 1 ? argv[1] : "out/figures";
  const std::string data = KNEAD_FIGURES_DATA;
  for (const char* name :
       {"tables_5_3_to_5_20", "table_5_15", "table_5_16", "figures_5_50_to_5_57"}) {
    if (!read_csv(fmt::format("{}/{}.csv", data, name)).empty()) continue;
    fmt::print(stderr, "{}/{}.csv: the published values are not there; run from a whole checkout\n",
               data, name);
    return 3;
  }
  Report report = whole_report(data);
  add_roofline(report);
  auto files = report.pictures;
  files["README.md"] = report.page;

  std::error_code failed;
  fs::create_directories(folder, failed);
  for (const auto& [name, text] : files) {
    std::ofstream file(folder / name, std::ios::binary);
    file << text;
    if (!file.flush()) {
      fmt::print(stderr, "{}: cannot be written\n", (folder / name).string());
      return 3;
    }
  }
  fmt::print("{} files in {}; begin with README.md\n", files.size(), folder.string());
}
