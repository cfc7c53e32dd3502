#include "lines.hpp"

#include <cmath>
#include <limits>

namespace knead::detail {

std::vector<double> gaussian_weights(double sigma) {
  const int reach = static_cast<int>(4 * sigma + 0.5);
  std::vector<double> weights(static_cast<std::size_t>(2 * reach + 1));
  double total = 0;
  for (int k = -reach; k <= reach; ++k) {
    const double w = std::exp(-0.5 * k * k / (sigma * sigma));
    weights[static_cast<std::size_t>(k + reach)] = w;
    total += w;
  }
  for (double& w : weights) w /= total;
  return weights;
}

// Felzenszwalb and Huttenlocher 2012: from left to right a stack of the parabolas that are lowest
// so far, with the places from which each is. A new one removes those that it is below from their
// beginning on. Each is pushed and popped once: O(n).
void lower_envelope(const std::vector<double>& f, std::vector<double>& result, double step) {
  const auto n = static_cast<int>(f.size());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<int> lowest;   // whose parabolas are lowest somewhere, from left to right
  std::vector<double> from;  // where each begins to be
  const auto at = [&](int k) { return f[static_cast<std::size_t>(k)]; };
  for (int q = 0; q < n; ++q) {
    if (at(q) == infinity) continue;
    double start = -infinity;
    while (!lowest.empty()) {
      const int v = lowest.back();
      start = (double(q) + v) / 2 + (at(q) - at(v)) / (2 * step * step * (q - v));
      if (start > from.back()) break;
      lowest.pop_back();
      from.pop_back();
      start = -infinity;
    }
    lowest.push_back(q);
    from.push_back(start);
  }
  result.assign(f.size(), infinity);
  if (lowest.empty()) return;
  std::size_t k = 0;
  for (int i = 0; i < n; ++i) {
    while (k + 1 < lowest.size() && from[k + 1] < i) ++k;
    const double d = step * (i - lowest[k]);
    result[static_cast<std::size_t>(i)] = d * d + at(lowest[k]);
  }
}

// Solves (c_{i−1} + 4 c_i + c_{i+1})/6 = s_i with c mirrored at both ends. The factors of the
// symmetric filter have the poles z = √3 − 2 and 1/z: one recursion forwards, one backwards, and
// the gain 6 (Unser, Aldroubi and Eden 1993). Exact, as LU would be, with |z| = 0.27 damping every
// error; lines side by side share a pass through memory.
void interpolate_lines(double* lines, std::size_t count, std::size_t stride, int n) {
  if (n == 1) return;
  const double pole = std::sqrt(3.0) - 2;
  const auto line = [&](int k) { return lines + static_cast<std::size_t>(k) * stride; };
  // The first of the causal sums, exactly: the mirrored samples have the period 2n − 2.
  const double last = std::pow(pole, n - 1);
  std::vector<double> sums(line(0), line(0) + count);
  const auto add = [&](int k, double weight) {
    for (std::size_t i = 0; i < count; ++i) sums[i] += weight * line(k)[i];
  };
  add(n - 1, last);
  for (int k = 1; k < n - 1; ++k) {
    const double weight = std::pow(pole, k) + std::pow(pole, 2 * n - 2 - k);
    if (std::abs(weight) < 1e-40) break;  // of the values, far below rounding
    add(k, weight);
  }
  for (std::size_t i = 0; i < count; ++i) line(0)[i] = sums[i] / (1 - last * last);
  for (int k = 1; k < n; ++k) {
    for (std::size_t i = 0; i < count; ++i) line(k)[i] += pole * line(k - 1)[i];
  }
  for (std::size_t i = 0; i < count; ++i) {
    line(n - 1)[i] = pole / (pole * pole - 1) * (pole * line(n - 2)[i] + line(n - 1)[i]);
  }
  for (int k = n - 2; k >= 0; --k) {
    for (std::size_t i = 0; i < count; ++i) line(k)[i] = pole * (line(k + 1)[i] - line(k)[i]);
  }
  for (int k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < count; ++i) line(k)[i] *= 6;
  }
}

void interpolate_line(double* line, std::size_t stride, int n) {
  interpolate_lines(line, 1, stride, n);
}

// The two middle ones are one expression, in t and in r = 1 − t.
void cubic_basis(double t, double* values, bool derivative) {
  const double r = 1 - t;
  if (derivative) {
    values[0] = -r * r / 2;
    values[1] = (3 * t - 4) * t / 2;
    values[2] = (1 + 2 * t - 3 * t * t) / 2;
    values[3] = t * t / 2;
  } else {
    values[0] = r * r * r / 6;
    values[1] = (4 - 3 * t * t * (2 - t)) / 6;
    values[2] = (4 - 3 * r * r * (2 - r)) / 6;
    values[3] = t * t * t / 6;
  }
}

}  // namespace knead::detail
