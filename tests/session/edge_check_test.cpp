// How faces meet at their edges: gaps, angles, what is known of faces that are no B-splines.

#include "scene/edge_check.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "exchange/two_sheets.hpp"
#include "knead/exchange/format.hpp"
#include "knead/session/command_json.hpp"
#include "knead/session/session_info.hpp"
#include "session/session_state.hpp"

namespace knead {
namespace {

using testing::two_sheets;
using testing::TwoSheets;

Session opened(const std::string& text) {
  return Session(Document::from(*open_source(text, "sheets.step")));
}

void run(Session& session, const std::vector<std::string>& commands) {
  for (const std::string& json : commands) {
    const auto command = parse_command(json);
    ASSERT_TRUE(command) << json << ": " << command.error().message();
    const auto status = session.execute(*command);
    ASSERT_TRUE(status) << json << ": " << status.error().message();
  }
}

EdgeCheck check_of(const Session& session, int edge, const std::string& surface = "#10") {
  const auto contacts = edge_contacts(*session.document().model(), surface);
  EXPECT_TRUE(contacts) << contacts.error().message();
  const auto checks = check_edges(session.state(), *contacts);
  EXPECT_TRUE(checks) << checks.error().message();
  for (const EdgeCheck& check : *checks) {
    if (check.id == TwoSheets::name(edge)) return check;
  }
  ADD_FAILURE() << "there is no such edge";
  return {};
}

// The net of #20 is (1, 0), (1, 1), (2, 0), (2, 1).
const std::string right = R"({"do":"select","surface":"#20"})";

TEST(EdgeCheck, SheetsThatContinueEachOtherAreSmoothAndClosed) {
  const TwoSheets sheets = two_sheets();
  const EdgeCheck check = check_of(opened(sheets.text), sheets.edge);
  EXPECT_EQ(check.faces,
            (std::vector{TwoSheets::name(sheets.faces[0]), TwoSheets::name(sheets.faces[1])}));
  EXPECT_LE(check.gap, 1e-15);
  ASSERT_TRUE(check.angle);
  EXPECT_LE(*check.angle, 1e-15);
  EXPECT_EQ(check.unknown, "");
}

TEST(EdgeCheck, AFoldIsTheLargestAngleAlongTheEdge) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets.text);
  run(session, {right, R"({"do":"points","which":[2,3],"by":[0,0,1]})"});
  EdgeCheck check = check_of(session, sheets.edge);
  EXPECT_NEAR(check.angle.value_or(0), std::numbers::pi / 4, 1e-14);
  EXPECT_LE(check.opened_angle.value_or(1), 1e-15);
  EXPECT_LE(check.gap, 1e-15);
  // Twisted: S_u = (1, 0, v / 2) along the edge.
  run(session, {R"({"do":"points","which":[2],"by":[0,0,-1]})",
                R"({"do":"points","which":[3],"by":[0,0,-0.5]})"});
  check = check_of(session, sheets.edge);
  EXPECT_NEAR(check.angle.value_or(0), std::atan(0.5), 1e-14);
  // The same seen from the other face.
  EXPECT_NEAR(check_of(session, sheets.edge, "#20").angle.value_or(0), std::atan(0.5), 1e-14);
}

TEST(EdgeCheck, APartedEdgeHasAGap) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets.text);
  run(session, {right, R"({"do":"points","which":[1],"by":[0,0,0.25]})"});
  const EdgeCheck check = check_of(session, sheets.edge);
  EXPECT_NEAR(check.gap, 0.25, 1e-15);
  EXPECT_LE(check.opened_gap, 1e-15);
  // One face alone: from the curve of the file, without an angle.
  const EdgeCheck outer = check_of(session, sheets.outer);
  EXPECT_LE(outer.gap, 1e-15);
  EXPECT_FALSE(outer.angle);
  run(session,
      {R"({"do":"select","surface":"#10"})", R"({"do":"points","which":[0],"by":[0,0,2]})"});
  EXPECT_NEAR(check_of(session, sheets.outer).gap, 2, 1e-14);
}

// The right sheet as z = (x - 1)², which bends by 2 across the edge, where it is tangent to the
// flat one.
const std::string parabola[] = {R"({"do":"elevate","by":[1,0]})",
                                R"({"do":"points","which":[4,5],"by":[0,0,1]})"};

TEST(EdgeCheck, ATangentEdgeHasADifferenceInCurvature) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets.text);
  EXPECT_LE(check_of(session, sheets.edge).curvature.value_or(1), 1e-15);
  run(session, {right, parabola[0], parabola[1]});
  EdgeCheck check = check_of(session, sheets.edge);
  EXPECT_LE(check.angle.value_or(1), 1e-15);
  EXPECT_NEAR(check.curvature.value_or(0), 2, 1e-13);
  EXPECT_LE(check.opened_curvature.value_or(1), 1e-15);
  EXPECT_FALSE(check_of(session, sheets.outer).curvature);
  // Bent alike on both sides, there is none: the left sheet becomes z = (x - 1)², too.
  run(session, {R"({"do":"select","surface":"#10"})", parabola[0],
                R"({"do":"points","which":[0,1],"by":[0,0,1]})"});
  check = check_of(session, sheets.edge);
  EXPECT_LE(check.angle.value_or(1), 1e-14);
  EXPECT_LE(check.curvature.value_or(1), 1e-13);
}

TEST(EdgeCheck, TheCurvatureOfAnotherSurfaceIsKnown) {
  // The plane of the right sheet becomes a cylinder of radius 4 below it, an extruded circle, or a
  // cone.
  const std::string place =
      "#22=CARTESIAN_POINT('',(1.,0.,-4.));#23=DIRECTION('',(0.,1.,0.));#24=DIRECTION('',(1.,0.,0.)"
      ");"
      "#25=AXIS2_PLACEMENT_3D('',#22,#23,#24);";
  const std::string extruded =
      "#26=CIRCLE('',#25,4.);#27=VECTOR('',#23,1.);#20=SURFACE_OF_LINEAR_EXTRUSION('',#26,#27);";
  // Through (1, 0, 0) and (1, 1, 0), about y: z = -4 + 4 means a turned line is the same cylinder.
  const std::string turned =
      "#26=LINE('',#3,#27);#27=VECTOR('',#23,1.);#28=AXIS1_PLACEMENT('',#22,#23);"
      "#20=SURFACE_OF_REVOLUTION('',#26,#28);";
  for (const std::string& surface :
       {std::string("#20=CYLINDRICAL_SURFACE('',#25,4.);"), extruded, turned}) {
    TwoSheets sheets = two_sheets(false, true);
    const std::string plane = "#20=PLANE('',#21);";
    const auto at = sheets.text.find(plane);
    ASSERT_NE(at, std::string::npos);
    sheets.text.replace(at, plane.size(), place + surface);
    const EdgeCheck check = check_of(opened(sheets.text), sheets.edge);
    ASSERT_EQ(check.unknown, "") << surface;
    EXPECT_NEAR(check.curvature.value_or(0), 0.25, 1e-13)
        << surface << " angle " << check.angle.value_or(9);
  }
  const TwoSheets flat = two_sheets(false, true);
  EXPECT_LE(check_of(opened(flat.text), flat.edge).curvature.value_or(1), 1e-15);
}

TEST(EdgeCheck, CurvaturesCountTowardsTheNormalsOfTheFaces) {
  // A cylinder of radius 4 falls away from the edge, the left sheet rises from it as z = (x - 1)².
  TwoSheets sheets = two_sheets(false, true);
  const std::string plane = "#20=PLANE('',#21);";
  sheets.text.replace(sheets.text.find(plane), plane.size(),
                      "#22=CARTESIAN_POINT('',(1.,0.,-4.));#23=DIRECTION('',(0.,1.,0.));#24="
                      "DIRECTION('',(1.,0.,0.));"
                      "#25=AXIS2_PLACEMENT_3D('',#22,#23,#24);#20=CYLINDRICAL_SURFACE('',#25,4.);");
  for (const bool turned : {false, true}) {
    for (const std::string face : {"),#10,.T.)", "),#20,.T.)"}) {
      if (turned)
        sheets.text.replace(sheets.text.find(face), face.size(), face.substr(0, 6) + ".F.)");
    }
    Session session = opened(sheets.text);
    run(session, {R"({"do":"select","surface":"#10"})", parabola[0],
                  R"({"do":"points","which":[0,1],"by":[0,0,1]})"});
    EXPECT_NEAR(check_of(session, sheets.edge).curvature.value_or(0), 2.25, 1e-12) << turned;
  }
}

TEST(EdgeCheck, ACreaseHasNoDifferenceInCurvature) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets.text);
  run(session, {right, R"({"do":"points","which":[2,3],"by":[0,0,1]})"});
  const EdgeCheck check = check_of(session, sheets.edge);
  EXPECT_FALSE(check.curvature);
  EXPECT_TRUE(check.opened_curvature);
}

TEST(EdgeCheck, AFaceOnAPlaneIsAsInTheFile) {
  const TwoSheets sheets = two_sheets(false, true);
  Session session = opened(sheets.text);
  EXPECT_LE(check_of(session, sheets.edge).angle.value_or(1), 1e-15);
  run(session,
      {R"({"do":"select","surface":"#10"})", R"({"do":"points","which":[0,1],"by":[0,0,-1]})"});
  const EdgeCheck check = check_of(session, sheets.edge);
  EXPECT_NEAR(check.angle.value_or(0), std::numbers::pi / 4, 1e-14);
  EXPECT_LE(check.gap, 1e-15);
}

TEST(EdgeCheck, TheNormalsAreThoseOfTheFaces) {
  TwoSheets sheets = two_sheets();
  const std::string face = "),#20,.T.)";
  const auto at = sheets.text.find(face);
  ASSERT_NE(at, std::string::npos);
  sheets.text.replace(at, face.size(), "),#20,.F.)");
  EXPECT_NEAR(check_of(opened(sheets.text), sheets.edge).angle.value_or(0), std::numbers::pi,
              1e-15);
}

TEST(EdgeCheck, WhatCannotBeFollowedIsSaid) {
  TwoSheets sheets = two_sheets(false, true);
  const auto at = sheets.text.find("#20=PLANE('',#21)");
  ASSERT_NE(at, std::string::npos);
  sheets.text.replace(at, 17, "#20=WAVY_PLANE('',#21)");
  const EdgeCheck check = check_of(opened(sheets.text), sheets.edge);
  EXPECT_NE(check.unknown.find("WAVY_PLANE"), std::string::npos) << check.unknown;
  EXPECT_FALSE(check.angle);
}

TEST(EdgeCheck, ThePageIsToldInDegrees) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets.text);
  run(session, {right, R"({"do":"points","which":[2,3],"by":[0,0,1]})"});
  const auto text = checked_edges_json(session, 0);
  ASSERT_TRUE(text) << text.error().message();
  const auto edges = nlohmann::json::parse(*text);
  ASSERT_EQ(edges.size(), 4U);
  for (const auto& edge : edges) {
    const bool shared = edge.at("id") == TwoSheets::name(sheets.edge);
    EXPECT_EQ(edge.at("faces").size(), shared ? 2U : 1U);
    EXPECT_EQ(edge.at("angle").is_null(), !shared);
    EXPECT_NEAR(shared ? edge.at("angle").get<double>() : 45, 45, 1e-12);
    EXPECT_TRUE(edge.at("curvature").is_null());
    EXPECT_EQ(edge.at("opened_curvature").is_null(), !shared);
  }
  Session fresh(Document::fresh("none"));
  run(fresh, {R"({"do":"new","shape":"plane"})"});
  EXPECT_EQ(*checked_edges_json(fresh, 0), "[]");
}

}  // namespace
}  // namespace knead
