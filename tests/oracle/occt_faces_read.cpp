#include <BRep_Tool.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESGeom_BoundedSurface.hxx>
#include <IGESGeom_TrimmedSurface.hxx>
#include <IGESSolid_Face.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <STEPControl_Reader.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_Surface.hxx>
#include <StepShape_FaceSurface.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include "oracle/occt_faces_data.hpp"

namespace knead::oracle {
namespace {

void list_faces(const TopoDS_Shape& shape, std::vector<TopoDS_Face>& list) {
  if (shape.IsNull()) return;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
    TopoDS_Face made = TopoDS::Face(at.Current());
    made.Location(TopLoc_Location());
    list.push_back(made);
  }
}

void read_step(const std::filesystem::path& path, OcctFaces::Data& data) {
  STEPControl_Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return;
  reader.TransferRoots();
  data.shape = reader.OneShape();
  const auto step = opencascade::handle<StepData_StepModel>::DownCast(reader.WS()->Model());
  const auto process = reader.WS()->TransferReader()->TransientProcess();
  for (int k = 1; k <= step->NbEntities(); ++k) {
    const auto face = opencascade::handle<StepShape_FaceSurface>::DownCast(step->Value(k));
    if (face.IsNull()) continue;
    auto& list = data.on["#" + std::to_string(step->IdentLabel(face->FaceGeometry()))];
    list_faces(TransferBRep::ShapeResult(process, face), list);
  }
}

/// The surface below an entity that is a face, or the entity itself.
opencascade::handle<IGESData_IGESEntity> surface_below(
    const opencascade::handle<IGESData_IGESEntity>& entity) {
  if (const auto f = opencascade::handle<IGESGeom_TrimmedSurface>::DownCast(entity))
    return f->Surface();
  if (const auto f = opencascade::handle<IGESGeom_BoundedSurface>::DownCast(entity))
    return f->Surface();
  if (const auto f = opencascade::handle<IGESSolid_Face>::DownCast(entity)) return f->Surface();
  return entity;
}

void read_iges(const std::filesystem::path& path, OcctFaces::Data& data) {
  IGESControl_Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return;
  reader.TransferRoots();
  data.shape = reader.OneShape();
  const auto model = opencascade::handle<IGESData_IGESModel>::DownCast(reader.WS()->Model());
  const auto process = reader.WS()->TransferReader()->TransientProcess();
  for (int k = 1; k <= model->NbEntities(); ++k) {
    const auto entity = model->Entity(k);
    const int type = entity->TypeNumber();
    if (type != 128 && type != 143 && type != 144 && type != 510) continue;
    const int number = model->DNum(surface_below(entity));
    list_faces(TransferBRep::ShapeResult(process, entity), data.on["#" + std::to_string(number)]);
  }
}

}  // namespace

std::optional<OcctFaces> OcctFaces::read(const std::filesystem::path& path) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  auto data = std::make_shared<Data>();
  const bool iges = path.extension() == ".igs" || path.extension() == ".iges";
  iges ? read_iges(path, *data) : read_step(path, *data);
  if (data->shape.IsNull()) return std::nullopt;
  TopExp::MapShapesAndAncestors(data->shape, TopAbs_EDGE, TopAbs_FACE, data->around);
  return OcctFaces(std::move(data));
}

}  // namespace knead::oracle
