#include "knead/spline/evaluate.hpp"

#include <cassert>

#include "base/parallel_for.hpp"
#include "simd/grid_kernels.hpp"

namespace knead {

void unit_normals(const Evaluation<2>& evaluation, Points& result) {
  assert(evaluation.order >= 1);
  const Points &u = evaluation.at({1, 0}), &v = evaluation.at({0, 1});
  result.resize(u.rows(), 3);
  const double *from_u = u.data(), *from_v = v.data();
  double* to = result.data();
  const detail::GridKernels& kernels = detail::grid_kernels();
  constexpr double work = 30;  // with a root and a division
  detail::parallel_for(
      u.rows(), detail::block_size(u.rows(), work), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        kernels.normals(from_u + 3 * begin, from_v + 3 * begin, end - begin, to + 3 * begin);
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

Expected<Points> unit_normals_on_grid(const Surface& surface,
                                      const std::array<std::span<const double>, 2>& parameters,
                                      Side side) {
  const auto found = evaluate_grid<2>(surface, parameters, 1, side);
  if (!found) return std::unexpected(found.error());
  return unit_normals(*found);
}

}  // namespace knead
