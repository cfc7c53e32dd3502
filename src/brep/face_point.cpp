#include "face_point.hpp"

#include <algorithm>

#include "brep/surfaces/face_surface.hpp"

namespace knead {

using namespace brep;

Expected<FacePoint> point_on_face(const Model& model, const std::string& face, const Point& near) {
  const auto found = std::ranges::find(model.faces, face, &Face::id);
  if (found == model.faces.end()) return input_error("there is no such face", face);
  EdgeSampler edges(model, {under_chord});
  const auto surface = FaceSurface::under(model, *found, edges);
  if (!surface) return std::unexpected(surface.error());
  const Eigen::Vector2d at = surface->foot(near).parameters;
  const int sense = found->sense();
  FacePoint result;
  result.point = surface->at(at);
  const auto curvature = surface->curvature(at);
  if (!curvature) return result;
  result.normal = sense * surface->normal(at);
  result.curvature = {sense * curvature->principal[0], sense * curvature->principal[1]};
  if (sense < 0) std::swap((*result.curvature)[0], (*result.curvature)[1]);
  return result;
}

}  // namespace knead
