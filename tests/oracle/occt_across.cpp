// Angles between faces that meet along an edge which they need not share: faces of IGES files have
// edges of their own.

#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <gp_Pnt.hxx>

#include "oracle/occt_faces_data.hpp"

namespace knead::oracle {
namespace {

constexpr int samples = 20;

/// An edge of a face: points of its curve in space, and its feet in the parameters of the face.
struct Course {
  std::vector<gp_Pnt> points;
  std::vector<gp_Pnt2d> feet;
  SurfaceHandle surface;
};

std::vector<Course> courses_of(const TopoDS_Face& face) {
  std::vector<Course> result;
  for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(at.Current());
    double f = 0, l = 0, f2 = 0, l2 = 0;
    TopLoc_Location location;
    const auto curve = BRep_Tool::Curve(edge, location, f, l);
    const auto flat = BRep_Tool::CurveOnSurface(edge, face, f2, l2);
    if (BRep_Tool::Degenerated(edge) || curve.IsNull() || flat.IsNull()) continue;
    Course& made = result.emplace_back();
    made.surface = surface_of(face);
    for (int k = 0; k <= samples; ++k) {
      const double share = static_cast<double>(k) / samples;
      made.points.push_back(
          curve->Value(f + (l - f) * share).Transformed(location.Transformation()));
      made.feet.push_back(flat->Value(f2 + (l2 - f2) * share));
    }
  }
  return result;
}

/// The same course, backwards or not; 0: another one.
int direction(const Course& a, const Course& b) {
  const double close = 1e-3 * std::max(a.points.front().Distance(a.points[samples / 2]), 1e-2);
  const auto runs = [&](bool back) {
    for (const int k : {0, samples / 4, samples / 2, samples}) {
      if (a.points[static_cast<std::size_t>(k)].Distance(
              b.points[static_cast<std::size_t>(back ? samples - k : k)]) > close)
        return false;
    }
    return true;
  };
  return runs(false) ? 1 : runs(true) ? -1 : 0;
}

/// The largest angle between both sides, the first lying on `own` and the second on its own
/// surface.
double angle_of(const Course& a, const Course& b, int way, const SurfaceHandle& surface) {
  double most = 0;
  for (int k = 0; k <= samples; ++k) {
    const auto i = static_cast<std::size_t>(k),
               j = static_cast<std::size_t>(way > 0 ? k : samples - k);
    const double angle =
        degrees_between(normal_at(surface, a.feet[i]), normal_at(b.surface, b.feet[j]));
    most = std::max(most, std::min(angle, 180 - angle));
  }
  return most;
}

}  // namespace

std::vector<OcctFaces::Across> OcctFaces::across(const std::string& surface,
                                                 const OcctFaces& after) const {
  constexpr double smooth = 0.1;  // degrees
  std::vector<Across> result;
  const auto from = data_->on.find(surface), to = after.data_->on.find(surface);
  if (from == data_->on.end() || to == after.data_->on.end() || to->second.empty()) return result;
  const SurfaceHandle moved = surface_of(to->second.front());
  std::vector<Course> ours, others;
  for (const auto& [id, faces] : data_->on) {
    for (const TopoDS_Face& face : faces) {
      auto courses = courses_of(face);
      auto& list = id == surface ? ours : others;
      list.insert(list.end(), courses.begin(), courses.end());
    }
  }
  for (const Course& edge : ours) {
    for (const Course& other : others) {
      const int way = direction(edge, other);
      if (way == 0) continue;
      const double before = angle_of(edge, other, way, edge.surface);
      if (before <= smooth) result.push_back({before, angle_of(edge, other, way, moved)});
      break;
    }
  }
  return result;
}

}  // namespace knead::oracle
