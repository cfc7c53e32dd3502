#include "knead/spline/extremum.hpp"
#include "program.hpp"
#include "step_sheet.hpp"

namespace knead::testing {
namespace {

TEST(Info, HasEveryFieldOfTheContract) {
  const Json info = knead({"info", bonnet(), "--json"}).json();
  EXPECT_EQ(info.at("file"), bonnet());
  EXPECT_EQ(info.at("format"), "STEP");
  EXPECT_EQ(info.at("units"), "mm");
  EXPECT_TRUE(info.at("instances").is_array());
  ASSERT_EQ(info.at("surfaces").size(), 2U);
  for (const Json& s : info.at("surfaces")) {
    const std::string id = s.at("id");
    const Surface surface = surface_of(bonnet(), id);
    EXPECT_TRUE(s.at("name").is_string());
    for (std::size_t d = 0; d < 2; ++d) {
      const KnotVector& knots = surface.knots()[d];
      EXPECT_EQ(s.at("degree").at(d), knots.degree());
      EXPECT_EQ(s.at("net").at(d), knots.count()) << "control points, not spans";
      EXPECT_EQ(s.at("clamped").at(d), knots.clamped());
      EXPECT_TRUE(s.at("closed").at(d).is_boolean());
      EXPECT_EQ(s.at("knots").at(d).get<std::vector<double>>(),
                std::vector<double>(knots.knots().begin(), knots.knots().end()))
          << "to the last bit, with their multiplicity";
      EXPECT_EQ(s.at("max_interior_multiplicity").at(d), knots.max_interior_multiplicity());
    }
    EXPECT_EQ(s.at("rational"), surface.rational());
    EXPECT_TRUE(s.at("trimmed").is_boolean());
    const BoundingBox box = bounding_box(surface);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(s.at("bounding_box").at(0).at(static_cast<std::size_t>(c)), box.lower[c]);
      EXPECT_EQ(s.at("bounding_box").at(1).at(static_cast<std::size_t>(c)), box.upper[c]);
    }
  }
}

TEST(Info, ListsPlacementsUnderInstances) {
  const Json instances = knead({"info", bonnet(), "--json"}).json().at("instances");
  ASSERT_FALSE(instances.empty());
  for (const Json& i : instances) {
    for (const char* field : {"id", "name", "parent", "child", "placement", "frame"})
      EXPECT_TRUE(i.contains(field));
  }
}

TEST(Info, SaysWhereThePartsOfAnAssemblyStand) {
  const Json model = knead({"info", bonnet(), "--json"}).json().at("assembly");
  EXPECT_EQ(model.at("unit"), "mm");
  std::size_t rings = 0;
  for (const Json& part : model.at("parts")) {
    for (const char* field : {"name", "unit", "surfaces", "faces", "places"})
      EXPECT_TRUE(part.contains(field));
    if (part.at("surfaces") != Json::array({"#1044"})) continue;
    rings += part.at("places").size();
    EXPECT_EQ(part.at("places")[0].at("matrix").size(), 3U);
  }
  EXPECT_EQ(rings, 1U);
  const std::string text = knead({"info", bonnet()}).out;
  EXPECT_NE(text.find("B-spline surfaces: #1044"), std::string::npos) << text;
}

TEST(Info, SaysWhichOtherSurfacesCanBeConverted) {
  const Json others = knead({"info", bonnet(), "--json"}).json().at("other_surfaces");
  ASSERT_EQ(others.size(), 4U);
  for (const Json& s : others) {
    EXPECT_EQ(s.at("form"), "SURFACE_OF_LINEAR_EXTRUSION");
    EXPECT_EQ(s.at("faces").size(), 1U);
    EXPECT_EQ(s.at("convertible"), true);
  }
  EXPECT_NE(knead({"info", bonnet()}).out.find("4 SURFACE_OF_LINEAR_EXTRUSION"), std::string::npos);
  const std::string listed = knead({"info", bonnet(), "--faces"}).out;
  const std::string line = others[0].at("id").get<std::string>() +
                           "     SURFACE_OF_LINEAR_EXTRUSION, face " +
                           others[0].at("faces").at(0).get<std::string>() + ": can be converted";
  EXPECT_NE(listed.find(line), std::string::npos) << listed;
}

TEST(Info, AFileWithoutSplineSurfacesIsNoError) {
  const Workshop workshop;
  const std::string path = workshop.file(
      "none.step",
      "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');"
      "\n"
      "FILE_SCHEMA(('X'));\nENDSEC;\nDATA;\n#1=CARTESIAN_POINT('',(0.,0.,0.));\nENDSEC;\n"
      "END-ISO-10303-21;\n");
  const Outcome run = knead({"info", path, "--json"});
  EXPECT_EQ(run.code, 0);
  EXPECT_TRUE(run.json().at("surfaces").empty());
  EXPECT_EQ(run.json().at("units"), "unknown");
}

/// The sheet of the bonnet with a point and a circle beside it, and a layer.
std::string with_more(const Workshop& workshop) {
  std::string text = step_sheet(surface_of(bonnet(), "#285"));
  text.insert(text.rfind("ENDSEC;"),
              "#9001=CARTESIAN_POINT('',(0.,0.,0.));\n#9002=AXIS2_PLACEMENT_3D('',#9001,$,$);\n"
              "#9003=CIRCLE('',#9002,1.);\n#9004=GEOMETRIC_SET('',(#9001,#9003));\n"
              "#9005=PRESENTATION_LAYER_ASSIGNMENT('hidden','',(#9004));\n");
  return workshop.file("more.step", text);
}

TEST(Info, MeshAndExportNameAndCountWhatTheyLeaveOut) {
  const Workshop workshop;
  const std::string path = with_more(workshop);
  const Json left = knead({"info", path, "--json"}).json().at("left_out");
  ASSERT_EQ(left.size(), 3U);
  EXPECT_EQ(left[0].at("what"), "points");
  EXPECT_EQ(left[0].at("count"), 1);
  EXPECT_EQ(left[0].at("reason"), "a point has no surface");
  EXPECT_TRUE(left[0].at("remedy").is_null());
  EXPECT_EQ(left[0].at("ids"), Json::array({"#9001"}));
  EXPECT_TRUE(left[1].at("remedy").is_string());
  const std::string text = knead({"info", path}).out;
  EXPECT_NE(text.find("  left out:\n    1 point (#9001): a point has no surface\n    1 curve"),
            std::string::npos)
      << text;
  const Outcome mesh = knead({"mesh", path, "--out", workshop / "a.stl"});
  const Outcome copy = knead({"export", path, "--out", workshop / "a.igs"});
  for (const Outcome& run : {mesh, copy}) {
    EXPECT_EQ(run.code, 0);
    for (const char* line : {"warning: left out: 1 point (#9001): a point has no surface\n",
                             "warning: left out: 1 curve that is no B-spline (#9003): ",
                             "warning: left out: 1 layer (#9005): layers are not shown\n"})
      EXPECT_NE(run.err.find(line), std::string::npos) << run.err;
  }
}

TEST(Info, AndMeshCountTessellatedItems) {
  const Workshop workshop;
  const std::string path = workshop.file(
      "tent.step",
      "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');"
      "\n"
      "FILE_SCHEMA(('AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF'));\nENDSEC;\nDATA;\n"
      "#1=COORDINATES_LIST('',4,((0.,0.,0.),(2.,0.,0.),(0.,2.,0.),(0.,0.,2.)));\n"
      "#2=TRIANGULATED_FACE('tent',#1,4,(),$,(),((1,3,2),(1,2,4),(2,3,4),(1,4,3)));\n"
      "#3=TRIANGULATED_FACE('torn',#1,4,(),$,(),((1,2,5)));\nENDSEC;\nEND-ISO-10303-21;\n");
  const Json info = knead({"info", path, "--json"}).json();
  EXPECT_EQ(info.at("tessellated_items"),
            Json::parse(R"([{"id": "#2", "name": "tent", "unit": "unknown", "triangles": 4}])"));
  ASSERT_EQ(info.at("left_out").size(), 1U);
  EXPECT_EQ(info.at("left_out")[0].at("ids"), Json::array({"#3"}));
  EXPECT_NE(knead({"info", path}).out.find("#2       \"tent\", tessellated, 4 triangles\n"),
            std::string::npos);
  const Outcome run = knead({"mesh", path, "--out", workshop / "a.stl"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("(1 tessellated item, 4 triangles, closed, "), std::string::npos)
      << run.out;
  EXPECT_NE(run.err.find("left out: 1 face that cannot be drawn (#3): an index is 5"),
            std::string::npos)
      << run.err;
}

TEST(Info, LeavesNothingOutOfTheSample) {
  EXPECT_TRUE(knead({"info", bonnet(), "--json"}).json().at("left_out").empty());
  EXPECT_EQ(knead({"info", bonnet()}).out.find("left out"), std::string::npos);
}

TEST(Info, ANameInAnyTongueIsValidJson) {
  const Workshop workshop;
  std::string text = step_sheet(surface_of(bonnet(), "#285"));
  text.replace(text.find("'sheet'"), 7, R"('\X2\00DC\X0\ "\\" ')");
  const Json info = knead({"info", workshop.file("name.step", text), "--json"}).json();
  EXPECT_EQ(info.at("surfaces").at(0).at("name"), "Ü \"\\\" ");
}

TEST(Info, TheShortFormNamesEverySurface) {
  const Outcome run = knead({"info", bonnet()});
  EXPECT_EQ(run.code, 0);
  for (const char* word : {"#285", "#1044", "bonnet skin", "net 14 x 12", "mm"}) {
    EXPECT_NE(run.out.find(word), std::string::npos) << word;
  }
}

}  // namespace
}  // namespace knead::testing
