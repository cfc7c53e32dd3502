#include "oracle/occt_curves.hpp"

#include <BRep_Tool.hxx>
#include <Geom_BSplineCurve.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <optional>

namespace knead::oracle {
namespace {

std::optional<Curve> curve_of(const Handle(Geom_BSplineCurve) & spline) {
  Points points(spline->NbPoles(), 3);
  std::vector<double> weights, knots;
  for (int k = 1; k <= spline->NbPoles(); ++k) {
    const gp_Pnt p = spline->Pole(k);
    points.row(k - 1) << p.X(), p.Y(), p.Z();
    if (spline->IsRational()) weights.push_back(spline->Weight(k));
  }
  for (int k = 1; k <= spline->NbKnots(); ++k) {
    knots.insert(knots.end(), static_cast<std::size_t>(spline->Multiplicity(k)), spline->Knot(k));
  }
  auto vector = KnotVector::create(spline->Degree(), std::move(knots));
  if (!vector) return std::nullopt;
  auto curve = Curve::create({*std::move(vector)}, std::move(points), std::move(weights));
  return curve ? std::optional(*std::move(curve)) : std::nullopt;
}

}  // namespace

OcctCurves occt_curves(const std::filesystem::path& path) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  OcctCurves result;
  STEPControl_Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return result;
  reader.TransferRoots();
  const auto check = reader.WS()->TransferReader()->TransientProcess()->CheckList(Standard_False);
  for (check.Start(); check.More(); check.Next())
    result.warnings += check.Value()->NbWarnings() + check.Value()->NbFails();
  const TopoDS_Shape shape = reader.OneShape();
  if (shape.IsNull()) return result;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) ++result.faces;
  for (TopExp_Explorer at(shape, TopAbs_EDGE, TopAbs_FACE); at.More(); at.Next()) {
    double first = 0, last = 0;
    auto spline = Handle(Geom_BSplineCurve)::DownCast(
        BRep_Tool::Curve(TopoDS::Edge(at.Current()), first, last));
    if (spline.IsNull()) continue;
    if (spline->IsPeriodic()) spline->SetNotPeriodic();  // what it makes of curves that are closed
    if (auto curve = curve_of(spline)) result.curves.push_back(*std::move(curve));
  }
  return result;
}

}  // namespace knead::oracle
