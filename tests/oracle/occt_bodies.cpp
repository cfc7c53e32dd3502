#include "oracle/occt_bodies.hpp"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <IGESControl_Reader.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <STEPControl_Reader.hxx>
#include <StepShape_ShapeRepresentation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Solid.hxx>
#include <XSControl_WorkSession.hxx>
#include <cmath>

namespace knead::oracle {
namespace {

TopoDS_Shape iges_shape(const std::filesystem::path& path) {
  IGESControl_Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return {};
  reader.TransferRoots();
  return reader.OneShape();
}

/// Of a STEP file without products nothing is a root: what its representations hold.
TopoDS_Shape step_shape(const std::filesystem::path& path) {
  STEPControl_Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return {};
  reader.TransferRoots();
  const auto model = reader.WS()->Model();
  for (int k = 1; reader.NbShapes() == 0 && k <= model->NbEntities(); ++k) {
    if (model->Value(k)->IsKind(STANDARD_TYPE(StepShape_ShapeRepresentation)))
      reader.TransferEntity(model->Value(k));
  }
  return reader.OneShape();
}

TopoDS_Shape shape_of(const std::filesystem::path& path) {
  const auto extension = path.extension();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  if (extension == ".igs" || extension == ".iges") return iges_shape(path);
  if (extension != ".brep") return step_shape(path);
  TopoDS_Shape shape;
  return BRepTools::Read(shape, path.c_str(), BRep_Builder()) ? shape : TopoDS_Shape();
}

OcctBody measured(const TopoDS_Shape& shape) {
  OcctBody result;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(at.Current(), properties, 1e-4);
    result.area += std::abs(properties.Mass());
  }
  Bnd_Box box;
  BRepBndLib::AddOptimal(shape, box, false, false);
  if (box.IsVoid()) return result;
  const gp_Pnt lower = box.CornerMin(), upper = box.CornerMax();
  result.box = {Eigen::Vector3d(lower.X(), lower.Y(), lower.Z()),
                Eigen::Vector3d(upper.X(), upper.Y(), upper.Z())};
  return result;
}

double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

std::vector<OcctBody> sewn(const TopoDS_Shape& shape, double tolerance) {
  BRepBuilderAPI_Sewing sewing(tolerance);
  sewing.Add(shape);
  sewing.Perform();
  std::vector<OcctBody> result;
  for (TopExp_Explorer at(sewing.SewedShape(), TopAbs_SHELL); at.More(); at.Next()) {
    if (!BRep_Tool::IsClosed(at.Current())) continue;
    TopoDS_Solid solid = BRepBuilderAPI_MakeSolid(TopoDS::Shell(at.Current())).Solid();
    BRepLib::OrientClosedSolid(solid);
    OcctBody& body = result.emplace_back(measured(solid));
    body.volume = volume_of(solid);
  }
  return result;
}

}  // namespace

std::optional<OcctBodies> occt_bodies(const std::filesystem::path& path) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  const TopoDS_Shape shape = shape_of(path);
  if (shape.IsNull()) return std::nullopt;
  OcctBodies result;
  result.whole = measured(shape);
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) ++result.faces;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next()) {
    ++result.solids;
    result.whole.volume += volume_of(solid.Current());
    for (TopExp_Explorer at(solid.Current(), TopAbs_SHELL); at.More(); at.Next()) {
      OcctBody& shell = result.shells.emplace_back(measured(at.Current()));
      shell.volume = volume_of(at.Current());
    }
  }
  constexpr double apart = 1e-5;  // of the diagonal: what is sewn
  if (result.solids == 0 && result.faces > 1)
    result.sewn = sewn(shape, apart * result.whole.box.diagonal().norm());
  return result;
}

}  // namespace knead::oracle
