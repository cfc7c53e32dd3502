#include "seams_rest.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "seams_edge.hpp"

namespace knead::seams {

// ρ minimises Σ |S_a' + ρ S_b'|² over the samples of both edges; `deviation` says how far it is
// from constant, in radians for small ones. Angles are between the normals, which need not have
// equal speeds.
Expected<RestMeeting> rest_meeting(const Surface& a, const Surface& b, const Seam& seam) {
  std::vector<double> t_a = edge_samples(a.knots(edge_along(seam.a.edge)));
  for (double t : edge_samples(b.knots(edge_along(seam.b.edge))))
    t_a.push_back(seam.reversed ? 1 - t : t);
  std::vector<double> t_b = t_a;
  if (seam.reversed) {
    for (double& t : t_b) t = 1 - t;
  }
  const auto at_a = evaluate_edge(a, seam.a.edge, t_a, 1),
             at_b = evaluate_edge(b, seam.b.edge, t_b, 1);
  if (!at_a) return std::unexpected(at_a.error().within(to_string(seam.a)));
  if (!at_b) return std::unexpected(at_b.error().within(to_string(seam.b)));
  const Points in_a = inward(*at_a, seam.a.edge), in_b = inward(*at_b, seam.b.edge);
  const Points& along = edge_along(seam.a.edge) == 0 ? at_a->at({1, 0}) : at_a->at({0, 1});

  RestMeeting rest;
  const double squares = in_b.squaredNorm();
  if (squares == 0) return rest;
  rest.ratio = -in_a.cwiseProduct(in_b).sum() / squares;
  rest.lowest = INFINITY;
  const double least_a = 1e-6 * in_a.rowwise().norm().maxCoeff(),
               least_b = 1e-6 * in_b.rowwise().norm().maxCoeff();
  for (Eigen::Index k = 0; k < in_a.rows(); ++k) {
    const Point x = in_a.row(k), y = in_b.row(k), edge = along.row(k);
    if (x.norm() <= least_a || y.norm() <= least_b) continue;
    rest.deviation = std::max(rest.deviation, (x + rest.ratio * y).norm() / x.norm());
    rest.lowest = std::min(rest.lowest, x.norm() / y.norm());
    rest.highest = std::max(rest.highest, x.norm() / y.norm());
    const Point normal_a = edge.cross(x), normal_b = y.cross(edge);
    if (normal_a.norm() == 0 || normal_b.norm() == 0) continue;
    const double angle = std::atan2(normal_a.cross(normal_b).norm(), normal_a.dot(normal_b));
    rest.angle = std::max(rest.angle, angle);
    rest.fold = std::max(rest.fold, std::numbers::pi - angle);
  }
  return rest;
}

// The most exact seams come first and set the values that others take.
void agree_ratios(std::span<const Surface* const> patches, std::span<const Seam> seams,
                  std::span<RestMeeting* const> rests) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < seams.size(); ++k) {
    if (rests[k] != nullptr && rests[k]->ratio != 0) order.push_back(k);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return rests[k]->deviation; });
  const auto length = [&](const PatchEdge& e) {
    return patches[static_cast<std::size_t>(e.patch)]->knots(edge_across(e.edge)).domain().length();
  };
  std::vector<double> values = {
      0};  // of |log ρ| per normalised parameter, set by the most exact seams
  for (std::size_t k : order) {
    RestMeeting& rest = *rests[k];
    // d/dt = length d/dx: S_a' length_a = −(ρ length_a/length_b) S_b' length_b.
    const double logarithm =
        std::log(std::abs(rest.ratio) * length(seams[k].a) / length(seams[k].b));
    const double size = std::abs(logarithm);
    const double nearest =
        *std::ranges::min_element(values, {}, [&](double value) { return std::abs(value - size); });
    if (std::abs(nearest - size) > std::max(1e-7, 3 * rest.deviation)) {
      values.push_back(size);
      continue;
    }
    const double change = std::copysign(nearest, logarithm) - logarithm;
    rest.ratio *= std::exp(change);
    rest.deviation += std::abs(change);
  }
}

}  // namespace knead::seams
