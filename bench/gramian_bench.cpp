// The Gramian methods side by side: every round times each of them once, in turn, so that whatever
// the machine does meets all of them; ratios are taken within a round: of each method to gauss, and
// of recurrence to gauss-reduced. Prints medians and the 10th and 90th percentiles.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "knead/gramian/gramian.hpp"

namespace {

using namespace knead;

enum class Family { uniform_lengths, exponential_lengths, equal_lengths };

KnotVector make_knots(int p, int count, Family family) {
  std::mt19937_64 random(12345 + static_cast<unsigned>(p));
  std::uniform_real_distribution<double> uniform(0.5, 1.5);
  std::exponential_distribution<double> exponential(1);
  std::vector<double> knots(static_cast<std::size_t>(p + 1), 0.0);
  double x = 0;
  for (int k = 0; k < count - p; ++k) {
    x += family == Family::equal_lengths     ? 1
         : family == Family::uniform_lengths ? uniform(random)
                                             : exponential(random);
    knots.push_back(x);
  }
  knots.insert(knots.end(), static_cast<std::size_t>(p), x);
  return *KnotVector::create(p, std::move(knots));
}

constexpr GramianMethod timed[] = {GramianMethod::gauss, GramianMethod::recurrence,
                                   GramianMethod::gauss_reduced, GramianMethod::analytic};
constexpr std::size_t reduced = 2;
static_assert(timed[reduced] == GramianMethod::gauss_reduced);

struct Candidate {
  GramianMethod method;
  std::function<void()> run;
  std::vector<double> seconds = {};
};

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

/// "median (10 % … 90 %) |" of how many times faster `fast` is than `slow`, round by round.
void print_ratio(const Candidate& slow, const Candidate& fast) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < slow.seconds.size(); ++k)
    ratios.push_back(slow.seconds[k] / fast.seconds[k]);
  std::printf(" %.2f (%.2f … %.2f) |", quantile(ratios, 0.5), quantile(ratios, 0.1),
              quantile(ratios, 0.9));
}

void compare(int p, int count, Family family, InstructionSet set, int rounds) {
  const KnotVector knots = make_knots(p, count, family);
  GramianSet result;  // shared, so that all candidates write to the same lines of the cache
  std::vector<Candidate> candidates;
  for (const GramianMethod method : timed) {
    // The one without kernels stands beside the scalar ones, once.
    if (method == GramianMethod::analytic && set != InstructionSet::scalar) continue;
    candidates.push_back({method, [&, method] { recompute_gramians(knots, method, result, set); }});
  }
  for (auto& candidate : candidates) candidate.run();
  const int repeat = std::max(1, static_cast<int>(60000.0 / count / (p + 1)));
  for (int round = 0; round < rounds; ++round) {
    for (auto& candidate : candidates) {
      const auto start = std::chrono::steady_clock::now();
      for (int k = 0; k < repeat; ++k) candidate.run();
      candidate.seconds.push_back(
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / repeat);
    }
  }
  const char* names[] = {"random lengths 0.5 to 1.5", "random lengths, exponential",
                         "equal lengths"};
  std::printf("| %d | %d | %s | %s |", p, count, names[static_cast<int>(family)],
              std::string(name(set)).c_str());
  for (const auto& candidate : candidates) {
    std::printf(" %.2f |", 1e9 * quantile(candidate.seconds, 0.5) / count);
    if (candidate.method != timed[0]) print_ratio(candidates[0], candidate);
    if (candidate.method == GramianMethod::recurrence) print_ratio(candidates[reduced], candidate);
  }
  for (std::size_t k = candidates.size(); k < std::size(timed); ++k) std::printf(" | |");
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

/// Arguments: [rounds [degree …]].
int main(int argc, char** argv) {
  std::vector<int> numbers, degrees;
  for (int k = 1; k < argc; ++k) {
    if (const int number = std::atoi(argv[k]); number > 0)
      numbers.push_back(number);  // others mean other benchmarks
  }
  if (argc > 1 && numbers.empty()) return 0;  // others are asked for
  const int rounds = numbers.empty() ? 61 : numbers.front();
  for (std::size_t k = 1; k < numbers.size(); ++k) degrees.push_back(numbers[k]);
  if (degrees.empty()) degrees = {3, 1, 2, 4, 5, 7};
  std::printf("| p | functions | knots | instructions | gauss ns/row |");
  for (const GramianMethod method : timed) {
    if (method == timed[0]) continue;
    std::printf(" %s ns/row | times gauss (10 %% … 90 %%) |", std::string(name(method)).c_str());
    if (method == GramianMethod::recurrence) std::printf(" times gauss-reduced (10 %% … 90 %%) |");
  }
  std::printf("\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const int p : degrees) {
    for (const int count : {100, 1000, 10000}) {
      for (const Family family :
           {Family::uniform_lengths, Family::exponential_lengths, Family::equal_lengths}) {
        for (const InstructionSet set : available_instruction_sets())
          compare(p, count, family, set, rounds);
      }
    }
  }
}
