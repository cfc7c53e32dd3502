#include "oracle/occt_file.hpp"

#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
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
#include <STEPControl_Reader.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <cmath>
#include <limits>

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
    result = std::max(
        result,
        surface->Value(at.X(), at.Y()).Distance(curve->Value(first + share * (last - first))));
  }
  return result;
}

/// The largest distance of an edge's points from the nearest of these faces but its own.
double parting_of(const TopoDS_Edge& edge, const TopoDS_Face& face_here,
                  const std::vector<TopoDS_Face>& faces) {
  double first = 0, last = 0;
  const auto curve = BRep_Tool::Curve(edge, first, last);
  if (curve.IsNull() || faces.size() < 2) return std::numeric_limits<double>::infinity();
  constexpr int steps = 20;
  double result = 0;
  for (int k = 0; k <= steps; ++k) {
    const auto vertex =
        BRepBuilderAPI_MakeVertex(curve->Value(first + (last - first) * k / steps)).Vertex();
    double nearest = std::numeric_limits<double>::infinity();
    for (const TopoDS_Face& face : faces) {
      if (face.IsSame(face_here)) continue;
      const BRepExtrema_DistShapeShape distance(vertex, face);
      if (distance.IsDone()) nearest = std::min(nearest, distance.Value());
    }
    result = std::max(result, nearest);
  }
  return result;
}

template <class Reader>
std::optional<TopoDS_Shape> read_exchange(const std::filesystem::path& path) {
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return std::nullopt;
  reader.TransferRoots();
  return reader.OneShape();
}

std::optional<TopoDS_Shape> read_brep(const std::filesystem::path& path) {
  TopoDS_Shape shape;
  if (!BRepTools::Read(shape, path.c_str(), BRep_Builder())) return std::nullopt;
  return shape;
}

std::optional<TopoDS_Shape> read_any(const std::filesystem::path& path) {
  return path.extension() == ".brep"   ? read_brep(path)
         : path.extension() == ".step" ? read_exchange<STEPControl_Reader>(path)
                                       : read_exchange<IGESControl_Reader>(path);
}

}  // namespace

std::vector<double> occt_partings(const std::filesystem::path& path) {
  const auto shape = read_any(path);
  std::vector<TopoDS_Face> faces;
  for (TopExp_Explorer at(shape.value_or(TopoDS_Shape()), TopAbs_FACE); at.More(); at.Next())
    faces.push_back(TopoDS::Face(at.Current()));
  std::vector<double> result;
  for (const TopoDS_Face& face : faces) {
    for (TopExp_Explorer e(face, TopAbs_EDGE); e.More(); e.Next())
      result.push_back(parting_of(TopoDS::Edge(e.Current()), face, faces));
  }
  return result;
}

std::optional<OcctFile> occt_read_file(const std::filesystem::path& path) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  const auto read = read_any(path);
  if (!read) return std::nullopt;
  const TopoDS_Shape& shape = *read;
  OcctFile result;
  if (shape.IsNull()) return result;
  constexpr std::pair<const char*, TopAbs_ShapeEnum> kinds[] = {
      {"solids", TopAbs_SOLID}, {"shells", TopAbs_SHELL}, {"faces", TopAbs_FACE},
      {"wires", TopAbs_WIRE},   {"edges", TopAbs_EDGE},   {"vertices", TopAbs_VERTEX}};
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
