#include "oracle/occt_meetings.hpp"

#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomAPI_ProjectPointOnCurve.hxx>
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

  /// The foot of p, at this share of the edge, and the normal there.
  [[nodiscard]] std::pair<gp_Pnt, gp_Vec> foot(const gp_Pnt& p, double share) const {
    constexpr double any = std::numeric_limits<double>::infinity();
    gp_Pnt2d at = flat_.IsNull() ? ShapeAnalysis_Surface(surface_).ValueOfUV(p, 1e-9)
                                 : flat_->Value(from_ + (to_ - from_) * share);
    distance(surface_, p, at, any, &at);
    gp_Vec normal = normal_at(surface_, at);
    if (reversed_) normal.Reverse();
    return {surface_->Value(at.X(), at.Y()), normal};
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
    const auto [q, n] = a.foot(p, share);
    auto [r, m] = b.foot(p, share);
    if (a.runs() == b.runs()) m.Reverse();  // the shell is not consistent
    const bool known = n.Magnitude() > 0 && m.Magnitude() > 0;
    return OcctFigures{q.Distance(r), std::max(p.Distance(q), p.Distance(r)),
                       known ? degrees_between(n, m) : -1};
  };
  OcctMeeting made{point_of(place(0)), point_of(place(0.5)), point_of(place(1)), {}, {}};
  for (int k = 0; k <= samples; ++k) {
    const auto [gap, off, angle] = figures(static_cast<double>(k) / samples);
    made.largest = {std::max(made.largest.gap, gap), std::max(made.largest.off_curve, off),
                    std::max(made.largest.angle, angle)};
  }
  made.at = [=](const Point& p) {
    const GeomAPI_ProjectPointOnCurve foot(gp_Pnt(p.x(), p.y(), p.z()), curve, from, to);
    if (foot.NbPoints() == 0) return OcctFigures{};
    return figures((foot.LowerDistanceParameter() - from) / (to - from));
  };
  return made;
}

}  // namespace

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
