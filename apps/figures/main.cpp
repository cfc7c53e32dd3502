// Regenerates the figures and tables of the thesis' evaluation of Gramians: knead_figures [FOLDER].
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "figures/figures.hpp"
#include "figures/tables.hpp"

int main(int argc, char** argv) {
  namespace fs = std::filesystem;
  using namespace knead::figures;
  const fs::path folder = argc > 1 ? argv[1] : "out/figures";
  const std::string data = KNEAD_FIGURES_DATA;
  if (read_csv(data + "/tables_5_3_to_5_20.csv").empty()) {
    fmt::print(stderr, "{}: the published tables are not there; run from a whole checkout\n", data);
    return 3;
  }
  Files files;
  files["tables.md"] = tables_markdown(data);
  add_curves(files);
  add_counts(files);
  add_errors(files, data);
  add_matrices(files);
  std::string index = "# The thesis' evaluation of Gramians, regenerated\n\n";
  for (const auto& [name, text] : files) {
    index += name.ends_with(".svg") ? fmt::format("![{0}]({0})\n\n", name) : fmt::format("- [{0}]({0})\n\n", name);
  }
  files["README.md"] = index;

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
  fmt::print("{} files in {}\n", files.size(), folder.string());
}
