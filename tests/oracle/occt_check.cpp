#include "oracle/occt_check.hpp"

#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cmath>

namespace knead::oracle {
namespace {

void list_complaints(Interface_CheckIterator checks, std::vector<std::string>& complaints) {
  for (checks.Start(); checks.More(); checks.Next()) {
    const auto& check = checks.Value();
    for (int k = 1; k <= check->NbFails(); ++k) complaints.emplace_back(check->CFail(k));
    for (int k = 1; k <= check->NbWarnings(); ++k) {
      // What it makes of every closed surface, and of one with full knots.
      const std::string text = check->CWarning(k);
      if (text.find("periodic") != std::string::npos ||
          text.find("C0-continuous") != std::string::npos)
        continue;
      complaints.push_back(text);
    }
  }
}

template <class Reader>
std::optional<OcctCheck> check(const std::filesystem::path& path) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  opencascade::handle<TDocStd_Document> document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Reader reader;
  reader.SetColorMode(Standard_True);
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return std::nullopt;
  if (!reader.Transfer(document)) return std::nullopt;
  OcctCheck result;
  auto* session = [&] {
    if constexpr (requires { reader.Reader(); })
      return reader.Reader().WS().get();
    else
      return reader.WS().get();
  }();
  list_complaints(session->ModelCheckList(), result.complaints);
  list_complaints(session->TransferReader()->LastCheckList(), result.complaints);

  TDF_LabelSequence labels;
  const auto shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const auto colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
  shapes->GetFreeShapes(labels);
  constexpr std::pair<const char*, TopAbs_ShapeEnum> kinds[] = {{"shells", TopAbs_SHELL},
                                                                {"faces", TopAbs_FACE},
                                                                {"edges", TopAbs_EDGE},
                                                                {"vertices", TopAbs_VERTEX}};
  for (int k = 1; k <= labels.Length(); ++k) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(labels.Value(k));
    const BRepCheck_Analyzer analyzer(shape);
    for (const auto& [name, kind] : kinds) {
      TopTools_IndexedMapOfShape all;
      TopExp::MapShapes(shape, kind, all);
      result.topology[name] += all.Extent();
      for (int n = 1; n <= all.Extent(); ++n) {
        result.bad_shapes += analyzer.IsValid(all(n)) ? 0 : 1;
        if (kind == TopAbs_SHELL) result.closed_shells += BRep_Tool::IsClosed(all(n)) ? 1 : 0;
        if (kind == TopAbs_EDGE)
          result.largest_tolerance =
              std::max(result.largest_tolerance, BRep_Tool::Tolerance(TopoDS::Edge(all(n))));
        if (kind != TopAbs_FACE) continue;
        GProp_GProps properties;
        BRepGProp::SurfaceProperties(all(n), properties);
        result.area += std::abs(properties.Mass());
        Quantity_Color colour;
        if (!colours->GetColor(all(n), XCAFDoc_ColorSurf, colour) &&
            !colours->GetColor(all(n), XCAFDoc_ColorGen, colour))
          continue;
        const auto part = [](double c) { return static_cast<int>(std::lround(255 * c)); };
        const auto srgb = [](double c) {
          return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
        };
        ++result.face_colours[{part(srgb(colour.Red())), part(srgb(colour.Green())),
                               part(srgb(colour.Blue()))}];
      }
    }
  }
  return result;
}

}  // namespace

std::optional<OcctCheck> occt_check(const std::filesystem::path& path) {
  return path.extension() == ".igs" ? check<IGESCAFControl_Reader>(path)
                                    : check<STEPCAFControl_Reader>(path);
}

}  // namespace knead::oracle
