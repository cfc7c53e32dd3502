#include "brush.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "base/decompositions.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

constexpr double first_length = 1. / 16;  // of a path at its first place, in radii
constexpr int fewest_of_plane = 6;        // samples, else it is that of the place
constexpr int enough_of_plane = 16;       // else it is fitted to more of the surroundings,
constexpr double wider = 1.25;            // farther by this,
constexpr int most_wider = 12;            // so many times
constexpr double of_plane = 1.25;         // radii within which it is fitted
constexpr double most_lean = std::numbers::pi / 3;  // of a pen's axis, from the normal
constexpr double opposed = 0.1;  // mean of normals below which they say nothing of a direction

/// Half the way to the neighbours on both sides. Trapezoidal weights of the abscissae, which need
/// not be even.
std::vector<double> cells_of(const std::vector<double>& at) {
  std::vector<double> cells(at.size());
  for (std::size_t k = 0; k < at.size(); ++k) {
    cells[k] = 0.5 * (at[std::min(k + 1, at.size() - 1)] - at[k > 0 ? k - 1 : 0]);
  }
  return cells;
}

Point turned(const Point& x, const Point& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix() * x;
}

/// What a stamp at a place does to a point at `off` from it.
Point stamped(const Brush& brush, const BrushPlace& place, const Point& normal, const Point& off) {
  const Point e = (place.along - place.along.dot(normal) * normal).stableNormalized();
  Point f = normal.cross(e);
  if (f.dot(place.across) < 0) f = -f;
  const double c = std::cos(brush.angle), s = std::sin(brush.angle),
               half = brush.radius / std::numbers::sqrt2;
  const double xi = off.dot(c * e + s * f) / half, eta = off.dot(c * f - s * e) / half;
  return brush.height * stamp_rim(xi, eta, brush.core) * brush.pattern.at(xi, eta) * normal;
}

/// Of the radius: what is as near to it is outside, so that samples which lie exactly there are so
/// on both sides of a mirror, however they are rounded. Profiles are below 1e-18 there.
constexpr double rim = 1e-9;

/// The profile across a crease, a cusp.
double cusp(double distance, double radius) {
  const double s = 1 - distance / radius;
  return s > rim ? s * s : 0;
}

bool is_sharp(BrushKind kind) { return kind == BrushKind::crease || kind == BrushKind::ridge; }

bool has_strength(BrushKind kind) {
  return kind == BrushKind::flatten || kind == BrushKind::smooth || kind == BrushKind::pinch;
}

bool leans(BrushKind kind) {
  switch (kind) {
    case BrushKind::push:
    case BrushKind::pull:
    case BrushKind::flatten:
    case BrushKind::pinch:
    case BrushKind::crease:
    case BrushKind::ridge:
    case BrushKind::stamp:
      return true;
    default:
      return false;
  }
}

/// The direction of a pen's axis, on the side of the normal and no farther from it than pens may
/// lean. Beyond 60° the direction would be nearly within the surface, and a push of it a shear.
Point leaned(const Point& normal, const Point& axis) {
  const Point along = axis.dot(normal) * normal, aside = axis - along;
  const double up = along.norm(), out = aside.norm();
  if (up + out == 0 || normal.squaredNorm() == 0) return normal;
  const double angle = std::min(std::atan2(out, up), most_lean);
  if (angle == 0) return normal;
  return std::cos(angle) * normal + std::sin(angle) * (axis.dot(normal) < 0 ? -aside : aside) / out;
}

double radius_of(const Brush& brush, double pressure) {
  const bool sized = brush.pressure == PressureUse::size || brush.pressure == PressureUse::both;
  return sized ? pressure * brush.radius : brush.radius;
}

double depth_of(const Brush& brush, double pressure) {
  return brush.pressure == PressureUse::depth || brush.pressure == PressureUse::both ? pressure : 1;
}

/// Sums over the samples within a radius of a point, weighed by the profile and their areas.
struct UnderBrush {
  Point normal = Point::Zero(), middle = Point::Zero();  ///< `middle` from the point
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double total = 0, known = 0;
  int count = 0;
};

UnderBrush under_brush(const Brush& brush, const BrushSamples& samples, const Point& at,
                       double radius) {
  UnderBrush sums;
  for (Eigen::Index g = 0; g < samples.points.rows(); ++g) {
    const Point off = samples.points.row(g).transpose() - at;
    const double square = off.squaredNorm();
    if (square >= radius * radius) continue;
    const double w = brush_falloff(std::sqrt(square), radius, brush.core) * samples.areas[g];
    const Point n = samples.normals.row(g);
    sums.normal += w * n;
    sums.middle += w * off;
    sums.spread += w * off * off.transpose();
    sums.total += w;
    sums.known += w * n.squaredNorm();
    sums.count += w > 0 ? 1 : 0;
  }
  return sums;
}

}  // namespace

bool acts_about_one_place(BrushKind kind) {
  return kind == BrushKind::grab || kind == BrushKind::twist || kind == BrushKind::scale ||
         kind == BrushKind::stamp;
}

// t³ (10 − 15 t + 6 t²), the quintic with two vanishing derivatives at both ends: C² is what cubic
// surfaces can follow.
double brush_falloff(double distance, double radius, double core) {
  const double t = (1 - distance / radius) /
                   (1 - core);  // from the rim inwards, where it is small without cancellation
  if (t >= 1) return 1;
  return t <= rim ? 0 : t * t * t * (10 - t * (15 - 6 * t));
}

// The area of a sample is |S_u × S_v| by the cell of its abscissa, so that means over samples are
// means over the surface and not over its net. A normal is left out where |S_u × S_v| is below 1e-9
// of |S_u|² + |S_v|²: at poles and on degenerate sides.
Expected<void> BrushSamples::append(const Surface& shape, const SiteValues<2>& values,
                                    double side) {
  const std::array<const std::vector<double>*, 2> at = {&values.abscissae(0), &values.abscissae(1)};
  const auto jet = evaluate_grid<2>(
      shape, {std::span<const double>(*at[0]), std::span<const double>(*at[1])}, 1);
  if (!jet) return std::unexpected(jet.error());
  const std::vector<double> us = cells_of(*at[0]), vs = cells_of(*at[1]);
  const Eigen::Index first = points.rows(), count = shape.size();
  points.conservativeResize(first + count, 3);
  normals.conservativeResize(first + count, 3);
  areas.conservativeResize(first + count);
  points.middleRows(first, count) = values.values(shape.control_points());
  for (Eigen::Index k = 0; k < count; ++k) {
    const Point u = jet->at({1, 0}).row(k), v = jet->at({0, 1}).row(k), across = u.cross(v);
    const double area = across.norm();
    const bool regular = area > 1e-9 * (u.squaredNorm() + v.squaredNorm());
    normals.row(first + k) = regular ? Point(side * across / area) : Point(Point::Zero());
    areas[first + k] = area * us[static_cast<std::size_t>(k) / vs.size()] *
                       vs[static_cast<std::size_t>(k) % vs.size()];
  }
  return {};
}

BrushImage BrushImage::mirror(const Point& point, const Point& normal) {
  return {Eigen::Matrix3d::Identity() - 2 * normal * normal.transpose(),
          2 * normal.dot(point) * normal};
}

BrushImage BrushImage::turn(const Point& point, const Point& direction, double angle) {
  const Eigen::Matrix3d linear = Eigen::AngleAxisd(angle, direction).toRotationMatrix();
  return {linear, point - linear * point};
}

BrushImage BrushImage::after(const BrushImage& other) const {
  return {linear * other.linear, linear * other.offset + offset};
}

BrushPlace BrushImage::of(const BrushPlace& place) const {
  return {linear * place.at + offset,
          linear * place.normal,
          linear * place.along,
          linear * place.across,
          {place.pen.pressure, linear * place.pen.axis}};
}

Brush BrushImage::of(Brush brush) const {
  brush.by = Point(linear * brush.by);
  // Its angle is in a frame that is mirrored itself.
  const bool framed = brush.kind == BrushKind::stamp;
  if (linear.determinant() < 0 && !framed) brush.angle = -brush.angle;
  return brush;
}

BrushHistory::BrushHistory(Eigen::Index samples)
    : weight_(Eigen::VectorXd::Zero(samples)),
      total_(Eigen::VectorXd::Zero(samples)),
      sum_(Points::Zero(samples, 3)) {}

// The mean normal under the brush rather than that of the place: single normals follow every
// wrinkle that the brush is to work on. Where they oppose each other, as on both sides of a thin
// sheet, the mean says nothing, and that of the place stays. For `flatten` the plane of least
// squares replaces both: its normal is the eigenvector of the covariance with the least eigenvalue.
// It needs a spread in two directions. It is fitted to more than what moves, since a plane of what
// moves alone follows the slopes of a bump, and lifts its crest where the brush comes up to it.
BrushHistory::Pose BrushHistory::pose_at(const Brush& brush, const BrushSamples& samples,
                                         const BrushPlace& place) {
  Pose pose{place, place.at, place.normal};
  const double radius = radius_of(brush, place.pen.pressure);
  const auto lean = [&] {
    if (leans(brush.kind) && !place.pen.axis.isZero(0))
      pose.normal = leaned(pose.normal, place.pen.axis);
    return pose;
  };
  const bool flat = brush.kind == BrushKind::flatten;
  double reach = flat ? of_plane * radius : radius;
  UnderBrush under = under_brush(brush, samples, place.at, reach);
  for (int k = 0; flat && k < most_wider && under.count < enough_of_plane; ++k) {
    reach *= wider;
    under = under_brush(brush, samples, place.at, reach);
  }
  if (under.normal.norm() > opposed * under.known) pose.normal = under.normal.normalized();
  if (!flat || under.count < fewest_of_plane) return lean();
  const Point middle = under.middle / under.total;
  const Eigen::Matrix3d spread = under.spread / under.total - middle * middle.transpose();
  const auto axes = detail::symmetric_eigen(spread);
  if (!axes || !(axes->values[1] > 1e-6 * axes->values[2])) return lean();  // on a line
  pose.middle = place.at + middle;
  const Point across = axes->vectors.col(0);
  pose.normal = across.dot(pose.normal) < 0 ? Point(-across) : across;
  return lean();
}

/// d at full weight, of the kinds that have a mean along the path.
Point BrushHistory::asked_at(const Pose& pose, const Brush& brush, const BrushSamples& samples,
                             Eigen::Index g, const Points& fair) {
  const Point n = samples.normals.row(g);
  switch (brush.kind) {
    case BrushKind::push:
    case BrushKind::crease:
      return -brush.height * pose.normal;
    case BrushKind::pull:
    case BrushKind::ridge:
      return brush.height * pose.normal;
    case BrushKind::inflate:
      return brush.height * (n.squaredNorm() > 0 ? n : pose.normal);
    case BrushKind::flatten:
      return (pose.middle - samples.points.row(g).transpose()).dot(pose.normal) * pose.normal;
    case BrushKind::smooth:
      return fair.row(g);
    default:
      return Point::Zero();
  }
}

// One piece of the path. The weight is that of its nearest point, of which the largest of all
// pieces counts; the mean is the trapezoidal rule between its ends. So u converges as places become
// dense, and does not count how many there are.
void BrushHistory::add(const Brush& brush, const BrushSamples& samples, const Pose& from,
                       const Pose& to, double length, const Points& fair) {
  const Point piece = to.place.at - from.place.at;
  const double square = piece.squaredNorm();
  for (Eigen::Index g = 0; g < samples.points.rows(); ++g) {
    const Point x = samples.points.row(g);
    const double share =
        square > 0 ? std::clamp((x - from.place.at).dot(piece) / square, 0., 1.) : 1;
    const Point nearest = from.place.at + share * piece;
    const double distance = (x - nearest).norm();
    if (distance >= brush.radius) continue;
    reaches_ = true;
    const double pressure = from.place.pen.towards(to.place.pen, share).pressure;
    const double radius = radius_of(brush, pressure);
    if (distance >= radius) continue;
    const double profile = depth_of(brush, pressure) *
                           (is_sharp(brush.kind) ? cusp(distance, radius)
                                                 : brush_falloff(distance, radius, brush.core));
    if (brush.kind == BrushKind::pinch) {
      // However it is pressed.
      const double near = brush_falloff(distance, brush.radius, brush.core);
      if (near < total_[g] || (near == total_[g] && profile <= weight_[g])) continue;
      total_[g] = near;
      weight_[g] = profile;
      const Point normal = ((1 - share) * from.normal + share * to.normal).stableNormalized();
      sum_.row(g) = (nearest - x) - (nearest - x).dot(normal) * normal;
      continue;
    }
    weight_[g] = std::max(weight_[g], profile);
    for (const Pose* end : {&from, &to}) {  // the trapezoidal rule
      const double reach = radius_of(brush, end->place.pen.pressure),
                   off = (x - end->place.at).norm();
      if (off >= reach) continue;
      const double w = brush_falloff(off, reach, brush.core) * 0.5 * length;
      if (w == 0) continue;
      sum_.row(g) += w * asked_at(*end, brush, samples, g, fair);
      total_[g] += w;
    }
  }
}

// The first place has no piece: a sixteenth of a radius stands for it, so that a tap does something
// and a long path hardly notices.
void BrushHistory::go_to(const Brush& brush, const BrushSamples& samples, const BrushPlace& place,
                         const Points& fair) {
  assert(samples.points.rows() == weight_.size());
  if (!begun_) {
    begun_ = true;
    first_ = last_ = pose_at(brush, samples, place);
    add(brush, samples, first_, first_, first_length * brush.radius, fair);
    return;
  }
  const double turn = std::abs(place.pen.pressure - last_.place.pen.pressure);
  const double length = (place.at - last_.place.at).norm() + first_length * brush.radius * turn;
  if (length == 0 || acts_about_one_place(brush.kind)) return;
  const Pose next = pose_at(brush, samples, place);
  add(brush, samples, last_, next, length, fair);
  last_ = next;
}

Point BrushHistory::about_first(const Brush& brush, const Point& x) const {
  const Point off = x - first_.place.at;
  if (brush.kind == BrushKind::stamp) {
    Brush pressed = brush;
    pressed.radius = radius_of(brush, first_.place.pen.pressure);
    pressed.height = depth_of(brush, first_.place.pen.pressure) * brush.height;
    return stamped(pressed, first_.place, first_.normal, off);
  }
  const double w = brush_falloff(off.norm(), brush.radius, brush.core);
  if (brush.kind == BrushKind::grab) return w * brush.by;
  if (brush.kind == BrushKind::twist) return turned(off, first_.normal, w * brush.angle) - off;
  return w * (brush.factor - 1) * off;
}

// u = a ŵ ∫ w d dl / ∫ w dl; of `pinch` d at the nearest place stands in the sum, without a mean.
Points BrushHistory::displacement(const Brush& brush, const BrushSamples& samples) const {
  Points result = Points::Zero(weight_.size(), 3);
  const double strength = has_strength(brush.kind) ? brush.strength : 1;
  for (Eigen::Index g = 0; g < result.rows(); ++g) {
    if (weight_[g] == 0) continue;
    if (acts_about_one_place(brush.kind)) {
      result.row(g) = about_first(brush, samples.points.row(g));
    } else if (total_[g] > 0) {
      const double total = brush.kind == BrushKind::pinch ? 1 : total_[g];
      result.row(g) = strength * weight_[g] / total * sum_.row(g);
    }
  }
  return result;
}

// Weights |u|² in place of a plain mean: copies that do not act at a sample do not dilute the one
// that does, and a copy fades in without a jump.
Points blended(std::span<const Points> copies) {
  if (copies.size() == 1) return copies.front();
  Points result = Points::Zero(copies.front().rows(), 3);
  for (Eigen::Index g = 0; g < result.rows(); ++g) {
    double total = 0;
    for (const Points& u : copies) {
      result.row(g) += u.row(g).squaredNorm() * u.row(g);
      total += u.row(g).squaredNorm();
    }
    if (total > 0) result.row(g) /= total;
  }
  return result;
}

}  // namespace knead
