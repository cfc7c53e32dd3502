#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "info_text.hpp"
#include "knead/base/printable.hpp"
#include "knead/brep/model.hpp"
#include "knead/spline/extremum.hpp"
#include "session/session_state.hpp"

namespace knead::python {
namespace {

void tell(FileSurface& info, const Surface& surface) {
  info.degree = {surface.knots(0).degree(), surface.knots(1).degree()};
  info.net = surface.net();
  info.rational = surface.rational();
  info.closed = brep::closed_directions(surface);
  const BoundingBox box = bounding_box(surface);
  for (std::size_t k = 0; k < 3; ++k) {
    info.bounding_box[0][k] = box.lower[static_cast<Eigen::Index>(k)];
    info.bounding_box[1][k] = box.upper[static_cast<Eigen::Index>(k)];
  }
}

/// Those of the session: as the file has them, or made and moved since.
std::vector<FileSurface> surfaces_of(const SessionState& state,
                                     const std::vector<FileSurface>& in_file) {
  std::vector<FileSurface> list;
  for (const SceneSurface& s : state.surfaces) {
    const auto found = std::ranges::find(in_file, s.id, &FileSurface::id);
    list.push_back(found != in_file.end() ? *found : FileSurface{.id = s.id, .name = s.name});
    if (found == in_file.end() || s.current != s.opened) tell(list.back(), *s.current);
  }
  return list;
}

void add(FileInfo& info, const ShapeCommon& common, const SceneCurve& body) {
  const Curve& curve = *body.current;
  info.curves.push_back(
      {common.id, common.name, curve.knots(0).degree(), curve.net()[0], curve.rational()});
}

void add(FileInfo& info, const ShapeCommon& common, const SceneVolume& body) {
  const Volume& v = *body.current;
  info.remarks.push_back(
      fmt::format("{:<8} {}volume of degree {} x {} x {}, net {} x {} x {}, {}", common.id,
                  common.name.empty() ? "" : "\"" + printable(common.name) + "\", ",
                  v.knots(0).degree(), v.knots(1).degree(), v.knots(2).degree(), v.net()[0],
                  v.net()[1], v.net()[2], v.rational() ? "rational" : "polynomial"));
}

}  // namespace

std::string text_of(const Session& session, const Source* source) {
  const SessionState& state = session.state();
  FileInfo info;
  if (source != nullptr) {
    info = file_info(*source);
  } else {
    info.file = session.document().name();
    info.format = "without a file";
    info.units = session.document().unit();
  }
  info.surfaces = surfaces_of(state, info.surfaces);
  std::erase_if(info.other_surfaces, [&](const FileOtherSurface& other) {
    return std::ranges::find(info.surfaces, other.id, &FileSurface::id) != info.surfaces.end();
  });
  for (const SceneBody& body : state.bodies) {
    std::visit([&](const auto& one) { add(info, common_of(body), one); }, body);
  }
  return cli::info_text(info);
}

}  // namespace knead::python
