#include "knead/spline/normals.hpp"

#include <cassert>
#include <cmath>

#include "base/parallel_for.hpp"

namespace knead {
namespace {

void put_normal(const double* a, const double* b, double* to) {
  const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
  const double length = std::sqrt(x * x + y * y + z * z);
  const double speeds = a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
  const double factor = length > 1e-9 * speeds ? 1 / length : 0;
  to[0] = factor * x;
  to[1] = factor * y;
  to[2] = factor * z;
}

}  // namespace

void unit_normals(const Evaluation<2>& evaluation, Points& result) {
  assert(evaluation.order >= 1);
  const Points &u = evaluation.at({1, 0}), &v = evaluation.at({0, 1});
  result.resize(u.rows(), 3);
  const double *from_u = u.data(), *from_v = v.data();
  double* to = result.data();
  constexpr double work = 30;  // with a root and a division
  detail::parallel_for(u.rows(), detail::block_size(u.rows(), work), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t k = 3 * begin; k < 3 * end; k += 3) put_normal(from_u + k, from_v + k, to + k);
  });
}

Points unit_normals(const Evaluation<2>& evaluation) {
  Points result;
  unit_normals(evaluation, result);
  return result;
}

Expected<Points> unit_normals(const Surface& surface, const Parameters<2>& parameters, Side side) {
  const auto found = evaluate<2>(surface, parameters, 1, side);
  if (!found) return std::unexpected(found.error());
  return unit_normals(*found);
}

Expected<Points> unit_normals_on_grid(const Surface& surface, const std::array<std::span<const double>, 2>& parameters,
                                      Side side) {
  const auto found = evaluate_grid<2>(surface, parameters, 1, side);
  if (!found) return std::unexpected(found.error());
  return unit_normals(*found);
}

}  // namespace knead
