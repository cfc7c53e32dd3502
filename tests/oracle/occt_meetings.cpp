#include "oracle/occt_meetings.hpp"

#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomAPI_ProjectPointOnCurve.hxx>
#include <GeomLProp_SLProps.hxx>
#include <Geom_Curve.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <limits>
#include <optional>

#include "oracle/occt_faces_data.hpp"

namespace knead::oracle {
namespace {

constexpr int samples = 200;
constexpr double tangent = 1;  // degrees: faces that meet at less have curvatures across the edge

Point point_of(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

/// A face at an edge of its own.
class Side {
 public:
  Side(const TopoDS_Edge& edge, const TopoDS_Face& face)
      : surface_(surface_of(face)), reversed_(face.Orientation() == TopAbs_REVERSED) {
    flat_ = BRep_Tool::CurveOnSurface(edge, face, from_, to_);
    for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
      if (at.Current().IsSame(edge)) runs_ = at.Current().Orientation();
    }
  }
  [[nodiscard]] TopAbs_Orientation runs() const { return runs_; }

  struct Foot {
    gp_Pnt place;
    gp_Vec normal;  ///< of the face
    gp_Pnt2d at;
  };
  /// The foot of p, at this share of the edge.
  [[nodiscard]] Foot foot(const gp_Pnt& p, double share) const {
    constexpr double any = std::numeric_limits<double>::infinity();
    gp_Pnt2d at = flat_.IsNull() ? ShapeAnalysis_Surface(surface_).ValueOfUV(p, 1e-9)
                                 : flat_->Value(from_ + (to_ - from_) * share);
    distance(surface_, p, at, any, &at);
    gp_Vec normal = normal_at(surface_, at);
    if (reversed_) normal.Reverse();
    return {surface_->Value(at.X(), at.Y()), normal, at};
  }
  /// The normal curvature in a direction, by Euler's formula, for the normal of the face.
  [[nodiscard]] double curvature(const Foot& foot, const gp_Vec& direction) const {
    GeomLProp_SLProps properties(surface_, foot.at.X(), foot.at.Y(), 2, 1e-9);
    if (!properties.IsCurvatureDefined()) return std::numeric_limits<double>::quiet_NaN();
    gp_Dir greatest, least;
    properties.CurvatureDirections(greatest, least);
    const double a = direction.Dot(gp_Vec(greatest)), b = direction.Dot(gp_Vec(least));
    const double bent =
        (properties.MaxCurvature() * a * a + properties.MinCurvature() * b * b) / (a * a + b * b);
    return gp_Vec(properties.Normal()).Dot(foot.normal) > 0 ? bent : -bent;
  }

 private:
  SurfaceHandle surface_;
  bool reversed_;
  opencascade::handle<Geom2d_Curve> flat_;
  double from_ = 0, to_ = 0;
  TopAbs_Orientation runs_ = TopAbs_FORWARD;
};

std::optional<OcctMeeting> meeting_at(const TopoDS_Edge& edge, const TopoDS_Face& first,
                                      const TopoDS_Face& second) {
  double from = 0, to = 0;
  const auto curve = BRep_Tool::Curve(edge, from, to);  // where the edge is
  if (BRep_Tool::Degenerated(edge) || curve.IsNull()) return std::nullopt;
  const auto place = [=](double share) { return curve->Value(from + (to - from) * share); };
  const Side a(edge, first), b(edge, second);
  const auto figures = [=](double share) {
    const gp_Pnt p = place(share);
    const Side::Foot first_foot = a.foot(p, share);
    Side::Foot other = b.foot(p, share);
    if (a.runs() == b.runs()) other.normal.Reverse();  // the shell is not consistent
    const gp_Vec &n = first_foot.normal, &m = other.normal;
    const bool known = n.Magnitude() > 0 && m.Magnitude() > 0;
    OcctFigures made{first_foot.place.Distance(other.place),
                     std::max(p.Distance(first_foot.place), p.Distance(other.place)),
                     known ? degrees_between(n, m) : -1};
    gp_Vec along;
    gp_Pnt there;
    curve->D1(from + (to - from) * share, there, along);
    const gp_Vec across = along.Crossed(n + m);  // of length 1 where they are known
    if (known && made.angle < tangent && across.Magnitude() > 0)
      made.curvatures = {a.curvature(first_foot, across.Normalized()),
                         b.curvature(other, across.Normalized())};
    return made;
  };
  OcctMeeting made{point_of(place(0)), point_of(place(0.5)), point_of(place(1)), {}, {}};
  for (int k = 0; k <= samples; ++k) {
    const OcctFigures here = figures(static_cast<double>(k) / samples);
    made.largest.gap = std::max(made.largest.gap, here.gap);
    made.largest.off_curve = std::max(made.largest.off_curve, here.off_curve);
    made.largest.angle = std::max(made.largest.angle, here.angle);
  }
  made.at = [=](const Point& p) {
    const GeomAPI_ProjectPointOnCurve foot(gp_Pnt(p.x(), p.y(), p.z()), curve, from, to);
    if (foot.NbPoints() == 0) return OcctFigures{};
    return figures((foot.LowerDistanceParameter() - from) / (to - from));
  };
  return made;
}

}  // namespace

std::optional<double> OcctFaces::gap_at(const Point& p, const std::string& surface,
                                        const std::string& other) const {
  const gp_Pnt place(p.x(), p.y(), p.z());
  std::vector<gp_Pnt> feet;
  for (const std::string& id : {surface, other}) {
    const auto on = data_->on.find(id);
    if (on == data_->on.end() || on->second.empty()) return std::nullopt;
    const SurfaceHandle under = surface_of(on->second.front());
    gp_Pnt2d at = ShapeAnalysis_Surface(under).ValueOfUV(place, 1e-9);
    distance(under, place, at, std::numeric_limits<double>::infinity(), &at);
    feet.push_back(under->Value(at.X(), at.Y()));
  }
  return feet[0].Distance(feet[1]);
}

std::vector<OcctMeeting> OcctFaces::meetings() const {
  TopTools_IndexedDataMapOfShapeListOfShape around;
  TopTools_IndexedMapOfShape known;
  for (const auto& [surface, faces] : data_->on) {
    for (const TopoDS_Face& face : faces) {
      if (known.Contains(face)) continue;
      known.Add(face);
      TopExp::MapShapesAndAncestors(face, TopAbs_EDGE, TopAbs_FACE, around);
    }
  }
  std::vector<OcctMeeting> result;
  for (int k = 1; k <= around.Extent(); ++k) {
    const auto& faces = around(k);
    if (faces.Extent() != 2 || faces.First().IsSame(faces.Last())) continue;
    const auto made = meeting_at(TopoDS::Edge(around.FindKey(k)), TopoDS::Face(faces.First()),
                                 TopoDS::Face(faces.Last()));
    if (made) result.push_back(*made);
  }
  return result;
}

}  // namespace knead::oracle
