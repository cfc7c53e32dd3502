#include "oracle/occt_places.hpp"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeWedge.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_Plane.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <array>
#include <gp_Pln.hxx>
#include <utility>

namespace knead::oracle {
namespace {

// Three rigid motions of which no two commute.
TopLoc_Location turn() {
  gp_Trsf t;
  t.SetRotation(gp_Ax1(gp_Pnt(1, 0, 0), gp_Dir(0, 1, 2)), 0.7);
  return t;
}
TopLoc_Location tilt() {
  gp_Trsf t;
  t.SetRotation(gp_Ax1(gp_Pnt(0, 3, 1), gp_Dir(3, 1, 0)), 1.3);
  return t;
}
TopLoc_Location shift() {
  gp_Trsf t;
  t.SetTranslation(gp_Vec(20, -7, 11));
  return t;
}

TopoDS_Shape wedge() { return BRepPrimAPI_MakeWedge(3, 4, 5, 1.0).Shape(); }

TopoDS_Compound together(const std::vector<TopoDS_Shape>& parts) {
  TopoDS_Compound result;
  const BRep_Builder builder;
  builder.MakeCompound(result);
  for (const TopoDS_Shape& part : parts) builder.Add(result, part);
  return result;
}

/// The faces of a wedge, in one shell; each stands elsewhere in its own coordinates.
TopoDS_Shape shell_of_placed_faces() {
  TopoDS_Shell shell;
  const BRep_Builder builder;
  builder.MakeShell(shell);
  TopLoc_Location place = tilt();
  for (TopExp_Explorer at(wedge(), TopAbs_FACE); at.More(); at.Next()) {
    place = turn() * place * shift().Inverted();
    builder.Add(shell, at.Current().Moved(place));
  }
  return shell.Moved(shift() * turn().Powered(-2));
}

/// A triangle whose vertices, edges, wire, surface and face have locations of their own.
TopoDS_Shape placed_to_the_vertex() {
  const std::array<gp_Pnt, 3> corners = {gp_Pnt(0, 0, 0), gp_Pnt(4, 0, 0), gp_Pnt(1, 3, 0)};
  const auto there = [](const gp_Pnt& p, const TopLoc_Location& place) {
    return p.Transformed(place.Transformation());
  };
  std::array<TopoDS_Shape, 3> vertices;
  const TopLoc_Location of_vertices = tilt() * turn().Powered(2);
  for (std::size_t k = 0; k < 3; ++k) {
    vertices[k] = BRepBuilderAPI_MakeVertex(there(corners[k], of_vertices.Inverted()))
                      .Vertex()
                      .Moved(of_vertices);
  }
  BRepBuilderAPI_MakeWire wire;
  const TopLoc_Location of_wire = tilt() * shift().Powered(-2);
  TopLoc_Location place = shift();
  for (std::size_t k = 0; k < 3; ++k) {
    place = turn() * place * tilt().Powered(-3);
    const TopLoc_Location back = (of_wire * place).Inverted();
    const auto end = [&](std::size_t v) { return TopoDS::Vertex(vertices[v % 3].Moved(back)); };
    wire.Add(TopoDS::Edge(BRepBuilderAPI_MakeEdge(end(k), end(k + 1)).Edge().Moved(place)));
  }
  const TopLoc_Location of_surface = turn() * tilt();
  const gp_Pln plane = gp_Pln(gp_Ax3()).Transformed(of_surface.Inverted().Transformation());
  TopoDS_Face face;
  const BRep_Builder builder;
  builder.MakeFace(face, new Geom_Plane(plane), of_surface, 1e-7);
  builder.Add(face, wire.Wire().Moved(of_wire));
  return face.Moved(shift().Powered(2) * tilt());
}

TopoDS_Shape spline_face() {
  TColgp_Array2OfPnt poles(1, 3, 1, 3);
  for (int i = 1; i <= 3; ++i) {
    for (int j = 1; j <= 3; ++j) poles.SetValue(i, j, gp_Pnt(i, 2 * j + 0.1 * i, i == 2 ? 0.5 : 0));
  }
  return BRepBuilderAPI_MakeFace(opencascade::handle<Geom_Surface>(new Geom_BezierSurface(poles)),
                                 1e-7)
      .Shape();
}

using PlacedMaker = TopoDS_Shape (*)();
constexpr std::pair<const char*, PlacedMaker> placed_makers[] = {
    {"product", [] { return wedge().Moved(shift() * tilt() * turn()); }},
    {"powers",
     [] {
       return wedge().Moved(turn().Powered(3) * tilt().Powered(-2) * turn().Inverted() * shift());
     }},
    {"nested",
     [] {
       const auto inner = together({wedge().Moved(turn() * tilt()), wedge().Moved(shift())});
       return together({inner.Moved(tilt() * turn().Powered(-1))})
           .Moved(turn() * shift().Powered(2) * tilt());
     }},
    {"again",
     [] {
       const auto one = wedge(), pair = TopoDS_Shape(together({one, spline_face().Moved(tilt())}));
       return TopoDS_Shape(together(
           {pair.Moved(turn()), one.Moved(shift()), pair.Moved(shift() * tilt()), one.Reversed()}));
     }},
    {"hollow",
     [] {
       const auto box = BRepPrimAPI_MakeBox(12, 12, 12).Shape();
       gp_Trsf inside;
       inside.SetTranslation(gp_Vec(4, 4, 4));
       return BRepAlgoAPI_Cut(box, wedge().Moved(inside)).Shape().Moved(turn() * shift());
     }},
    {"faces", shell_of_placed_faces},
    {"vertices", placed_to_the_vertex},
    {"spline",
     [] {
       return together({spline_face().Moved(turn() * tilt())}).Moved(tilt().Powered(2) * shift());
     }},
};

}  // namespace

std::vector<std::string> occt_placed_names() {
  std::vector<std::string> names;
  for (const auto& [name, maker] : placed_makers) names.emplace_back(name);
  return names;
}

bool occt_write_placed(const std::string& name, const std::filesystem::path& path) {
  for (const auto& [other, maker] : placed_makers) {
    if (other == name) return BRepTools::Write(maker(), path.c_str());
  }
  return false;
}

std::optional<OcctPlaces> occt_places(const std::filesystem::path& path) {
  TopoDS_Shape shape;
  if (!BRepTools::Read(shape, path.c_str(), BRep_Builder())) return std::nullopt;
  const auto point = [](const gp_Pnt& p) { return Point(p.X(), p.Y(), p.Z()); };
  OcctPlaces result;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(at.Current(), properties);
    result.areas.push_back(std::abs(properties.Mass()));
    result.centres.push_back(point(properties.CentreOfMass()));
  }
  for (TopExp_Explorer at(shape, TopAbs_VERTEX); at.More(); at.Next()) {
    result.vertices.push_back(point(BRep_Tool::Pnt(TopoDS::Vertex(at.Current()))));
  }
  return result;
}

}  // namespace knead::oracle
