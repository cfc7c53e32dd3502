#include <gtest/gtest.h>

#include "exchange/support.hpp"

namespace knead {
namespace {

using testing::bilinear_patch;
using testing::parse_or_die;
using testing::step_text;
using testing::unit_square_points;

std::string context(int id, int unit) {
  return "#" + std::to_string(id) +
         "=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#" +
         std::to_string(unit) + "))REPRESENTATION_CONTEXT('',''));\n";
}
const std::string millimetre = "#31=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n";
const std::string inch =
    "#32=(CONVERSION_BASED_UNIT('INCH',#33)LENGTH_UNIT()NAMED_UNIT(#34));\n"
    "#33=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#31);\n#34=DIMENSIONAL_EXPONENTS(1.,0.,0.,0."
    ",0.,0.,0.);\n";

TEST(StepUnits, AreReadAndReported) {
  const auto mm = parse_or_die(step_text(millimetre + context(40, 31)));
  EXPECT_EQ(mm.model().length_unit(), "mm");
  ASSERT_EQ(mm.model().units.size(), 1U);
  EXPECT_EQ(mm.model().units[0].context, "#40");
  EXPECT_EQ(mm.model().units[0].metres, 1e-3);
  const auto inches = parse_or_die(step_text(millimetre + inch + context(40, 32)));
  EXPECT_EQ(inches.model().length_unit(), "inch");
  EXPECT_DOUBLE_EQ(inches.model().units[0].metres, 0.0254);
  EXPECT_EQ(parse_or_die(step_text("#31=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.));\n" +
                                   context(40, 31)))
                .model()
                .length_unit(),
            "m");
  EXPECT_EQ(parse_or_die(step_text("#31=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));\n" +
                                   context(40, 31)))
                .model()
                .length_unit(),
            "unknown");
  EXPECT_EQ(parse_or_die(step_text("#1=A();\n")).model().length_unit(), "unknown");
}

/// The unit of a file whose unit is called `name` and is `factor` millimetres long.
std::string unit_called(const std::string& name, const std::string& factor) {
  return parse_or_die(step_text(millimetre + "#32=(CONVERSION_BASED_UNIT('" + name +
                                "',#33)LENGTH_UNIT()NAMED_UNIT(#34));\n#33=LENGTH_MEASURE_WITH_"
                                "UNIT(LENGTH_MEASURE(" +
                                factor +
                                "),#31);\n#34=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n" +
                                context(40, 32)))
      .model()
      .length_unit();
}

TEST(StepUnits, AreThoseOfTheirLengthWhateverTheirName) {
  EXPECT_EQ(unit_called("METRE", "1000."), "m");
  EXPECT_EQ(unit_called("Millimeter", "1."), "mm");
  EXPECT_EQ(unit_called("IN", "25.400000000000002"), "inch");
  EXPECT_EQ(unit_called("INCH", "304.8"), "foot");
  EXPECT_EQ(unit_called("thou", "2.54E-2"), "mil");
  EXPECT_EQ(unit_called("US SURVEY FOOT", "304.8006096012192"), "us survey foot");
}

TEST(StepUnits, ColoursAndViewsSayNothingOfLengths) {
  const auto file = parse_or_die(
      step_text(millimetre + inch + context(40, 31) + context(41, 32) + unit_square_points() +
                bilinear_patch() +
                "#50=SHAPE_REPRESENTATION('',(#10),#41);\n#60=STYLED_ITEM('',(),#10);\n"
                "#61=MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#60),#40);\n"
                "#62=DRAUGHTING_MODEL('',(#60),#40);\n"));
  EXPECT_EQ(file.model().length_unit(), "inch");
  EXPECT_EQ(file.surfaces()[0].unit, "inch");
}

TEST(StepUnits, OfWhatOnlyAStyleRefersToAreTheUnitsOfTheFile) {
  const auto file = parse_or_die(
      step_text(millimetre + context(40, 31) + unit_square_points() + bilinear_patch() +
                "#60=STYLED_ITEM('',(),#10);\n"
                "#61=MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#60),#40);\n"));
  EXPECT_EQ(file.surfaces()[0].unit, "mm");
}

TEST(StepUnits, AUnitDefinedByItselfIsNoCrash) {
  const auto file = parse_or_die(step_text(
      "#32=(CONVERSION_BASED_UNIT('LOOP',#33)LENGTH_UNIT()NAMED_UNIT(#34));\n"
      "#33=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(2.),#32);\n#34=DIMENSIONAL_EXPONENTS();\n" +
      context(40, 32)));
  EXPECT_EQ(file.model().length_unit(), "loop");
  EXPECT_EQ(file.model().units[0].metres, 0);
}

TEST(StepUnits, EachSurfaceHasTheUnitOfItsRepresentation) {
  const auto patch = [](int id) {
    auto text = bilinear_patch();
    return text.replace(0, 3, "#" + std::to_string(id));
  };
  const auto file = parse_or_die(
      step_text(millimetre + inch + context(40, 31) + context(41, 32) + unit_square_points() +
                patch(10) + patch(11) + patch(12) + patch(13) +
                "#50=SHAPE_REPRESENTATION('',(#51),#40);\n#51=GEOMETRIC_SET('',(#10,#12));"
                "\n#52=SHAPE_REPRESENTATION('',(#11,#12),#41);\n"));
  ASSERT_EQ(file.surfaces().size(), 4U);
  EXPECT_EQ(file.model().length_unit(), "mm, inch");
  EXPECT_EQ(file.model().find_surface("#10")->unit, "mm");
  EXPECT_EQ(file.model().find_surface("#11")->unit, "inch");
  EXPECT_EQ(file.model().find_surface("#12")->unit, "unknown")
      << "it stands in representations of both";
  EXPECT_EQ(file.model().find_surface("#13")->unit, "unknown") << "it stands in none";
  EXPECT_EQ(file.model().find_surface("#99"), nullptr);
}

TEST(StepUnits, OfForeignFiles) {
  const std::pair<const char*, const char*> known[] = {
      {"as1-oc-214.stp", "mm"}, {"NIST_MBE_PMI_5.stp", "inch"}, {"vsp.stp", "foot"},
      {"goteborg.step", "m"},   {"dm1-id-214.stp", "inch"},     {"MAINBODY_BACK.stp", "inch"},
      {"linkrods.step", "mm"}};
  for (const auto& [name, unit] : known) {
    KNEAD_NEEDS(testing::foreign_cad(name));
    const auto file = step::File::read(testing::foreign_cad(name));
    ASSERT_TRUE(file) << file.error().message();
    EXPECT_EQ(file->model().length_unit(), unit) << name;
    for (const auto& surface : file->surfaces())
      EXPECT_EQ(surface.unit, unit) << name << surface.id;
  }
}

const std::string placements =
    "#60=CARTESIAN_POINT('',(1.,2.,3.));\n#61=DIRECTION('',(0.,2.,0.));\n#62=DIRECTION('',(0.,0.,1."
    "));\n"
    "#63=AXIS2_PLACEMENT_3D('',#60,#61,#62);\n#64=CARTESIAN_POINT('',(0.,0.,0.));\n#65=AXIS2_"
    "PLACEMENT_3D('',#64,$,$);"
    "\n";

std::string assembly(const std::string& representations) {
  return placements +
         "#70=PRODUCT('car','the car','',());\n#71=PRODUCT('door','',$,());\n"
         "#72=PRODUCT_DEFINITION_FORMATION('','',#70);\n#73=PRODUCT_DEFINITION_FORMATION_WITH_"
         "SPECIFIED_SOURCE('','',#"
         "71,.MADE.);\n"
         "#74=PRODUCT_DEFINITION('','',#72,$);\n#75=PRODUCT_DEFINITION('','',#73,$);\n"
         "#76=NEXT_ASSEMBLY_USAGE_OCCURRENCE('u1','left "
         "door','',#74,#75,$);\n#77=PRODUCT_DEFINITION_SHAPE('','',#76);\n"
         "#80=SHAPE_REPRESENTATION('car',(#63),$);\n#81=SHAPE_REPRESENTATION('door',(#65),$);\n"
         "#82=PRODUCT_DEFINITION_SHAPE('','',#74);\n#83=SHAPE_DEFINITION_REPRESENTATION(#82,#80);\n"
         "#84=PRODUCT_DEFINITION_SHAPE('','',#75);\n#85=SHAPE_DEFINITION_REPRESENTATION(#84,#81);"
         "\n" +
         representations + "#92=CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#91,#77);\n";
}

TEST(StepInstances, PlaceAComponentInItsAssembly) {
  // The convention, and the other way round, as some writers have it.
  for (const auto* relation : {"#90=ITEM_DEFINED_TRANSFORMATION('','',#65,#63);\n#91=("
                               "REPRESENTATION_RELATIONSHIP('','',#81,#80)",
                               "#90=ITEM_DEFINED_TRANSFORMATION('','',#63,#65);\n#91=("
                               "REPRESENTATION_RELATIONSHIP('','',#80,#81)"}) {
    const auto file = parse_or_die(step_text(
        assembly(std::string(relation) + "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#90)"
                                         "SHAPE_REPRESENTATION_RELATIONSHIP());\n")));
    ASSERT_EQ(file.model().instances.size(), 1U);
    const auto& instance = file.model().instances[0];
    EXPECT_EQ(instance.id, "#76");
    EXPECT_EQ(instance.name, "left door");
    EXPECT_EQ(instance.parent, "the car");
    EXPECT_EQ(instance.child, "door");
    ASSERT_TRUE(instance.placement);
    EXPECT_EQ(instance.placement->origin, Point(1, 2, 3));
    EXPECT_EQ(instance.placement->axis, Point(0, 2, 0)) << "as given, not normalised";
    EXPECT_EQ(instance.placement->ref_direction, Point(0, 0, 1));
    ASSERT_TRUE(instance.frame);
    EXPECT_EQ(instance.frame->origin, Point(0, 0, 0));
    EXPECT_EQ(instance.frame->axis, Point(0, 0, 1));
    EXPECT_EQ(instance.frame->ref_direction, Point(1, 0, 0));
  }
}

TEST(StepInstances, MappedItemsPlaceARepresentation) {
  const auto file = parse_or_die(
      step_text(assembly("#91=A();\n") +
                "#95=REPRESENTATION_MAP(#65,#81);\n#96=MAPPED_ITEM('copy',#95,#63);\n"));
  ASSERT_EQ(file.model().instances.size(), 2U);
  EXPECT_FALSE(file.model().instances[0].placement) << "#91 is no transformation";
  EXPECT_EQ(file.model().instances[1].name, "copy");
  EXPECT_EQ(file.model().instances[1].child, "door");
  EXPECT_EQ(file.model().instances[1].parent, "") << "no representation holds it";
  EXPECT_EQ(file.model().instances[1].placement->origin, Point(1, 2, 3));
  const auto held = parse_or_die(step_text(
      placements +
      "#31=CTX();\n#80=SHAPE_REPRESENTATION('',(#96),#31);\n#81=SHAPE_REPRESENTATION('',(#65),#31);"
      "\n"
      "#70=PRODUCT('car','','',());\n#72=PRODUCT_DEFINITION_FORMATION('','',#70);\n#74=PRODUCT_"
      "DEFINITION('','',#72,$);\n"
      "#82=PRODUCT_DEFINITION_SHAPE('','',#74);\n#83=SHAPE_DEFINITION_REPRESENTATION(#82,#80);\n"
      "#95=REPRESENTATION_MAP(#65,#81);\n#96=MAPPED_ITEM('copy',#95,#63);\n"));
  ASSERT_EQ(held.model().instances.size(), 1U);
  EXPECT_EQ(held.model().instances[0].parent, "car");
}

TEST(StepInstances, OfAForeignFile) {
  const auto path = testing::foreign_cad("as1-oc-214.stp");
  KNEAD_NEEDS(path);
  const auto file = step::File::read(path);
  ASSERT_TRUE(file);
  ASSERT_EQ(file->model().instances.size(), 13U);
  const auto found = std::find_if(
      file->model().instances.begin(), file->model().instances.end(),
      [](const brep::Instance& instance) { return instance.name == "l-bracket-assembly_2"; });
  ASSERT_NE(found, file->model().instances.end());
  EXPECT_EQ(found->parent, "as1");
  EXPECT_EQ(found->child, "l-bracket-assembly");
  EXPECT_EQ(found->placement->origin, Point(175, 25, 20));
}

}  // namespace
}  // namespace knead
