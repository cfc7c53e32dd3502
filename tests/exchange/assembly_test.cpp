#include "knead/brep/model.hpp"

#include <fmt/format.h>

#include "brep/tessellation/model_mesh.hpp"
#include "exchange/mesh_measures.hpp"
#include "exchange/support.hpp"

namespace knead::step {
namespace {

using testing::bilinear_patch;
using testing::parse_or_die;
using testing::step_text;
using testing::unit_square_points;

/// Millimetres #40 and inches #41; the unit square #10; frames #60 at the origin, #61 at (5, 0, 0)
/// with z along x and x along y, #62 at (0, 0, 7).
std::string ground() {
  return "#31=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n"
         "#32=(CONVERSION_BASED_UNIT('INCH',#33)LENGTH_UNIT()NAMED_UNIT(#34));\n"
         "#33=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#31);\n#34=DIMENSIONAL_EXPONENTS(1.,0.,"
         "0.,0.,0.,0.,0.);\n"
         "#40=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#31))"
         "REPRESENTATION_CONTEXT('',''));\n"
         "#41=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#32))"
         "REPRESENTATION_CONTEXT('',''));"
         "\n" +
         unit_square_points() + bilinear_patch() +
         "#50=CARTESIAN_POINT('',(5.,0.,0.));\n#51=CARTESIAN_POINT('',(0.,0.,7.));\n#52=DIRECTION('"
         "',(1.,0.,0.));\n"
         "#53=DIRECTION('',(0.,1.,0.));\n#54=DIRECTION('',(0.,0.,1.));\n#55=DIRECTION('',(0.,0.,-1."
         "));\n"
         "#60=AXIS2_PLACEMENT_3D('',#1,$,$);\n#61=AXIS2_PLACEMENT_3D('',#50,#52,#53);\n"
         "#62=AXIS2_PLACEMENT_3D('',#51,$,$);\n";
}

/// A product with a representation #id+4 of these items, in a context.
std::string product(int id, const std::string& name, const std::string& items, int context = 40) {
  return fmt::format(
      "#{0}=PRODUCT('{5}','{5}','',());\n#{1}=PRODUCT_DEFINITION_FORMATION('','',#{0});\n"
      "#{2}=PRODUCT_DEFINITION('','',#{1},$);\n#{3}=PRODUCT_DEFINITION_SHAPE('','',#{2});\n"
      "#{4}=SHAPE_REPRESENTATION('',({6}),#{7});\n#{8}=SHAPE_DEFINITION_REPRESENTATION(#{3},#{4});"
      "\n",
      id, id + 1, id + 2, id + 3, id + 4, name, items, context, id + 5);
}

/// The child (a product's first id) in the parent: its frame `from` on the parent's `to`; `turned`:
/// rep_1 is the parent.
std::string usage(int id, int parent, int child, int from, int to, bool turned = false) {
  const int rep_1 = (turned ? parent : child) + 4, rep_2 = (turned ? child : parent) + 4;
  return fmt::format(
      "#{0}=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','','',#{1},#{2},$);\n#{3}=PRODUCT_DEFINITION_SHAPE(''"
      ",'',#{0});\n"
      "#{4}=ITEM_DEFINED_TRANSFORMATION('','',#{5},#{6});\n"
      "#{7}=(REPRESENTATION_RELATIONSHIP('','',#{8},#{9})REPRESENTATION_RELATIONSHIP_WITH_"
      "TRANSFORMATION(#{4})"
      "SHAPE_REPRESENTATION_RELATIONSHIP());\n#{10}=CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{7},#{"
      "3});\n",
      id, parent + 2, child + 2, id + 1, id + 2, turned ? to : from, turned ? from : to, id + 3,
      rep_1, rep_2, id + 4);
}

brep::Assembly assembly(const std::string& data) {
  auto result = parse_or_die(step_text(ground() + data)).model().assembly;
  if (!result) {
    ADD_FAILURE() << result.error().message();
    return {};
  }
  return *std::move(result);
}

void expect_point(const brep::PartPlace& place, const Point& from, const Point& to) {
  EXPECT_LT((place.to_model * from - to).norm(), 1e-14 * (1 + to.norm())) << place.path;
}

TEST(Assembly, APartIsWhereItsUsagesPutIt) {
  for (const bool turned : {false, true}) {
    const auto model =
        assembly(product(100, "car", "#60") + product(200, "door", "#10,#60") +
                 usage(300, 100, 200, 60, 61, turned) + usage(320, 100, 200, 60, 62, turned));
    EXPECT_EQ(model.unit, "mm");
    ASSERT_EQ(model.parts.size(), 1U);
    const brep::Part& door = model.parts[0];
    EXPECT_EQ(door.name, "door");
    EXPECT_EQ(door.surfaces, std::vector<std::string>{"#10"});
    ASSERT_EQ(door.places.size(), 2U);
    EXPECT_EQ(door.places[0].path, "car/door");
    // z of the part is along x of the model, its x along y, and so its y along z.
    expect_point(door.places[0], Point(1, 2, 3), Point(5 + 3, 1, 2));
    expect_point(door.places[1], Point(1, 2, 3), Point(1, 2, 10));
    EXPECT_TRUE(model.placed());
    EXPECT_EQ(model.part_of("#10"), &door);
    EXPECT_TRUE(model.warnings.empty());
  }
}

TEST(Assembly, PlacesAreMultipliedDownTheTree) {
  const auto model = assembly(product(100, "car", "#60") + product(200, "door", "#60") +
                              product(400, "hinge", "#10") + usage(300, 100, 200, 60, 61) +
                              usage(320, 100, 200, 60, 62) + usage(500, 200, 400, 62, 60) +
                              usage(520, 200, 400, 60, 60));
  ASSERT_EQ(model.parts.size(), 1U);
  ASSERT_EQ(model.parts[0].places.size(), 4U);
  EXPECT_EQ(model.parts[0].places[0].path, "car/door/hinge");
  expect_point(model.parts[0].places[0], Point(1, 2, 3), Point(5 + 3 - 7, 1, 2));
  expect_point(model.parts[0].places[3], Point(1, 2, 3), Point(1, 2, 10));
}

TEST(Assembly, LengthsAreConvertedFromContextToContext) {
  const auto model = assembly(product(100, "car", "#60") + product(200, "door", "#10", 41) +
                              usage(300, 100, 200, 60, 62));
  EXPECT_EQ(model.unit, "mm");
  EXPECT_EQ(model.parts[0].unit, "inch");
  expect_point(model.parts[0].places[0], Point(1, 0, 0), Point(25.4, 0, 7));
}

TEST(Assembly, GeometryIsFoundThroughRelatedRepresentations) {
  const auto model =
      assembly(product(100, "car", "#60") + product(200, "door", "#60") +
               "#250=GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION('',(#10),#40);\n"
               "#251=SHAPE_REPRESENTATION_RELATIONSHIP('','',#204,#250);\n" +
               usage(300, 100, 200, 60, 62));
  ASSERT_EQ(model.parts.size(), 1U);
  EXPECT_EQ(model.parts[0].name, "door");
  expect_point(model.parts[0].places[0], Point(1, 2, 3), Point(1, 2, 10));
}

TEST(Assembly, StylesAndViewsPlaceNothing) {
  const auto model = assembly(
      product(100, "car", "#60") + product(200, "door", "#10") + usage(300, 100, 200, 60, 62) +
      "#400=STYLED_ITEM('',(),#10);\n"
      "#401=MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#400),#40);\n"
      "#402=REPRESENTATION_MAP(#60,#104);\n#403=MAPPED_ITEM('',#402,#61);\n"
      "#404=DRAUGHTING_MODEL('',(#403),#40);\n");
  ASSERT_EQ(model.parts.size(), 1U);
  EXPECT_EQ(model.parts[0].places.size(), 1U);
}

TEST(Assembly, AColouredMappedItemStandsWhereItIsWhicheverIsNamedFirst) {
  for (const int style : {399, 450}) {
    const auto model = assembly(
        product(100, "car", "#403,#404") + fmt::format("#{}=STYLED_ITEM('',(#60),#403);\n", style) +
        "#401=SHAPE_REPRESENTATION('',(#10),#40);\n#402=REPRESENTATION_MAP(#60,#401);\n"
        "#403=MAPPED_ITEM('',#402,#62);\n#404=MAPPED_ITEM('',#402,#61);\n");
    ASSERT_EQ(model.parts.size(), 1U);
    EXPECT_EQ(model.parts[0].places.size(), 2U) << style;
  }
}

TEST(Assembly, MappedItemsMayScaleAndMirror) {
  const auto model =
      assembly(product(100, "car", "#403,#404") +
               "#401=SHAPE_REPRESENTATION('',(#10),#40);\n#402=REPRESENTATION_MAP(#60,#401);\n"
               "#403=MAPPED_ITEM('',#402,#62);\n#404=MAPPED_ITEM('',#402,#405);\n"
               "#405=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','','',#52,#53,#50,2.,#55);\n");
  ASSERT_EQ(model.parts.size(), 1U);
  ASSERT_EQ(model.parts[0].places.size(), 2U);
  expect_point(model.parts[0].places[0], Point(1, 2, 3), Point(1, 2, 10));
  expect_point(model.parts[0].places[1], Point(1, 2, 3), Point(5 + 2, 4, -6));
}

TEST(Assembly, WhatBelongsToNoProductStandsAtItsCoordinates) {
  const auto model = assembly("");
  ASSERT_EQ(model.parts.size(), 1U);
  EXPECT_EQ(model.parts[0].surfaces.size(), 1U);
  EXPECT_FALSE(model.placed());
}

TEST(Assembly, WhatCannotBeFollowedIsSaid) {
  const auto open = assembly(product(100, "car", "#60") + product(200, "door", "#10") +
                             "#300=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','','',#102,#202,$);\n");
  ASSERT_EQ(open.warnings.size(), 1U);
  EXPECT_NE(open.warnings[0].find("#300: \"door\" has no placement"), std::string::npos)
      << open.warnings[0];
  expect_point(open.parts[0].places[0], Point(1, 2, 3), Point(1, 2, 3));

  const auto circle = assembly(product(100, "car", "#60") + product(200, "door", "#10") +
                               usage(300, 100, 200, 60, 62) + usage(320, 200, 100, 60, 62));
  ASSERT_EQ(circle.warnings.size(), 1U);
  EXPECT_NE(circle.warnings[0].find("contains itself"), std::string::npos);
  ASSERT_EQ(circle.parts.size(), 1U);
}

TEST(Assembly, TheNumberOfPlacesIsLimited) {
  std::string data = product(1000, "part", "#10");
  for (int k = 0; k < 40; ++k) {  // 2^40 places
    const int parent = 2000 + 100 * k, child = k == 0 ? 1000 : parent - 100;
    data += product(parent, "level", "#60") + usage(parent + 10, parent, child, 60, 62) +
            usage(parent + 20, parent, child, 60, 61);
  }
  const auto model = parse_or_die(step_text(ground() + data)).model().assembly;
  ASSERT_FALSE(model);
  EXPECT_NE(model.error().message().find("more than 100000 places"), std::string::npos)
      << model.error().message();
}

TEST(Assembly, CurvesBelongToTheirParts) {
  const auto curve = [](int id) {
    return fmt::format(
        "#{}=B_SPLINE_CURVE_WITH_KNOTS('',1,(#1,#2),.UNSPECIFIED.,.F.,.F.,(2,2),(0.,1.),."
        "UNSPECIFIED.);\n",
        id);
  };
  const brep::Assembly model = assembly(
      curve(70) + curve(71) + curve(72) + "#73=GEOMETRIC_CURVE_SET('',(#71,#70));\n" +
      "#74=GEOMETRIC_CURVE_SET('',(#72));\n" + product(100, "root", "#60") +
      product(110, "wire", "#60,#73") + product(120, "plate", "#60,#10") +
      usage(200, 100, 110, 60, 61) + usage(210, 100, 110, 60, 62) + usage(220, 100, 120, 60, 61));
  ASSERT_EQ(model.parts.size(), 3U);
  const auto part = [&](const std::string& name) {
    return *std::ranges::find(model.parts, name, &brep::Part::name);
  };
  EXPECT_EQ(part("wire").curves, (std::vector<std::string>{"#70", "#71"}));
  ASSERT_EQ(part("wire").places.size(), 2U);
  EXPECT_NE(part("wire").places[0].to_model.translation(),
            part("wire").places[1].to_model.translation());
  EXPECT_TRUE(part("wire").surfaces.empty());
  EXPECT_EQ(part("plate").surfaces, std::vector<std::string>{"#10"});
  EXPECT_TRUE(part("plate").curves.empty());
  EXPECT_EQ(part("").curves, std::vector<std::string>{"#72"}) << "of no product";
}

TEST(Assembly, MeshesStandWhereTheirPartsDo) {
  const auto file = parse_or_die(
      step_text(ground() + product(100, "car", "#403,#404") +
                "#401=SHAPE_REPRESENTATION('',(#10),#40);\n"
                "#402=REPRESENTATION_MAP(#60,#401);\n#403=MAPPED_ITEM('',#402,#62);\n"
                "#404=MAPPED_ITEM('',#402,#405);\n"
                "#405=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','','',#52,#53,#50,2.,#55);\n"));
  const auto model = model_faces(file.model(), 0.01);
  ASSERT_TRUE(model) << model.error().message();
  ASSERT_EQ(model->faces.size(), 2U);
  EXPECT_DOUBLE_EQ(testing::area_of(model->faces[0]), 1);
  EXPECT_DOUBLE_EQ(testing::area_of(model->faces[1]), 4);
  EXPECT_EQ(model->faces[0].points[0].z(), 7);
  for (const FaceMesh& mesh : model->faces) {  // the mirror turns triangles and normals alike
    const auto& [a, b, c] = mesh.triangles[0];
    const Point normal =
        (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]).normalized();
    EXPECT_NEAR(normal.dot(mesh.normals[a]), 1, 1e-14);
  }
  EXPECT_NEAR(model->faces[1].normals[0].z(), -model->faces[0].normals[0].z(), 1e-14);
}

}  // namespace
}  // namespace knead::step
