#include "oracle/occt_shells.hpp"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <GCE2d_MakeSegment.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <STEPControl_Writer.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <array>
#include <cmath>
#include <functional>
#include <gp_Ax3.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Trsf.hxx>
#include <numbers>

namespace knead::oracle {
namespace {

constexpr double side = 100;
using Height = std::function<double(double x, double y)>;
/// Where a fraction of the domain lies along a side, 0 … 1: the identity for an even
/// parametrisation.
using Speed = std::function<double(double)>;

/// A bicubic surface with `spans` even spans per direction over [x0, x1] × [y0, y1]; its control
/// points lie at their Greville abscissae, seen through `speed` in y.
opencascade::handle<Geom_BSplineSurface> sheet(double x0, double x1, double y0, double y1,
                                               int spans_x, int spans_y, const Height& height,
                                               const Speed& speed) {
  const auto knots = [](int spans) {
    std::vector<double> all(4, 0);
    for (int k = 1; k < spans; ++k) all.push_back(static_cast<double>(k) / spans);
    all.insert(all.end(), 4, 1);
    return all;
  };
  const auto u = knots(spans_x), v = knots(spans_y);
  const auto greville = [](const std::vector<double>& x, int i) {
    const auto k = static_cast<std::size_t>(i);
    return (x[k + 1] + x[k + 2] + x[k + 3]) / 3;
  };
  TColgp_Array2OfPnt poles(1, spans_x + 3, 1, spans_y + 3);
  for (int i = 0; i < spans_x + 3; ++i) {
    for (int j = 0; j < spans_y + 3; ++j) {
      const double x = x0 + (x1 - x0) * greville(u, i), y = y0 + (y1 - y0) * speed(greville(v, j));
      poles.SetValue(i + 1, j + 1, gp_Pnt(x, y, height(x, y)));
    }
  }
  const auto distinct = [](int spans) {
    TColStd_Array1OfReal all(1, spans + 1);
    for (int k = 0; k <= spans; ++k) all.SetValue(k + 1, static_cast<double>(k) / spans);
    return all;
  };
  const auto multiplicities = [](int spans) {
    TColStd_Array1OfInteger all(1, spans + 1);
    all.Init(1);
    all.SetValue(1, 4);
    all.SetValue(spans + 1, 4);
    return all;
  };
  return new Geom_BSplineSurface(poles, distinct(spans_x), distinct(spans_y),
                                 multiplicities(spans_x), multiplicities(spans_y), 3, 3);
}

double wavy(double x, double y) { return 4 * std::sin(x / 30) * std::cos(y / 40); }
double flat(double, double) { return 0; }
double even(double t) { return t; }
double uneven(double t) { return t + 0.25 * t * (1 - t); }

TopoDS_Face whole(const opencascade::handle<Geom_BSplineSurface>& surface) {
  return BRepBuilderAPI_MakeFace(surface, 1e-7);
}

/// The part of a surface inside a polygon, whose corners are given by their x and y.
TopoDS_Face part(const opencascade::handle<Geom_BSplineSurface>& surface,
                 const std::vector<gp_Pnt>& corners) {
  const gp_Pnt lower = surface->Pole(1, 1),
               upper = surface->Pole(surface->NbUPoles(), surface->NbVPoles());
  const auto at = [&](const gp_Pnt& p) {
    return gp_Pnt2d((p.X() - lower.X()) / (upper.X() - lower.X()),
                    (p.Y() - lower.Y()) / (upper.Y() - lower.Y()));
  };
  BRepBuilderAPI_MakeWire wire;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const opencascade::handle<Geom2d_TrimmedCurve> segment =
        GCE2d_MakeSegment(at(corners[k]), at(corners[(k + 1) % corners.size()])).Value();
    TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(segment, surface);
    BRepLib::BuildCurve3d(edge);
    wire.Add(edge);
  }
  BRepBuilderAPI_MakeFace face(surface, wire.Wire());
  TopoDS_Face made = face.Face();
  BRepLib::BuildCurves3d(made);
  return made;
}

/// A face on the plane of four corners.
TopoDS_Face flat_face(const std::array<gp_Pnt, 4>& corners) {
  BRepBuilderAPI_MakePolygon outline(corners[0], corners[1], corners[2], corners[3], true);
  return BRepBuilderAPI_MakeFace(outline.Wire(), true).Face();
}

TopoDS_Face strip() {
  return flat_face({gp_Pnt(0, 0, 0), gp_Pnt(50, 0, 0), gp_Pnt(50, side, 0), gp_Pnt(0, side, 0)});
}

/// Up to x = 50, where it runs along x.
TopoDS_Face part_of_a_cylinder() {
  const gp_Ax3 axes(gp_Pnt(50, 0, -40), gp_Dir(0, 1, 0), gp_Dir(0, 0, 1));
  return BRepBuilderAPI_MakeFace(gp_Cylinder(axes, 40), -1, 0, 0, side).Face();
}

double rising(double x, double y) {
  return (x - 50) / 5 + 4 * std::sin((x - 50) / 30) * std::cos(y / 40);
}

std::vector<TopoDS_Face> faces_of(const std::string& name) {
  if (name == "planes") {
    const double z = 50 * std::tan(30 * std::numbers::pi / 180);
    return {strip(), flat_face({gp_Pnt(50, 0, 0), gp_Pnt(side, 0, z), gp_Pnt(side, side, z),
                                gp_Pnt(50, side, 0)})};
  }
  if (name == "plane_and_wavy")
    return {strip(), whole(sheet(50, side, 0, side, 5, 8, rising, even))};
  if (name == "plane_and_flat")
    return {strip(), whole(sheet(50, side, 0, side, 6, 11, flat, uneven))};
  if (name == "cylinder_and_flat")
    return {part_of_a_cylinder(), whole(sheet(50, side, 0, side, 6, 11, flat, uneven))};
  if (name == "matching") {
    return {whole(sheet(0, 50, 0, side, 5, 8, wavy, even)),
            whole(sheet(50, side, 0, side, 5, 8, wavy, even))};
  }
  if (name == "other_parameters") {
    return {whole(sheet(0, 50, 0, side, 5, 8, flat, even)),
            whole(sheet(50, side, 0, side, 6, 11, flat, uneven))};
  }
  if (name == "inside") {
    const gp_Pnt a(40, 0, 0), b(60, side, 0);
    return {part(sheet(-20, 90, -10, 110, 8, 9, flat, even),
                 {gp_Pnt(0, 0, 0), a, b, gp_Pnt(0, side, 0)}),
            part(sheet(20, 130, -15, 120, 7, 10, flat, even),
                 {a, gp_Pnt(side, 0, 0), gp_Pnt(side, side, 0), b})};
  }
  if (name == "curved") {  // one wavy surface, on another net for the second face
    const gp_Pnt a(40, 0, 0), b(60, side, 0);
    const auto shape = sheet(-20, 120, -10, 110, 10, 9, wavy, even),
               finer = sheet(-20, 120, -10, 110, 10, 9, wavy, even);
    TColStd_Array1OfReal more(1, 4);
    for (int k = 1; k <= 4; ++k) more.SetValue(k, 0.23 * k);
    TColStd_Array1OfInteger once(1, 4);
    once.Init(1);
    finer->InsertUKnots(more, once);
    finer->InsertVKnots(more, once);
    return {part(shape, {gp_Pnt(0, 0, 0), a, b, gp_Pnt(0, side, 0)}),
            part(finer, {a, gp_Pnt(side, 0, 0), gp_Pnt(side, side, 0), b})};
  }
  if (name == "strips") {  // a chain of three
    return {whole(sheet(0, 35, 0, side, 5, 8, flat, even)),
            whole(sheet(35, 65, 0, side, 4, 10, flat, uneven)),
            whole(sheet(65, side, 0, side, 6, 7, flat, even))};
  }
  if (name == "smooth_corner") {
    return {whole(sheet(0, 50, 0, 50, 5, 5, flat, even)),
            whole(sheet(50, side, 0, 50, 6, 7, flat, uneven)),
            whole(sheet(0, 50, 50, side, 5, 6, flat, even)),
            whole(sheet(50, side, 50, side, 6, 8, flat, uneven))};
  }
  return {whole(sheet(0, 50, 0, 50, 5, 5, wavy, even)),
          whole(sheet(50, side, 0, 50, 5, 5, wavy, even)),
          whole(sheet(0, 50, 50, side, 5, 5, wavy, even)),
          whole(sheet(50, side, 50, side, 5, 5, wavy, even))};
}

TopoDS_Shape shell_of(const std::string& name) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  BRepBuilderAPI_Sewing sewing(1e-5);
  for (const TopoDS_Face& face : faces_of(name)) sewing.Add(face);
  sewing.Perform();
  const TopoDS_Shape shape = sewing.SewedShape();
  BRepLib::BuildCurves3d(shape);
  return shape;
}

}  // namespace

std::vector<std::string> occt_shell_names() {
  return {"matching", "other_parameters", "inside", "curved", "strips", "corner", "smooth_corner"};
}

std::vector<std::string> occt_mixed_shell_names() {
  return {"planes", "plane_and_wavy", "plane_and_flat", "cylinder_and_flat"};
}

bool occt_write_shell(const std::string& name, const std::filesystem::path& path) {
  const TopoDS_Shape shape = shell_of(name);
  if (path.extension() == ".brep") return BRepTools::Write(shape, path.c_str());
  STEPControl_Writer writer;
  Interface_Static::SetCVal("write.step.unit", "MM");
  return writer.Transfer(shape, STEPControl_AsIs) == IFSelect_RetDone &&
         writer.Write(path.c_str()) == IFSelect_RetDone;
}

std::vector<std::string> occt_brep_names() {
  return {"made_nested.brep", "made_triangulated.brep"};
}

bool occt_write_brep(const std::string& name, const std::filesystem::path& path) {
  if (name == "made_triangulated.brep") {
    const TopoDS_Shape shape = shell_of("other_parameters");
    BRepMesh_IncrementalMesh(shape, 1);
    return BRepTools::Write(shape, path.c_str());
  }
  gp_Trsf turn, shift;
  turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 2, 3)), 0.7);
  shift.SetTranslation(gp_Vec(300, 20, 10));
  const BRep_Builder builder;
  TopoDS_Compound inner, outer;
  builder.MakeCompound(inner);
  builder.MakeCompound(outer);
  builder.Add(inner, shell_of("matching").Moved(TopLoc_Location(turn)));
  builder.Add(outer, inner.Moved(TopLoc_Location(shift)));
  builder.Add(outer, shell_of("other_parameters"));
  return BRepTools::Write(outer, path.c_str());
}

}  // namespace knead::oracle
