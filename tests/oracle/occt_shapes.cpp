#include "oracle/occt_shapes.hpp"

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_Plane.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_BSplineSurface.hxx>
#include <StepShape_FaceSurface.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <gp_Elips.hxx>
#include <memory>
#include <tuple>

namespace knead::oracle {
namespace {

TopoDS_Shape moved(const TopoDS_Shape& shape, double x, double y, double z, double angle = 0) {
  gp_Trsf turn, shift;
  turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 2, 3)), angle);
  shift.SetTranslation(gp_Vec(x, y, z));
  return BRepBuilderAPI_Transform(shape, shift * turn).Shape();
}

TopoDS_Edge bezier(const std::vector<gp_Pnt>& poles) {
  TColgp_Array1OfPnt array(1, static_cast<int>(poles.size()));
  for (std::size_t k = 0; k < poles.size(); ++k) array.SetValue(static_cast<int>(k) + 1, poles[k]);
  return BRepBuilderAPI_MakeEdge(opencascade::handle<Geom_Curve>(new Geom_BezierCurve(array)));
}

gp_Ax2 upright(double x = 0, double y = 0, double z = 0) {
  return {gp_Pnt(x, y, z), gp_Dir(0, 0, 1)};
}

using Maker = TopoDS_Shape (*)();

const std::vector<std::pair<std::string, Maker>>& makers() {
  static const std::vector<std::pair<std::string, Maker>> all = {
      {"box", [] { return moved(BRepPrimAPI_MakeBox(3, 4, 5).Shape(), 10, 20, 30, 0.7); }},
      {"hollow_box",
       [] {
         const TopoDS_Shape box = BRepPrimAPI_MakeBox(20, 20, 20).Shape();
         const auto hollow = moved(BRepPrimAPI_MakeCylinder(2, 8).Shape(), 5, 5, 5, 0.4);
         return TopoDS_Shape(BRepAlgoAPI_Cut(BRepAlgoAPI_Cut(box, hollow).Shape(),
                                             moved(BRepPrimAPI_MakeSphere(3).Shape(), 14, 14, 14))
                                 .Shape());
       }},
      {"cylinder", [] { return moved(BRepPrimAPI_MakeCylinder(2, 30).Shape(), 1, 2, 3, 0.4); }},
      {"half_cylinder", [] { return BRepPrimAPI_MakeCylinder(2, 3, 3.0).Shape(); }},
      {"cone", [] { return moved(BRepPrimAPI_MakeCone(3, 0, 4).Shape(), 1, 2, 3, 1.1); }},
      {"cone_upside_down", [] { return BRepPrimAPI_MakeCone(0, 3, 4).Shape(); }},
      {"frustum", [] { return BRepPrimAPI_MakeCone(3, 1, 4).Shape(); }},
      {"part_of_a_cone", [] { return BRepPrimAPI_MakeCone(3, 0, 4, 1.0).Shape(); }},
      {"sphere", [] { return moved(BRepPrimAPI_MakeSphere(5).Shape(), 1, 2, 3, 0.3); }},
      {"sphere_zone", [] { return BRepPrimAPI_MakeSphere(5, -0.5, 0.7).Shape(); }},
      {"hemisphere", [] { return BRepPrimAPI_MakeSphere(5, 0, 1.5707963267948966).Shape(); }},
      {"sphere_sector",
       [] { return BRepPrimAPI_MakeSphere(5, -0.5, 1.5707963267948966, 4.0).Shape(); }},
      {"torus", [] { return moved(BRepPrimAPI_MakeTorus(5, 2).Shape(), 1, 2, 3, 0.9); }},
      {"torus_sector", [] { return BRepPrimAPI_MakeTorus(5, 2, 2.0).Shape(); }},
      {"torus_part", [] { return BRepPrimAPI_MakeTorus(5, 2, -1.0, 2.0, 2.0).Shape(); }},
      {"drilled_box",
       [] {
         TopoDS_Shape shape = BRepPrimAPI_MakeBox(20, 20, 5).Shape();
         for (int i = 0; i < 3; ++i) {
           for (int j = 0; j < 3; ++j) {
             shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(
                                                upright(4 + 6 * i, 4 + 6 * j, -1), 1 + 0.3 * i, 9)
                                                .Shape())
                         .Shape();
           }
         }
         return shape;
       }},
      {"crossing_cylinders",
       [] {
         const auto lying =
             BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-10, 0, 1), gp_Dir(1, 0, 0)), 2, 20).Shape();
         return TopoDS_Shape(
             BRepAlgoAPI_Fuse(BRepPrimAPI_MakeCylinder(upright(0, 0, -10), 3, 20).Shape(), lying)
                 .Shape());
       }},
      {"drilled_sphere",
       [] {
         return TopoDS_Shape(
             BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(5).Shape(),
                             BRepPrimAPI_MakeCylinder(upright(1, 0.5, -10), 2, 20).Shape())
                 .Shape());
       }},
      {"sphere_drilled_from_the_side",
       [] {
         const gp_Ax2 side(gp_Pnt(0, 0, 0), gp_Dir(0.3, 1, 0.2));
         return TopoDS_Shape(BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(5).Shape(),
                                             BRepPrimAPI_MakeCylinder(side, 2, 20).Shape())
                                 .Shape());
       }},
      {"drilled_torus",
       [] {
         return TopoDS_Shape(
             BRepAlgoAPI_Cut(BRepPrimAPI_MakeTorus(5, 2).Shape(),
                             BRepPrimAPI_MakeCylinder(upright(0.5, 5, -10), 0.8, 20).Shape())
                 .Shape());
       }},
      {"cut_torus",
       [] {
         return TopoDS_Shape(
             BRepAlgoAPI_Cut(BRepPrimAPI_MakeTorus(5, 2).Shape(),
                             moved(BRepPrimAPI_MakeBox(20, 20, 20).Shape(), -10, 1, -10))
                 .Shape());
       }},
      {"split_torus",
       [] {
         return TopoDS_Shape(
             BRepAlgoAPI_Cut(BRepPrimAPI_MakeTorus(5, 2).Shape(),
                             moved(BRepPrimAPI_MakeBox(20, 20, 20).Shape(), -10, -10, 0.3))
                 .Shape());
       }},
      {"drilled_cone",
       [] {
         const gp_Ax2 side(gp_Pnt(-10, 0, 1), gp_Dir(1, 0.2, 0));
         return TopoDS_Shape(BRepAlgoAPI_Cut(BRepPrimAPI_MakeCone(3, 0, 6).Shape(),
                                             BRepPrimAPI_MakeCylinder(side, 0.7, 20).Shape())
                                 .Shape());
       }},
      {"slanted_cylinder",
       [] {
         const auto box =
             moved(BRepPrimAPI_MakeBox(gp_Pnt(-20, -20, 0), 40, 40, 40).Shape(), 0, 0, 6, 0.4);
         return TopoDS_Shape(BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(2, 12).Shape(), box).Shape());
       }},
      {"rounded_box",
       [] {
         const TopoDS_Shape box = BRepPrimAPI_MakeBox(8, 6, 4).Shape();
         BRepFilletAPI_MakeFillet fillet(box);
         for (TopExp_Explorer at(box, TopAbs_EDGE); at.More(); at.Next())
           fillet.Add(1, TopoDS::Edge(at.Current()));
         return fillet.Shape();
       }},
      {"vase",
       [] {
         const auto edge = bezier({{1, 0, 0}, {5, 0, 1}, {0.5, 0, 4}, {2, 0, 6}});
         return BRepPrimAPI_MakeRevol(edge, gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))).Shape();
       }},
      {"drop",
       [] {
         const auto edge = bezier({{0, 0, 0}, {5, 0, 0}, {0.5, 0, 4}, {0, 0, 6}});
         return BRepPrimAPI_MakeRevol(edge, gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))).Shape();
       }},
      {"part_of_a_vase",
       [] {
         const auto edge = bezier({{1, 0, 0}, {5, 0, 1}, {0.5, 0, 4}, {2, 0, 6}});
         return BRepPrimAPI_MakeRevol(edge, gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 2.5).Shape();
       }},
      {"revolved_ellipse",
       [] {
         const gp_Elips ellipse(gp_Ax2(gp_Pnt(6, 0, 0), gp_Dir(0, 1, 0)), 3, 1);
         return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeEdge(ellipse).Edge(),
                                      gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)))
             .Shape();
       }},
      {"channel",
       [] {
         const auto edge = bezier({{0, 0, 0}, {5, 8, 0}, {8, -6, 1}, {12, 2, 0}});
         return BRepPrimAPI_MakePrism(edge, gp_Vec(1, 2, 9)).Shape();
       }},
      {"elliptic_tube",
       [] {
         const gp_Elips ellipse(upright(), 4, 2);
         return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeEdge(ellipse).Edge(), gp_Vec(1, 0, 9))
             .Shape();
       }},
      {"cut_elliptic_cylinder",
       [] {
         const gp_Elips ellipse(upright(), 4, 2);
         const auto wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(ellipse).Edge()).Wire();
         const auto solid =
             BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire).Face(), gp_Vec(0, 0, 9)).Shape();
         const auto drill =
             BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-10, 0.2, 4), gp_Dir(1, 0, 0)), 1, 20).Shape();
         return TopoDS_Shape(BRepAlgoAPI_Cut(solid, drill).Shape());
       }},
  };
  return all;
}

}  // namespace

std::vector<std::string> occt_shape_names() {
  std::vector<std::string> names;
  for (const auto& [name, maker] : makers()) names.push_back(name);
  return names;
}

bool occt_write_shape(const std::string& name, const std::filesystem::path& path) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  for (const auto& [other, maker] : makers()) {
    if (other != name) continue;
    STEPControl_Writer writer;
    Interface_Static::SetCVal("write.step.unit", "MM");
    return writer.Transfer(maker(), STEPControl_AsIs) == IFSelect_RetDone &&
           writer.Write(path.c_str()) == IFSelect_RetDone;
  }
  return false;
}

namespace {

/// Reads a file in this unit; null if it cannot.
std::unique_ptr<STEPControl_Reader> read(const std::filesystem::path& path,
                                         const std::string& unit) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  auto reader = std::make_unique<STEPControl_Reader>();
  const std::map<std::string, const char*> names = {
      {"m", "M"}, {"cm", "CM"}, {"inch", "INCH"}, {"foot", "FT"}};
  const auto known = names.find(unit);
  Interface_Static::SetCVal("xstep.cascade.unit", known == names.end() ? "MM" : known->second);
  if (reader->ReadFile(path.c_str()) != IFSelect_RetDone) return nullptr;
  reader->TransferRoots();
  return reader;
}

/// Calls `visit` with each entity of a file and what it became.
template <class Visit>
void for_each_entity(const std::filesystem::path& path, const std::string& unit,
                     const Visit& visit) {
  const auto reader = read(path, unit);
  if (!reader) return;
  const auto step = opencascade::handle<StepData_StepModel>::DownCast(reader->WS()->Model());
  const auto process = reader->WS()->TransferReader()->TransientProcess();
  for (int k = 1; k <= step->NbEntities(); ++k) {
    const auto entity = step->Value(k);
    visit(entity, TransferBRep::ShapeResult(process, entity),
          "#" + std::to_string(step->IdentLabel(entity)));
  }
}

}  // namespace

std::map<std::string, double> occt_face_areas(const std::filesystem::path& path,
                                              const std::string& unit, bool splines) {
  std::map<std::string, double> areas;
  for_each_entity(
      path, unit, [&](const auto& entity, const TopoDS_Shape& shape, const std::string& id) {
        const auto face = opencascade::handle<StepShape_FaceSurface>::DownCast(entity);
        if (face.IsNull() ||
            face->FaceGeometry()->IsKind(STANDARD_TYPE(StepGeom_BSplineSurface)) != splines)
          return;
        double sum = 0;
        for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
          GProp_GProps properties;
          BRepGProp::SurfaceProperties(at.Current(), properties);
          sum += std::abs(properties.Mass());
        }
        areas[id] = sum;
      });
  return areas;
}

OcctWhole occt_whole(const std::filesystem::path& path, const std::string& unit, bool with_box) {
  OcctWhole result;
  const auto reader = read(path, unit);
  if (!reader) return result;
  const TopoDS_Shape shape = reader->OneShape();
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(at.Current(), properties);
    result.area += std::abs(properties.Mass());
    ++result.faces;
  }
  for (TopExp_Explorer at(shape, TopAbs_SOLID); at.More(); at.Next()) {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(at.Current(), properties);
    result.volume += properties.Mass();
    ++result.solids;
  }
  if (!with_box) return result;
  Bnd_Box box;
  BRepBndLib::AddOptimal(shape, box, false, false);
  std::tie(result.lower[0], result.lower[1], result.lower[2]) =
      std::tuple(box.CornerMin().X(), box.CornerMin().Y(), box.CornerMin().Z());
  std::tie(result.upper[0], result.upper[1], result.upper[2]) =
      std::tuple(box.CornerMax().X(), box.CornerMax().Y(), box.CornerMax().Z());
  return result;
}

}  // namespace knead::oracle
