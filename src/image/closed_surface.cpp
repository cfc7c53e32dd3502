#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "knead/image/surface_snake.hpp"
#include "knead/spline/evaluate.hpp"
#include "snake_settings.hpp"
#include "surface_net.hpp"

namespace knead {
namespace {

using std::numbers::pi;

constexpr int fewest_from_pole_to_pole = 6;

Expected<void> check_start(const SurfaceStart& start) {
  const bool torus = start.form == SurfaceForm::torus;
  for (std::size_t d = 0; d < (torus ? 2U : 3U); ++d) {
    if (!(start.radii[d] > 0 && start.radii[d] <= 1e9)) {
      return input_error("the surface has no size", "radii", "give radii above 0");
    }
  }
  if (torus && start.radii[1] >= start.radii[0]) {
    return input_error(
        fmt::format("the tube of {} closes the ring of {}", start.radii[1], start.radii[0]),
        "radii", "give the ring's first, then the tube's, which is less");
  }
  if (!start.centre.allFinite()) return input_error("the centre is not finite", "centre");
  if (!start.axis.allFinite() || !(start.axis.norm() > 0)) {
    return input_error("the axis has no direction", "axis", "use [0, 0, 1]");
  }
  return {};
}

/// A place of the start, at fractions of a turn around u and v (of half a turn from pole to pole).
/// A sphere has its poles at z = −1, v = 0, and at z = 1, v = 1, so that S_u × S_v points outwards.
Point place_of(const SurfaceStart& start, const Eigen::Quaterniond& turn, double u, double v) {
  const double a = 2 * pi * u;
  Point at;
  if (start.form == SurfaceForm::torus) {
    const double b = 2 * pi * v, out = start.radii[0] + start.radii[1] * std::cos(b);
    at = {out * std::cos(a), out * std::sin(a), start.radii[1] * std::sin(b)};
  } else {
    const double b = pi * v;
    at = {start.radii[0] * std::sin(b) * std::cos(a), start.radii[1] * std::sin(b) * std::sin(a),
          -start.radii[2] * std::cos(b)};
  }
  return start.centre + turn * at;
}

SurfaceSpace space_for(const SurfaceStart& start, const SurfaceSnakeSettings& settings) {
  const bool torus = start.form == SurfaceForm::torus;
  const double mean =
      torus ? start.radii[0] : (start.radii[0] + start.radii[1] + start.radii[2]) / 3;
  const double around = settings.units > 0 ? settings.units : 2 * pi * mean;
  return {start.form,
          settings.degree,
          settings.control_points,
          {around, torus ? around * start.radii[1] / start.radii[0] : around / 2}};
}

}  // namespace

// Fitted by least squares in the space of the snake, and not interpolated: the conditions at the
// poles hold, and the first step starts from a shape that the snake can have.
Expected<ClosedSurface> closed_surface(const SurfaceStart& start,
                                       const SurfaceSnakeSettings& settings) {
  if (auto checked = check_settings(settings); !checked) return std::unexpected(checked.error());
  if (auto checked = check_start(start); !checked) return std::unexpected(checked.error());
  if (start.form == SurfaceForm::sphere && settings.control_points[1] < fewest_from_pole_to_pole) {
    return input_error(fmt::format("{} from pole to pole are too few", settings.control_points[1]),
                       "control_points", fmt::format("use {} or more", fewest_from_pole_to_pole));
  }
  const SurfaceSpace space = space_for(start, settings);
  const auto net = SurfaceNet::create(space, 0, 0);
  if (!net) return std::unexpected(net.error());
  const auto turn = Eigen::Quaterniond::FromTwoVectors(Point::UnitZ(), start.axis);
  const auto &u = net->quadrature(0).parameters, &v = net->quadrature(1).parameters;
  Points places(std::ssize(u) * std::ssize(v), 3);
  Eigen::Index k = 0;
  for (const double a : u) {
    for (const double b : v)
      places.row(k++) = place_of(start, turn, a / space.lengths[0], b / space.lengths[1]);
  }
  const auto c = projected(space, places);
  if (!c) return std::unexpected(c.error());
  return net->surface(*c);
}

// Area ∫ |S_u × S_v|; volume ∫ S · (S_u × S_v) / 3 by the divergence theorem, whose integrand is of
// degree 3p − 1 at most in each direction: p + 3 points are exact for p ≤ 6, and the area's root is
// smooth.
SurfaceMeasure measure(const ClosedSurface& snake) {
  std::array<BasisQuadrature, 2> q;
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& knots = snake.surface.knots()[d];
    q[d] = gauss_basis(knots, knots.degree() + 3, 1);
  }
  SurfaceMeasure sum;
  const auto at = evaluate_grid<2>(snake.surface,
                                   std::array<const BasisTable*, 2>{&q[0].basis, &q[1].basis}, 1);
  if (!at) return sum;  // only rational surfaces can fail
  Eigen::Index k = 0;
  for (const double a : q[0].weights) {
    for (const double b : q[1].weights) {
      const Eigen::RowVector3d normal = at->derivatives[1].row(k).cross(at->derivatives[2].row(k));
      sum.area += a * b * normal.norm();
      sum.volume += a * b * at->points().row(k).dot(normal) / 3;
      ++k;
    }
  }
  return sum;
}

}  // namespace knead
