#include "plate.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "knead/energy/stiffness.hpp"

namespace knead::examples {
namespace {

/// The lowest `count` of f(m, n) for m, n = 1 … waves, where f grows with both.
template <class F>
std::vector<double> lowest(int count, int waves, const F& f) {
  std::vector<double> all;
  for (int m = 1; m <= waves; ++m) {
    for (int n = 1; n <= waves; ++n) all.push_back(f(m, n));
  }
  std::ranges::sort(all);
  all.resize(std::min(all.size(), static_cast<std::size_t>(count)));
  return all;
}

/// Σ c_s cos(s a h) with both neighbours at distance s.
double symbol(const std::array<double, 4>& c, double angle) {
  return c[0] +
         2 * (c[1] * std::cos(angle) + c[2] * std::cos(2 * angle) + c[3] * std::cos(3 * angle));
}

}  // namespace

Expected<std::vector<double>> plate_frequencies(int degree, int spans, int count) {
  if (degree < 2) return usage_error("a plate needs bending, and bending degree 2");
  const auto knots = KnotVector::clamped_uniform(degree, spans + degree);
  if (!knots) return std::unexpected(knots.error());
  const auto stiffness =
      Stiffness<2>::create({*knots, *knots}, stretch_and_bend({{0, 0, 0}, {1, 1, 1}}));
  if (!stiffness) return std::unexpected(stiffness.error());
  const auto mass = Stiffness<2>::create({*knots, *knots}, mass_energy<2>());
  if (!mass) return std::unexpected(mass.error());
  const int n = knots->count();
  std::vector<int> free;
  for (int i = 1; i + 1 < n; ++i) {
    for (int j = 1; j + 1 < n; ++j) free.push_back(i * n + j);
  }
  if (static_cast<int>(free.size()) < count)
    return usage_error("the net has fewer frequencies than are asked for");
  const Eigen::MatrixXd k = Eigen::MatrixXd(stiffness->assemble())(free, free);
  const Eigen::MatrixXd m = Eigen::MatrixXd(mass->assemble())(free, free);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(k, m,
                                                                         Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success)
    return numerical_error("the eigenvalues were not found", "plate", "");
  std::vector<double> frequencies;
  for (int i = 0; i < count; ++i) frequencies.push_back(std::sqrt(solver.eigenvalues()[i]));
  return frequencies;
}

std::vector<double> exact_plate_frequencies(int count) {
  return lowest(count, count,
                [](int m, int n) { return (m * m + n * n) * std::numbers::pi * std::numbers::pi; });
}

std::vector<double> bounding_plate_frequencies(int spans, int count) {
  // ∫ N_i^(a) N_(i+s)^(a) of cubics on whole numbers as knots.
  constexpr std::array<double, 4> g00 = {151.0 / 315, 397.0 / 1680, 1.0 / 42, 1.0 / 5040};
  constexpr std::array<double, 4> g11 = {2.0 / 3, -1.0 / 8, -1.0 / 5, -1.0 / 120};
  constexpr std::array<double, 4> g22 = {8.0 / 3, -3.0 / 2, 0, 1.0 / 6};
  return lowest(count, std::min(count, spans - 1), [&](int m, int n) {
    const double h = 1.0 / spans, a = m * std::numbers::pi * h, b = n * std::numbers::pi * h;
    const auto s22 = [&](double angle) {
      return symbol(g22, angle) / symbol(g00, angle) / (h * h * h * h);
    };
    const auto s11 = [&](double angle) {
      return symbol(g11, angle) / symbol(g00, angle) / (h * h);
    };
    return std::sqrt(s22(a) + 2 * s11(a) * s11(b) + s22(b));
  });
}

}  // namespace knead::examples
