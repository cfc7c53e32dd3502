// The Gramian kernels compiled to WebAssembly, run by node, against the scalar ones of this
// machine.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "gramian/simd/kernels.hpp"
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
        const unsigned seed =
            1000 * static_cast<unsigned>(p) + 100 * k + static_cast<unsigned>(family);
        std::mt19937_64 random(seed);
        all.push_back({std::string(testing::listed_families[family]) + " p=" + std::to_string(p) +
                           " seed " + std::to_string(seed),
                       testing::random_member(random, p, family)});
      }
    }
    all.push_back({"many equal spans", testing::uniform_clamped(p, 150)});
  }
  return all;
}

/// All numbers that the program prints for these knot vectors; fails the test where it does not
/// run.
std::vector<double> run_in_node(const std::vector<testing::NamedKnots>& all) {
  const fs::path directory =
      fs::temp_directory_path() / ("knead_wasm_" + std::to_string(::getpid()));
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
  const std::string command = "'" KNEAD_NODE "' --no-warnings '" KNEAD_WASM_RUNNER "' '" + program +
                              "' < '" + in + "' > '" + out + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  std::vector<double> numbers(fs::file_size(out) / sizeof(double));
  std::ifstream(out, std::ios::binary)
      .read(reinterpret_cast<char*>(numbers.data()),
            static_cast<std::streamsize>(numbers.size() * sizeof(double)));
  fs::remove_all(directory);
  return numbers;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Integrated again in extended precision, which has as many digits as the machine offers:
/// functions whose common support leaves the domain. So are all of degrees above those of the
/// kernels, by Gauss points.
bool cut_by_the_domain(const KnotVector& knots, int i, int j) {
  const auto [lower, upper] = std::minmax(i, j);
  return knots[upper] < knots.domain().lower ||
         knots[lower + knots.degree() + 1] > knots.domain().upper;
}

// The points of a Gauss rule come from extended precision too: a last bit of theirs may differ.
TEST(WasmGramians,
     of_the_recurrence_are_those_of_this_machine_to_the_last_bit_and_of_gauss_to_rounding) {
  if (!fs::exists(program)) GTEST_SKIP() << program << " is not there; make test builds it";
  if (std::string_view(KNEAD_NODE).empty()) GTEST_SKIP() << "no node to run it";
  const auto all = all_knots();
  const std::vector<double> numbers = run_in_node(all);
  std::size_t at = 0, compared_by_bits = 0;
  for (const auto& [name, knots] : all) {
    const int p = knots.degree();
    for (const GramianMethod method : {GramianMethod::recurrence, GramianMethod::gauss}) {
      GramianSet set;
      recompute_gramians(knots, method, set, InstructionSet::scalar);
      const BandMatrix* const terms[] = {&set.g00, &set.g11, &set.g22, &set.g10};
      for (const InstructionSet instructions :
           {InstructionSet::scalar, InstructionSet::vector128}) {
        SCOPED_TRACE(name + ", " + std::string(knead::name(method)) + ", " +
                     std::string(knead::name(instructions)));
        for (int t = 0; t < 4; ++t) {
          const BandMatrix &rows = *terms[t == 3 ? 1 : t], &columns = *terms[t == 3 ? 0 : t];
          for (int s = -p; s <= p; ++s) {
            for (int k = 0; k < static_cast<int>(terms[t]->diagonal(s).size()); ++k) {
              const int i = s < 0 ? k - s : k, j = i + s;
              const double here = (*terms[t])(i, j);
              ASSERT_LT(at, numbers.size());
              const double there = numbers[at++];
              if (method == GramianMethod::recurrence && p <= detail::max_kernel_degree &&
                  !cut_by_the_domain(knots, i, j)) {
                ++compared_by_bits;
                EXPECT_TRUE(same_bits(here, there) || (here == 0 && there == 0))
                    << t << ": " << i << ", " << j;
              } else {  // beside what Cauchy and Schwarz allow the entry to be
                EXPECT_LE(std::abs(here - there),
                          1e-15 * std::sqrt(rows(i, i) * columns(j, j)) + 1e-300)
                    << t << ": " << i << ", " << j;
              }
            }
          }
        }
      }
    }
  }
  EXPECT_EQ(at, numbers.size());
  EXPECT_GT(compared_by_bits, 100'000U);
}

}  // namespace
}  // namespace knead
