#include <gtest/gtest.h>

#include "exchange/part21/part21.hpp"
#include "exchange/support.hpp"

namespace knead {
namespace {

using testing::bilinear_patch;
using testing::parse_or_die;
using testing::same_bits;
using testing::step_text;
using testing::unit_square_points;

std::string edited(const std::string& bytes, const std::string& id,
                   const std::function<void(Points&)>& change) {
  const auto file = parse_or_die(bytes);
  step::Edit edit{id, file.model().find_surface(id)->surface.control_points()};
  change(edit.control_points);
  const auto result = file.with_control_points({&edit, 1});
  if (!result) {
    ADD_FAILURE() << result.error().message();
    return {};
  }
  EXPECT_TRUE(same_bits(parse_or_die(*result).model().find_surface(id)->surface.control_points(),
                        edit.control_points));
  return *result;
}

// The text with each first occurrence of a pair's left replaced by its right.
std::string replaced(std::string text,
                     const std::vector<std::pair<std::string, std::string>>& pairs) {
  for (const auto& [from, to] : pairs) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
  }
  return text;
}

const std::string five = "5.0000000000000000E+00";
const std::string six = "6.0000000000000000E+00";

TEST(StepWriter, WithoutChangesTheBytesAreTheInput) {
  const auto bytes = step_text(unit_square_points() + bilinear_patch());
  const auto file = parse_or_die(bytes);
  EXPECT_EQ(*file.with_control_points({}), bytes);
  const step::Edit same{"#10", file.surfaces()[0].surface.control_points()};
  EXPECT_EQ(*file.with_control_points({&same, 1}), bytes);
}

TEST(StepWriter, OnlyTheNumberThatChangesIsRewritten) {
  const auto bytes = step_text(
      "#1 = CARTESIAN_POINT ( 'it''s , (1.)' /* x */ , ( 0.000 , /* y 0. */ 0. ,\r\n 0.E0 ) ) ;\n" +
      unit_square_points().substr(unit_square_points().find('\n') + 1) + bilinear_patch());
  EXPECT_EQ(edited(bytes, "#10", [](Points& p) { p(0, 1) = 5; }),
            replaced(bytes, {{"*/ 0. ,", "*/ " + five + " ,"}}));
}

TEST(StepWriter, ZeroAndMinusZeroAreDifferent) {
  const auto bytes = step_text(unit_square_points() + bilinear_patch());
  EXPECT_EQ(edited(bytes, "#10", [](Points& p) { p(0, 2) = -0.0; }),
            replaced(bytes, {{"(0.,0.,0.)", "(0.,0.,-0.0000000000000000E+00)"}}));
}

TEST(StepWriter, APointUsedElsewhereKeepsItsRecord) {
  const auto bytes =
      step_text(unit_square_points() + bilinear_patch() + "#12=VERTEX_POINT('',#4);\n");
  EXPECT_EQ(
      edited(bytes, "#10", [](Points& p) { p(3, 2) = 5; }),
      replaced(bytes, {{"(#3,#4)", "(#3,#13)"},
                       {".UNSPECIFIED.);\n",
                        ".UNSPECIFIED.);\n#13=CARTESIAN_POINT('',(1.,1.," + five + "));\n"}}));
  // The others are the surface's own.
  EXPECT_EQ(edited(bytes, "#10", [](Points& p) { p(0, 2) = 5; }),
            replaced(bytes, {{"(0.,0.,0.)", "(0.,0.," + five + ")"}}));
}

TEST(StepWriter, ANewRecordKeepsLabelSpacingAndCommentsAndTheLineBreaksOfTheFile) {
  auto bytes = step_text("#1= CARTESIAN_POINT ( 'corner' , (0., 0.,0.) /* here */ ) ;\n" +
                         unit_square_points().substr(unit_square_points().find('\n') + 1) +
                         bilinear_patch() + "#12=VERTEX_POINT('',#1);\n");
  for (std::size_t k = 0; (k = bytes.find('\n', k)) != std::string::npos; k += 2)
    bytes.insert(k, "\r");
  EXPECT_EQ(edited(bytes, "#10", [](Points& p) { p(0, 0) = 5; }),
            replaced(bytes, {{"((#1,", "((#13,"},
                             {".UNSPECIFIED.);\r\n",
                              ".UNSPECIFIED.);\r\n#13=CARTESIAN_POINT ( 'corner' , (" + five +
                                  ", 0.,0.) /* here */ );\r\n"}}));
}

TEST(StepWriter, AFileInOneLineStaysInOneLine) {
  auto bytes = step_text(unit_square_points() + bilinear_patch() + "#12=VERTEX_POINT('',#1);\n");
  std::erase(bytes, '\n');
  const auto result = edited(bytes, "#10", [](Points& p) { p(0, 0) = 5; });
  EXPECT_EQ(result.find('\n'), std::string::npos);
}

TEST(StepWriter, APointOfTwoSurfacesGetsARecordForEachThatMoves) {
  const auto second = replaced(bilinear_patch(), {{"#10", "#11"}});
  const auto bytes = step_text(unit_square_points() + bilinear_patch() + second);
  const auto one = edited(bytes, "#10", [](Points& p) { p(0, 0) = 5; });
  EXPECT_EQ(parse_or_die(one).model().find_surface("#11")->surface.control_points()(0, 0), 0);
  EXPECT_EQ(edited(one, "#10", [](Points& p) { p(0, 0) = 0; }).size(), one.size())
      << "the new record is its own";
  const auto file = parse_or_die(bytes);
  step::Edit edits[] = {{"#10", file.surfaces()[0].surface.control_points()},
                        {"#11", file.surfaces()[1].surface.control_points()}};
  edits[0].control_points(0, 0) = 5;
  edits[1].control_points(0, 0) = 6;
  const auto both = file.with_control_points(edits);
  ASSERT_TRUE(both);
  EXPECT_EQ(parse_or_die(*both).surfaces()[0].surface.control_points()(0, 0), 5);
  EXPECT_EQ(parse_or_die(*both).surfaces()[1].surface.control_points()(0, 0), 6);
}

// A seam: the first and the last row of the net are the same points.
const std::string seam = unit_square_points() +
                         "#10=B_SPLINE_SURFACE_WITH_KNOTS('',1,1,((#1,#2),(#3,#4),(#1,#2)),."
                         "UNSPECIFIED.,.T.,.F.,.F.,(2,1,2),(2,2),"
                         "(0.,1.,2.),(0.,1.),.UNSPECIFIED.);\n";

TEST(StepWriter, ReferencesSharedWithinTheSurfaceStaySharedWhileTheyAgree) {
  const auto bytes = step_text(seam);
  EXPECT_EQ(edited(bytes, "#10", [](Points& p) { p(0, 2) = p(4, 2) = 5; }),
            replaced(bytes, {{"(0.,0.,0.)", "(0.,0.," + five + ")"}}));
}

TEST(StepWriter, ReferencesSharedWithinTheSurfaceAreSplitWhereTheyDiffer) {
  const auto bytes = step_text(seam);
  // One stays where it was and keeps the record.
  EXPECT_EQ(
      edited(bytes, "#10", [](Points& p) { p(0, 2) = 5; }),
      replaced(bytes, {{"((#1,", "((#11,"},
                       {".UNSPECIFIED.);\n",
                        ".UNSPECIFIED.);\n#11=CARTESIAN_POINT('',(0.,0.," + five + "));\n"}}));
  // Both move apart: the first takes the record along.
  EXPECT_EQ(edited(bytes, "#10",
                   [](Points& p) {
                     p(0, 2) = 5;
                     p(4, 2) = 6;
                   }),
            replaced(bytes, {{"(0.,0.,0.)", "(0.,0.," + five + ")"},
                             {"(#1,#2)),", "(#11,#2)),"},
                             {".UNSPECIFIED.);\n",
                              ".UNSPECIFIED.);\n#11=CARTESIAN_POINT('',(0.,0.," + six + "));\n"}}));
}

TEST(StepWriter, APoleOpensIntoAsManyRecordsAsItHasPositions) {
  const auto bytes = step_text(
      unit_square_points() + "#9=VERTEX_POINT('',#1);\n" +
      "#10=BEZIER_SURFACE('',1,3,((#1,#1,#1,#1),(#2,#3,#4,#2)),.UNSPECIFIED.,.F.,.T.,.F.);\n");
  const auto together = edited(bytes, "#10", [](Points& p) { p.topRows(4).col(2).setConstant(5); });
  EXPECT_NE(together.find("((#11,#11,#11,#11),"), std::string::npos);
  const auto apart = edited(bytes, "#10", [](Points& p) {
    p(0, 2) = p(2, 2) = 5;
    p(1, 2) = 6;
  });
  EXPECT_NE(apart.find("((#11,#12,#11,#1),"), std::string::npos);
}

TEST(StepWriter, ComplexInstancesAreRewrittenInPlace) {
  const auto bytes = step_text(
      "#1=(CARTESIAN_POINT((0.,0.,0.))GEOMETRIC_REPRESENTATION_ITEM()POINT()REPRESENTATION_ITEM('p'"
      "));\n" +
      unit_square_points().substr(unit_square_points().find('\n') + 1) +
      "#10=(BOUNDED_SURFACE()B_SPLINE_SURFACE(1,1,((#1,#2),(#3,#4)),.UNSPECIFIED.,.F.,.F.,.F.)"
      "BEZIER_SURFACE()"
      "GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(((1.,1.),(1.,1.)))REPRESENTATION_"
      "ITEM('')SURFACE());\n#"
      "12=VERTEX_POINT('',#4);\n");
  EXPECT_EQ(edited(bytes, "#10", [](Points& p) { p(0, 2) = 5; }),
            replaced(bytes, {{"((0.,0.,0.))", "((0.,0.," + five + "))"}}));
  EXPECT_EQ(edited(bytes, "#10", [](Points& p) { p(3, 0) = 5; }),
            replaced(bytes, {{"(#3,#4)", "(#3,#13)"},
                             {"SURFACE());\n",
                              "SURFACE());\n#13=CARTESIAN_POINT('',(" + five + ",1.,0.));\n"}}));
}

TEST(StepWriter, InAScopeTheNewRecordStandsInTheScopeOfTheSurface) {
  const auto bytes =
      step_text("#20=&SCOPE\n" + unit_square_points() + bilinear_patch() +
                "#12=VERTEX_POINT('',#1);\nENDSCOPE /#10/\nHOLDER(#10);\n#30=OTHER(#20,#10);\n");
  const auto result = edited(bytes, "#10", [](Points& p) {
    p(0, 2) = 5;
    p(1, 2) = 6;
  });
  EXPECT_EQ(
      result,
      replaced(bytes, {{"(0.,1.,0.)", "(0.,1.," + six + ")"},
                       {"((#1,", "((#31,"},
                       {".UNSPECIFIED.);\n",
                        ".UNSPECIFIED.);\n#31=CARTESIAN_POINT('',(0.,0.," + five + "));\n"}}));
  const auto parsed = Part21File::parse(result, "");
  EXPECT_EQ(parsed->instance(*parsed->find(31)).scope, *parsed->find(20));
}

TEST(StepWriter, NewNamesStayBelowWhatReadersUnderstandWhereTheyCan) {
  const auto bytes = step_text(unit_square_points() + bilinear_patch() +
                               "#2147483647=VERTEX_POINT('',#1);\n#5=B();\n");
  EXPECT_NE(edited(bytes, "#10", [](Points& p) { p(0, 0) = 5; }).find("#6=CARTESIAN_POINT"),
            std::string::npos);
  const auto far = step_text(unit_square_points() + bilinear_patch() + "#7=VERTEX_POINT('',#1);\n");
  EXPECT_NE(edited(far, "#10", [](Points& p) { p(0, 0) = 5; }).find("#11=CARTESIAN_POINT"),
            std::string::npos);
}

TEST(StepWriter, AnAnchorCountsAsAReference) {
  auto bytes = step_text(unit_square_points() + bilinear_patch());
  bytes.insert(bytes.find("DATA;"), "ANCHOR;\n<corner>=#1;\nENDSEC;\n");
  EXPECT_NE(edited(bytes, "#10", [](Points& p) { p(0, 0) = 5; }).find("((#11,"), std::string::npos);
}

TEST(StepWriter, WrongEditsAreErrors) {
  const auto file = parse_or_die(step_text(unit_square_points() + bilinear_patch()));
  const auto points = file.surfaces()[0].surface.control_points();
  const auto what = [&](std::vector<step::Edit> edits) {
    const auto result = file.with_control_points(edits);
    EXPECT_FALSE(result);
    EXPECT_EQ(result.error().kind, ErrorKind::input);
    return result.error().message();
  };
  EXPECT_NE(what({{"#99", points}}).find("#99"), std::string::npos);
  EXPECT_NE(what({{"#10", points}, {"#10", points}}).find("twice"), std::string::npos);
  EXPECT_NE(what({{"#10", Points(points.topRows(3))}}).find("#10"), std::string::npos);
  auto infinite = points;
  infinite(1, 1) = std::numeric_limits<double>::infinity();
  EXPECT_NE(what({{"#10", infinite}}).find("finite"), std::string::npos);
}

}  // namespace
}  // namespace knead
