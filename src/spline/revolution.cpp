#include "knead/spline/revolution.hpp"

#include <cassert>
#include <numbers>
#include <string>

namespace knead {
namespace {

constexpr double half_root = std::numbers::sqrt2 / 2;
// Eighths of a turn: where two quarters meet, and the corners between.
constexpr std::array<std::array<double, 2>, 8> ring = {
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

double weight(int eighth) { return eighth % 2 == 0 ? 1 : half_root; }

Expected<KnotVector> quarter_knots(int quarters) {
  std::vector<double> knots(3, 0.0);
  for (int k = 1; k < quarters; ++k)
    knots.insert(knots.end(), 2, static_cast<double>(k) / quarters);
  knots.insert(knots.end(), 3, 1.0);
  return KnotVector::create(2, std::move(knots));
}

}  // namespace

Expected<Curve> circle_quarters(std::array<double, 2> centre, double radius, int first,
                                int quarters) {
  assert(quarters >= 1);
  auto knots = quarter_knots(quarters);
  if (!knots) return std::unexpected(knots.error());
  Points points(2 * quarters + 1, 3);
  std::vector<double> weights;
  for (int k = 0; k <= 2 * quarters; ++k) {
    const int eighth = ((2 * first + k) % 8 + 8) % 8;
    const auto& [cosine, sine] = ring[static_cast<std::size_t>(eighth)];
    points.row(k) << centre[0] + radius * cosine, 0, centre[1] + radius * sine;
    weights.push_back(weight(eighth));
  }
  return Curve::create({*std::move(knots)}, std::move(points), std::move(weights));
}

Expected<Surface> revolve(const Curve& profile) {
  auto round = quarter_knots(4);
  if (!round) return std::unexpected(round.error());
  const int count = round->count(), n = profile.size();
  Points points(static_cast<Eigen::Index>(count) * n, 3);
  std::vector<double> weights;
  for (int i = 0; i < count; ++i) {
    const auto& [cosine, sine] = ring[static_cast<std::size_t>(i % 8)];
    for (int j = 0; j < n; ++j) {
      const auto at = profile.control_points().row(j);
      if (at[1] != 0) {
        return input_error("the profile leaves the plane y = 0",
                           "control point " + std::to_string(j), "give control points (r, 0, z)");
      }
      points.row(i * n + j) << at[0] * cosine, at[0] * sine, at[2];
      weights.push_back(weight(i) *
                        (profile.rational() ? profile.weights()[static_cast<std::size_t>(j)] : 1));
    }
  }
  return Surface::create({*std::move(round), profile.knots(0)}, std::move(points),
                         std::move(weights));
}

}  // namespace knead
