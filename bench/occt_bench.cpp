// Evaluation beside Open CASCADE's adaptor with its cache, by knead's evaluator that the caller keeps: a bicubic net of
// 32 × 32 on 500 × 500 points, one thread.
#include <GeomAdaptor_Surface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <array>
#include <cstdlib>
#include <gp_Vec.hxx>

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
  return new Geom_BSplineSurface(poles, weights, knots, knots, multiplicities, multiplicities, k.degree(), k.degree());
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
        if (order == 1) {
          const Points &du = result.at({1, 0}), &dv = result.at({0, 1});
          for (Eigen::Index i = 0; i < size; ++i) {
            const double *a = du.data() + 3 * i, *b = dv.data() + 3 * i;
            const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
            const double scale = 1 / std::sqrt(x * x + y * y + z * z);
            double* to = normals.data() + 3 * i;
            to[0] = scale * x, to[1] = scale * y, to[2] = scale * z;
          }
        }
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

BENCHMARK_CAPTURE(evaluation, points, false, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(evaluation, d1_normal, false, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(evaluation, rational_points, true, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(evaluation, rational_d1_normal, true, 1)->Unit(benchmark::kMillisecond);

}  // namespace
