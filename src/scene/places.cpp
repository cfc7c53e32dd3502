#include "places.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace knead {

template <int D>
Expected<std::array<double, D>> parameters_at(const Spline<D>& spline, std::span<const double> at,
                                              const char* where) {
  if (at.size() != D) {
    return input_error(fmt::format("{} number{} for {} direction{}", at.size(),
                                   at.size() == 1 ? "" : "s", D, D == 1 ? "" : "s"),
                       where,
                       D == 1   ? "give [s]"
                       : D == 2 ? "give [s, t]"
                                : "give [s, t, r]");
  }
  std::array<double, D> u;
  for (std::size_t d = 0; d < D; ++d) {
    if (!(at[d] >= 0 && at[d] <= 1)) {
      return input_error(fmt::format("{} is not a fraction of the domain", at[d]), where,
                         "use numbers from 0 to 1");
    }
    const Interval domain = spline.knots()[d].domain();
    u[d] = std::min(domain.lower + at[d] * domain.length(), domain.upper);
  }
  return u;
}

template Expected<std::array<double, 1>> parameters_at<1>(const Curve&, std::span<const double>,
                                                          const char*);
template Expected<std::array<double, 2>> parameters_at<2>(const Surface&, std::span<const double>,
                                                          const char*);
template Expected<std::array<double, 3>> parameters_at<3>(const Volume&, std::span<const double>,
                                                          const char*);

Expected<std::array<double, 2>> parameters_at(const Surface& surface, const Fractions& at,
                                              const char* where) {
  return parameters_at<2>(surface, at, where);
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

double net_size(const Surface& surface) {
  const Points& net = surface.control_points();
  return (net.colwise().maxCoeff() - net.colwise().minCoeff()).norm();
}

}  // namespace knead
