#include "travelled.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <vector>

#include "base/decompositions.hpp"
#include "knead/spline/closest_point.hpp"
#include "knead/spline/evaluate.hpp"
#include "spline/surface_jet.hpp"

namespace knead {
namespace {

/// A shape with its points at the abscissae.
struct SampledShape {
  const Surface& shape;
  const SiteValues<2>& values;
  Points points;

  /// About the foot of a point: downhill from the nearest sample.
  ///
  /// The nearest sample is a start in the right valley of the distance; a global search would cost
  /// more for each of a stroke's places.
  [[nodiscard]] std::array<double, 2> foot(const Point& x) const {
    Eigen::Index nearest = 0;
    (points.rowwise() - x.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
    const auto columns = static_cast<Eigen::Index>(values.abscissae(1).size());
    const std::array<double, 2> start = {
        values.abscissae(0)[static_cast<std::size_t>(nearest / columns)],
        values.abscissae(1)[static_cast<std::size_t>(nearest % columns)]};
    return closest_point_from<2>(shape, x, start).parameters;
  }

  [[nodiscard]] bool inside(const std::array<double, 2>& foot) const {
    for (std::size_t d = 0; d < 2; ++d) {
      const Interval domain = shape.knots()[d].domain();
      if (!(foot[d] > domain.lower && foot[d] < domain.upper)) return false;
    }
    return true;
  }
};

/// How a displacement moves with a tool: through the domain, and in space.
struct Motion {
  Eigen::Vector2d way = Eigen::Vector2d::Zero();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
};

// Inside the domain the way is the difference of the feet's parameters. Where a foot is on the
// border the tool has left the surface, and its feet stand still: then the way in space is
// expressed by the tangents, (S_u S_v) way ≈ to − from in least squares. Displacements turn as the
// normal does.
std::optional<Motion> motion_of(const SampledShape& on, const Travel& travel) {
  const std::array<double, 2> from = on.foot(travel.from), to = on.foot(travel.to);
  const SurfaceJet a = surface_jet(on.shape, from[0], from[1]),
                   b = surface_jet(on.shape, to[0], to[1]);
  const Point normal_a = a.d[1].cross(a.d[2]), normal_b = b.d[1].cross(b.d[2]);
  if (!(normal_a.norm() > 0 && normal_b.norm() > 0)) return std::nullopt;
  Motion motion;
  if (on.inside(from) && on.inside(to)) {
    motion.way = {to[0] - from[0], to[1] - from[1]};
  } else {
    Eigen::Matrix<double, 3, 2> tangents;
    tangents << b.d[1], b.d[2];
    const auto way = detail::least_squares(tangents, travel.to - travel.from);
    if (!way) return std::nullopt;
    motion.way = *way;
  }
  motion.turn = Eigen::Quaterniond::FromTwoVectors(normal_a, normal_b).toRotationMatrix();
  if (!motion.way.allFinite() || !motion.turn.allFinite()) return std::nullopt;
  return motion;
}

/// The displacement, moved, at the abscissae.
///
/// D(u − way), turned: the value at the parameters from where it comes. Beyond the border it is
/// that of the border.
std::optional<Points> moved(const SampledShape& on, const Surface& displacement,
                            const Motion& motion) {
  std::array<std::vector<double>, 2> at;
  for (std::size_t d = 0; d < 2; ++d) {
    const Interval domain = on.shape.knots()[d].domain();
    at[d] = on.values.abscissae(static_cast<int>(d));
    for (double& u : at[d])
      u = std::clamp(u - motion.way[static_cast<Eigen::Index>(d)], domain.lower, domain.upper);
  }
  const std::array<std::span<const double>, 2> grid = {at[0], at[1]};
  const auto there = evaluate_grid<2>(displacement, grid);
  if (!there) return std::nullopt;
  return Points(there->points() * motion.turn.transpose());
}

}  // namespace

// With several tools every sample follows the one that comes nearest to it, and the result is
// interpolated at the abscissae. It is a guess from which a step starts: whatever cannot be
// computed leaves the displacement as it is.
Points travelled(const Surface& shape, const SiteValues<2>& values, const Points& displacement,
                 std::span<const Travel> travels) {
  const auto field = shape.with_control_points(displacement);
  if (!field || travels.empty()) return displacement;
  const SampledShape on{shape, values, values.values(shape.control_points())};
  Points result(shape.size(), 3);
  Eigen::VectorXd distances =
      Eigen::VectorXd::Constant(shape.size(), std::numeric_limits<double>::infinity());
  for (const Travel& travel : travels) {
    const auto motion = motion_of(on, travel);
    const auto there = motion ? moved(on, *field, *motion) : std::nullopt;
    if (!there) return displacement;
    for (Eigen::Index i = 0; i < result.rows(); ++i) {
      const double distance = (on.points.row(i).transpose() - travel.to).squaredNorm();
      if (!(distance < distances[i])) continue;
      distances[i] = distance;
      result.row(i) = there->row(i);
    }
  }
  return distances.allFinite() ? values.coefficients(std::move(result)) : displacement;
}

}  // namespace knead
