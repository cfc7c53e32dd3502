#include "knead/exchange/face_point.hpp"

#include <algorithm>

#include "face_surface.hpp"
#include "step_data.hpp"
#include "step_faces.hpp"

namespace knead {

using namespace step;

Expected<FacePoint> point_on_face(const File& file, const std::string& face, const Point& near) {
  const Reader reader(file.data().records);
  const auto faces = read_faces(reader);
  const auto found = std::ranges::find_if(faces, [&](const Face& f) { return name_of(reader, f.instance) == face; });
  if (found == faces.end()) return input_error("there is no such face", face);
  EdgeSampler loops(reader, {under_chord});
  const auto surface = FaceSurface::under(reader, *found, loops, plane_angle_units(reader));
  if (!surface) return std::unexpected(surface.error());
  const Eigen::Vector2d at = surface->foot(near).parameters;
  const double sense = found->same_sense ? 1 : -1;
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
