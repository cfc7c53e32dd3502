#pragma once

#include <map>
#include <utility>

#include "brep/edge_curve.hpp"
#include "exchange/faces/face_plan.hpp"
#include "sections.hpp"

namespace knead::iges {

/// The curves and surfaces of a model as entities of a new file.
class ModelGeometry {
 public:
  /// \param model that of the plan, but for surfaces that IGES cannot hold, which are B-splines
  ModelGeometry(const detail::FacePlan& plan, const brep::Model& model, Sections& to)
      : plan_(plan), model_(model), to_(to) {}

  /// A B-spline surface (128), or a plane, cylinder, cone, sphere or torus (190 to 198) with its
  /// directions. Errors (input): another form.
  Expected<int> surface(brep::Index support);
  /// A line (110), an arc (100) or a B-spline curve (126) over the range of an edge, along its
  /// curve.
  Expected<int> curve(brep::Index edge);

 private:
  int point(const Point& p);
  int direction(const Point& d);
  int matrix(const brep::Frame& frame);
  int elementary(const brep::ElementarySurface& surface);
  int arc(const brep::Conic& circle, const Interval& range);

  const detail::FacePlan& plan_;
  const brep::Model& model_;
  Sections& to_;
  std::map<brep::Index, int> surfaces_;
};

/// A closed clamped curve that starts at this parameter inside its domain, over a range that is a
/// period later where it was before it. The same points, but for rounding where the knot is
/// inserted.
[[nodiscard]] Expected<Curve> starting_at(const Curve& curve, double start);

/// The parameters of an entity 124.
[[nodiscard]] Values matrix_values(const Eigen::Affine3d& move);

}  // namespace knead::iges
