#include "oracle/occt_model.hpp"

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <STEPControl_Reader.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_BSplineSurface.hxx>
#include <StepShape_FaceSurface.hxx>
#include <TopAbs.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

namespace knead::oracle {
namespace {

// Names of xstep.cascade.unit.
const char* occt_unit(const std::string& unit) {
  if (unit == "m") return "M";
  if (unit == "cm") return "CM";
  if (unit == "inch") return "INCH";
  if (unit == "foot") return "FT";
  return "MM";
}

opencascade::handle<Geom_BSplineSurface> b_spline_of(const TopoDS_Face& face) {
  TopLoc_Location ignored;
  opencascade::handle<Geom_Surface> surface = BRep_Tool::Surface(face, ignored);
  if (const auto trimmed = opencascade::handle<Geom_RectangularTrimmedSurface>::DownCast(surface)) {
    surface = trimmed->BasisSurface();
  }
  return opencascade::handle<Geom_BSplineSurface>::DownCast(surface);
}

OcctSurface copy_of(const Geom_BSplineSurface& surface) {
  OcctSurface result;
  result.degree = {surface.UDegree(), surface.VDegree()};
  result.net = {surface.NbUPoles(), surface.NbVPoles()};
  result.periodic = {surface.IsUPeriodic() == Standard_True,
                     surface.IsVPeriodic() == Standard_True};
  for (int k = 1; k <= surface.NbUKnots(); ++k) {
    result.knots[0].insert(result.knots[0].end(),
                           static_cast<std::size_t>(surface.UMultiplicity(k)), surface.UKnot(k));
  }
  for (int k = 1; k <= surface.NbVKnots(); ++k) {
    result.knots[1].insert(result.knots[1].end(),
                           static_cast<std::size_t>(surface.VMultiplicity(k)), surface.VKnot(k));
  }
  result.poles.resize(result.net[0] * result.net[1], 3);
  const bool rational = surface.IsURational() || surface.IsVRational();
  for (int i = 0; i < result.net[0]; ++i) {
    for (int j = 0; j < result.net[1]; ++j) {
      const gp_Pnt pole = surface.Pole(i + 1, j + 1);
      result.poles.row(i * result.net[1] + j) << pole.X(), pole.Y(), pole.Z();
      if (rational) result.weights.push_back(surface.Weight(i + 1, j + 1));
    }
  }
  return result;
}

double area(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(shape, properties, 1e-4);
  return std::abs(properties.Mass());
}

void add_face(const TopoDS_Face& face, OcctResult& result) {
  const auto surface = b_spline_of(face);
  if (surface.IsNull()) return;
  result.surfaces.push_back(copy_of(*surface));
  const double whole = area(BRepBuilderAPI_MakeFace(surface, 1e-7).Shape());
  if (whole > 0) result.area_ratios.push_back(area(face) / whole);
}

void count(const TopoDS_Shape& shape, OcctModel& model) {
  constexpr std::array<std::pair<TopAbs_ShapeEnum, const char*>, 6> kinds = {
      {{TopAbs_SOLID, "solids"},
       {TopAbs_SHELL, "shells"},
       {TopAbs_FACE, "faces"},
       {TopAbs_WIRE, "wires"},
       {TopAbs_EDGE, "edges"},
       {TopAbs_VERTEX, "vertices"}}};
  for (const auto& [kind, name] : kinds) {
    for (TopExp_Explorer at(shape, kind); at.More(); at.Next()) ++model.topology[name];
  }
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
    TopLoc_Location ignored;
    const auto surface = BRep_Tool::Surface(TopoDS::Face(at.Current()), ignored);
    model.faces.emplace_back(surface.IsNull() ? "none" : surface->DynamicType()->Name());
  }
}

}  // namespace

std::optional<OcctModel> occt_read(const std::filesystem::path& path, const std::string& unit) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  STEPControl_Reader reader;
  Interface_Static::SetCVal("xstep.cascade.unit", occt_unit(unit));
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return std::nullopt;
  OcctModel model;
  const auto step = opencascade::handle<StepData_StepModel>::DownCast(reader.WS()->Model());
  for (int k = 1; k <= step->NbEntities(); ++k)
    ++model.entities[step->Value(k)->DynamicType()->Name()];
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  if (!shape.IsNull()) count(shape, model);

  const auto transfer = reader.WS()->TransferReader();
  const auto result_of = [&](const opencascade::handle<Standard_Transient>& entity) {
    return TransferBRep::ShapeResult(transfer->TransientProcess(), entity);
  };
  const auto name_of = [&](const opencascade::handle<Standard_Transient>& entity) {
    return "#" + std::to_string(step->IdentLabel(entity));
  };
  for (int k = 1; k <= step->NbEntities(); ++k) {
    const auto entity = step->Value(k);
    std::string name;
    if (const auto face = opencascade::handle<StepShape_FaceSurface>::DownCast(entity)) {
      if (face->FaceGeometry()->IsKind(STANDARD_TYPE(StepGeom_BSplineSurface)))
        name = name_of(face->FaceGeometry());
    } else if (entity->IsKind(STANDARD_TYPE(StepGeom_BSplineSurface))) {
      name = name_of(entity);
    }
    if (name.empty()) continue;
    auto& result = model.results[name];
    for (TopExp_Explorer at(result_of(entity), TopAbs_FACE); at.More(); at.Next())
      add_face(TopoDS::Face(at.Current()), result);
  }
  return model;
}

}  // namespace knead::oracle
