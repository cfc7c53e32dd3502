// Points given by angles, and items that are no exact geometry.

#include <cmath>
#include <numbers>

#include "exchange/support.hpp"
#include "knead/exchange/format.hpp"

namespace knead {
namespace {

using testing::bilinear_patch;
using testing::open_or_die;
using testing::parse_or_die;
using testing::step_text;
using testing::unit_square_points;

std::string context(const std::string& angle) {
  return angle +
         "#51=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n"
         "#52=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#51,#50))"
         "REPRESENTATION_CONTEXT('',''))"
         ";"
         "\n#53=SHAPE_REPRESENTATION('',(#10),#52);\n";
}
const std::string radians = "#50=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));\n";
const std::string degrees =
    "#48=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));\n"
    "#49=PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.0174532925199432958),#48);\n"
    "#47=DIMENSIONAL_EXPONENTS(0.,0.,0.,0.,0.,0.,0.);\n"
    "#50=(CONVERSION_BASED_UNIT('DEGREE',#49)NAMED_UNIT(#47)PLANE_ANGLE_UNIT());\n";

std::string points(bool in_degrees) {
  const std::string right = in_degrees ? "90." : "1.5707963267948966";
  return "#1=CARTESIAN_POINT('',(0.,0.,0.));\n#2=CYLINDRICAL_POINT('',*,2.,0.,5.);\n#3=CYLINDRICAL_"
         "POINT('',*,3.," +
         right + ",-1.);\n#4=SPHERICAL_POINT('',*,4.," + right + "," + right + ");\n";
}

TEST(StepPoints, ByAnglesAreRead) {
  for (const bool in_degrees : {false, true}) {
    const auto file = parse_or_die(
        step_text(points(in_degrees) + bilinear_patch() + context(in_degrees ? degrees : radians)));
    ASSERT_EQ(file.surfaces().size(), 1U) << file.model().unreadable[0].reason.message();
    const Points& p = file.surfaces()[0].surface.control_points();
    EXPECT_EQ(Point(p.row(1)), Point(2, 0, 5));
    EXPECT_NEAR((Point(p.row(2)) - Point(0, 3, -1)).norm(), 0, 1e-15 * 3);
    EXPECT_NEAR((Point(p.row(3)) - Point(0, 4, 0)).norm(), 0, 1e-15 * 4);
  }
}

TEST(StepPoints, ByAnglesStayAndGetNewRecordsWhereTheyMove) {
  const std::string text = step_text(points(false) + bilinear_patch() + context(radians));
  const auto file = parse_or_die(text);
  EXPECT_EQ(*file.with_control_points({}), text);
  Points moved = file.surfaces()[0].surface.control_points();
  moved(3, 2) = 0.25;
  const step::Edit edit{"#10", moved};
  const auto written = file.with_control_points({&edit, 1});
  ASSERT_TRUE(written) << written.error().message();
  EXPECT_NE(written->find(points(false)), std::string::npos) << "the old records";
  EXPECT_TRUE(
      testing::same_bits(parse_or_die(*written).surfaces()[0].surface.control_points(), moved));
}

TEST(StepPoints, OfAPlaneStayInTheCurvesOfParameters) {
  const std::string curve =
      "#60=POLAR_POINT('',*,1.,0.5);\n#61=POLAR_POINT('',*,0.,0.);\n"
      "#62=B_SPLINE_CURVE_WITH_KNOTS('',1,(#61,#60),.UNSPECIFIED.,.F.,.F.,(2,2),(0.,1.),."
      "UNSPECIFIED.);\n"
      "#63=(GEOMETRIC_REPRESENTATION_CONTEXT(2)PARAMETRIC_REPRESENTATION_CONTEXT()REPRESENTATION_"
      "CONTEXT('',''));\n"
      "#64=DEFINITIONAL_REPRESENTATION('',(#62),#63);\n#65=PCURVE('',#10,#64);\n";
  const auto source = open_or_die(
      step_text(unit_square_points() + bilinear_patch() + context(radians) + curve), "a.step");
  ASSERT_EQ(source->surfaces().size(), 1U);
  EXPECT_TRUE(source->unreadable().empty());
  Points moved = source->surfaces()[0].surface->control_points();
  moved(3, 2) = 0.25;
  const auto surface = source->surfaces()[0].surface->with_control_points(moved);
  const auto written = source->save(std::vector{std::make_shared<const Surface>(*surface)});
  ASSERT_TRUE(written) << written.error().message();
  EXPECT_NE(written->find(curve), std::string::npos);
  EXPECT_TRUE(testing::same_bits(
      open_or_die(*written, "a.step")->surfaces()[0].surface->control_points(), moved));
}

TEST(StepPoints, OfAPlaneOrOfSeveralUnitsAreErrorsWithARemedy) {
  const auto reason = [](const std::string& data) {
    const auto file = parse_or_die(step_text(data));
    EXPECT_EQ(file.model().unreadable.size(), 1U);
    return file.model().unreadable.empty() ? "" : file.model().unreadable[0].reason.message();
  };
  std::string polar = unit_square_points();
  polar.replace(polar.find("#4="), std::string::npos, "#4=POLAR_POINT('',*,1.,0.5);\n");
  EXPECT_NE(reason(polar + bilinear_patch() + context(radians)).find("a point of a plane"),
            std::string::npos);
  const std::string both =
      context(degrees) +
      "#54=(GLOBAL_UNIT_ASSIGNED_CONTEXT((#48))REPRESENTATION_CONTEXT('',''));\n";
  EXPECT_NE(reason(points(true) + bilinear_patch() + both).find("several units"),
            std::string::npos);
}

}  // namespace
}  // namespace knead
