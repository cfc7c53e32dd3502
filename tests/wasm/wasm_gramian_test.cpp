// The Gramian kernels compiled to WebAssembly, run by node, against the scalar ones of this machine.
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "knead/gramian/gramian.hpp"
#include "support/knot_families.hpp"
#include "support/listed_families.hpp"

namespace knead {
namespace {

namespace fs = std::filesystem;

const std::string program = KNEAD_WASM_PROGRAMS "/gramian_values.wasm";

std::vector<testing::NamedKnots> all_knots() {
  std::vector<testing::NamedKnots> all;
  for (int p = 1; p <= max_degree; ++p) {
    for (auto& family : testing::knot_families(p)) all.push_back(std::move(family));
    for (std::size_t family = 0; family < testing::listed_families.size(); ++family) {
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned seed = 1000 * static_cast<unsigned>(p) + 100 * k + static_cast<unsigned>(family);
        std::mt19937_64 random(seed);
        all.push_back({std::string(testing::listed_families[family]) + " p=" + std::to_string(p) + " seed " +
                           std::to_string(seed),
                       testing::random_member(random, p, family)});
      }
    }
    all.push_back({"many equal spans", testing::uniform_clamped(p, 150)});
  }
  return all;
}

/// All numbers that the program prints for these knot vectors; fails the test where it does not run.
std::vector<double> run_in_node(const std::vector<testing::NamedKnots>& all) {
  const fs::path directory = fs::temp_directory_path() / ("knead_wasm_" + std::to_string(::getpid()));
  fs::create_directories(directory);
  const std::string in = (directory / "in").string(), out = (directory / "out").string();
  {
    std::ofstream file(in, std::ios::binary);
    for (const auto& [name, knots] : all) {
      const std::int32_t head[] = {knots.degree(), static_cast<std::int32_t>(knots.knots().size())};
      file.write(reinterpret_cast<const char*>(head), sizeof head);
      file.write(reinterpret_cast<const char*>(knots.knots().data()),
                 static_cast<std::streamsize>(knots.knots().size_bytes()));
    }
  }
  const std::string command = "'" KNEAD_NODE "' --no-warnings '" KNEAD_WASM_RUNNER "' '" + program + "' < '" + in +
                              "' > '" + out + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  std::vector<double> numbers(fs::file_size(out) / sizeof(double));
  std::ifstream(out, std::ios::binary)
      .read(reinterpret_cast<char*>(numbers.data()), static_cast<std::streamsize>(numbers.size() * sizeof(double)));
  fs::remove_all(directory);
  return numbers;
}

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

TEST(WasmGramians, are_those_of_this_machine_to_the_last_bit) {
  if (!fs::exists(program)) GTEST_SKIP() << program << " is not there; make test builds it";
  if (std::string_view(KNEAD_NODE).empty()) GTEST_SKIP() << "no node to run it";
  const auto all = all_knots();
  const std::vector<double> numbers = run_in_node(all);
  std::size_t at = 0;
  for (const auto& [name, knots] : all) {
    for (const GramianMethod method : {GramianMethod::recurrence, GramianMethod::gauss}) {
      GramianSet set;
      recompute_gramians(knots, method, set, InstructionSet::scalar);
      for (const InstructionSet instructions : {InstructionSet::scalar, InstructionSet::vector128}) {
        SCOPED_TRACE(name + ", " + std::string(knead::name(method)) + ", " + std::string(knead::name(instructions)));
        int different = 0;
        for (const BandMatrix* matrix : {&set.g00, &set.g11, &set.g22, &set.g10}) {
          for (int s = -knots.degree(); s <= knots.degree(); ++s) {
            for (const double value : matrix->diagonal(s)) {
              ASSERT_LT(at, numbers.size());
              const double there = numbers[at++];
              if (!same_bits(value, there) && !(value == 0 && there == 0) && different++ < 3) {
                ADD_FAILURE() << "diagonal " << s << " of term " << (matrix - &set.g00) << ": " << value << " here, "
                              << there << " there, " << (there - value) / value;
              }
            }
          }
        }
      }
    }
  }
  EXPECT_EQ(at, numbers.size());
}

}  // namespace
}  // namespace knead
