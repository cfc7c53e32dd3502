#include "figures/cancellation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "figures/thesis_knots.hpp"
#include "knead/gramian/gramian.hpp"
#include "knead/spline/basis.hpp"

namespace knead::figures {
namespace {

int last_knot(int degree) { return std::max(13, degree + 7); }

/// The terms of the Dirac rule for (i, i): all knots of N_i are simple.
std::vector<double> terms(const KnotVector& knots, int i) {
  const int p = knots.degree();
  std::vector<double> result;
  for (const KnotJumps& at : derivative_jumps(knots, i)) {
    const double term = at.jumps.back() * basis_integral(knots, i, p + 1, at.knot);
    result.push_back(p % 2 == 0 ? -term : term);
  }
  return result;
}

double plain_sum(const std::vector<double>& numbers) {
  double sum = 0;
  for (const double x : numbers) sum += x;
  return sum;
}

double kahan_sum(const std::vector<double>& numbers) {
  double sum = 0, lost = 0;
  for (const double x : numbers) {
    const double y = x - lost, next = sum + y;
    lost = (next - sum) - y;
    sum = next;
  }
  return sum;
}

KnotVector mirrored(const KnotVector& knots) {
  std::vector<double> x(knots.knots().begin(), knots.knots().end());
  const double end = x.back();
  for (double& u : x) u = end - u;
  std::ranges::reverse(x);
  return *KnotVector::create(knots.degree(), std::move(x));
}

double worst(const KnotVector& knots, bool better_side = false) {
  const int n = knots.count();
  const BandMatrix analytic = *gramian(knots, 0, 0, GramianMethod::analytic);
  const BandMatrix from_right = *gramian(mirrored(knots), 0, 0, GramianMethod::analytic);
  const BandMatrix right = *gramian(knots, 0, 0, GramianMethod::recurrence);
  double result = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < std::min(n, i + knots.degree() + 1); ++j) {
      double error = std::abs(analytic(i, j) - right(i, j));
      if (better_side)
        error = std::min(error, std::abs(from_right(n - 1 - i, n - 1 - j) - right(i, j)));
      result = std::max(result, error / right(i, j));
    }
  }
  return result;
}

}  // namespace

Cancellation cancellation(int degree, int r) {
  const int i = degree + 5, last = last_knot(degree);
  const auto error = [](const KnotVector& knots, int row, auto sum) {
    const double right = (*gramian(knots, 0, 0))(row, row);
    return std::abs(sum(terms(knots, row)) - right) / right;
  };
  const KnotVector knots = thesis_knots(degree, r, 1, last);
  Cancellation result;
  double sizes = 0;
  for (const double term : terms(knots, i)) sizes += std::abs(term);
  result.condition = sizes / (*gramian(knots, 0, 0))(i, i);
  const auto jumps = derivative_jumps(knots, i);
  for (std::size_t k = 0; k < 2; ++k) {
    result.weight[k] = jumps[k + 1].jumps.back();
    result.integral[k] = basis_integral(knots, i, degree + 1, jumps[k + 1].knot);
  }
  result.plain = error(knots, i, plain_sum);
  result.kahan = error(knots, i, kahan_sum);
  result.normalised = error(thesis_knots(degree, r, 1.0 / 13, last), i, plain_sum);
  result.mirrored = error(mirrored(knots), knots.count() - 1 - i, plain_sum);
  return result;
}

double worst_on_thesis_knots(int degree, int r) { return worst(thesis_knots(degree, r)); }

double worst_by_better_side(int degree, int r) { return worst(thesis_knots(degree, r), true); }

double worst_on_cluster(int degree) {
  std::vector<double> x(static_cast<std::size_t>(degree), 0.0);
  for (int k = 0; k <= 6; ++k) x.push_back(k);
  x.insert(x.end(), {6 + 1e-8, 6 + 2e-8});
  for (int k = 8; k <= 13; ++k) x.push_back(k);
  x.insert(x.end(), static_cast<std::size_t>(degree), 13.0);
  return worst(*KnotVector::create(degree, std::move(x)));
}

}  // namespace knead::figures
