// The stiffness matrix of a cubic net with all six terms: assembly beside writing the same bytes,
// and applying it to three columns without assembly beside the product with the assembled matrix.
// Of rational nets, a tolerance beside a fixed number of points.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include "knead/energy/stiffness.hpp"
#include "medians.hpp"

namespace {

using namespace knead;

Stiffness<2> stiffness(int net, int degree = 3) {
  const KnotVector k = *KnotVector::clamped_uniform(degree, net);
  return *Stiffness<2>::create({k, k}, stretch_and_bend<2>({{1, 0.3, 0.5}, {1e-3, 2e-3, 5e-4}}));
}

/// The values of a matrix that is kept, as after a change of material.
void refresh_over_write(benchmark::State& state, const Stiffness<2>& k) {
  SparseMatrix kept = k.assemble();
  std::vector<char> bytes(static_cast<std::size_t>(kept.nonZeros()) * sizeof(double));
  int value = 0;
  bench::beside(
      state,
      [&] {
        k.refresh(kept);
        benchmark::DoNotOptimize(kept.valuePtr());
        benchmark::ClobberMemory();
      },
      [&] {
        std::memset(bytes.data(), ++value, bytes.size());
        benchmark::DoNotOptimize(bytes.data());
        benchmark::ClobberMemory();
      },
      bench::Ratio::over_reference);
}

void assembly_over_write(benchmark::State& state) {
  refresh_over_write(state, stiffness(static_cast<int>(state.range(0))));
}
void assembly_of_degree(benchmark::State& state) {
  refresh_over_write(state, stiffness(256, static_cast<int>(state.range(0))));
}

/// A new matrix with its pattern, beside new memory of its size.
void new_assembly_over_write(benchmark::State& state) {
  const Stiffness<2> k = stiffness(static_cast<int>(state.range(0)));
  const auto entries = static_cast<std::size_t>(k.assemble().nonZeros());
  int value = 0;
  bench::beside(
      state, [&] { benchmark::DoNotOptimize(k.assemble().valuePtr()); },
      [&] {
        std::unique_ptr<char[]> bytes(new char[entries * (sizeof(double) + sizeof(int))]);
        std::memset(bytes.get(), ++value, entries * (sizeof(double) + sizeof(int)));
        benchmark::DoNotOptimize(bytes.get());
        benchmark::ClobberMemory();
      },
      bench::Ratio::over_reference);
}

void apply_beside_product(benchmark::State& state) {
  const Stiffness<2> k = stiffness(static_cast<int>(state.range(0)));
  const SparseMatrix assembled = k.assemble();
  const Points x = Points::Random(k.size(), 3);
  Points y(k.size(), 3);
  bench::beside(
      state, [&] { benchmark::DoNotOptimize(k.apply(x).data()); },
      [&] {
        y.noalias() = assembled * x;
        benchmark::DoNotOptimize(y.data());
      },
      bench::Ratio::times_faster);
}

/// A rational net with weights from 1 to 4, to 1e-10 of the diagonal, beside p + 8 Gauss points
/// everywhere.
void rational_over_points(benchmark::State& state) {
  const auto degree = static_cast<int>(state.range(0));
  const bool smooth = state.range(1) != 0;
  const KnotVector k = *KnotVector::clamped_uniform(degree, 32);
  std::vector<double> weights;
  std::mt19937 random(7);
  for (int i = 0; i < 32 * 32; ++i) {
    const double t = smooth
                         ? 0.5 + 0.5 * std::sin(0.4 * (i / 32)) * std::cos(0.3 * (i % 32))
                         : static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
    weights.push_back(std::pow(4, t));
  }
  const Surface surface = *Surface::create({k, k}, Points::Random(32 * 32, 3), weights);
  const Energy<2> energy = stretch_and_bend(Material{});
  bench::beside(
      state, [&] { benchmark::DoNotOptimize(*Stiffness<2>::create(surface, energy)); },
      [&] {
        benchmark::DoNotOptimize(
            *Stiffness<2>::create(surface, energy, {.rational_gauss_points = degree + 8}));
      },
      bench::Ratio::over_reference);
}

BENCHMARK(assembly_over_write)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(assembly_of_degree)->Arg(2)->Arg(5)->Unit(benchmark::kMillisecond);
BENCHMARK(new_assembly_over_write)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(apply_beside_product)->Arg(128)->Unit(benchmark::kMillisecond);
BENCHMARK(rational_over_points)->ArgsProduct({{2, 3, 5}, {0, 1}})->Unit(benchmark::kMillisecond);

}  // namespace
