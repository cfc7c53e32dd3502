#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "knead/energy/field_assembler.hpp"

namespace {

using namespace knead;

/// A cubic 64 × 64 net, all six coefficients of the material as cubic fields on knots of their own.
constexpr int net = 64;

SplineField<2> field(int count, double shift) {
  const KnotVector k = *KnotVector::clamped_uniform(3, count);
  std::vector<double> c(static_cast<std::size_t>(count * count));
  for (std::size_t i = 0; i < c.size(); ++i)
    c[i] = 1 + 0.3 * std::sin(0.1 * static_cast<double>(i) + shift);
  return *SplineField<2>::create({k, k}, c);
}

MaterialFieldOf<2> material(int count) {
  MaterialFieldOf<2> m;
  for (std::size_t k = 0; k < 3; ++k)
    m.alpha[k] = field(count, static_cast<double>(k)),
    m.beta[k] = field(count, 7.0 + static_cast<double>(k));
  return m;
}

FieldEnergy<2> energy(int count) {
  FieldEnergy<2> e = stretch_energy<2>(material(count));
  for (const auto& term : bend_energy<2>(material(count))) e.push_back(term);
  return e;
}

Surface sheet(bool weights) {
  const KnotVector k = *KnotVector::clamped_uniform(3, net);
  return *Surface::create({k, k}, Points::Zero(net * net, 3),
                          std::vector<double>(weights ? net * net : 0, 1.0));
}

void triple_products(benchmark::State& state) {
  FieldAssembler<2> assembler(sheet(false));
  const auto e = energy(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(assembler.assemble(e)->valuePtr());
}

void triple_products_cold(benchmark::State& state) {
  const auto e = energy(static_cast<int>(state.range(0)));
  for (auto _ : state)
    benchmark::DoNotOptimize(FieldAssembler<2>(sheet(false)).assemble(e)->valuePtr());
}

/// Element by element, as finite element programs do: per element all six terms by dense products
/// over 5 × 5 Gauss points, which are exact for a cubic field on the same knots (with 64
/// coefficients; on other knots the field has kinks inside the elements and the same points are not
/// exact).
void gauss(benchmark::State& state) {
  const Surface s = sheet(false);
  const auto e = energy(static_cast<int>(state.range(0)));
  const int p = 3, points = 5, local = 16, total = points * points;
  const BasisQuadrature q = gauss_basis(s.knots(0), points, 2);
  const int spans = q.basis.size() / points;
  const SparseMatrix pattern = Stiffness<2>::create(s, {})->assemble();
  std::vector<std::vector<double>> values;
  for (auto _ : state) {
    SparseMatrix matrix = pattern;
    values.clear();
    for (const auto& term : e)
      values.push_back(
          *std::get<SplineField<2>>(term.coefficient).on_grid({q.parameters, q.parameters}));
    Eigen::MatrixXd a(local, total), b(local, total), block(local, local);
    for (int su = 0; su < spans; ++su) {
      for (int sv = 0; sv < spans; ++sv) {
        block.setZero();
        for (std::size_t t = 0; t < e.size(); ++t) {
          for (int k = 0; k < total; ++k) {
            const int ku = su * points + k / points, kv = sv * points + k % points;
            const double w = e[t].factor * q.weights[static_cast<std::size_t>(ku)] *
                             q.weights[static_cast<std::size_t>(kv)] *
                             values[t][static_cast<std::size_t>(ku * q.basis.size() + kv)];
            const double *au = q.basis.row(ku, e[t].a[0]), *av = q.basis.row(kv, e[t].a[1]);
            const double *bu = q.basis.row(ku, e[t].b[0]), *bv = q.basis.row(kv, e[t].b[1]);
            for (int r = 0; r <= p; ++r) {
              for (int c = 0; c <= p; ++c)
                a(4 * r + c, k) = w * au[r] * av[c], b(4 * r + c, k) = bu[r] * bv[c];
            }
          }
          block.noalias() += a * b.transpose();
        }
        const int iu = q.basis.first[static_cast<std::size_t>(su * points)],
                  iv = q.basis.first[static_cast<std::size_t>(sv * points)];
        for (int r = 0; r < local; ++r) {
          const int row = (iu + r / 4) * net + iv + r % 4;
          const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[row];
          const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[row + 1];
          for (int c = 0; c < local; c += 4) {
            const auto at =
                std::lower_bound(begin, end, (iu + c / 4) * net + iv) - matrix.innerIndexPtr();
            for (int l = 0; l < 4; ++l) matrix.valuePtr()[at + l] += block(r, c + l);
          }
        }
      }
    }
    benchmark::DoNotOptimize(matrix.valuePtr());
    state.counters["norm"] = matrix.norm();
  }
  state.counters["exact norm"] = FieldAssembler<2>(s).assemble(e)->norm();
}

void rational(benchmark::State& state) {
  FieldAssembler<2> assembler(sheet(true), {GramianMethod::gauss, 5});
  const auto e = energy(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(assembler.assemble(e)->valuePtr());
}

/// Knots of 1000 functions on [0, 1], of spans of random lengths.
KnotVector random_knots(int p, unsigned seed) {
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> length(1);
  std::vector<double> knots(static_cast<std::size_t>(p + 1), 0.0);
  for (int k = p + 1; k < 1000; ++k) knots.push_back(knots.back() + 0.01 + length(random));
  const double last = knots.back() + 1;
  for (double& knot : knots) knot /= last;
  knots.insert(knots.end(), static_cast<std::size_t>(p + 1), 1.0);
  return *KnotVector::create(p, knots);
}

/// Between two knot vectors that have no inner knot in common; the argument is the degree of both.
void triple_gramians(benchmark::State& state) {
  const int p = static_cast<int>(state.range(0));
  const KnotVector knots = random_knots(p, 1), coefficient = random_knots(p, 2);
  for (auto _ : state)
    benchmark::DoNotOptimize(triple_gramian(coefficient, knots, 1, 1)->coefficient_count());
}

void mixed_gramians(benchmark::State& state) {
  const int p = static_cast<int>(state.range(0));
  const KnotVector rows = random_knots(p, 1), columns = random_knots(p, 2);
  for (auto _ : state) benchmark::DoNotOptimize(mixed_gramian(rows, 0, columns, 0)->nonZeros());
}

BENCHMARK(triple_gramians)->Arg(2)->Arg(3)->Arg(5)->Unit(benchmark::kMicrosecond);
BENCHMARK(mixed_gramians)->Arg(2)->Arg(3)->Arg(5)->Unit(benchmark::kMicrosecond);
BENCHMARK(triple_products)->Arg(64)->Arg(20)->Unit(benchmark::kMillisecond);
BENCHMARK(triple_products_cold)->Arg(64)->Arg(20)->Unit(benchmark::kMillisecond);
BENCHMARK(gauss)->Arg(64)->Arg(20)->Unit(benchmark::kMillisecond);
BENCHMARK(rational)->Arg(64)->Unit(benchmark::kMillisecond);

}  // namespace
