#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "knead/brep/model.hpp"
#include "knead/brep/visible_region.hpp"

namespace knead {

/// An edge of faces that all lie on B-spline surfaces: its curve in space, and its course in the
/// parameters of every one of these surfaces.
///
/// The foot of a point of the curve is the nearest point of the surface, sought from the feet of
/// its neighbours: a file's own parameter curves (PCURVE) are not used. On closed surfaces feet may
/// lie a turn outside 0 … 1; the undetermined parameter at a pole is that of the neighbouring
/// point. Immutable; const access is thread-safe.
class SharedEdge {
 public:
  /// A point of the edge and its feet, one for each of `surfaces()`, in fractions of their domains.
  struct Sample {
    double parameter = 0;  ///< of the curve of the edge
    Point point = Point::Zero();
    std::vector<Eigen::Vector2d> feet;
    /// On each of `surfaces()` the direction from the foot, in fractions of the domain, that goes
    /// across the edge by a unit vector which all share: in the mean of their tangent planes,
    /// perpendicular to the curve. Empty beside a pole, where one has no tangent plane.
    std::vector<Eigen::Vector2d> across = {};
    double angle = 0;  ///< largest angle between the tangent planes of the first of `surfaces()`
                       ///< and another, 0 … π/2
  };

  /// Errors (input): no such edge; a face at it that lies on another surface than a B-spline, named
  /// with its surface; a curve that cannot be followed. Cost: a pass over the file, and some
  /// hundred searches for the nearest point.
  [[nodiscard]] static Expected<SharedEdge> create(const brep::Model& model, const std::string& id);

  [[nodiscard]] const std::string& id() const;
  /// The ids of the surfaces on which its faces lie, each once; a closed surface twice if the edge
  /// runs along the line where it meets itself: its lower end, at fraction 0, and its upper one.
  [[nodiscard]] const std::vector<std::string>& surfaces() const;
  /// The ids of the VERTEX_POINTs at the least and at the greatest parameter; the same twice for a
  /// closed edge.
  [[nodiscard]] const std::array<std::string, 2>& vertices() const;
  [[nodiscard]] std::array<Point, 2> vertex_points() const;
  /// The ids of the other edges that end in these vertices.
  [[nodiscard]] const std::array<std::vector<std::string>, 2>& edges_at_vertices() const;
  /// Points of the edge by ascending parameter, ends included, at least 65.
  [[nodiscard]] const std::vector<Sample>& samples() const;
  /// A point at any parameter between the ends. Cost: a few iterations per surface.
  [[nodiscard]] Sample at(double parameter) const;
  /// Inner parameters at which the curve may have a corner: knots of a multiplicity that is the
  /// degree or more.
  [[nodiscard]] const std::vector<double>& corners() const;
  /// Largest distance of the samples from any of the surfaces, file units.
  [[nodiscard]] double gap() const;
  /// Largest angle between tangent planes at the samples, radians; 0 with one of `surfaces()`.
  [[nodiscard]] double angle() const;
  /// As stated by the file, in its own unit; 0 if none.
  [[nodiscard]] double uncertainty() const;
  /// The parameter that the record of the curve has where this one is `parameter`: lines count
  /// multiples of their VECTOR here lengths.
  [[nodiscard]] double file_parameter(double parameter) const;
  /// The record's curve runs through the parameters backwards.
  [[nodiscard]] bool turned() const;

 private:
  struct Data;
  explicit SharedEdge(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

/// ∂S by the fractions of both directions at a foot. Errors: those of evaluation.
using Tangents = Eigen::Matrix<double, 3, 2>;
[[nodiscard]] Expected<Tangents> tangents_at_foot(const Surface& surface,
                                                  const Eigen::Vector2d& foot);

/// What a sample says of the tangent planes at its feet, one for each surface: its angle, and the
/// directions across a curve that runs along `along`. Nothing where one has no normal.
void look_across(std::span<const Surface> surfaces, const Point& along, SharedEdge::Sample& sample);

/// The unit normal S_u × S_v of a surface at a foot. Zero where it has none: beside a pole, where
/// one derivative by fractions of the domain is less than 1e-5 of the other, or both are parallel.
/// Errors: those of evaluation.
[[nodiscard]] Expected<Point> normal_at_foot(const Surface& surface, const Eigen::Vector2d& foot);

/// The angle between two planes with these normals, of which the sense does not count: 0 … π/2.
[[nodiscard]] double angle_between_planes(const Point& normal, const Point& other);

/// The parameters of a surface at a foot, which may lie a turn outside of its domain.
[[nodiscard]] std::array<double, 2> parameters_at_foot(const Surface& surface,
                                                       const Eigen::Vector2d& foot);

/// S_after − S_before at a foot. Errors: those of evaluation.
[[nodiscard]] Expected<Point> displacement_at(const Surface& before, const Surface& after,
                                              const Eigen::Vector2d& foot);

}  // namespace knead
