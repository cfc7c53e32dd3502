// Reading a STEP file as `knead info` does: the sample a hundred times over in one file, entity
// names apart.
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "knead/brep/face_conversion.hpp"
#include "knead/exchange/format.hpp"
#include "medians.hpp"
#include "support/renumbered.hpp"

namespace {

using namespace knead;

std::string large_file() {
  constexpr int copies = 100;
  constexpr long names = 100000;  // more than the sample has
  std::ifstream file(KNEAD_SOURCE_DIR "/samples/bonnet.step", std::ios::binary);
  const std::string sample((std::istreambuf_iterator<char>(file)), {});
  const std::size_t data = sample.find("DATA;"), end = sample.rfind("ENDSEC;");
  if (data == std::string::npos || end == std::string::npos) std::abort();
  std::string result = sample.substr(0, data + 5);
  for (int k = 0; k < copies; ++k)
    result += testing::renumbered(sample.substr(data + 5, end - data - 5), k * names);
  return result + sample.substr(end);
}

void info(benchmark::State& state) {
  const std::string text = large_file();
  std::vector<double> times;
  for (auto _ : state) {
    times.push_back(bench::milliseconds_of([&] {
      const auto file = open_source(text, "large.step");
      if (!file) std::abort();
      benchmark::DoNotOptimize(brep::other_surfaces(*(*file)->model()).size() +
                               (*file)->surfaces().size());
    }));
  }
  state.counters["mb"] = static_cast<double>(text.size()) / 1e6;
  state.counters["mb_per_s"] = static_cast<double>(text.size()) / 1e3 / bench::median(times);
}

BENCHMARK(info)->Unit(benchmark::kMillisecond);

}  // namespace
