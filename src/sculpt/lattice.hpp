#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "knead/spline/extremum.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// Free-form deformation: a box of space as a B-spline volume, V(u) = lower + u ∘ (upper − lower)
/// at rest, and the points embedded in it (thesis § 5.7). As an `ActiveSpline<3>` it deforms the
/// embedded geometry: x ↦ V(u(x)), u(x) = (x − lower) / (upper − lower).
class Lattice {
 public:
  /// \param box what it must contain, file units. It is widened by `margin` of its diagonal on
  /// every side, so that a flat box gains a thickness.
  /// \param degree, net per direction: knots are clamped and uniform on [0, 1], control points at
  /// Greville abscissae.
  /// Errors (input): a degree or net that makes no valid knots; a margin that is not positive; a
  /// box that is not finite.
  [[nodiscard]] static Expected<Lattice> create(const BoundingBox& box, double margin,
                                                const std::array<int, 3>& degree,
                                                const std::array<int, 3>& net);

  /// The same for a box that is not widened. Errors: `upper` is not above `lower` in every
  /// direction.
  [[nodiscard]] static Expected<Lattice> between(const Point& lower, const Point& upper,
                                                 const std::array<int, 3>& degree,
                                                 const std::array<int, 3>& net);

  /// The volume at rest.
  [[nodiscard]] const Volume& rest() const { return rest_; }

  /// The images of points (N × 3) when the volume's control points move to `control_points`: x +
  /// D(u(x)) with D the displacement of the volume, so that points stay exactly where the volume
  /// does not move. Errors (input): a point outside the box, named by its row.
  [[nodiscard]] Expected<Points> deformed(const Points& points, const Points& control_points) const;

  /// x ↦ D(u(x)), as of `deformed`; zero outside of the box.
  [[nodiscard]] Expected<std::function<Expected<Point>(const Point&)>> displacement(
      const Points& control_points) const;

  /// Control points after some have been moved, each once. Errors (input, at `which` or `by`): none
  /// are named; there is no such control point; a move that is not finite.
  [[nodiscard]] Expected<Points> moved(Points control_points, std::span<const int> which,
                                       const std::array<double, 3>& by) const;

  /// Control points on faces "u0", "u1", "v0", "v1", "w0", "w1" (u along x), `rows` deep; an error
  /// lists the names.
  [[nodiscard]] Expected<std::vector<bool>> faces(std::span<const std::string> names,
                                                  int rows) const;

 private:
  Lattice(Volume rest, Point lower, Point size)
      : rest_(std::move(rest)), lower_(lower), size_(size) {}

  Volume rest_;
  Point lower_, size_;
};

}  // namespace knead
