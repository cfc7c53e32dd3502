// What scripts/instructions.sh and scripts/bench_compare.sh conclude from what they measured.
//   knead_bench_judge counts EXPECTED.json COUNTED.json   complains of counts of instructions that
//   differ knead_bench_judge slower DIRECTORY FIRST LAST         lists the benchmarks that are
//   slower in rounds FIRST … LAST:
//                                                         Google Benchmark's
//                                                         DIRECTORY/ROUND/{base,head}/, all *.json
//                                                         below
// Exit codes: 0 nothing to complain of, 1 something, 2 wrong usage, 3 unreadable files.
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "judge.hpp"

namespace {

using namespace knead::bench;
using Json = nlohmann::json;

constexpr double count_share = 0.03, time_share = 0.1;

Json parsed(const std::filesystem::path& file) {
  std::ifstream in(file);
  Json json = Json::parse(in, nullptr, false);
  if (json.is_discarded()) {
    std::cerr << "knead_bench_judge: " << file.string() << " is missing or no JSON\n";
    std::exit(3);
  }
  return json;
}

Measured counts(const std::string& file) {
  const Json json = parsed(file);
  if (!json.contains("instructions")) {
    std::cerr << "knead_bench_judge: " << file << " has no \"instructions\"\n";
    std::exit(3);
  }
  return json["instructions"].get<Measured>();
}

/// Of all results in a directory: the counter "ms", which is a median, where there is one, or the
/// processor's time.
Measured times(const std::filesystem::path& directory) {
  Measured result;
  if (!std::filesystem::is_directory(directory)) return result;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory)) {
    if (entry.path().extension() != ".json") continue;
    const Json results = parsed(entry.path());
    for (const Json& b : results.value("benchmarks", Json::array())) {
      const std::string name = entry.path().stem().string() + ":" + b.value("name", "");
      const double time = b.contains("ms") ? b["ms"].get<double>() : b.value("cpu_time", 0.0);
      const auto [at, added] = result.try_emplace(name, time);
      if (!added) at->second = std::min(at->second, time);
    }
  }
  return result;
}

int judge_counts(const std::string& expected, const std::string& counted) {
  const auto complaints = unexpected_counts(counts(expected), counts(counted), count_share);
  for (const std::string& line : complaints) std::cout << line << "\n";
  return complaints.empty() ? 0 : 1;
}

int judge_times(const std::filesystem::path& directory, int first, int last) {
  std::vector<Measured> base, head;
  for (int round = first; round <= last; ++round) {
    base.push_back(times(directory / std::to_string(round) / "base"));
    head.push_back(times(directory / std::to_string(round) / "head"));
    if (head.back().empty()) {
      std::cerr << "knead_bench_judge: round " << round << " of " << directory.string()
                << " has no results\n";
      return 3;
    }
  }
  const auto slower = slower_in_every_round(base, head, time_share);
  for (const std::string& name : slower) {
    std::cout << name;
    for (std::size_t k = 0; k < base.size(); ++k)
      std::cout << fmt::format(" {:.2f}", head[k][name] / base[k][name]);
    std::cout << "\n";
  }
  return slower.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 3 && words[0] == "counts") return judge_counts(words[1], words[2]);
  if (words.size() == 4 && words[0] == "slower") {
    return judge_times(words[1], std::atoi(words[2].c_str()), std::atoi(words[3].c_str()));
  }
  std::cerr << "usage: knead_bench_judge counts EXPECTED.json COUNTED.json | slower DIRECTORY "
               "FIRST LAST\n";
  return 2;
}
