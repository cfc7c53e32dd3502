#pragma once

#include <BRep_Tool.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_Surface.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Pnt2d.hxx>
#include <gp_Vec.hxx>
#include <numbers>

#include "oracle/occt_gaps.hpp"

namespace knead::oracle {

using SurfaceHandle = opencascade::handle<Geom_Surface>;

inline SurfaceHandle surface_of(const TopoDS_Face& face) {
  SurfaceHandle surface = BRep_Tool::Surface(face);
  if (const auto trimmed = opencascade::handle<Geom_RectangularTrimmedSurface>::DownCast(surface)) {
    return trimmed->BasisSurface();
  }
  return surface;
}

/// Distance of a point from a surface: by Levenberg and Marquardt's iteration from (u, v), which
/// ends at the foot, or by Open CASCADE's own search where that ends farther than `wanted`.
double distance(const SurfaceHandle& surface, const gp_Pnt& p, gp_Pnt2d at, double wanted,
                gp_Pnt2d* foot = nullptr);

inline gp_Vec normal_at(const SurfaceHandle& surface, gp_Pnt2d at) {
  gp_Pnt p;
  gp_Vec du, dv;
  surface->D1(at.X(), at.Y(), p, du, dv);
  const gp_Vec n = du.Crossed(dv);
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  surface->Bounds(u0, u1, v0, v1);
  constexpr double unbounded = 1e3;  // planes, cylinders and cones are
  const double a = du.Magnitude() * std::min(u1 - u0, unbounded),
               b = dv.Magnitude() * std::min(v1 - v0, unbounded);
  // Beside a pole there is no normal to speak of.
  if (std::min(a, b) <= 1e-5 * std::max(a, b) || n.Magnitude() == 0) return {0, 0, 0};
  return n / n.Magnitude();
}

inline double degrees_between(const gp_Vec& a, const gp_Vec& b) {
  if (a.Magnitude() == 0 || b.Magnitude() == 0) return 0;
  return std::atan2(a.Crossed(b).Magnitude(), a.Dot(b)) * 180 / std::numbers::pi;
}

struct OcctFaces::Data {
  TopoDS_Shape shape;
  std::map<std::string, std::vector<TopoDS_Face>> on;
  TopTools_IndexedDataMapOfShapeListOfShape around;  // faces of every edge
};

}  // namespace knead::oracle
