#include "figures/roofline.hpp"

#include <fmt/format.h>

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "figures/svg.hpp"
#include "gramian/operation_count.hpp"
#include "knead/base/threads.hpp"
#include "knead/energy/stiffness.hpp"
#include "knead/gramian/gramian.hpp"
#include "knead/spline/evaluate.hpp"
#include "solve/panels.hpp"

namespace knead::figures {
namespace {

using Net = knead::Points;
constexpr int degree = 3;
constexpr double number = sizeof(double);

/// A sum of `terms` products.
constexpr double sum_of(double terms) { return 2 * terms - 1; }

Net some_points(int count) {
  Net result(count, 3);
  for (Eigen::Index i = 0; i < result.size(); ++i)
    result.data()[i] = std::sin(static_cast<double>(i * i % 1013));
  return result;
}

struct Grid {
  knead::Surface surface;
  Evaluator<2> evaluator;
  Evaluation<2> result = {};
  Net normals = {};
};

Grid grid(int points, int order) {
  const KnotVector knots = *KnotVector::clamped_uniform(degree, 32);
  const auto surface = knead::Surface::create({knots, knots}, some_points(32 * 32));
  std::vector<double> u;
  for (int k = 0; k < points; ++k) u.push_back(k / static_cast<double>(points - 1));
  return {*surface, *Evaluator<2>::on_grid({knots, knots}, {u, u}, order)};
}

void add_evaluation(int points, std::vector<RooflineKernel>& kernels) {
  const double count = static_cast<double>(points) * points, terms = degree + 1;
  // Of the net, for one derivative, at every u.
  const double contraction = 32 * 3 * sum_of(terms) * points;
  auto plain = std::make_shared<Grid>(grid(points, 0));
  kernels.push_back(
      {"points on a grid", contraction + count * 3 * sum_of(terms), count * 3 * number,
       [plain] { static_cast<void>(plain->evaluator.evaluate(plain->surface, plain->result)); }});
  auto first = std::make_shared<Grid>(grid(points, 1));
  const auto evaluate = [first] {
    static_cast<void>(first->evaluator.evaluate(first->surface, first->result));
  };
  kernels.push_back({"and first derivatives", 2 * contraction + count * 9 * sum_of(terms),
                     count * 9 * number, evaluate});
  evaluate();
  // A vector product of 9, its length of 6, both speeds of 11 and their test of 1, the quotient and
  // 3 products.
  kernels.push_back({"unit normals of these", count * 31, count * 9 * number,
                     [first] { unit_normals(first->result, first->normals); }});
}

/// How many distinct pairs of derivative orders the terms have in a direction.
double kinds_of(const Energy<2>& energy, std::size_t direction) {
  std::set<std::pair<int, int>> kinds;
  for (const auto& term : energy) kinds.emplace(term.a[direction], term.b[direction]);
  return static_cast<double>(kinds.size());
}

/// Entries of a band matrix.
double band(double n) { return n * (2 * degree + 1) - degree * (degree + 1); }

struct System {
  Stiffness<2> k;
  SparseMatrix matrix;
  Panels factor;
  Net x;
  Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>
      y;  // what the factor takes for three columns
};

/// In the order in which `SparseCholesky` factors it.
Panels factor_of(const SparseMatrix& a) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
  Eigen::AMDOrdering<int>()(a, inverse);
  SparseMatrix lower(a.rows(), a.cols());
  lower.selfadjointView<Eigen::Lower>() =
      a.selfadjointView<Eigen::Lower>().twistedBy(inverse.inverse());
  return *Panels::factor(lower);
}

void add_stiffness(int net, std::vector<RooflineKernel>& kernels) {
  const KnotVector knots = *KnotVector::clamped_uniform(degree, net);
  const Energy<2> energy = stretch_and_bend<2>({{1, 0.3, 0.5}, {1e-3, 2e-3, 5e-4}});
  const Stiffness<2> k = *Stiffness<2>::create({knots, knots}, energy);
  SparseMatrix matrix = k.assemble(), shifted = matrix;
  shifted.diagonal().array() += 1e-3;
  const auto system =
      std::make_shared<System>(k, std::move(matrix), factor_of(shifted), some_points(k.size()));
  system->y.setOnes(k.size(), 4);
  const double n = net, points = n * n, entries = band(n) * band(n);
  const double outer = kinds_of(energy, 0), inner = kinds_of(energy, 1);
  const double vectors = 2 * 3 * points * number;
  const auto stored = static_cast<double>(system->factor.stored());
  kernels.push_back({"K refreshed", entries * sum_of(inner), entries * number,
                     [system] { system->k.refresh(system->matrix); }});
  // Lines combined and multiplied by a band, for every pair of orders in the first direction.
  kernels.push_back({"K applied, not assembled",
                     outer * 3 * n * (sum_of(1) * band(n) + 2 * points * (2 * degree + 1) / n),
                     vectors, [system] { system->x = system->k.apply(system->x) * 1e-9; }});
  kernels.push_back({"K assembled times three columns", entries * 2 * 3,
                     entries * (number + sizeof(int)) + vectors, [system] {
                       system->x = symmetric_product(system->matrix, system->x) * 1e-9;
                     }});
  kernels.push_back(
      {"substitution, three columns", 2 * stored * 2 * 3, 2 * stored * number + vectors, [system] {
         system->factor.forward<4>(system->y.data(), system->factor.all());
         system->factor.backward<4>(system->y.data(), system->factor.all());
       }});
}

void add_gramians(std::vector<RooflineKernel>& kernels) {
  constexpr int count = 10'000;
  std::vector<double> values(degree + 1, 0.0);
  for (int k = 1; k < count - degree; ++k)
    values.push_back(values.back() + 1 + 0.5 * std::sin(k * k % 1013));
  values.insert(values.end(), degree + 1, values.back() + 1);
  const KnotVector knots = *KnotVector::create(degree, std::move(values));
  const auto set = std::make_shared<GramianSet>();
  const auto method = GramianMethod::recurrence;
  // Three symmetric bands and one that is not.
  kernels.push_back({"four Gramians, recurrence",
                     static_cast<double>(count_operations(knots, method).total()),
                     count * (3.0 * (degree + 1) + 2 * degree + 1) * number,
                     [set, knots] { recompute_gramians(knots, method, *set); }});
}

}  // namespace

std::vector<RooflineKernel> roofline_kernels(int points, int net) {
  std::vector<RooflineKernel> kernels;
  add_evaluation(points, kernels);
  add_stiffness(net, kernels);
  add_gramians(kernels);
  return kernels;
}

void add_roofline(Report& report) {
  set_thread_count(1);
  const Machine machine = measured_machine();
  Chart chart("Roofline: kernels in one thread", "operations per byte that must be moved",
              "10⁹ operations per second");
  chart.logarithmic(true, true);
  const auto roof = [&](const char* name, double bandwidth, Style style) {
    const double ridge = machine.peak / bandwidth;
    chart.line(
        name,
        {{0.1, 0.1 * bandwidth / 1e9}, {ridge, machine.peak / 1e9}, {200, machine.peak / 1e9}},
        style);
  };
  roof("limit: memory", machine.memory, {.colour = 7});
  roof("limit: cache", machine.cache, {.colour = 7, .dashed = true});
  std::string table;
  for (const RooflineKernel& kernel : roofline_kernels()) {
    const double seconds = shortest_seconds(kernel.run), rate = kernel.operations / seconds,
                 share = kernel.operations / kernel.bytes;
    const double limit = std::min(machine.peak, share * machine.memory),
                 near = std::min(machine.peak, share * machine.cache);
    chart.line(kernel.name, {{share, rate / 1e9}}, {.markers = true});
    table +=
        fmt::format("| {} | {:.2f} | {:.2f} | {:.2f} | {:.3f} | {:.1f} | {:.0f} % | {:.0f} % |\n",
                    kernel.name, kernel.operations / 1e6, kernel.bytes / 1e6, share, 1e3 * seconds,
                    rate / 1e9, 100 * rate / limit, 100 * rate / near);
  }
  set_thread_count(0);
  report.text(fmt::format(
      "\n## Roofline: kernels of this library\n\nIn one thread, the shortest of 31 runs by the "
      "processor's clock, "
      "beside what the machine did "
      "in "
      "the same run: {:.1f} GB/s of memory, {:.1f} GB/s of the cache (b = a/2, of 64 MB and of 128 "
      "kB), {:.1f} 10⁹ "
      "additions and multiplications per second. Operations and bytes are counted from the "
      "formulas; "
      "bytes are what has to be moved at least. `docs/performance.md` says what follows.\n\n"
      "| kernel | 10⁶ operations | MB | operations per byte | ms | 10⁹ operations/s | of the limit "
      "by memory | by the "
      "cache |\n|---|--:|--:|--:|--:|--:|--:|--:|\n{}",
      machine.memory / 1e9, machine.cache / 1e9, machine.peak / 1e9, table));
  report.picture("roofline.svg", chart.svg(),
                 "Roofline: what kernels reach beside the limits of this machine.");
}

}  // namespace knead::figures
