#include "knead/scene/places.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "knead/spline/basis.hpp"

namespace knead {

Expected<std::array<double, 2>> parameters_at(const Surface& surface, const Fractions& at, const char* where) {
  std::array<double, 2> u;
  for (std::size_t d = 0; d < 2; ++d) {
    if (!(at[d] >= 0 && at[d] <= 1)) {
      return input_error(fmt::format("{} is not a fraction of the domain", at[d]), where, "use numbers from 0 to 1");
    }
    const Interval domain = surface.knots()[d].domain();
    u[d] = std::min(domain.lower + at[d] * domain.length(), domain.upper);
  }
  return u;
}

Expected<std::array<Interval, 2>> region_at(const Surface& surface, const FractionBox& region) {
  const auto lower = parameters_at(surface, {region[0][0], region[1][0]}, "region");
  const auto upper = parameters_at(surface, {region[0][1], region[1][1]}, "region");
  if (!lower) return std::unexpected(lower.error());
  if (!upper) return std::unexpected(upper.error());
  std::array<Interval, 2> result;
  for (std::size_t d = 0; d < 2; ++d) {
    if ((*upper)[d] < (*lower)[d]) {
      return input_error("a side of the region decreases", "region",
                         "write [[s0, s1], [t0, t1]] with s0 <= s1, t0 <= t1");
    }
    result[d] = {(*lower)[d], (*upper)[d]};
  }
  return result;
}

std::vector<std::pair<int, double>> basis_terms(const Surface& surface, const std::array<double, 2>& u, int first) {
  std::array<std::array<double, max_degree + 1>, 2> n;
  std::array<int, 2> span;
  for (std::size_t d = 0; d < 2; ++d) {
    span[d] = surface.knots()[d].find_span(u[d]);
    basis_values(surface.knots()[d], span[d], u[d], n[d].data());
  }
  const int p = surface.knots(0).degree(), q = surface.knots(1).degree(), columns = surface.net()[1];
  std::vector<std::pair<int, double>> terms;
  double sum = 0;
  for (int r = 0; r <= p; ++r) {
    for (int c = 0; c <= q; ++c) {
      const int row = (span[0] - p + r) * columns + span[1] - q + c;
      const double w = surface.rational() ? surface.weights()[static_cast<std::size_t>(row)] : 1;
      terms.emplace_back(first + row, w * n[0][static_cast<std::size_t>(r)] * n[1][static_cast<std::size_t>(c)]);
      sum += terms.back().second;
    }
  }
  for (auto& term : terms) term.second /= sum;
  return terms;
}

}  // namespace knead
