#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "knead/spline/evaluate.hpp"

// A bicubic net of 32 × 32 control points on a grid of 500 × 500 points. `memory` writes as many bytes as the result
// has, into memory allocated as the result is: the limit on this machine, measured in the same run.

namespace {

using knead::KnotVector;
using knead::Points;
using knead::Surface;

constexpr int net = 32, grid = 500;

Surface sample(bool rational) {
  const auto knots = KnotVector::clamped_uniform(3, net);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> offset(-0.3, 0.3), weight(0.5, 2);
  Points points(net * net, 3);
  std::vector<double> weights;
  for (int i = 0; i < net; ++i) {
    for (int j = 0; j < net; ++j) {
      points.row(i * net + j) << i + offset(random), j + offset(random), std::sin(0.3 * i) * std::cos(0.25 * j);
      if (rational) weights.push_back(weight(random));
    }
  }
  auto surface = Surface::create({*knots, *knots}, points, weights);
  if (!surface) std::abort();
  return *surface;
}

std::vector<double> parameters() {
  std::vector<double> result;
  for (int k = 0; k < grid; ++k) result.push_back(k / static_cast<double>(grid - 1));
  return result;
}

void report(benchmark::State& state) { state.SetItemsProcessed(state.iterations() * grid * grid); }

void evaluate_grid(benchmark::State& state, bool rational, int order) {
  const Surface surface = sample(rational);
  const auto u = parameters();
  for (auto _ : state) {
    auto result = knead::evaluate_grid<2>(surface, std::array<std::span<const double>, 2>{u, u}, order);
    benchmark::DoNotOptimize(result->derivatives.back().data());
  }
  report(state);
}

/// Frame after frame: the basis is tabulated once and memory is used again.
void evaluate_grid_again(benchmark::State& state, bool rational, int order) {
  const Surface surface = sample(rational);
  const auto table = knead::tabulate_basis(surface.knots(0), parameters(), order);
  knead::Evaluation<2> result;
  for (auto _ : state) {
    const std::array<const knead::BasisTable*, 2> tables{&*table, &*table};
    if (!knead::evaluate_grid<2>(surface, tables, order, result)) std::abort();
    benchmark::DoNotOptimize(result.derivatives.back().data());
  }
  report(state);
}

void evaluate(benchmark::State& state, bool rational, int order) {
  const Surface surface = sample(rational);
  const auto u = parameters();
  knead::Parameters<2> scattered(grid * grid, 2);
  for (int k = 0; k < grid * grid; ++k) scattered.row(k) << u[k / grid], u[k % grid];
  for (auto _ : state) {
    auto result = knead::evaluate<2>(surface, scattered, order);
    benchmark::DoNotOptimize(result->derivatives.back().data());
  }
  report(state);
}

void memory(benchmark::State& state, int order, bool again) {
  std::vector<Points> result;
  for (auto _ : state) {
    if (!again) result.clear();
    result.resize(static_cast<std::size_t>((order + 1) * (order + 2) / 2));
    for (Points& points : result) {
      points.resize(grid * grid, 3);
      points.setConstant(1.5);
    }
    benchmark::DoNotOptimize(result.back().data());
  }
  report(state);
}

BENCHMARK_CAPTURE(evaluate_grid, points, false, 0);
BENCHMARK_CAPTURE(memory, points, 0, false);
BENCHMARK_CAPTURE(evaluate_grid_again, points, false, 0);
BENCHMARK_CAPTURE(memory, points_again, 0, true);
BENCHMARK_CAPTURE(evaluate_grid, first_derivatives, false, 1);
BENCHMARK_CAPTURE(memory, first_derivatives, 1, false);
BENCHMARK_CAPTURE(evaluate_grid_again, first_derivatives, false, 1);
BENCHMARK_CAPTURE(memory, first_derivatives_again, 1, true);
BENCHMARK_CAPTURE(evaluate_grid_again, rational_points, true, 0);
BENCHMARK_CAPTURE(evaluate_grid_again, rational_first_derivatives, true, 1);
BENCHMARK_CAPTURE(evaluate, scattered_points, false, 0);
BENCHMARK_CAPTURE(evaluate, scattered_first_derivatives, false, 1);

}  // namespace
