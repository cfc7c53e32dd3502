#pragma once

#include <array>
#include <optional>
#include <string>

#include "knead/brep/model.hpp"

namespace knead {

/// A point of a face that lies on no B-spline surface.
struct FacePoint {
  Point point = Point::Zero();
  Point normal = Point::Zero();  ///< of the face, unit; zero where there is none
  std::optional<std::array<double, 2>>
      curvature;  ///< the principal ones towards that normal, the larger first,
                  ///< 1/length; none where there is no normal
};

/// The point of the surface under a face that is nearest to a point, as of a picture of the face:
/// exact but for rounding, on planes, cylinders, cones, spheres, tori, surfaces of revolution and
/// of linear extrusion, and on faces without a surface, whose loop spans a plane; of swept curves
/// it is on the surface as exactly, and the nearest there to about 1e-11 of its size. Whether the
/// face reaches there is not asked. Errors (input): no such face; a surface of another form, a
/// B-spline among them; edges that cannot be read. Cost: a pass over the faces of the file.
[[nodiscard]] Expected<FacePoint> point_on_face(const brep::Model& model, const std::string& face,
                                                const Point& near);

}  // namespace knead
