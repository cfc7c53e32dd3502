#include "knead/exchange/source.hpp"

#include <algorithm>

#include "exchange/brep_square.hpp"
#include "exchange/iges_builder.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/format.hpp"
#include "support/made_step.hpp"

namespace knead {
namespace {

using testing::IgesBuilder;
using testing::open_or_die;
using testing::StepBuilder;

using Ids = std::vector<std::string>;

std::string id(int record) { return "#" + std::to_string(record); }

/// The only entry of this name, or one of none.
LeftOut entry(const std::vector<LeftOut>& list, const std::string& many) {
  LeftOut found;
  for (const LeftOut& left : list) {
    if (left.many != many) continue;
    EXPECT_EQ(found.count, 0U) << many << " twice";
    found = left;
  }
  return found;
}

std::vector<LeftOut> of_step(const std::string& data) {
  return left_out_of_list(*open_or_die(testing::step_text(data), "a.step"));
}
std::vector<LeftOut> of_iges(const IgesBuilder& b) {
  return left_out_of_list(*open_or_die(b.text(), "a.igs"));
}

/// A shape that holds these records, in millimetres.
void shape(StepBuilder& b, const std::vector<int>& items) {
  b.entity(fmt::format("SHAPE_REPRESENTATION('',({}),#{})", StepBuilder::list_of(items),
                       b.context("mm")));
}

TEST(LeftOut, IsOneLineWithCountNamesReasonAndRemedy) {
  LeftOut left{"point", "points", 1, "a point has no surface"};
  EXPECT_EQ(sentence(left), "1 point: a point has no surface");
  left.ids = {"#1", "#2"};
  left.count = 2;
  left.remedy = "draw\na surface";
  EXPECT_EQ(sentence(left), "2 points (#1, #2): a point has no surface; draw\\na surface");
  left.count = 9;
  EXPECT_TRUE(sentence(left).starts_with("9 points (#1, #2, …): ")) << sentence(left);
  left.line = 7;
  EXPECT_TRUE(sentence(left).starts_with("9 points (#1, #2, …; from line 7): ")) << sentence(left);
}

TEST(LeftOut, NothingOfAFileWhoseFacesAreAllDrawn) {
  EXPECT_TRUE(of_step(testing::unit_square_points() + testing::bilinear_patch()).empty());
  EXPECT_TRUE(left_out_of_list(*open_or_die(testing::shell(), "a.igs")).empty());
  EXPECT_TRUE(left_out_of_list(*open_or_die(testing::brep_square, "a.brep")).empty());
}

TEST(LeftOutOfStep, PointsCurvesAndSurfacesThatStandForThemselves) {
  StepBuilder b;
  const int point = b.point(1, 2, 3),
            circle = b.entity(fmt::format("CIRCLE('',#{},1.)", b.frame()));
  const int plane = b.plane({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  const int set = b.entity(fmt::format("GEOMETRIC_SET('',(#{},#{}))", point, circle));
  const int line = b.entity(fmt::format(
      "LINE('',#{},#{})", point, b.entity(fmt::format("VECTOR('',#{},1.)", b.direction(1, 0, 0)))));
  shape(b, {set, plane, line, b.frame()});
  const auto list = of_step(b.text());
  EXPECT_EQ(entry(list, "points").ids, Ids{id(point)});
  EXPECT_EQ(entry(list, "points").count, 1U);
  EXPECT_EQ(entry(list, "curves that are no B-splines").count, 2U);
  EXPECT_EQ(entry(list, "surfaces without faces").ids, Ids{id(plane)});
  EXPECT_EQ(list.size(), 3U);
}

TEST(LeftOutOfStep, PointsOfPropertiesAreNoneOfTheShape) {
  StepBuilder b;
  const int point = b.point(1, 2, 3);
  const int centre =
      b.entity(fmt::format("SHAPE_REPRESENTATION('',(#{}),#{})", point, b.context("mm")));
  b.entity(fmt::format("PROPERTY_DEFINITION_REPRESENTATION($,#{})", centre));
  EXPECT_TRUE(of_step(b.text()).empty());
}

TEST(LeftOutOfStep, CurvesThatCannotBeReadHaveTheirReason) {
  const std::string data = testing::unit_square_points() +
                           "#20=B_SPLINE_CURVE_WITH_KNOTS('',1,(#1,#2),.UNSPECIFIED.,.F.,.F.,(2,3),"
                           "(0.,1.),.UNSPECIFIED.);\n"
                           "#21=GEOMETRIC_CURVE_SET('',(#20));\n";
  const auto list = of_step(data);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].many, "curves that cannot be read");
  EXPECT_EQ(list[0].ids, Ids{"#20"});
  EXPECT_FALSE(list[0].reason.empty());
}

TEST(LeftOutOfStep, SolidsWithoutFacesAnnotationsViewsAndLayers) {
  const auto list = of_step(
      "#1=BLOCK('',$,1.,2.,3.);\n#2=RIGHT_CIRCULAR_CYLINDER('',$,1.,2.);\n#3=BOOLEAN_RESULT('',."
      "UNION.,#1,#2);\n"
      "#4=CSG_SOLID('',#3);\n#5=EXTRUDED_AREA_SOLID('',$,$,1.);\n#6=DRAUGHTING_CALLOUT('',(#7));\n"
      "#7=ANNOTATION_CURVE_OCCURRENCE('',(),#8);\n#8=GEOMETRIC_CURVE_SET('',(#9));\n#9=POLYLINE('',"
      "(#12,#13));\n"
      "#10=(GEOMETRIC_TOLERANCE('','',$,$)GEOMETRIC_TOLERANCE_WITH_DATUM_REFERENCE(())POSITION_"
      "TOLERANCE());\n"
      "#11=CAMERA_MODEL_D3('',$,$);\n#12=CARTESIAN_POINT('',(0.,0.,0.));\n#13=CARTESIAN_POINT('',("
      "1.,0.,0.));\n"
      "#14=PRESENTATION_LAYER_ASSIGNMENT('','',(#9));\n#15=VOLUME_3D_ELEMENT_REPRESENTATION('',(),$"
      ",$,$,$,$);\n"
      "#16=B_SPLINE_VOLUME_WITH_KNOTS('',1);\n#17=SHAPE_REPRESENTATION('',(#4,#5,#16,#18),$);\n"
      "#18=NEVER_HEARD_OF('');\n");
  EXPECT_EQ(entry(list, "records of solids made of primitives").ids, (Ids{"#1", "#2", "#3", "#4"}));
  EXPECT_FALSE(entry(list, "records of solids made of primitives").remedy.empty());
  EXPECT_EQ(entry(list, "swept solids").ids, Ids{"#5"});
  EXPECT_EQ(entry(list, "drawn annotations").count, 2U);
  EXPECT_EQ(entry(list, "dimensions, tolerances and datums").count, 1U)
      << "a record of three parts";
  EXPECT_EQ(entry(list, "saved views").count, 1U);
  EXPECT_EQ(entry(list, "layers").count, 1U);
  EXPECT_EQ(entry(list, "records of finite elements").count, 1U);
  EXPECT_EQ(entry(list, "volumes").count, 1U);
  EXPECT_EQ(entry(list, "items NEVER_HEARD_OF").ids, Ids{"#18"});
  EXPECT_EQ(list.size(), 9U) << "the curve of an annotation is no curve of the model";
}

TEST(LeftOutOfStep, EdgesWithoutFacesButNotSurfacesThatAreBoundedByThemselves) {
  StepBuilder b;
  const int p = b.vertex(0, 0, 0), q = b.vertex(1, 0, 0);
  const int edge = b.line(p, q, {0, 0, 0}, {1, 0, 0});
  b.entity(fmt::format("CONNECTED_EDGE_SET('',(#{}))", edge));
  Points corners(4, 3);
  corners << 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0;
  const KnotVector k = *KnotVector::clamped_uniform(1, 2);
  const int spline = b.surface(*Surface::create({k, k}, corners), "sheet");
  const int cut =
      b.entity(fmt::format("RECTANGULAR_TRIMMED_SURFACE('',#{},0.,.5,0.,1.,.T.,.T.)", spline));
  shape(b, {cut});
  const auto list = of_step(b.text());
  EXPECT_EQ(entry(list, "free edges").ids, Ids{id(edge)});
  EXPECT_EQ(list.size(), 1U);
}

TEST(LeftOutOfStep, FacesThatCannotBeDrawnAndSurfacesThatCannotBeRead) {
  StepBuilder b;
  const int p = b.vertex(0, 0, 0), q = b.vertex(1, 0, 0);
  const auto loop = [&] {
    const int there = b.line(p, q, {0, 0, 0}, {1, 0, 0});
    const int on = b.entity(fmt::format("ORIENTED_EDGE('',*,*,#{},.T.)", there));
    const int off = b.entity(fmt::format("ORIENTED_EDGE('',*,*,#{},.F.)", there));
    return b.entity(fmt::format("FACE_BOUND('',#{},.T.)",
                                b.entity(fmt::format("EDGE_LOOP('',(#{},#{}))", on, off))));
  };
  const int offset = b.entity(
      fmt::format("OFFSET_SURFACE('',#{},1.,.F.)", b.plane({0, 0, 0}, {0, 0, 1}, {1, 0, 0})));
  const int unknown = b.entity(fmt::format("ADVANCED_FACE('',(#{}),#{},.T.)", loop(), offset));
  const int bad = b.entity(
      "B_SPLINE_SURFACE_WITH_KNOTS('',1,1,(),.UNSPECIFIED.,.F.,.F.,.F.,(2,2),(2,2),(0.,1.),(0.,1.),"
      ".UNSPECIFIED.)");
  const int above = b.entity(fmt::format("ADVANCED_FACE('',(#{}),#{},.T.)", loop(), bad));
  const int nowhere = b.entity(fmt::format("ADVANCED_FACE('',(#{}),$,.T.)", loop()));
  const auto source = open_or_die(testing::step_text(b.text()), "a.step");
  const auto list = left_out_of_list(*source);
  EXPECT_EQ(entry(list, "surfaces that cannot be sculpted").ids, Ids{id(bad)});
  EXPECT_EQ(entry(list, "faces that cannot be read").ids, Ids{id(nowhere)});
  std::map<std::string, std::string> reasons;
  for (const LeftOut& left : list) {
    if (left.many == "faces that cannot be drawn") reasons[left.ids.at(0)] = left.reason;
  }
  EXPECT_EQ(reasons[id(above)], "its surface cannot be read") << "why is said with the surface";
  EXPECT_NE(reasons[id(unknown)].find("of this form"), std::string::npos) << reasons[id(unknown)];
}

// A list of surfaces does not search for the feet of edges on splines; one of faces draws them.
TEST(LeftOutOfStep, FacesWhoseEdgesLieOffTheirSurfaceAreNamedWhereFacesAreListed) {
  StepBuilder b;
  Points corners(4, 3);
  corners << 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0;
  const KnotVector k = *KnotVector::clamped_uniform(1, 2);
  const int sheet = b.surface(*Surface::create({k, k}, corners), "sheet");
  const std::array<Point, 3> apart = {Point(0, 0, 5), Point(1, 0, 5), Point(0, 1, 5)};
  std::array<int, 3> vertices = {};
  for (std::size_t i = 0; i < 3; ++i)
    vertices[i] = b.vertex(apart[i].x(), apart[i].y(), apart[i].z());
  std::string uses;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const Point way = apart[j] - apart[i];
    const int edge = b.line(vertices[i], vertices[j], {apart[i].x(), apart[i].y(), apart[i].z()},
                            {way.x(), way.y(), way.z()});
    uses += fmt::format("{}#{}", i > 0 ? "," : "",
                        b.entity(fmt::format("ORIENTED_EDGE('',*,*,#{},.T.)", edge)));
  }
  const int loop = b.entity(fmt::format("EDGE_LOOP('',({}))", uses));
  const int bound = b.entity(fmt::format("FACE_BOUND('',#{},.T.)", loop));
  const int face = b.entity(fmt::format("ADVANCED_FACE('',(#{}),#{},.T.)", bound, sheet));
  const auto source = open_or_die(testing::step_text(b.text()), "a.step");
  EXPECT_TRUE(left_out_of_list(*source).empty());
  const auto faces = left_out_of_faces(*source);
  EXPECT_EQ(entry(faces, "faces that cannot be drawn").ids, Ids{id(face)});
  EXPECT_NE(entry(faces, "faces that cannot be drawn").reason.find("do not lie on its surface"),
            std::string::npos);
}

TEST(LeftOutOfStep, PartsWithoutGeometry) {
  StepBuilder b;
  const int context = b.context("mm");
  const auto whole = b.product("whole", "SHAPE_REPRESENTATION", {}, context);
  const auto part = b.product("part", "SHAPE_REPRESENTATION", {}, context);
  b.place(part, whole, whole.frame, "part:1");
  b.place(part, whole, whole.frame, "part:2");
  EXPECT_EQ(entry(of_step(b.text()), "parts without geometry").count, 1U);
}

TEST(LeftOutOfIges, EverythingThatIsNoPartOfAFace) {
  IgesBuilder b;
  b.add(128, testing::plate());
  const int point = b.add(116, "1.,2.,3.,0");
  const int line = b.add(110, "0.,0.,0.,1.,0.,0.");
  const int composite = b.add(102, fmt::format("1,{}", line));
  b.add(106, "1,2,0.,0.,0.,1.,1.", 0, 1);
  b.add(106, "1,2,0.,0.,0.,1.,1.", 0, 40);
  b.add(150, "1.,2.,3.");
  b.add(180, "3,-13,-13,1");
  b.add(212, "0");
  b.add(402, "0", 0, 7);
  b.add(404, "0,0");
  b.add(314, "100.,0.,50.,4HPink");
  b.add(406, "1,4HName");
  b.add(999, "0");
  const int definition = b.add(308, "0,4HPart,1,1");
  b.add(190, fmt::format("{},0,0", b.add(116, "0.,0.,0.,0")));
  const auto list = of_iges(b);
  EXPECT_EQ(entry(list, "points").ids, (Ids{id(point), "#9"})) << "not that of the plane";
  EXPECT_EQ(entry(list, "curves that bound no face").ids, Ids{id(composite)})
      << "not what it is made of";
  EXPECT_EQ(entry(list, "solids without faces").count, 2U);
  EXPECT_EQ(entry(list, "annotations").count, 2U);
  for (const char* once :
       {"groups", "drawings and views", "colours", "entities of type 406 (property)",
        "entities of type 999", "surfaces without faces"})
    EXPECT_EQ(entry(list, once).count, 1U) << once;
  EXPECT_EQ(entry(list, "subfigure definitions").ids, Ids{id(definition)});
  EXPECT_EQ(list.size(), 11U);
}

TEST(LeftOutOfIges, SubfiguresWithoutAPlace) {
  IgesBuilder b;
  const int surface = b.add(128, testing::plate());
  const int definition = b.add(308, fmt::format("0,4HPart,1,{}", surface));
  b.add(408, fmt::format("{},1.,2.,3.,1.", definition));
  const int none = b.add(408, fmt::format("{},1.,2.,3.,1.", surface));
  const auto list = of_iges(b);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].many, "subfigure instances");
  EXPECT_EQ(list[0].ids, Ids{id(none)});
}

TEST(LeftOutOfIges, FacesWithoutBounds) {
  IgesBuilder b;
  b.add(144, fmt::format("{},0,0,0", b.add(128, testing::plate())));
  EXPECT_TRUE(of_iges(b).empty()) << "a whole B-spline surface is shown";
  const int plane = b.add(190, fmt::format("{},0,0", b.add(116, "0.,0.,0.,0")));
  b.add(144, fmt::format("{},0,0,0", plane));
  const int broken = b.add(144, "0,1,0,0");
  const auto list = of_iges(b);
  EXPECT_EQ(entry(list, "faces without bounds").count, 1U);
  EXPECT_EQ(entry(list, "faces that cannot be read").ids, Ids{id(broken)});
  EXPECT_EQ(list.size(), 2U);
}

TEST(LeftOutOfBrep, FurtherUsesOfFacesAndLooseEdges) {
  std::string text = testing::brep_square;
  // Of the shapes, which are counted from the end: the face twice, one of its edges, and a vertex.
  text.replace(text.rfind("+1 1 "), std::string::npos, "+1 1 +1 1 +3 0 +7 0 \n");
  const auto source = open_or_die(text, "a.brep");
  EXPECT_TRUE(source->remarks().empty());
  const auto list = left_out_of_list(*source);
  for (const char* once : {"further uses of faces", "free edges", "free vertices"})
    EXPECT_EQ(entry(list, once).count, 1U) << once;
  EXPECT_EQ(list.size(), 3U);
}

TEST(LeftOut, OfMeshesAndNewFilesIsTheSameAndMore) {
  StepBuilder b;
  const int p = b.point(0, 0, 0), q = b.point(1, 0, 0);
  const int curve = b.entity(fmt::format(
      "B_SPLINE_CURVE_WITH_KNOTS('',1,(#{},#{}),.UNSPECIFIED.,.F.,.F.,(2,2),(0.,1.),.UNSPECIFIED.)",
      p, q));
  shape(b, {b.entity(fmt::format("GEOMETRIC_SET('',(#{},#{}))", curve, b.point(1, 2, 3)))});
  const auto source = open_or_die(testing::step_text(b.text()), "a.step");
  ASSERT_EQ(source->curves().size(), 1U);
  const auto listed = left_out_of_list(*source), meshed = left_out_of_mesh(*source, {});
  const auto step = left_out_of_surfaces(*source, *find_format("step"));
  EXPECT_EQ(listed.size(), 1U);
  EXPECT_EQ(entry(meshed, "curves").ids, Ids{id(curve)});
  for (const auto& list : {listed, meshed, step})
    EXPECT_EQ(sentence(entry(list, "points")), sentence(listed[0]));
  EXPECT_EQ(step.size(), 1U) << "STEP holds curves";
  EXPECT_EQ(entry(left_out_of_surfaces(*source, *find_format("stl")), "curves").count, 1U);
}

}  // namespace
}  // namespace knead
