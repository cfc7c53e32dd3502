#include "knead/spline/basis.hpp"

#include <cassert>

namespace knead {

std::vector<KnotJumps> derivative_jumps(const KnotVector& knots, int i) {
  assert(i >= 0 && i < knots.count());
  const int p = knots.degree(), end = i + p + 2;
  std::vector<KnotJumps> result;
  for (int first = i, last; first < end; first = last) {
    last = first;
    while (last < end && knots[last] == knots[first]) ++last;
    const int m = last - first;
    // 1/Q(ξ + h) = Π 1/((ξ − x_l) + h): one factor after the other, a power series in h up to
    // h^(m−1).
    double series[max_degree + 2] = {1};
    for (int l = i; l < end; ++l) {
      if (l >= first && l < last) continue;
      const double distance = knots[first] - knots[l];
      series[0] /= distance;
      for (int k = 1; k < m; ++k) series[k] = (series[k] - series[k - 1]) / distance;
    }
    KnotJumps at{knots[first], m, std::vector<double>(static_cast<std::size_t>(m))};
    double factor = knots[end - 1] - knots[i];  // times p!/t!
    for (int r = 1; r <= p; ++r) factor *= r;
    for (int t = 0; t < m; ++t) {
      const int r = p - t;
      if (t > 1) factor /= t;
      at.jumps[static_cast<std::size_t>(m - 1 - t)] =
          (r % 2 == 0 ? -factor : factor) * series[m - 1 - t];
    }
    result.push_back(std::move(at));
  }
  return result;
}

}  // namespace knead
