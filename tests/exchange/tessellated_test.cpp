#include "knead/brep/face_mesh.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "brep/tessellation/context_faces.hpp"
#include "brep/tessellation/model_mesh.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/save_model.hpp"
#include "knead/exchange/source.hpp"
#include "support/made_step.hpp"

namespace knead {
namespace {

using testing::StepBuilder;

/// The corners of the unit cube, x fastest, as COORDINATES_LIST #10.
const std::string corners =
    "#10=COORDINATES_LIST('',8,((0.,0.,0.),(1.,0.,0.),(0.,1.,0.),(1.,1.,0.),(0.,0.,1.),(1.,0.,1.),("
    "0.,1.,1.),(1.,1.,1.)"
    "));\n";
/// Its sides from outside, counterclockwise.
const std::string cube_triangles =
    "((1,3,2),(2,3,4),(5,6,7),(6,8,7),(1,2,5),(2,6,5),(3,7,4),(4,7,8),(1,5,3),(3,5,7),(2,4,6),(4,8,"
    "6))";

brep::TessellatedItems read(const std::string& data) {
  return testing::parse_or_die(testing::step_text(data)).model().tessellated;
}

/// Of a closed mesh; half the sum of x · normal over thirds of triangles.
double volume(const FaceMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += mesh.points[t[0]].dot(mesh.points[t[1]].cross(mesh.points[t[2]]));
  return sum / 6;
}

/// Every normal is a unit vector, and every triangle seen from the tips of those at its corners.
void expect_consistent(const FaceMesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.points.size());
  for (const Point& n : mesh.normals) EXPECT_NEAR(n.norm(), 1, 1e-15);
  for (const auto& t : mesh.triangles) {
    const Point across =
        (mesh.points[t[1]] - mesh.points[t[0]]).cross(mesh.points[t[2]] - mesh.points[t[0]]);
    for (const auto k : t) EXPECT_GT(across.dot(mesh.normals[k]), 0);
  }
}

/// Corners of triangles as numbers of coordinates along x of a list that has them at 1, 2, 3, …
std::vector<std::array<int, 3>> corners_of(const FaceMesh& mesh) {
  std::vector<std::array<int, 3>> result;
  for (const auto& t : mesh.triangles) {
    std::array<int, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k)
      triangle[k] = static_cast<int>(std::lround(mesh.points[t[k]].x()));
    result.push_back(triangle);
  }
  return result;
}

/// Points (k, k mod 2, 0), k from 1.
const std::string zigzag =
    "#10=COORDINATES_LIST('',6,((1.,1.,0.),(2.,0.,0.),(3.,1.,0.),(4.,0.,0.),(5.,1.,0.),(6.,0.,0.)))"
    ";\n";

TEST(Tessellated, ACubeOfOneFaceIsClosedAndHasFlatSides) {
  const auto found =
      read(corners + "#20=TRIANGULATED_FACE('cube',#10,8,(),$,()," + cube_triangles + ");\n");
  ASSERT_EQ(found.items.size(), 1U);
  const brep::TessellatedItem& item = found.items[0];
  EXPECT_EQ(item.name, "cube");
  EXPECT_EQ(item.mesh.id, "#20");
  EXPECT_TRUE(item.mesh.tessellated);
  EXPECT_EQ(item.mesh.triangles.size(), 12U);
  EXPECT_EQ(volume(item.mesh), 1);
  expect_consistent(item.mesh);
  EXPECT_EQ(open_sides({&item.mesh, 1}), 0U);
}

TEST(Tessellated, ASetOfTrianglesIsReadLikeAFaceButHasNoLink) {
  const auto found =
      read(corners + "#20=TRIANGULATED_SURFACE_SET('',#10,8,(),()," + cube_triangles + ");\n");
  ASSERT_EQ(found.items.size(), 1U);
  EXPECT_EQ(volume(found.items[0].mesh), 1);
}

TEST(Tessellated, StripsAlternateAndFansTurnAboutTheirFirstPoint) {
  for (const std::string kind : {"COMPLEX_TRIANGULATED_FACE('',#10,6,(),$,()",
                                 "COMPLEX_TRIANGULATED_SURFACE_SET('',#10,6,(),()"}) {
    const auto found = read(zigzag + "#20=" + kind + ",((1,2,3,4,5),(2,3,3,4)),((1,4,5,6)));\n");
    ASSERT_EQ(found.items.size(), 1U);
    const std::vector<std::array<int, 3>> wanted = {
        {1, 2, 3}, {3, 2, 4}, {3, 4, 5}, {1, 4, 5}, {1, 5, 6}};
    EXPECT_EQ(corners_of(found.items[0].mesh), wanted)
        << "triangles with a repeated point join strips";
  }
}

TEST(Tessellated, TrianglesOfAStripAllLieOnOneSide) {
  const auto found =
      read(zigzag + "#20=COMPLEX_TRIANGULATED_FACE('',#10,6,(),$,(),((1,2,3,4,5,6)),());\n");
  ASSERT_EQ(found.items.size(), 1U);
  for (const Point& n : found.items[0].mesh.normals) EXPECT_EQ(n, Point(0, 0, 1));
}

TEST(Tessellated, IndicesOfPointsLeadToCoordinatesAndNormalsToThem) {
  // Point 2 of the item is coordinate 4, and so on; it stands twice, with two normals.
  const auto found =
      read(zigzag +
           "#20=TRIANGULATED_FACE('',#10,4,((0.,0.,2.),(0.,0.6,0.8),(0.,0.,1.),(0.,-0.6,0.8)),$,"
           "(5,4,6,4),((1,2,3),(1,4,3)));\n");
  ASSERT_EQ(found.items.size(), 1U);
  const FaceMesh& mesh = found.items[0].mesh;
  const std::vector<std::array<int, 3>> wanted = {{5, 4, 6}, {5, 4, 6}};
  EXPECT_EQ(corners_of(mesh), wanted);
  ASSERT_EQ(mesh.points.size(), 4U) << "one per normal";
  expect_consistent(mesh);
  EXPECT_EQ(mesh.normals[mesh.triangles[0][1]].y(), 0.6);
  EXPECT_EQ(mesh.normals[mesh.triangles[1][1]].y(), -0.6);
}

TEST(Tessellated, NormalsSayWhichSideIsOutside) {
  const auto found =
      read(zigzag + "#20=COMPLEX_TRIANGULATED_FACE('',#10,6,((0.,0.,-1.)),$,(),((1,2,3,4)),());\n");
  ASSERT_EQ(found.items.size(), 1U);
  expect_consistent(found.items[0].mesh);
  EXPECT_EQ(found.items[0].mesh.normals[0], Point(0, 0, -1));
}

TEST(Tessellated, WrongIndicesAndNumbersNameTheItemAndTheOthersAreRead) {
  const std::string good = "#20=TRIANGULATED_FACE('',#10,6,(),$,(),((1,2,3)));\n";
  const std::pair<std::string, std::string> cases[] = {
      {"TRIANGULATED_FACE('',#10,6,(),$,(),((1,2,7)))",
       "an index is 7, which is none of its 6 points"},
      {"TRIANGULATED_FACE('',#10,6,(),$,(),((0,1,2)))", "an index is 0"},
      {"TRIANGULATED_FACE('',#10,6,(),$,(),((1.5,1,2)))", "no whole number"},
      {"TRIANGULATED_FACE('',#10,6,(),$,(1,2,9),((1,2,3)))",
       "an index is 9, which is none of its 6 coordinates"},
      {"TRIANGULATED_FACE('',#10,6,(),$,(1,2,3),((1,2,4)))",
       "an index is 4, which is none of its 3 points"},
      {"TRIANGULATED_FACE('',#10,6,(),$,(),((1,2)))", "fewer than three points"},
      {"TRIANGULATED_FACE('',#10,6,(),$,(),((1,2,3,4)))", "a triangle has 4 corners"},
      {"TRIANGULATED_FACE('',#10,6,(),$,(),())", "no triangles"},
      {"TRIANGULATED_FACE('',#10,6,((0.,0.,1.),(0.,0.,1.)),$,(1,2,3),((1,2,3)))",
       "2 normals for 3 points"},
      {"TRIANGULATED_FACE('',#10,6,((0.,0.)),$,(),((1,2,3)))", "normal 1 is not three numbers"},
      {"TRIANGULATED_FACE('',#99,6,(),$,(),((1,2,3)))", "incomplete"},
      {"TRIANGULATED_FACE('',#11,6,(),$,(),((1,2,3)))", "point 2 is not three numbers"},
      {"COMPLEX_TRIANGULATED_FACE('',#10,6,(),$,(),((1,2)),())", "a strip has fewer"}};
  for (const auto& [record, wanted] : cases) {
    const auto found = read(zigzag + "#11=COORDINATES_LIST('',2,((0.,0.,0.),(1.,1.E60,0.)));\n" +
                            good + "#21=" + record + ";\n");
    EXPECT_EQ(found.items.size(), 1U) << record;
    ASSERT_EQ(found.skipped.size(), 1U) << record;
    EXPECT_EQ(found.skipped[0].id, "#21");
    EXPECT_EQ(found.skipped[0].reason.kind, ErrorKind::input);
    EXPECT_NE(found.skipped[0].reason.message().find(wanted), std::string::npos)
        << found.skipped[0].reason.message();
  }
}

/// A part with the cube as its shape, and the assembly that puts it 10 along x, twice.
std::string assembly(const std::string& unit) {
  StepBuilder b;
  const int context = b.context(unit);
  const auto whole = b.product("whole", "SHAPE_REPRESENTATION", {}, context);
  const auto part = b.product("part", "SHAPE_REPRESENTATION", {}, context);
  b.place(part, whole, b.frame(10, 0, 0), "part:1");
  b.place(part, whole, b.frame(20, 0, 0), "part:2");
  const int shown =
      b.entity(fmt::format("TESSELLATED_SHAPE_REPRESENTATION('',(#30),#{})", context));
  b.entity(
      fmt::format("SHAPE_REPRESENTATION_RELATIONSHIP('','',#{},#{})", part.representation, shown));
  return corners + "#20=TRIANGULATED_FACE('',#10,8,(),$,()," + cube_triangles +
         ");\n#30=TESSELLATED_SOLID('box',(#20),$);\n" + b.text();
}

TEST(Tessellated, APartInInchesStandsWhereItsAssemblyPutsIt) {
  const auto source = testing::open_or_die(testing::step_text(assembly("inch")), "a.step");
  const brep::TessellatedItems& found = source->model()->tessellated;
  ASSERT_EQ(found.items.size(), 1U);
  EXPECT_EQ(found.items[0].name, "box") << "of the solid that holds it";
  EXPECT_EQ(found.items[0].unit, "inch");
  const auto model = model_faces(*source->model());
  ASSERT_TRUE(model) << model.error().message();
  ASSERT_EQ(model->faces.size(), 2U);
  Eigen::AlignedBox3d box;
  for (const FaceMesh& face : model->faces) {
    for (const Point& p : face.points) box.extend(p);
    EXPECT_NEAR(volume(face), 1, 1e-12);
  }
  EXPECT_EQ(box.min(), Point(10, 0, 0));
  EXPECT_EQ(box.max(), Point(21, 1, 1));
  EXPECT_EQ(open_sides(model->faces), 0U);
  const auto saved = save_model(*source, *find_format("gltf"));
  ASSERT_TRUE(saved) << saved.error().message();
  EXPECT_EQ(saved->tessellated, 2U);
  EXPECT_NE(saved->bytes.find("\"box\""), std::string::npos);
}

TEST(Tessellated, SetsRepositionWhatTheyHold) {
  const std::string place =
      "#1=CARTESIAN_POINT('',(5.,0.,0.));\n#2=DIRECTION('',(0.,0.,1.));\n#3=DIRECTION('',(0.,1.,0.)"
      ");\n"
      "#4=AXIS2_PLACEMENT_3D('',#1,#2,#3);\n#5=CARTESIAN_POINT('',(0.,0.,10.));\n#6=AXIS2_"
      "PLACEMENT_3D('',#5,$,$);\n";
  const auto set = [](int id, int at, int item) {
    return fmt::format(
        "#{}=(GEOMETRIC_REPRESENTATION_ITEM()REPOSITIONED_TESSELLATED_ITEM(#{})REPRESENTATION_ITEM("
        "'moved')"
        "TESSELLATED_GEOMETRIC_SET((#{}))TESSELLATED_ITEM());\n",
        id, at, item);
  };
  const auto found =
      read(zigzag + place + "#20=TRIANGULATED_SURFACE_SET('',#10,6,(),(),((1,2,3)));\n" +
           set(30, 4, 20) + set(31, 6, 30));
  ASSERT_EQ(found.items.size(), 1U);
  const FaceMesh& mesh = found.items[0].mesh;
  // A quarter turn about z takes (1, 1, 0) to (−1, 1, 0).
  EXPECT_LE((mesh.points[mesh.triangles[0][0]] - Point(4, 1, 10)).norm(), 1e-14);
  EXPECT_EQ(found.items[0].name, "moved");
}

TEST(Tessellated, PicturesOfExactFacesAreNotShownTwice) {
  StepBuilder b;
  const int plane = b.plane({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  std::vector<int> v;
  for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
    v.push_back(b.vertex(x, y, 0));
  const int bound = b.bound(
      {b.line(v[0], v[1], {0, 0, 0}, {1, 0, 0}), b.line(v[1], v[2], {1, 0, 0}, {0, 1, 0}),
       b.line(v[2], v[3], {1, 1, 0}, {-1, 0, 0}), b.line(v[3], v[0], {0, 1, 0}, {0, -1, 0})});
  const int face = b.entity(fmt::format("ADVANCED_FACE('',(#{}),#{},.T.)", bound, plane));
  const int shell = b.entity(fmt::format("OPEN_SHELL('',(#{}))", face));
  const std::string triangles = ",(),((1,2,3)));\n";
  for (const std::string& data :
       {fmt::format("#20=TRIANGULATED_FACE('',#10,6,(),#{}", face) + triangles,
        "#20=TRIANGULATED_FACE('',#10,6,(),$" + triangles +
            fmt::format("#30=TESSELLATED_SHELL('',(#20),#{});\n", shell)}) {
    const auto source =
        testing::open_or_die(testing::step_text(zigzag + data + b.text()), "a.step");
    EXPECT_TRUE(source->model()->tessellated.items.empty());
    EXPECT_EQ(context_faces(*source->model())->faces.size(), 1U);
    const auto left = left_out_of_list(*source);
    ASSERT_EQ(left.size(), 1U);
    EXPECT_EQ(left[0].many, "tessellated pictures of faces");
    EXPECT_EQ(left[0].ids, std::vector<std::string>{"#20"});
  }
  // A link to a surface says nothing of what of it is shown.
  const std::string other = fmt::format("#20=TRIANGULATED_FACE('',#10,6,(),#{}", plane) + triangles;
  EXPECT_EQ(read(zigzag + other + b.text()).items.size(), 1U);
}

TEST(Tessellated, OfAnnotationsNothingIsShown) {
  const std::string data =
      zigzag +
      "#20=COMPLEX_TRIANGULATED_SURFACE_SET('',#10,6,(),(),((1,2,3)),());\n"
      "#21=TESSELLATED_CURVE_SET('',#10,((1,2)));\n#22=TESSELLATED_GEOMETRIC_SET('',(#20,#21));\n"
      "#23=TESSELLATED_ANNOTATION_OCCURRENCE('',(),#22);\n";
  EXPECT_TRUE(read(data).items.empty());
  const auto left = left_out_of_list(*testing::open_or_die(testing::step_text(data), "a.step"));
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left[0].many, "drawn annotations");
}

TEST(Tessellated, OthersAreContextAndNamedWhereTheyAreLeftOut) {
  const std::string data = testing::unit_square_points() + testing::bilinear_patch() +
                           "#30=TESSELLATED_EDGE('',#40,$,(1,2));\n" +
                           "#40=COORDINATES_LIST('',3,((0.,0.,0.),(1.,0.,0.),(0.,1.,0.)));\n"
                           "#41=TRIANGULATED_FACE('',#40,3,((0.,0.,1.)),$,(),((1,2,3)));\n"
                           "#42=TRIANGULATED_FACE('',#40,3,((0.,0.,1.)),$,(),((1,2,4)));\n"
                           "#43=TESSELLATED_SHELL('',(#30,#41,#42),$);\n";
  const auto source = testing::open_or_die(testing::step_text(data), "a.step");
  const auto context = context_faces(*source->model());
  ASSERT_EQ(context->faces.size(), 1U);
  EXPECT_TRUE(context->faces[0].tessellated);
  EXPECT_EQ(context->faces[0].normals[0], Point(0, 0, 1));
  ASSERT_EQ(context->skipped.size(), 1U);
  const auto left = left_out_of_list(*source);
  ASSERT_EQ(left.size(), 2U);
  EXPECT_EQ(left[0].ids, std::vector<std::string>{"#42"});
  EXPECT_EQ(left[1].many, "tessellated curves and points");
  const auto written = left_out_of_surfaces(*source, *find_format("step"));
  EXPECT_EQ(written[0].many, "tessellated items");
  EXPECT_EQ(written[0].count, 2U);
  EXPECT_EQ(*source->save({{source->surfaces()[0].surface}}), testing::step_text(data))
      << "not a byte is lost";
}

TEST(Tessellated, SetsThatHoldEachOtherManyTimesEnd) {
  std::string data = zigzag +
                     "#20=TRIANGULATED_SURFACE_SET('',#10,6,(),(),((1,2,3)));\n#100=TESSELLATED_"
                     "GEOMETRIC_SET('',(#20,#20));\n";
  for (int k = 101; k < 140; ++k)
    data += fmt::format("#{0}=TESSELLATED_GEOMETRIC_SET('',(#{1},#{1}));\n", k, k - 1);
  const auto left = left_out_of_list(*testing::open_or_die(testing::step_text(data), "a.step"));
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left[0].reason, "sets hold each other too often");
}

}  // namespace
}  // namespace knead
