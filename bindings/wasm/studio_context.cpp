#include "studio_context.hpp"

#include <limits>

namespace knead::studio {

Point middle_of(const brep::Model& model) {
  constexpr double rough = 0.1;
  const double none = std::numeric_limits<double>::infinity();
  Point lower = Point::Constant(none), upper = -lower;
  if (const auto context = context_faces(model, rough)) {
    for (const FaceMesh& mesh : context->faces) {
      for (const Point& p : mesh.points) {
        lower = lower.cwiseMin(p);
        upper = upper.cwiseMax(p);
      }
    }
  }
  return lower.x() <= upper.x() ? Point((lower + upper) / 2) : Point::Zero();
}

Point middle_of(const Document& document) {
  Point lower = Point::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  for (const DocumentSurface& s : document.surfaces()) {
    lower = lower.cwiseMin(s.surface->control_points().colwise().minCoeff().transpose());
    upper = upper.cwiseMax(s.surface->control_points().colwise().maxCoeff().transpose());
  }
  if (!document.surfaces().empty()) return (lower + upper) / 2;
  return document.model() != nullptr ? middle_of(*document.model()) : Point::Zero();
}

Point origin_near(const SessionState& now, const Point& otherwise) {
  constexpr double far = 100;
  if (now.surfaces.empty() && now.bodies.empty()) return otherwise;
  const Points& points = now.surfaces.empty() ? control_points_of(now.bodies.front())
                                              : now.surfaces.front().current->control_points();
  const Point lower = points.colwise().minCoeff().transpose(),
              upper = points.colwise().maxCoeff().transpose();
  const Point centre = (lower + upper) / 2;
  return centre.norm() > far * (upper - lower).norm() ? centre : Point(Point::Zero());
}

}  // namespace knead::studio
