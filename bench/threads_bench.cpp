// One thread beside several in one loop, by the clock on the wall: how many times faster several
// are. Two of them, or as many as KNEAD_BENCH_THREADS says.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdlib>

#include "knead/base/threads.hpp"
#include "knead/energy/shell_energy.hpp"
#include "knead/energy/stiffness.hpp"
#include "knead/solve/sparse_cholesky.hpp"
#include "knead/spline/evaluate.hpp"
#include "medians.hpp"
#include "sample_surface.hpp"
#include "solve/dissection.hpp"

namespace {

using namespace knead;

int several() {
  const char* text = std::getenv("KNEAD_BENCH_THREADS");
  return text != nullptr ? std::atoi(text) : 2;
}

template <class F>
double wall_milliseconds_of(int threads, const F& f) {
  set_thread_count(threads);
  const auto start = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

template <class F>
void one_beside_several(benchmark::State& state, const F& f) {
  std::vector<double> one, more;
  for (auto _ : state) {
    one.push_back(wall_milliseconds_of(1, f));
    more.push_back(wall_milliseconds_of(several(), f));
  }
  set_thread_count(0);
  const double by_one = bench::median(one), by_several = bench::median(more);
  state.counters["one_ms"] = by_one;
  state.counters["several_ms"] = by_several;
  state.counters["ratio"] = by_one / by_several;
}

void grid(benchmark::State& state, bool rational, int order) {
  const Surface surface = bench::sample_surface(rational);
  const auto u = bench::sample_parameters();
  const auto evaluator = *Evaluator<2>::on_grid(surface.knots(), {u, u}, order);
  Evaluation<2> result;
  one_beside_several(state, [&] {
    if (!evaluator.evaluate(surface, result)) std::abort();
  });
}

Parameters<2> scattered_parameters() {
  constexpr int count = 20000;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> anywhere(0, 1);
  Parameters<2> at(count, 2);
  for (int i = 0; i < count; ++i) at.row(i) << anywhere(random), anywhere(random);
  return at;
}

void scattered(benchmark::State& state) {
  const Surface surface = bench::sample_surface(false);
  const Parameters<2> at = scattered_parameters();
  one_beside_several(state, [&] { benchmark::DoNotOptimize(*evaluate<2>(surface, at, 1)); });
}

void normals(benchmark::State& state) {
  const Surface surface = bench::sample_surface(false);
  const auto u = bench::sample_parameters();
  const auto jet = *evaluate_grid<2>(surface, {u, u}, 1);
  Points result;
  one_beside_several(state, [&] { unit_normals(jet, result); });
}

Stiffness<2> stiffness(int net) {
  const KnotVector k = *KnotVector::clamped_uniform(3, net);
  return *Stiffness<2>::create({k, k}, stretch_and_bend<2>({{1, 0.3, 0.5}, {1e-3, 2e-3, 5e-4}}));
}

void assembly(benchmark::State& state) {
  const Stiffness<2> k = stiffness(static_cast<int>(state.range(0)));
  one_beside_several(state, [&] { benchmark::DoNotOptimize(k.assemble().valuePtr()); });
}

void refresh(benchmark::State& state) {
  const Stiffness<2> k = stiffness(static_cast<int>(state.range(0)));
  SparseMatrix kept = k.assemble();
  one_beside_several(state, [&] { k.refresh(kept); });
}

void apply(benchmark::State& state) {
  const Stiffness<2> k = stiffness(static_cast<int>(state.range(0)));
  const Points x = Points::Random(k.size(), 3);
  one_beside_several(state, [&] { benchmark::DoNotOptimize(k.apply(x).data()); });
}

struct System {
  SparseMatrix a;
  GridPlaces places;
};

System system(int net) {
  const KnotVector k = *KnotVector::clamped_uniform(3, net);
  const Surface sheet = *Surface::create({k, k}, Points::Random(net * net, 3));
  return {stiffness(net).assemble() + Stiffness<2>::create({k, k}, mass_energy<2>())->assemble(),
          grid_places<2>(std::span(&sheet, 1))};
}

void factor(benchmark::State& state) {
  const System of = system(static_cast<int>(state.range(0)));
  one_beside_several(state, [&] {
    if (!SparseCholesky::factor(SparseMatrix(of.a), of.places)) std::abort();
  });
}

void solve(benchmark::State& state) {
  const System of = system(static_cast<int>(state.range(0)));
  const auto factor = *SparseCholesky::factor(SparseMatrix(of.a), of.places);
  const Points b = Points::Random(of.a.rows(), 3);
  one_beside_several(state, [&] { benchmark::DoNotOptimize(factor.solve(b).data()); });
}

void shell_hessian(benchmark::State& state) {
  const KnotVector k = *KnotVector::clamped_uniform(3, static_cast<int>(state.range(0)));
  Points points(k.count() * k.count(), 3);
  for (int i = 0; i < points.rows(); ++i) {
    const double u = k.greville(i / k.count()), v = k.greville(i % k.count());
    points.row(i) << u, v, 0.1 * u * v;
  }
  const auto shell = *ShellEnergy::create(*Surface::create({k, k}, points), ShellMaterial{});
  const ShellStress stress = shell.stress(points);
  one_beside_several(state,
                     [&] { benchmark::DoNotOptimize(shell.hessian(points, stress).valuePtr()); });
}

BENCHMARK_CAPTURE(grid, points, false, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(grid, first_derivatives, false, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(grid, rational_first_derivatives, true, 1)->Unit(benchmark::kMillisecond);
BENCHMARK(scattered)->Unit(benchmark::kMillisecond);
BENCHMARK(normals)->Unit(benchmark::kMillisecond);
BENCHMARK(assembly)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(refresh)->Arg(64)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(apply)->Arg(64)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(factor)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(solve)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(shell_hessian)->Arg(32)->Arg(64)->Unit(benchmark::kMillisecond);

}  // namespace
