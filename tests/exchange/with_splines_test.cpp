#include <algorithm>

#include "brep/shared_edge.hpp"
#include "exchange/step/conversion.hpp"
#include "exchange/two_sheets.hpp"
#include "knead/brep/face_conversion.hpp"

namespace knead::step {
namespace {

using namespace brep;  // NOLINT: what is tested
using testing::parse_or_die;

// The edge is closed to rounding.
constexpr double exact = 1e-14;

TEST(WithSplines, TheRecordKeepsItsNameAndAllElseItsBytes) {
  const testing::TwoSheets sheets = testing::two_sheets(false, true);
  const File file = parse_or_die(sheets.text);
  ASSERT_EQ(other_surfaces(file.model()).size(), 1U);
  EXPECT_EQ(other_surfaces(file.model())[0].id, "#20");
  EXPECT_EQ(other_surfaces(file.model())[0].form, "PLANE");
  const std::string by_face = testing::TwoSheets::name(sheets.faces[1]);
  const auto after = with_splines(file, {&by_face, 1});
  ASSERT_TRUE(after) << after.error().message();
  EXPECT_TRUE(other_surfaces(after->model()).empty());
  const std::string &before = file.bytes(), &now = after->bytes();
  const std::size_t at = before.find("PLANE(");
  EXPECT_EQ(now.substr(0, at), before.substr(0, at));
  const std::string rest = before.substr(before.find(";\n", at) + 1);
  EXPECT_EQ(now.substr(now.size() - rest.size()), rest);
  ASSERT_EQ(after->surfaces().size(), 2U);
  EXPECT_EQ(after->model().find_surface("#20")->faces, 1);
  const auto edge = SharedEdge::create(after->model(), testing::TwoSheets::name(sheets.edge));
  ASSERT_TRUE(edge) << edge.error().message();
  EXPECT_LE(edge->gap(), exact * 2);
  EXPECT_LE(edge->angle(), 1e-9);
}

TEST(WithSplines, ParameterCurvesOnTheSurfaceAreDropped) {
  // The edge of both faces has a PCURVE on each, and another surface trims the plane.
  testing::TwoSheets sheets = testing::two_sheets(false, true);
  std::string text = sheets.text;
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  const auto curve_of = [&](int edge) {
    const std::string record = text.substr(text.find("#" + std::to_string(edge) + "=EDGE_CURVE("));
    const std::size_t last = record.find(",.T.);");
    const std::size_t begin = record.rfind(',', last - 1) + 1;
    return record.substr(begin, last - begin);
  };
  const std::string shared = curve_of(sheets.edge);
  replace("," + shared + ",.T.);", ",#50,.T.);");
  replace("ENDSEC;\nEND-ISO",
          "#50=INTERSECTION_CURVE(''," + shared +
              ",(#51,#52),.PCURVE_S2.);\n#51=PCURVE('',#10,#60);\n#52=PCURVE('',#20,#60);\n"
              "#60=DEFINITIONAL_REPRESENTATION('',(),#61);\n#61=REPRESENTATION_CONTEXT('','');\n"
              "#62=OFFSET_SURFACE('',#20,0.1,.F.);\nENDSEC;\nEND-ISO");
  const File file = parse_or_die(text);
  const std::string id = "#20";
  const auto after = with_splines(file, {&id, 1});
  ASSERT_TRUE(after) << after.error().message();
  const std::string& now = after->bytes();
  EXPECT_NE(now.find("#50=SURFACE_CURVE(''," + shared + ",(#51),.CURVE_3D.);"), std::string::npos)
      << now;
  const std::size_t copy = now.find("=PLANE(");
  ASSERT_NE(copy, std::string::npos);
  const std::size_t begin = now.rfind('#', copy);
  const std::string old = now.substr(begin, copy - begin);
  EXPECT_NE(now.find("#52=PCURVE(''," + old + ",#60);"), std::string::npos) << now;
  EXPECT_NE(now.find("#62=OFFSET_SURFACE(''," + old + ",0.1,.F.);"), std::string::npos) << now;
  EXPECT_NE(now.find("#20=B_SPLINE_SURFACE_WITH_KNOTS("), std::string::npos);
}

}  // namespace
}  // namespace knead::step
