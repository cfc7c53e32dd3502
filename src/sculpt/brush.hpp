#pragma once

#include <span>
#include <vector>

#include "spline/interpolation/site_values.hpp"
#include "stamp.hpp"

namespace knead {

/// What a brush does to the points that it is led over (docs/brushes.md).
enum class BrushKind {
  push,     ///< against the mean normal under it
  pull,     ///< along it
  inflate,  ///< along the normal of each point
  flatten,  ///< towards the plane fitted under it
  smooth,   ///< towards the fair shape
  pinch,    ///< towards the path, within the surface
  crease,   ///< a sharp valley along the path
  ridge,    ///< a sharp crest along it
  grab,     ///< a point dragged
  twist,    ///< a turn about the normal of a point
  scale,    ///< larger or smaller about a point
  mask,     ///< what brushes and strokes leave alone
  unmask,   ///< which they do not any more
  stamp,    ///< a pattern pressed as a height
};

/// Grab, twist, scale and stamp act about one place; the others along a path.
[[nodiscard]] bool acts_about_one_place(BrushKind kind);

/// What the pressure of a pen scales.
enum class PressureUse {
  depth,  ///< the weight of a place: how far its points go
  size,   ///< the radius there
  both,
  none,
};

/// How a pen is held at a place of the path of a brush.
struct PenHold {
  double pressure = 1;         ///< p, 0 to 1
  Point axis = Point::Zero();  ///< of the pen, of any length; zero: along the normal of the surface

  friend bool operator==(const PenHold&, const PenHold&) = default;
  /// The one at a share of the way to another; exactly this one where both are the same.
  [[nodiscard]] PenHold towards(const PenHold& other, double share) const {
    return {pressure + share * (other.pressure - pressure), axis + share * (other.axis - axis)};
  }
};

/// A brush. Lengths in file units.
struct Brush {
  BrushKind kind = BrushKind::push;
  double radius = 1;     ///< R > 0
  double height = 0.25;  ///< h of push, pull, inflate, crease, ridge and stamp; of either sign
  double strength = 1;   ///< a, 0 to 1, of flatten, smooth, pinch, mask and unmask
  /// Share of the radius (of a stamp's half side) within which the falloff is 1; 0 to < 1.
  double core = 0;
  Point by = Point::Zero();  ///< grab: where the point goes, from where it is
  double angle = 0;          ///< twist, stamp: about the normal, counterclockwise, radians
  double factor = 1;         ///< scale: > 0
  /// Stamp: over the square about the place whose corners are on the radius.
  StampPattern pattern = {};
  /// What the pen's pressure scales at each place of a path.
  PressureUse pressure = PressureUse::depth;

  friend bool operator==(const Brush&, const Brush&) = default;
};

/// The falloff w(r): 1 up to the core c, 0 from the radius R, in between 1 − s³(10 − 15s + 6s²)
/// with s = (r/R − c)/(1 − c): twice continuously differentiable.
[[nodiscard]] double brush_falloff(double distance, double radius, double core);

/// The shape before a stroke at the Greville abscissae of its control points, row by row those of
/// all patches.
struct BrushSamples {
  Points points;          ///< x
  Points normals;         ///< n = S_u × S_v / |S_u × S_v|; zero where undefined
  Eigen::VectorXd areas;  ///< |S_u × S_v| times the cell of the abscissa

  /// `side`: 1 or −1, by which the normals are multiplied.
  /// Errors: those of evaluation. Cost: that of an evaluation of first order at all abscissae.
  [[nodiscard]] Expected<void> append(const Surface& shape, const SiteValues<2>& values,
                                      double side = 1);
};

/// A point of the surface on the path of a brush.
struct BrushPlace {
  Point at = Point::Zero(), normal = Point::Zero();
  Point along = Point::Zero(),
        across = Point::Zero();  ///< where a stamp's ξ and η grow; they span the tangent plane
  PenHold pen = {};
};

/// An isometry of space, x → Q x + o, which makes the copies of a stroke: mirror images and turns.
struct BrushImage {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();  ///< Q, orthogonal
  Point offset = Point::Zero();                          ///< o

  /// In the plane through `point` with this normal (of length 1).
  [[nodiscard]] static BrushImage mirror(const Point& point, const Point& normal);
  /// About the axis through `point` in this direction (of length 1).
  [[nodiscard]] static BrushImage turn(const Point& point, const Point& direction, double angle);
  /// This one after the other one.
  [[nodiscard]] BrushImage after(const BrushImage& other) const;
  [[nodiscard]] BrushPlace of(const BrushPlace& place) const;
  [[nodiscard]] Brush of(Brush brush) const;

  friend bool operator==(const BrushImage&, const BrushImage&) = default;
};

/// What a brush has asked of every sample so far, along one path.
///
/// The path is a polyline through its places in space, from which every sample has a distance. With
/// the weight ŵ(g), the largest falloff on the path, and a mean along it weighed by the falloff,
///
///   u(g) = a ŵ(g) · ∫ w(g, l) d(g, l) dl / ∫ w(g, l) dl
///
/// where d(g, l) is what the brush would do to the sample at full weight at the place l: so u
/// depends on the path and not on the number of places by which it was given, or on how often a
/// place was passed. Pinch takes d at the nearest place.
///
/// A pen's pressure p, linear between places, makes ŵ the largest p w on the path
/// (PressureUse::depth), or the radius of a place p R (size). Its axis leans the direction of push,
/// pull, crease, ridge and stamp, and the plane of flatten and pinch, from the normal by up to 60°;
/// the others have no direction of their own. Pressure that changes at one place counts as R/16 of
/// path for a change by 1. At p = 1 without an axis all bits are those without a pen. A value.
class BrushHistory {
 public:
  explicit BrushHistory(Eigen::Index samples);

  /// Goes on to a place. `fair` is the displacement to the fair shape, for `smooth` alone.
  /// Cost: O(samples); the mean along the path is a sum over the places, which should be R/8 apart
  /// or nearer.
  void go_to(const Brush& brush, const BrushSamples& samples, const BrushPlace& place,
             const Points& fair);

  /// u, one row per sample; exactly zero from the radius on.
  [[nodiscard]] Points displacement(const Brush& brush, const BrushSamples& samples) const;
  /// Whether a sample was within the radius, however lightly a pen was pressed.
  [[nodiscard]] bool reaches() const { return reaches_; }
  /// a ŵ.
  [[nodiscard]] Eigen::VectorXd weights(const Brush& brush) const {
    return brush.strength * weight_;
  }

 private:
  /// A place with the plane that the samples near it lie about.
  struct Pose {
    BrushPlace place;
    Point middle = Point::Zero(), normal = Point::Zero();
  };
  [[nodiscard]] static Pose pose_at(const Brush& brush, const BrushSamples& samples,
                                    const BrushPlace& place);
  [[nodiscard]] static Point asked_at(const Pose& pose, const Brush& brush,
                                      const BrushSamples& samples, Eigen::Index g,
                                      const Points& fair);
  void add(const Brush& brush, const BrushSamples& samples, const Pose& from, const Pose& to,
           double length, const Points& fair);
  [[nodiscard]] Point about_first(const Brush& brush, const Point& x) const;

  bool begun_ = false, reaches_ = false;
  Pose first_, last_;
  Eigen::VectorXd weight_, total_;  // ŵ and ∫ w dl
  Points sum_;                      // ∫ w d dl
};

/// One displacement of those of several copies of a stroke, Σ |u|² u / Σ |u|²: the one there is
/// where they do not overlap, and symmetric where they do.
[[nodiscard]] Points blended(std::span<const Points> copies);

}  // namespace knead
