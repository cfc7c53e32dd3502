// Writes the sample CAD files: make_samples DIRECTORY
//
// bonnet.step: an assembly of a car bonnet, an open shell whose skin is one trimmed bicubic
// B-spline surface between four flanges, and of a headlamp ring, one rational surface. Through Open
// CASCADE, so that the file is as CAD systems write it and nobody wrote numbers by hand. The same
// version of Open CASCADE gives the same bytes.

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepLib.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRep_Builder.hxx>
#include <Geom2d_BezierCurve.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <StepBasic_Product.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_BSplineSurface.hxx>
#include <StepGeom_BSplineSurfaceWithKnotsAndRationalBSplineSurface.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepShape_AdvancedFace.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

namespace {

constexpr double length = 1400;      // mm, along x, from the nose to the windscreen
constexpr double width = 1100;       // mm, along y, symmetric
constexpr double flange_depth = 30;  // mm

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "make_samples: %s\n", what.c_str());
  std::exit(1);
}

// Height of the skin: crowned both ways, falling off at the nose, with two swage lines that fade
// towards it.
double height(double x, double y) {
  const double s = x / length;
  const double t = 2 * y / width;
  const double crown = 70 * (1 - t * t) * (0.6 + 0.4 * s);
  const double rise = 190 * s - 75 * s * s - 90 * std::exp(-6 * s);
  const double ridge = (std::abs(t) - 0.45) / 0.16;
  return crown + rise + 14 * s * std::exp(-ridge * ridge);
}

// Clamped knots over [0, n] without a pattern of equal spans: `inner` are the interior ones.
struct Direction {
  std::vector<double> inner;
  [[nodiscard]] int count() const { return static_cast<int>(inner.size()) + 4; }
  [[nodiscard]] std::vector<double> knots() const {
    std::vector<double> all(4, 0.0);
    all.insert(all.end(), inner.begin(), inner.end());
    all.insert(all.end(), 4, 1.0);
    return all;
  }
  [[nodiscard]] double greville(int i) const {
    const auto k = knots();
    const auto at = static_cast<std::size_t>(i);
    return (k[at + 1] + k[at + 2] + k[at + 3]) / 3;
  }
};

opencascade::handle<Geom_BSplineSurface> skin_surface() {
  const Direction u{
      {0.06, 0.14, 0.24, 0.35, 0.45, 0.55, 0.65, 0.75, 0.84, 0.93}};    // 14 control points
  const Direction v{{0.10, 0.22, 0.34, 0.46, 0.54, 0.66, 0.78, 0.90}};  // 12
  TColgp_Array2OfPnt poles(1, u.count(), 1, v.count());
  for (int i = 0; i < u.count(); ++i) {
    for (int j = 0; j < v.count(); ++j) {
      const double y = width * (v.greville(j) - 0.5);
      // The nose is bowed in plan.
      const double x =
          length * u.greville(i) + (1 - u.greville(i)) * 160 * std::pow(2 * y / width, 2);
      poles.SetValue(i + 1, j + 1, gp_Pnt(x, y, height(length * u.greville(i), y)));
    }
  }
  const auto fill = [](const Direction& direction, TColStd_Array1OfReal& knots,
                       TColStd_Array1OfInteger& multiplicities) {
    knots.SetValue(1, 0.0);
    multiplicities.Init(1);
    for (std::size_t k = 0; k < direction.inner.size(); ++k)
      knots.SetValue(static_cast<int>(k) + 2, direction.inner[k]);
    knots.SetValue(knots.Upper(), 1.0);
    multiplicities.SetValue(1, 4);
    multiplicities.SetValue(multiplicities.Upper(), 4);
  };
  TColStd_Array1OfReal u_knots(1, u.count() - 2);
  TColStd_Array1OfReal v_knots(1, v.count() - 2);
  TColStd_Array1OfInteger u_multiplicities(1, u.count() - 2);
  TColStd_Array1OfInteger v_multiplicities(1, v.count() - 2);
  fill(u, u_knots, u_multiplicities);
  fill(v, v_knots, v_multiplicities);
  return new Geom_BSplineSurface(poles, u_knots, v_knots, u_multiplicities, v_multiplicities, 3, 3);
}

// The skin, cut along four bowed lines of its parameter plane, and a flange hanging from each.
TopoDS_Shape bonnet() {
  const auto surface = skin_surface();
  const std::array<gp_Pnt2d, 4> corners = {gp_Pnt2d(0.10, 0.09), gp_Pnt2d(0.93, 0.05),
                                           gp_Pnt2d(0.93, 0.95), gp_Pnt2d(0.10, 0.91)};
  const std::array<gp_Pnt2d, 4> middles = {gp_Pnt2d(0.50, 0.04), gp_Pnt2d(0.98, 0.50),
                                           gp_Pnt2d(0.50, 0.96), gp_Pnt2d(0.01, 0.50)};
  BRepBuilderAPI_MakeWire outline;
  for (std::size_t k = 0; k < 4; ++k) {
    TColgp_Array1OfPnt2d poles(1, 3);
    poles.SetValue(1, corners[k]);
    poles.SetValue(2, middles[k]);
    poles.SetValue(3, corners[(k + 1) % 4]);
    const opencascade::handle<Geom2d_BezierCurve> line = new Geom2d_BezierCurve(poles);
    outline.Add(BRepBuilderAPI_MakeEdge(line, surface).Edge());
  }
  if (!outline.IsDone()) fail("the outline of the bonnet does not close");
  const TopoDS_Face skin = BRepBuilderAPI_MakeFace(surface, outline.Wire(), true).Face();
  BRepLib::BuildCurves3d(skin, 1e-4);
  BRepBuilderAPI_Sewing sewing(1e-3);
  sewing.Add(skin);
  for (TopExp_Explorer edge(skin, TopAbs_EDGE); edge.More(); edge.Next()) {
    sewing.Add(BRepPrimAPI_MakePrism(edge.Current(), gp_Vec(0, 0, -flange_depth)).Shape());
  }
  sewing.Perform();
  return sewing.SewedShape();
}

// A quarter of the tube of a headlamp ring, as NURBS: biquadratic, rational, and bounded by nothing
// but its own sides.
TopoDS_Shape ring() {
  using std::numbers::pi;
  const opencascade::handle<Geom_ToroidalSurface> torus =
      new Geom_ToroidalSurface(gp_Ax3(), 110, 28);
  const opencascade::handle<Geom_RectangularTrimmedSurface> part =
      new Geom_RectangularTrimmedSurface(torus, 0.2, pi - 0.2, -0.4 * pi, 0.6 * pi);
  const auto surface = GeomConvert::SurfaceToBSplineSurface(part);
  BRepBuilderAPI_Sewing sewing(1e-6);
  sewing.Add(BRepBuilderAPI_MakeFace(surface, 1e-6).Face());
  sewing.Perform();
  const TopoDS_Shape sewn = sewing.SewedShape();
  if (sewn.ShapeType() == TopAbs_SHELL) return sewn;
  TopoDS_Shell shell;
  BRep_Builder builder;
  builder.MakeShell(shell);
  builder.Add(shell, sewn);
  return shell;
}

void check(const TopoDS_Shape& shape, const char* name, int faces) {
  if (!BRepCheck_Analyzer(shape).IsValid()) fail(std::string(name) + " is not a valid shape");
  if (shape.ShapeType() != TopAbs_SHELL) fail(std::string(name) + " is not one shell");
  int count = 0;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) ++count;
  if (count != faces) fail(std::string(name) + " has " + std::to_string(count) + " faces");
}

opencascade::handle<TCollection_HAsciiString> text(const char* value) {
  return new TCollection_HAsciiString(value);
}

// Labels that Open CASCADE does not write of itself.
void name_items(const opencascade::handle<Interface_InterfaceModel>& model) {
  for (int k = 1; k <= model->NbEntities(); ++k) {
    const auto entity = model->Value(k);
    if (const auto item = opencascade::handle<StepGeom_BSplineSurface>::DownCast(entity)) {
      const bool rational =
          entity->IsKind(STANDARD_TYPE(
              StepGeom_BSplineSurfaceWithKnotsAndRationalBSplineSurface)) == Standard_True;
      item->SetName(text(rational ? "headlamp ring" : "bonnet skin"));
    } else if (const auto face = opencascade::handle<StepShape_AdvancedFace>::DownCast(entity)) {
      const bool spline =
          face->FaceGeometry()->IsKind(STANDARD_TYPE(StepGeom_BSplineSurface)) == Standard_True;
      face->SetName(text(spline ? "outer face" : "flange"));
    }
  }
}

void write(const TopoDS_Shape& bonnet_shape, const TopoDS_Shape& ring_shape,
           const std::string& path) {
  opencascade::handle<TDocStd_Document> document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  const auto shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const auto colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
  const auto part = [&](const TopoDS_Shape& shape, const char* name) {
    const TDF_Label label = shapes->AddShape(shape, false);
    TDataStd_Name::Set(label, name);
    return label;
  };
  const TDF_Label car = shapes->NewShape();
  TDataStd_Name::Set(car, "Front end");
  const TDF_Label bonnet_part = part(bonnet_shape, "Bonnet");
  const TDF_Label ring_part = part(ring_shape, "Headlamp ring");
  // One colour only: Open CASCADE writes several in the order of addresses, which differs from run
  // to run.
  colours->SetColor(bonnet_part, Quantity_Color(0.09, 0.24, 0.45, Quantity_TOC_sRGB),
                    XCAFDoc_ColorSurf);
  gp_Trsf place;
  place.SetTransformation(gp_Ax3(gp_Pnt(60, -430, -140), gp_Dir(-1, 0, 0.25), gp_Dir(0, 1, 0)),
                          gp_Ax3());
  TDataStd_Name::Set(shapes->AddComponent(car, bonnet_part, TopLoc_Location()), "bonnet");
  TDataStd_Name::Set(shapes->AddComponent(car, ring_part, TopLoc_Location(place)),
                     "left headlamp ring");
  shapes->UpdateAssemblies();

  STEPCAFControl_Writer writer;
  writer.SetNameMode(true);
  writer.SetColorMode(true);
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetCVal("write.step.unit", "MM");
  Interface_Static::SetIVal("write.surfacecurve.mode", 0);
  if (!writer.Transfer(document, STEPControl_AsIs))
    fail("Open CASCADE does not transfer the model");
  const opencascade::handle<StepData_StepModel> model =
      opencascade::handle<StepData_StepModel>::DownCast(writer.ChangeWriter().WS()->Model());
  name_items(model);
  APIHeaderSection_MakeHeader header(model);
  header.SetName(text("bonnet.step"));
  header.SetTimeStamp(text("2024-01-01T00:00:00"));
  header.SetAuthorValue(1, text("Knead"));
  header.SetOrganizationValue(1, text("Knead"));
  header.SetOriginatingSystem(text("samples/make_samples.cpp"));
  header.SetAuthorisation(text(""));
  header.SetDescriptionValue(1, text("Sample: a bonnet skin with flanges, and a headlamp ring"));
  if (writer.Write(path.c_str()) != IFSelect_RetDone) fail("cannot write " + path);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) fail("usage: make_samples DIRECTORY");
  const TopoDS_Shape bonnet_shape = bonnet();
  check(bonnet_shape, "the bonnet", 5);
  const TopoDS_Shape ring_shape = ring();
  check(ring_shape, "the ring", 1);
  write(bonnet_shape, ring_shape, (std::filesystem::path(argv[1]) / "bonnet.step").string());
  return 0;
}
