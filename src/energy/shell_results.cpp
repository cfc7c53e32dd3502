#include "knead/energy/shell_energy.hpp"

#include <cmath>

#include "shell_point.hpp"

namespace knead {
namespace {

detail::ShellPoint point_of(const Evaluation<2>& s, Eigen::Index k) {
  detail::ShellDerivatives d;
  d << s.at({1, 0}).row(k).transpose(), s.at({0, 1}).row(k).transpose(),
      s.at({2, 0}).row(k).transpose(), s.at({0, 2}).row(k).transpose(),
      s.at({1, 1}).row(k).transpose();
  return detail::ShellPoint(d);
}

/// The trace and the determinant of a tensor with contravariant components 11, 22, 12, in
/// orthonormal ones.
struct Invariants {
  double trace, determinant;

  Invariants(const Eigen::Vector3d& t, const Eigen::Vector3d& metric)
      : trace(metric[0] * t[0] + metric[1] * t[1] + 2 * metric[2] * t[2]),
        determinant((t[0] * t[1] - t[2] * t[2]) * (metric[0] * metric[1] - metric[2] * metric[2])) {
  }

  /// The larger first.
  [[nodiscard]] std::array<double, 2> principal() const {
    const double root = std::sqrt(std::max(0.0, trace * trace / 4 - determinant));
    return {trace / 2 + root, trace / 2 - root};
  }
  [[nodiscard]] double von_mises() const {
    return std::sqrt(std::max(0.0, trace * trace - 3 * determinant));
  }
};

ShellPointResults results_at(const detail::ShellPoint& rest, const detail::ShellPoint& now,
                             const ShellMaterial& m) {
  const double t = m.thickness;
  const detail::Vector6 strain = detail::shell_strain(now, rest.metric, rest.curvature);
  const Eigen::Matrix3d elastic = detail::plane_stress(rest.inverse, m.young, m.poisson);
  const Eigen::Vector3d n = t * elastic * strain.head<3>(),
                        moment = t * t * t / 12 * elastic * strain.tail<3>();
  const Eigen::Vector3d kappa(strain[3], strain[4], strain[5] / 2);
  const auto curved = Invariants(kappa, rest.inverse).principal();
  ShellPointResults result;
  result.membrane = Invariants(n, rest.metric).principal();
  result.moment = Invariants(moment, rest.metric).principal();
  for (std::size_t face = 0; face < 2; ++face) {
    const double side = face == 0 ? 6 : -6;
    result.von_mises[face] = Invariants(n / t + side / (t * t) * moment, rest.metric).von_mises();
  }
  result.bending_strain = t / 2 * std::max(std::abs(curved[0]), std::abs(curved[1]));
  return result;
}

}  // namespace

Expected<std::vector<ShellPointResults>> shell_results(const Surface& rest, const Surface& current,
                                                       const ShellMaterial& material,
                                                       const Parameters<2>& at) {
  const auto before = evaluate<2>(rest, at, 2), now = evaluate<2>(current, at, 2);
  if (!before) return std::unexpected(before.error());
  if (!now) return std::unexpected(now.error());
  std::vector<ShellPointResults> results;
  results.reserve(static_cast<std::size_t>(at.rows()));
  for (Eigen::Index k = 0; k < at.rows(); ++k) {
    const auto here = material.at({at(k, 0), at(k, 1)});
    if (!here) return std::unexpected(here.error());
    results.push_back(results_at(point_of(*before, k), point_of(*now, k), *here));
  }
  return results;
}

}  // namespace knead
