#pragma once

#include <map>
#include <string>

#include "exchange/faces/face_plan.hpp"
#include "new_file.hpp"

namespace knead::step {

/// The curves, surfaces, edges and vertices of a model as records of a new file, each once.
class ModelGeometry {
 public:
  ModelGeometry(const detail::FacePlan& plan, NewFile& file)
      : plan_(plan), model_(*plan.model), file_(file) {}

  /// A B_SPLINE_SURFACE_WITH_KNOTS or the analytic or swept surface that it is.
  std::string surface(brep::Index support);
  /// A VERTEX_POINT.
  std::string vertex(brep::Index vertex);
  /// An EDGE_CURVE on a LINE, CIRCLE, ELLIPSE, HYPERBOLA, PARABOLA, POLYLINE or
  /// B_SPLINE_CURVE_WITH_KNOTS.
  std::string edge(brep::Index edge);
  /// A record of its control points.
  std::string spline(const Surface& surface, const std::string& name);
  std::string spline(const Curve& curve, const std::string& name);

 private:
  std::string direction(const Point& d);
  std::string placement(const brep::Frame& frame);
  std::string line(const brep::Line& line, bool turned);
  std::string conic(const brep::Conic& conic, bool turned);
  std::string form(const brep::CurveGeometry& curve, bool turned);
  std::string swept_curve(const brep::CurveGeometry& curve);
  std::string elementary(const brep::ElementarySurface& surface);
  std::string swept(const brep::SweptSurface& surface);

  const detail::FacePlan& plan_;
  const brep::Model& model_;
  NewFile& file_;
  std::map<brep::Index, std::string> surfaces_, vertices_, edges_;
  std::map<const brep::CurveGeometry*, std::string> curves_;
};

}  // namespace knead::step
