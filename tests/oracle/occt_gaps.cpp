#include "oracle/occt_gaps.hpp"

#include <BRepCheck_Analyzer.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>
#include <limits>

#include "oracle/occt_faces_data.hpp"

namespace knead::oracle {

double distance(const SurfaceHandle& surface, const gp_Pnt& p, gp_Pnt2d at, double wanted,
                gp_Pnt2d* foot) {
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  surface->Bounds(u0, u1, v0, v1);
  const auto clamped = [&](double& u, double& v) {
    if (!surface->IsUPeriodic()) u = std::clamp(u, u0, u1);
    if (!surface->IsVPeriodic()) v = std::clamp(v, v0, v1);
  };
  double u = at.X(), v = at.Y();
  clamped(u, v);
  gp_Pnt q;
  gp_Vec du, dv;
  surface->D1(u, v, q, du, dv);
  double best = p.Distance(q), damping = 1e-6;
  for (int k = 0; k < 60 && best > 1e-9 && damping < 1e8; ++k) {
    const gp_Vec off(q, p);
    const double a = du.Dot(du), b = du.Dot(dv), c = dv.Dot(dv), g = du.Dot(off), h = dv.Dot(off);
    const double aa = a * (1 + damping) + 1e-300, cc = c * (1 + damping) + 1e-300,
                 det = aa * cc - b * b;
    if (!(det > 0)) {
      damping = 10 * damping + 1e-12;
      continue;
    }
    double next_u = u + (cc * g - b * h) / det, next_v = v + (aa * h - b * g) / det;
    clamped(next_u, next_v);
    gp_Pnt next;
    gp_Vec next_du, next_dv;
    surface->D1(next_u, next_v, next, next_du, next_dv);
    const double d = p.Distance(next);
    if (d >= best) {
      damping *= 8;
      continue;
    }
    const bool done = best - d < 1e-14 * (1 + best);
    best = d;
    u = next_u;
    v = next_v;
    q = next;
    du = next_du;
    dv = next_dv;
    damping = std::max(0.2 * damping, 1e-12);
    if (done) break;
  }
  if (foot != nullptr) *foot = gp_Pnt2d(u, v);
  if (best <= wanted) return best;
  try {
    ShapeAnalysis_Surface analysis(surface);
    const gp_Pnt2d found = analysis.ValueOfUV(p, 1e-9);
    const double other = p.Distance(surface->Value(found.X(), found.Y()));
    if (foot != nullptr && other < best) *foot = found;
    best = std::min(best, other);
  } catch (Standard_Failure&) {
  }
  return best;
}

namespace {

template <class F>
void for_each_of(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind, const F& f) {
  TopTools_IndexedMapOfShape all;
  TopExp::MapShapes(shape, kind, all);
  for (int k = 1; k <= all.Extent(); ++k) f(all(k));
}

/// Another face meets `face` at `edge` with the same tangent planes.
bool is_smooth(const TopoDS_Edge& edge, const TopoDS_Face& face,
               const TopTools_ListOfShape& around) {
  double f = 0, l = 0;
  const auto pcurve = BRep_Tool::CurveOnSurface(edge, face, f, l);
  if (pcurve.IsNull()) return false;
  for (const TopoDS_Shape& shape : around) {
    const TopoDS_Face& other = TopoDS::Face(shape);
    if (other.IsSame(face)) continue;
    double f2 = 0, l2 = 0;
    const auto theirs = BRep_Tool::CurveOnSurface(edge, other, f2, l2);
    if (theirs.IsNull()) return false;
    double most = 0;
    for (int k = 1; k < 8; ++k) {
      const double t = f + (l - f) * k / 8;
      const double angle = degrees_between(
          normal_at(BRep_Tool::Surface(face), pcurve->Value(t)),
          normal_at(BRep_Tool::Surface(other), theirs->Value(f2 + (l2 - f2) * k / 8)));
      most = std::max(most, std::min(angle, 180 - angle));
    }
    return most <= 0.1;
  }
  return false;
}

}  // namespace

int OcctFaces::faces() const {
  int count = 0;
  for_each_of(data_->shape, TopAbs_FACE, [&](const TopoDS_Shape&) { ++count; });
  return count;
}

int OcctFaces::bad_faces() const {
  const BRepCheck_Analyzer check(data_->shape);
  int bad = 0;
  for_each_of(data_->shape, TopAbs_FACE,
              [&](const TopoDS_Shape& s) { bad += check.IsValid(s) ? 0 : 1; });
  return bad;
}

int OcctFaces::bad_edges() const {
  const BRepCheck_Analyzer check(data_->shape);
  int bad = 0;
  for_each_of(data_->shape, TopAbs_EDGE,
              [&](const TopoDS_Shape& s) { bad += check.IsValid(s) ? 0 : 1; });
  return bad;
}

std::map<std::string, int> OcctFaces::topology() const {
  constexpr std::pair<TopAbs_ShapeEnum, const char*> kinds[] = {
      {TopAbs_SOLID, "solids"}, {TopAbs_SHELL, "shells"}, {TopAbs_FACE, "faces"},
      {TopAbs_WIRE, "wires"},   {TopAbs_EDGE, "edges"},   {TopAbs_VERTEX, "vertices"}};
  std::map<std::string, int> result;
  for (const auto& [kind, name] : kinds) {
    for_each_of(data_->shape, kind, [&, key = name](const TopoDS_Shape&) { ++result[key]; });
  }
  return result;
}

std::vector<OcctEdge> OcctFaces::edges(const std::string& surface, const OcctFaces& after) const {
  constexpr int samples = 40;
  std::vector<OcctEdge> result;
  const auto from = data_->on.find(surface), to = after.data_->on.find(surface);
  if (from == data_->on.end() || to == after.data_->on.end() || to->second.empty()) return result;
  const SurfaceHandle moved = surface_of(to->second.front());
  for (const TopoDS_Face& face : from->second) {
    const SurfaceHandle handle = surface_of(face);
    for_each_of(face, TopAbs_EDGE, [&](const TopoDS_Shape& shape) {
      const TopoDS_Edge& edge = TopoDS::Edge(shape);
      if (BRep_Tool::Degenerated(edge)) return;
      double f = 0, l = 0, f2 = 0, l2 = 0;
      TopLoc_Location location;
      const auto curve = BRep_Tool::Curve(edge, location, f, l);
      if (curve.IsNull()) return;
      const auto flat = BRep_Tool::CurveOnSurface(edge, face, f2, l2);
      OcctEdge measured;
      measured.tolerance = BRep_Tool::Tolerance(edge);
      for (int k = 0; k <= samples; ++k) {
        const gp_Pnt p =
            curve->Value(f + (l - f) * k / samples).Transformed(location.Transformation());
        const gp_Pnt2d at = flat.IsNull() ? ShapeAnalysis_Surface(handle).ValueOfUV(p, 1e-7)
                                          : flat->Value(f2 + (l2 - f2) * k / samples);
        measured.gap = std::max(measured.gap, distance(moved, p, at, std::max(1e-6, measured.gap)));
        measured.turn =
            std::max(measured.turn, degrees_between(normal_at(handle, at), normal_at(moved, at)));
      }
      for (const auto& [vertex, t] :
           {std::pair(TopExp::FirstVertex(edge), f), std::pair(TopExp::LastVertex(edge), l)}) {
        if (vertex.IsNull()) continue;
        const gp_Pnt end = curve->Value(t).Transformed(location.Transformation());
        measured.ends = std::max(measured.ends, end.Distance(BRep_Tool::Pnt(vertex)));
      }
      if (const int k = data_->around.FindIndex(edge); k > 0) {
        measured.smooth = is_smooth(edge, face, data_->around.FindFromIndex(k));
      }
      result.push_back(measured);
    });
  }
  return result;
}

std::vector<OcctCrease> OcctFaces::creases(const std::string& surface,
                                           const std::string& other) const {
  constexpr int samples = 200;
  std::vector<OcctCrease> result;
  const auto faces = data_->on.find(surface), others = data_->on.find(other);
  if (faces == data_->on.end() || others == data_->on.end()) return result;
  for (const TopoDS_Face& face : faces->second) {
    for_each_of(face, TopAbs_EDGE, [&](const TopoDS_Shape& shape) {
      const TopoDS_Edge& edge = TopoDS::Edge(shape);
      double f = 0, l = 0, f2 = 0, l2 = 0, f3 = 0, l3 = 0;
      TopLoc_Location location;
      const auto curve = BRep_Tool::Curve(edge, location, f, l);
      const auto flat = BRep_Tool::CurveOnSurface(edge, face, f2, l2);
      if (BRep_Tool::Degenerated(edge) || curve.IsNull() || flat.IsNull()) return;
      for (const TopoDS_Face& next : others->second) {
        const bool itself = next.IsSame(face);
        if (itself && !BRep_Tool::IsClosed(edge, face)) continue;
        const TopoDS_Edge turned = TopoDS::Edge(edge.Reversed());
        const auto theirs = BRep_Tool::CurveOnSurface(itself ? turned : edge, next, f3, l3);
        if (theirs.IsNull()) continue;
        OcctCrease& made = result.emplace_back();
        for (int k = 0; k <= samples; ++k) {
          const double share = static_cast<double>(k) / samples;
          const gp_Pnt p = curve->Value(f + (l - f) * share).Transformed(location.Transformation());
          gp_Pnt2d a = flat->Value(f2 + (l2 - f2) * share),
                   b = theirs->Value(f3 + (l3 - f3) * share);
          constexpr double any = std::numeric_limits<double>::infinity();
          distance(surface_of(face), p, a, any, &a);
          distance(surface_of(next), p, b, any, &b);
          const double angle =
              degrees_between(normal_at(surface_of(face), a), normal_at(surface_of(next), b));
          made.points.emplace_back(p.X(), p.Y(), p.Z());
          made.angle = std::max(made.angle, std::min(angle, 180 - angle));
        }
      }
    });
  }
  return result;
}

OcctFaces::Moved OcctFaces::moved(const std::string& surface, const OcctFaces& after) const {
  constexpr int count = 41;
  Moved result;
  const auto from = data_->on.find(surface), to = after.data_->on.find(surface);
  if (from == data_->on.end() || to == after.data_->on.end() || to->second.empty()) return result;
  const SurfaceHandle moved = surface_of(to->second.front());
  for (const TopoDS_Face& face : from->second) {
    const SurfaceHandle handle = surface_of(face);
    BRepTopAdaptor_FClass2d side(face, 1e-7);
    double a = 0, b = 0, c = 0, d = 0, u0 = 0, u1 = 0, v0 = 0, v1 = 0;
    BRepTools::UVBounds(face, a, b, c, d);
    handle->Bounds(u0, u1, v0, v1);
    const auto look = [&](double u, double v) {
      const gp_Pnt2d at(u, v);
      const double way = handle->Value(u, v).Distance(moved->Value(u, v));
      double& most = side.Perform(at) == TopAbs_IN ? result.visible : result.hidden;
      most = std::max(most, way);
      // Where nothing moves but the rounding, a normal that turns is that of a degenerate point.
      if (way > 1e-9 && degrees_between(normal_at(handle, at), normal_at(moved, at)) > 90)
        result.folded = true;
    };
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        look(a + (b - a) * (i + 0.5) / count, c + (d - c) * (j + 0.5) / count);
        look(u0 + (u1 - u0) * (i + 0.5) / count, v0 + (v1 - v0) * (j + 0.5) / count);
      }
    }
  }
  return result;
}

OcctFaces::Apart OcctFaces::apart(const std::string& surface, const OcctFaces& after) const {
  constexpr int count = 21;
  Apart result;
  const auto from = data_->on.find(surface), to = after.data_->on.find(surface);
  if (from == data_->on.end() || to == after.data_->on.end() ||
      from->second.size() != to->second.size())
    return result;
  for (std::size_t n = 0; n < from->second.size(); ++n) {
    const TopoDS_Face &face = from->second[n], &other = to->second[n];
    const SurfaceHandle handle = surface_of(face), theirs = surface_of(other);
    const bool turned =
        (face.Orientation() == TopAbs_REVERSED) != (other.Orientation() == TopAbs_REVERSED);
    BRepTopAdaptor_FClass2d side(face, 1e-7);
    ShapeAnalysis_Surface search(theirs);
    double a = 0, b = 0, c = 0, d = 0;
    BRepTools::UVBounds(face, a, b, c, d);
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        const gp_Pnt2d at(a + (b - a) * (i + 0.5) / count, c + (d - c) * (j + 0.5) / count);
        if (side.Perform(at) != TopAbs_IN) continue;
        const gp_Pnt p = handle->Value(at.X(), at.Y());
        gp_Pnt2d foot;
        result.distance =
            std::max(result.distance, distance(theirs, p, search.ValueOfUV(p, 1e-9), 1e-9, &foot));
        const double angle = degrees_between(normal_at(handle, at), normal_at(theirs, foot));
        const bool known =
            normal_at(handle, at).Magnitude() > 0 && normal_at(theirs, foot).Magnitude() > 0;
        if (known) result.turn = std::max(result.turn, turned ? 180 - angle : angle);
        ++result.points;
      }
    }
  }
  return result;
}

}  // namespace knead::oracle
