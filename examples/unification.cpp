// The models of thesis chapter 3, side by side (docs/unification.md).
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "comparison.hpp"
#include "knead/gramian/gramian.hpp"
#include "mass_spring.hpp"

namespace {

using namespace knead;
using namespace knead::examples;

template <class T>
T value(Expected<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return std::move(*result);
}

void identities() {
  fmt::print("1. One contour, three derivations. Largest difference of matrix entries:\n\n");
  constexpr int n = 64;
  constexpr double h = 1.0 / n, alpha = 3, beta = 0.25;
  const Eigen::MatrixXd differences = h * differenced_contour(n, alpha, beta, h);
  const Eigen::MatrixXd springs = spring_ring(n, alpha / h, beta / (h * h * h));
  fmt::print("   closed contour, differences times h against springs alpha/h, beta/h^3: {}\n",
             (differences - springs).cwiseAbs().maxCoeff());
  const KnotVector knots = value(KnotVector::clamped_uniform(1, n + 1));
  const Eigen::MatrixXd exact = value(gramian(knots, 1, 1)).dense();
  fmt::print("   open contour, springs 1/h against the Gramian 11 of linear B-splines:  {}\n\n",
             (spring_chain(n + 1, 1 / h) - exact).cwiseAbs().maxCoeff());
}

void errors_and_times() {
  fmt::print(
      "2. A sheet under load, error relative to the largest deflection, and digits that are "
      "right:\n\n"
      "      n   at masses   interpolated  digits   exact model   digits\n");
  Comparison last;
  for (int n : {9, 17, 33, 65}) {
    last = value(compare_models(n));
    fmt::print("   {:4}   {:9.2e}   {:12.2e}  {:6.1f}   {:11.2e}   {:6.1f}\n", n, last.spring_error,
               last.surface_error, -std::log10(last.surface_error), last.exact_error,
               -std::log10(last.exact_error));
  }
  fmt::print(
      "\n   Times in ms. Springs: explicit steps to 1e-8, or a factor and a solution; "
      "interpolation of each frame.\n"
      "   Exact model: matrices and factor once, then each frame.\n\n"
      "      n    steps   explicit    direct   interpolation   once    frame\n");
  for (int n : {9, 17, 33, 65}) {
    const Comparison c = value(compare_models(n));
    fmt::print("   {:4}   {:6}   {:8.2f}  {:8.2f}   {:13.3f}   {:6.2f}   {:5.2f}\n", n,
               c.relax_steps, 1e3 * c.relax_time, 1e3 * c.direct_time, 1e3 * c.interpolation_time,
               1e3 * c.exact_setup, 1e3 * c.exact_step);
  }
}

void touches() {
  fmt::print(
      "\n3. The same spring constant, more points. Height of the middle, drawn towards 1:\n\n"
      "      n   a spring at every mass   springs per area\n");
  for (int n : {9, 17, 33, 65}) {
    const Touch t = value(touch(n, 0.01));
    fmt::print("   {:4}   {:22.5f}   {:16.9f}\n", n, t.springs, t.exact);
  }
}

void losses() {
  fmt::print(
      "\n4. What interpolating anew costs a surface that nothing touches, relative change after 1, "
      "100, 1000 frames:\n\n");
  for (double cluster : {0.0, 1e-8}) {
    fmt::print("   {:22}",
               cluster == 0 ? "uniform knots" : fmt::format("three knots {:.0e} apart", cluster));
    for (int rounds : {1, 100, 1000})
      fmt::print("  {:8.1e}", value(interpolation_drift(cluster, rounds)));
    fmt::print("\n");
  }
  fmt::print("   active surface: {}\n", value(movement_at_rest(32)));
  for (bool averaged : {true, false}) {
    fmt::print(
        "\n   Ripples of the surface interpolated through a dent, at and beyond a distance from "
        "it, {}:\n\n",
        averaged ? "knots averaged from the masses" : "clamped uniform knots");
    for (int n : {17, 33, 65}) {
      fmt::print("   {:4}", n);
      for (double distance : {0.0, 0.05, 0.1, 0.2}) {
        fmt::print("   {:4.2f}: {:8.1e}", distance, value(ripple(n, distance, averaged)));
      }
      fmt::print("\n");
    }
  }
}

}  // namespace

int main() try {
  identities();
  errors_and_times();
  touches();
  losses();
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
