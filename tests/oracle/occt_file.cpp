#include "oracle/occt_file.hpp"

#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <IGESControl_Reader.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <cmath>

namespace knead::oracle {
namespace {

double gap_of(const TopoDS_Edge& edge, const TopoDS_Face& face) {
  double first = 0, last = 0, first_2d = 0, last_2d = 0;
  const auto curve = BRep_Tool::Curve(edge, first, last);
  const auto flat = BRep_Tool::CurveOnSurface(edge, face, first_2d, last_2d);
  const auto surface = BRep_Tool::Surface(face);
  double result = BRep_Tool::Tolerance(edge);
  if (curve.IsNull() || flat.IsNull()) return result;
  constexpr int steps = 40;
  for (int k = 0; k <= steps; ++k) {
    const double share = static_cast<double>(k) / steps;
    const gp_Pnt2d at = flat->Value(first_2d + share * (last_2d - first_2d));
    result = std::max(result, surface->Value(at.X(), at.Y()).Distance(curve->Value(first + share * (last - first))));
  }
  return result;
}

std::optional<TopoDS_Shape> read_iges(const std::filesystem::path& path) {
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  IGESControl_Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return std::nullopt;
  reader.TransferRoots();
  return reader.OneShape();
}

std::optional<TopoDS_Shape> read_brep(const std::filesystem::path& path) {
  TopoDS_Shape shape;
  if (!BRepTools::Read(shape, path.c_str(), BRep_Builder())) return std::nullopt;
  return shape;
}

}  // namespace

std::optional<OcctFile> occt_read_file(const std::filesystem::path& path) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  const auto read = path.extension() == ".brep" ? read_brep(path) : read_iges(path);
  if (!read) return std::nullopt;
  const TopoDS_Shape& shape = *read;
  OcctFile result;
  if (shape.IsNull()) return result;
  constexpr std::pair<const char*, TopAbs_ShapeEnum> kinds[] = {{"solids", TopAbs_SOLID}, {"shells", TopAbs_SHELL},
                                                                {"faces", TopAbs_FACE},   {"wires", TopAbs_WIRE},
                                                                {"edges", TopAbs_EDGE},   {"vertices", TopAbs_VERTEX}};
  for (const auto& [name, kind] : kinds) {
    for (TopExp_Explorer at(shape, kind); at.More(); at.Next()) ++result.topology[name];
  }
  for (TopExp_Explorer at(shape, TopAbs_SOLID); at.More(); at.Next()) {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(at.Current(), properties);
    result.volume += properties.Mass();
  }
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
    const TopoDS_Face face = TopoDS::Face(at.Current());
    result.bad_faces += BRepCheck_Analyzer(face).IsValid() ? 0 : 1;
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(face, properties);
    result.area += std::abs(properties.Mass());
    for (TopExp_Explorer e(face, TopAbs_EDGE); e.More(); e.Next()) {
      result.gaps.push_back(gap_of(TopoDS::Edge(e.Current()), face));
    }
  }
  return result;
}

}  // namespace knead::oracle
