#include "oracle/occt_held.hpp"

#include <BRepCheck_Analyzer.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <IGESControl_Reader.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <STEPControl_Reader.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>

#include "oracle/occt_faces_data.hpp"

namespace knead::oracle {

struct OcctHeld::Data {
  TopoDS_Shape shape;
};

namespace {

constexpr int edge_intervals = 20;

template <class Reader>
TopoDS_Shape transferred(Reader reader, const std::filesystem::path& path) {
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return {};
  reader.TransferRoots();
  return reader.OneShape();
}

TopoDS_Shape shape_of(const std::filesystem::path& path) {
  const auto extension = path.extension();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  if (extension == ".igs" || extension == ".iges") return transferred(IGESControl_Reader(), path);
  if (extension != ".brep") return transferred(STEPControl_Reader(), path);
  TopoDS_Shape shape;
  return BRepTools::Read(shape, path.c_str(), BRep_Builder()) ? shape : TopoDS_Shape();
}

/// Each once, in their order.
std::vector<TopoDS_Shape> parts_of(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape all;
  TopExp::MapShapes(shape, kind, all);
  std::vector<TopoDS_Shape> result;
  for (int k = 1; k <= all.Extent(); ++k) result.push_back(all(k));
  return result;
}

double gap_between(const TopoDS_Edge& edge, const TopoDS_Face& face, const SurfaceHandle& surface) {
  double f = 0, l = 0, f2 = 0, l2 = 0;
  const auto curve = BRep_Tool::Curve(edge, f, l);
  if (BRep_Tool::Degenerated(edge) || curve.IsNull()) return 0;
  const auto flat = BRep_Tool::CurveOnSurface(edge, face, f2, l2);
  double gap = 0;
  for (int k = 0; k <= edge_intervals; ++k) {
    const gp_Pnt p = curve->Value(f + (l - f) * k / edge_intervals);
    const gp_Pnt2d at = flat.IsNull() ? ShapeAnalysis_Surface(surface).ValueOfUV(p, 1e-7)
                                      : flat->Value(f2 + (l2 - f2) * k / edge_intervals);
    gap = std::max(gap, distance(surface, p, at, std::max(1e-6, gap)));
  }
  return gap;
}

}  // namespace

std::optional<OcctHeld> OcctHeld::read(const std::filesystem::path& path) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  Data data{.shape = shape_of(path)};
  if (data.shape.IsNull()) return std::nullopt;
  return OcctHeld(std::make_shared<const Data>(std::move(data)));
}

std::vector<double> OcctHeld::gaps() const {
  std::vector<double> result;
  for (const TopoDS_Shape& shape : parts_of(data_->shape, TopAbs_FACE)) {
    const TopoDS_Face& face = TopoDS::Face(shape);
    for (const TopoDS_Shape& edge : parts_of(face, TopAbs_EDGE)) {
      result.push_back(gap_between(TopoDS::Edge(edge), face, surface_of(face)));
    }
  }
  return result;
}

int OcctHeld::bad_shapes() const {
  const BRepCheck_Analyzer check(data_->shape);
  int bad = 0;
  for (const auto kind : {TopAbs_FACE, TopAbs_EDGE}) {
    for (const TopoDS_Shape& shape : parts_of(data_->shape, kind))
      bad += check.IsValid(shape) ? 0 : 1;
  }
  return bad;
}

}  // namespace knead::oracle
