// Evaluation beside Open CASCADE, one thread, a bicubic net of 32 × 32: 500 × 500 points beside its
// adaptor with its cache, by knead's evaluator that the caller keeps; scattered points beside the
// faster of adaptor and surface; closest points beside its projection, prepared once as ours is.
#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <array>
#include <cstdlib>
#include <gp_Vec.hxx>
#include <random>

#include "knead/spline/closest_point.hpp"
#include "knead/spline/evaluate.hpp"
#include "medians.hpp"
#include "sample_surface.hpp"

namespace {

using namespace knead;

Handle(Geom_BSplineSurface) in_occt(const Surface& s) {
  const auto [m, n] = s.net();
  TColgp_Array2OfPnt poles(1, m, 1, n);
  TColStd_Array2OfReal weights(1, m, 1, n);
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      const int at = i * n + j;
      const Points& p = s.control_points();
      poles.SetValue(i + 1, j + 1, gp_Pnt(p(at, 0), p(at, 1), p(at, 2)));
      weights.SetValue(i + 1, j + 1, s.rational() ? s.weights()[static_cast<std::size_t>(at)] : 1);
    }
  }
  const KnotVector& k = s.knots(0);  // the same in both directions
  std::vector<double> values;
  std::vector<int> times;
  for (const double knot : k.knots()) {
    if (values.empty() || knot != values.back()) {
      values.push_back(knot);
      times.push_back(0);
    }
    ++times.back();
  }
  const int count = static_cast<int>(values.size());
  TColStd_Array1OfReal knots(1, count);
  TColStd_Array1OfInteger multiplicities(1, count);
  for (int i = 0; i < count; ++i) {
    knots.SetValue(i + 1, values[static_cast<std::size_t>(i)]);
    multiplicities.SetValue(i + 1, times[static_cast<std::size_t>(i)]);
  }
  return new Geom_BSplineSurface(poles, weights, knots, knots, multiplicities, multiplicities,
                                 k.degree(), k.degree());
}

/// Points; with `order` 1 first derivatives and unit normals too.
void evaluation(benchmark::State& state, bool rational, int order) {
  const Surface surface = bench::sample_surface(rational);
  const GeomAdaptor_Surface theirs(in_occt(surface));
  const std::vector<double> u = bench::sample_parameters();
  const auto table = tabulate_basis(surface.knots(0), u, order);
  if (!table) std::abort();
  const std::array<const BasisTable*, 2> tables{&*table, &*table};
  Evaluation<2> result;
  const auto size = static_cast<Eigen::Index>(u.size() * u.size());
  Points normals(size, 3);
  std::array<Points, 3> reference = {Points(size, 3), Points(size, 3), Points(size, 3)};
  const auto put = [&](std::size_t k, Eigen::Index i, const gp_XYZ& p) {
    double* to = reference[k].data() + 3 * i;
    to[0] = p.X(), to[1] = p.Y(), to[2] = p.Z();
  };
  bench::beside(
      state,
      [&] {
        if (!evaluate_grid<2>(surface, tables, order, result)) std::abort();
        if (order == 1) unit_normals(result, normals);
        benchmark::DoNotOptimize(result.derivatives.back().data());
        benchmark::DoNotOptimize(normals.data());
      },
      [&] {
        Eigen::Index i = 0;
        gp_Pnt p;
        gp_Vec du, dv;
        for (const double s : u) {
          for (const double t : u) {
            if (order == 0) {
              theirs.D0(s, t, p);
            } else {
              theirs.D1(s, t, p, du, dv);
              put(1, i, du.XYZ());
              put(2, i, dv.XYZ());
              const gp_Vec normal = du.Crossed(dv).Normalized();
              double* to = normals.data() + 3 * i;
              to[0] = normal.X(), to[1] = normal.Y(), to[2] = normal.Z();
            }
            put(0, i++, p.XYZ());
          }
        }
        benchmark::DoNotOptimize(reference[0].data());
        benchmark::DoNotOptimize(normals.data());
      },
      bench::Ratio::times_faster);
  if ((reference[0] - result.derivatives[0]).cwiseAbs().maxCoeff() > 1e-10) std::abort();
}

/// Where neighbours in the list are none on the surface. Points, with `order` 1 first derivatives,
/// too.
void scattered(benchmark::State& state, bool rational, int order) {
  constexpr int count = 20000;
  const Surface surface = bench::sample_surface(rational);
  const Handle(Geom_BSplineSurface) theirs = in_occt(surface);
  const GeomAdaptor_Surface adaptor(theirs);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> anywhere(0, 1);
  Parameters<2> at(count, 2);
  for (int i = 0; i < count; ++i) at.row(i) << anywhere(random), anywhere(random);
  Points reference(count, 3);
  gp_Pnt p;
  gp_Vec du, dv;
  const auto run = [&](const auto& evaluator) {
    for (Eigen::Index i = 0; i < count; ++i) {
      order == 0 ? evaluator.D0(at(i, 0), at(i, 1), p)
                 : evaluator.D1(at(i, 0), at(i, 1), p, du, dv);
      reference.row(i) << p.X(), p.Y(), p.Z();
      benchmark::DoNotOptimize(dv);
    }
  };
  const bool cached =
      bench::milliseconds_of([&] { run(adaptor); }) < bench::milliseconds_of([&] { run(*theirs); });
  Evaluation<2> result;
  bench::beside(
      state,
      [&] {
        result = std::move(*evaluate<2>(surface, at, order));
        benchmark::DoNotOptimize(result.derivatives.back().data());
      },
      [&] { cached ? run(adaptor) : run(*theirs); }, bench::Ratio::times_faster);
  if ((reference - result.points()).cwiseAbs().maxCoeff() > 1e-10) std::abort();
}

/// Of points up to a tenth of the size away.
void closest(benchmark::State& state, bool rational) {
  constexpr int count = 100;
  const Surface surface = bench::sample_surface(rational);
  const auto search = ClosestPointSearch<2>::create(surface);
  if (!search) std::abort();
  GeomAPI_ProjectPointOnSurf projection;
  projection.Init(in_occt(surface), 0, 1, 0, 1, 1e-10, Extrema_ExtAlgo_Grad);
  std::mt19937 random(12);
  std::uniform_real_distribution<double> anywhere(0, 1);
  std::vector<Point> from;
  for (int i = 0; i < count; ++i) {
    const Point on = *evaluate_point<2>(surface, {anywhere(random), anywhere(random)});
    from.push_back(on +
                   Point(anywhere(random) - 0.5, anywhere(random) - 0.5, 6 * anywhere(random) - 3));
  }
  std::vector<double> ours(count), theirs(count);
  bench::beside(
      state,
      [&] {
        for (std::size_t i = 0; i < count; ++i) ours[i] = search->nearest(from[i]).distance;
      },
      [&] {
        for (std::size_t i = 0; i < count; ++i) {
          projection.Perform(gp_Pnt(from[i].x(), from[i].y(), from[i].z()));
          theirs[i] = projection.NbPoints() > 0 ? projection.LowerDistance() : 1e300;
        }
      },
      bench::Ratio::times_faster);
  int nearer = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (ours[i] > theirs[i] + 1e-9) std::abort();
    if (theirs[i] > ours[i] + 1e-6) ++nearer;
  }
  state.counters["missed_by_occt"] = nearer;
}

BENCHMARK_CAPTURE(evaluation, points, false, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(evaluation, d1_normal, false, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(evaluation, rational_points, true, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(evaluation, rational_d1_normal, true, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scattered, points, false, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scattered, d1, false, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scattered, rational_points, true, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scattered, rational_d1, true, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(closest, points, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(closest, rational, true)->Unit(benchmark::kMillisecond);

}  // namespace
