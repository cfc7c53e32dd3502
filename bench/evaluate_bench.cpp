#include <benchmark/benchmark.h>

#include <cstdlib>
#include <cstring>

#include "knead/spline/evaluate.hpp"
#include "sample_surface.hpp"

// A bicubic net of 32 × 32 control points on a grid of 500 × 500 points. `memory_set` writes as
// many bytes as the result has, into memory allocated as the result is: the limit on this machine,
// measured in the same run.

namespace {

using knead::Points;
using knead::Surface;

constexpr int grid = knead::bench::sample_grid;
using knead::bench::sample_surface;

void report(benchmark::State& state) { state.SetItemsProcessed(state.iterations() * grid * grid); }

void evaluate_grid(benchmark::State& state, bool rational, int order) {
  const Surface surface = sample_surface(rational);
  const auto u = knead::bench::sample_parameters();
  for (auto _ : state) {
    auto result =
        knead::evaluate_grid<2>(surface, std::array<std::span<const double>, 2>{u, u}, order);
    benchmark::DoNotOptimize(result->derivatives.back().data());
  }
  report(state);
}

/// Frame after frame: the basis is tabulated once and memory is used again.
void evaluate_grid_again(benchmark::State& state, bool rational, int order) {
  const Surface surface = sample_surface(rational);
  const auto table =
      knead::tabulate_basis(surface.knots(0), knead::bench::sample_parameters(), order);
  knead::Evaluation<2> result;
  for (auto _ : state) {
    const std::array<const knead::BasisTable*, 2> tables{&*table, &*table};
    if (!knead::evaluate_grid<2>(surface, tables, order, result)) std::abort();
    benchmark::DoNotOptimize(result.derivatives.back().data());
  }
  report(state);
}

void evaluate(benchmark::State& state, bool rational, int order) {
  const Surface surface = sample_surface(rational);
  const auto u = knead::bench::sample_parameters();
  knead::Parameters<2> scattered(grid * grid, 2);
  for (int k = 0; k < grid * grid; ++k) scattered.row(k) << u[k / grid], u[k % grid];
  for (auto _ : state) {
    auto result = knead::evaluate<2>(surface, scattered, order);
    benchmark::DoNotOptimize(result->derivatives.back().data());
  }
  report(state);
}

void memory_set(benchmark::State& state, int order, bool again) {
  std::vector<Points> result;
  int value = 0;
  for (auto _ : state) {
    if (!again) result.clear();
    result.resize(static_cast<std::size_t>((order + 1) * (order + 2) / 2));
    for (Points& points : result) {
      points.resize(grid * grid, 3);
      std::memset(points.data(), ++value, sizeof(double) * static_cast<std::size_t>(points.size()));
    }
    benchmark::DoNotOptimize(result.back().data());
  }
  report(state);
}

BENCHMARK_CAPTURE(evaluate_grid, points, false, 0);
BENCHMARK_CAPTURE(memory_set, points, 0, false);
BENCHMARK_CAPTURE(evaluate_grid_again, points, false, 0);
BENCHMARK_CAPTURE(memory_set, points_again, 0, true);
BENCHMARK_CAPTURE(evaluate_grid, first_derivatives, false, 1);
BENCHMARK_CAPTURE(memory_set, first_derivatives, 1, false);
BENCHMARK_CAPTURE(evaluate_grid_again, first_derivatives, false, 1);
BENCHMARK_CAPTURE(memory_set, first_derivatives_again, 1, true);
BENCHMARK_CAPTURE(evaluate_grid_again, rational_points, true, 0);
BENCHMARK_CAPTURE(evaluate_grid_again, rational_first_derivatives, true, 1);
BENCHMARK_CAPTURE(evaluate, scattered_points, false, 0);
BENCHMARK_CAPTURE(evaluate, scattered_first_derivatives, false, 1);

}  // namespace
