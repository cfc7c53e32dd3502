// Two passes, fast diagonalisation and the vectorised system on one problem (docs/two-passes.md).
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>

#include "knead/solve/sparse_cholesky.hpp"
#include "two_passes.hpp"

namespace {

using namespace knead;

/// The shortest of several runs, in milliseconds.
template <class F>
double shortest(int runs, const F& run) {
  double best = 1e300;
  for (int k = 0; k < runs; ++k) {
    const auto start = std::chrono::steady_clock::now();
    run();
    best = std::min(
        best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                  .count());
  }
  return best;
}

void compare(int count) {
  const auto line = *KnotVector::clamped_uniform(3, count);
  const std::array<KnotVector, 2> knots = {line, line};
  // λ (G00 + c G11) ⊗ (G00 + c G11): α = λ c, 2 β12 = λ c².
  constexpr double lambda = 20, c = 0.05;
  Energy<2> energy = stretch_and_bend({{lambda * c, 0, lambda * c}, {0, lambda * c * c / 2, 0}});
  for (const EnergyTerm<2>& mass : mass_energy<2>(lambda)) energy.push_back(mass);
  const Points d = Points::Random(count * count, 3);
  const int runs = count > 100 ? 3 : 9;

  Points two, fast, vector;
  const double two_setup =
      shortest(runs, [&] { static_cast<void>(examples::TwoPasses::create(knots, energy)); });
  const auto passes = *examples::TwoPasses::create(knots, energy);
  const double two_solve = shortest(runs, [&] { two = passes.solve(d); });
  const double fast_setup =
      shortest(1, [&] { static_cast<void>(examples::FastDiagonalisation::create(knots, energy)); });
  const auto diagonal = *examples::FastDiagonalisation::create(knots, energy);
  const double fast_solve = shortest(runs, [&] { fast = diagonal.solve(d); });
  const auto matrix = examples::vectorised(knots, energy);
  const double factor_time =
      shortest(std::min(runs, 3), [&] { static_cast<void>(SparseCholesky::factor(matrix)); });
  const auto factor = *SparseCholesky::factor(matrix);
  const double solve_time = shortest(runs, [&] { vector = factor.solve(d); });
  const double size = vector.cwiseAbs().maxCoeff();
  fmt::print("{:4} | {:8.3f} {:8.3f} {:7.1e} | {:8.1f} {:8.2f} {:7.1e} | {:8.1f} {:8.2f}\n", count,
             two_setup, two_solve, (two - vector).cwiseAbs().maxCoeff() / size, fast_setup,
             fast_solve, (fast - vector).cwiseAbs().maxCoeff() / size, factor_time, solve_time);
}

}  // namespace

int main() try {
  fmt::print("times in ms; differences from the vectorised solution, of its largest coordinate\n");
  fmt::print(
      " net | two passes: setup, solve, diff. | diagonalisation            | vectorised: factor, "
      "solve\n");
  for (const int count : {32, 64, 128, 256}) compare(count);
  return 0;
} catch (const std::exception& e) {
  std::fputs(e.what(), stderr);
  return 1;
}
