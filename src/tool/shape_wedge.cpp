#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "describe/describe.hpp"
#include "searched_solid.hpp"
#include "separable_patch.hpp"

namespace knead {

void describe(WedgeShape& s, Fields& fields) {
  fields.name("wedge", "a straight ridge along x over its foot in z = 0");
  fields.add("length", s.length,
             {.help = "along the ridge", .unit = Unit::length, .range = above(0)});
  fields.add("angle", s.angle,
             {.help = "between the flanks, in degrees",
              .unit = Unit::angle,
              .range = {.least = 0, .most = 180, .open_below = true, .open_above = true}});
  fields.add("height", s.height,
             {.help = "from its foot to the ridge", .unit = Unit::length, .range = above(0)});
  fields.add("rounding", s.rounding,
             {.help = "radius of the ridge's edge", .unit = Unit::length, .range = at_least(0)});
}

namespace detail {
namespace {

using Vector2 = Eigen::Vector2d;

/// Half of the profile, y >= 0: the foot from (0, 0) to `corner`, the flank from there to the arc
/// about `centre`, which ends in (0, height). The flank's normal is (cos, sin), and (sin, −cos)
/// leads down it.
struct Profile {
  double cos, sin, height, rounding;
  Vector2 centre = {0.0, height - rounding}, normal = {cos, sin}, down = {sin, -cos};
  Vector2 corner = {(rounding + centre.y() * sin) / cos, 0.0};

  /// The profile for this tangent of half the opening angle.
  [[nodiscard]] static Profile create(double tangent, double height, double rounding) {
    const double cos = 1 / std::sqrt(1 + tangent * tangent);
    return {cos, tangent * cos, height, rounding};
  }

  struct Foot {
    double distance;  // negative inside
    Vector2 point, normal;
    double curvature = 0;  // of the curve of equal distance
  };

  [[nodiscard]] Foot foot(const Vector2& q) const {
    const Vector2 d = q - centre;
    const double along = d.dot(down), reach = d.norm();
    const bool on_arc = along < 0;
    const double beyond = (on_arc ? reach : d.dot(normal)) - rounding;
    const Vector2 n = on_arc ? Vector2(d / reach) : normal;
    if (-q.y() > beyond && q.x() <= corner.x()) return {-q.y(), {q.x(), 0.0}, {0.0, -1.0}};
    if (along > (corner - centre).dot(down) && (beyond > 0 || q.y() < 0)) {
      const Vector2 away = q - corner;
      const double distance = away.norm();
      if (distance > 0) return {distance, corner, away / distance, 1 / distance};
    }
    return {beyond, q - beyond * n, n, on_arc ? 1 / reach : 0};
  }
};

double tangent_of(const WedgeShape& s) { return std::tan(s.angle * (std::numbers::pi / 360)); }

/// The nearest point of a product of convex sets is the pair of theirs; inside, the nearer boundary
/// counts.
class Wedge final : public ShapeKernel {
 public:
  Wedge(const Profile& profile, double half_length) : profile_(profile), half_(half_length) {
    const double width = std::max(profile.corner.x(), profile.rounding * profile.cos);
    size = std::min({half_, width, 0.5 * profile.height});
    box = {Point(-half_, -width, 0), Point(half_, width, profile.height)};
  }

  Nearest nearest(const Point& x) const override {
    const double end = std::signbit(x.x()) ? -1 : 1, side = std::signbit(x.y()) ? -1 : 1;
    const double beyond = std::abs(x.x()) - half_;
    const Profile::Foot foot = profile_.foot({std::abs(x.y()), x.z()});
    const Point ahead(end, 0, 0), across(0, side * foot.normal.x(), foot.normal.y());
    const Point tangent = ahead.cross(across);
    Nearest r;
    if (beyond > 0 && foot.distance > 0) {
      r.distance = std::hypot(beyond, foot.distance);
      r.point = Point(end * half_, side * foot.point.x(), foot.point.y());
      r.normal = (beyond * ahead + foot.distance * across) / r.distance;
      const Point turning = (foot.distance * ahead - beyond * across) / r.distance;
      r.hessian = (turning * turning.transpose() +
                   foot.distance * foot.curvature * tangent * tangent.transpose()) /
                  r.distance;
    } else if (beyond >= foot.distance) {
      r.distance = beyond;
      r.point = Point(end * half_, x.y(), x.z());
      r.normal = ahead;
    } else {
      r.distance = foot.distance;
      r.point = Point(x.x(), side * foot.point.x(), foot.point.y());
      r.normal = across;
      r.hessian = foot.curvature * tangent * tangent.transpose();
    }
    return r;
  }

 private:
  Profile profile_;
  double half_;
};

/// The rounded wedge scaled unequally across its ridge, whose arc becomes elliptic, by search.
Kernel scaled_wedge(const WedgeShape& s, const Point& scale) {
  const Profile plain = Profile::create(tangent_of(s), s.height, s.rounding);
  const Vector2 across(scale.y(), scale.z());
  const Vector2 corner = plain.corner.cwiseProduct(across),
                centre = plain.centre.cwiseProduct(across);
  const Vector2 tip = (plain.centre + s.rounding * plain.normal).cwiseProduct(across),
                radii = s.rounding * across;
  const double half = 0.5 * s.length * scale.x();

  constexpr Range all = {0, 1};
  constexpr std::array<int, 3> axes = {1, 2, 0};
  const auto along = MonotoneCurve::segment(Vector2(1, 0), Vector2(1, 1)),
             out = MonotoneCurve::segment(Vector2(0, 1), Vector2(1, 1));
  Patches patches;
  // A piece of the profile is swept along the ridge, and from the middle of the foot over an end.
  const auto add = [&](const MonotoneCurve& curve, const Range& range, bool foot) {
    const ParameterRectangle at = {{all, range}};
    patches.push_back(
        std::make_unique<SeparablePatch>(at, along, curve, Point(1, 1, half), Point::Zero(), axes));
    if (foot) return;
    patches.push_back(
        std::make_unique<SeparablePatch>(at, out, curve, Point(1, 1, half), Point::Zero(), axes));
  };
  add(MonotoneCurve::segment(Vector2::Zero(), corner), all, true);
  if ((corner - tip).norm() > 1e-12 * corner.norm())
    add(MonotoneCurve::segment(corner, tip), all, false);
  // The arc's angles, from that of the flank's normal to a right angle, in halves of the quarter.
  if (plain.sin < plain.cos) {
    add(MonotoneCurve::arc(centre, radii, 1, false), Range{plain.sin / plain.cos, 1}, false);
  }
  add(MonotoneCurve::arc(centre, radii, 1, true), Range{0, std::min(1.0, plain.cos / plain.sin)},
      false);

  const auto inside = [plain, scale, half_length = 0.5 * s.length](const Point& x) {
    const Point y = x.cwiseQuotient(scale);
    return std::abs(y.x()) <= half_length && plain.foot({std::abs(y.y()), y.z()}).distance <= 0;
  };
  const double width = std::max(corner.x(), tip.x()), height = s.height * scale.z();
  return std::make_unique<SearchedSolid>(
      std::move(patches), inside, std::array<bool, 3>{true, true, false}, false,
      BoundingBox{Point(-half, -width, 0), Point(half, width, height)},
      std::min({half, width, 0.5 * height}));
}

Expected<void> validate(const WedgeShape& s) {
  for (const auto& [value, field] : {std::pair{s.length, "length"}, std::pair{s.height, "height"},
                                     std::pair{s.angle, "angle"}}) {
    if (!(std::isfinite(value) && value > 0))
      return input_error(fmt::format("{} cannot be the {}", value, field), field,
                         "use a number > 0");
  }
  if (s.angle >= 180)
    return input_error(fmt::format("{} cannot be the angle", s.angle), "angle",
                       "use less than 180");
  const double most = s.height / (1 - std::sin(s.angle * (std::numbers::pi / 360)));
  if (!(s.rounding >= 0 && s.rounding <= most * (1 + 1e-12))) {  // the sine is rounded
    return input_error(
        fmt::format("{} cannot be the rounding", s.rounding), "rounding",
        fmt::format("use a number from 0 to {:.4g}: the round edge must end above the foot", most));
  }
  return {};
}

}  // namespace

Expected<Kernel> shape_kernel(const WedgeShape& s, const Point& scale) {
  if (auto valid = validate(s); !valid) return std::unexpected(valid.error());
  if (s.rounding > 0 && scale.y() != scale.z()) return scaled_wedge(s, scale);
  const double tangent =
      scale.y() == scale.z() ? tangent_of(s) : tangent_of(s) * (scale.y() / scale.z());
  return std::make_unique<Wedge>(
      Profile::create(tangent, s.height * scale.z(), s.rounding * scale.z()),
      0.5 * s.length * scale.x());
}

}  // namespace detail
}  // namespace knead
