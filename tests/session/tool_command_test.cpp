#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"
#include "sheet.hpp"

namespace knead {
namespace {

using testing::at;
using testing::ball;
using testing::first;
using testing::fresh;
using testing::lift;
using testing::moved;
using testing::new_sheet;
using testing::on_sheet;
using testing::open_sample;
using testing::refusal;
using testing::run;
using testing::same_bits;
using testing::same_state;

// What each command promises, on sheets of size 10 by 10 with nets of 10 by 10.

TEST(Command, EveryShapeOfToolPressesItsDent) {
  const std::vector<std::string> shapes = {
      R"("sphere")",
      R"("ellipsoid","sizes":[3,2,1.5])",
      R"("box","sizes":[2,2,1.5],"rounding":0.5)",
      R"("cylinder","radius":2,"height":3)",
      R"("cone","radius":2,"height":3,"top_radius":1,"axis":[0,0,1])",
      R"("capsule","radius":1.5,"height":2,"axis":[1,0,0])",
      R"("torus","radius":2,"minor":1.5)",
      R"("plane","axis":[0,0,1])",
      R"("bowl","radius":2,"thickness":0.5,"axis":[0,0,-1])",
      R"("superellipsoid","sizes":[2,2,1.5],"exponents":[0.5,0.5])",
      R"("supertoroid","radius":2,"minor":1.5,"exponents":[1,1])"};
  for (const std::string& shape : shapes) {
    const std::string radius =
        shape.find("radius") == std::string::npos && shape != shapes[7] ? R"(,"radius":2)" : "";
    const std::string z = shape == shapes[7] ? "0.3" : "-1.2";
    Session session = on_sheet(
        {R"({"do":"tool","shape":)" + shape + radius + R"(,"position":[5.1,5.2,)" + z + "]}",
         R"({"do":"step","count":2})"});
    EXPECT_GT(session.largest_displacement(0), 0.05) << shape;
    EXPECT_LT(session.largest_displacement(0), 4) << shape;
  }
}

TEST(Command, ASurfaceOfTheDocumentIsATool) {
  Session session = fresh();
  run(session,
      {R"({"do":"new","size":[4,4],"net":[5,5],"name":"stamp"})", new_sheet, R"({"do":"edge"})",
       R"({"do":"tool","shape":"surface","surface":"#1","position":[3,3,0.5],)"
       R"("mode":"proximity","range":2})",
       R"({"do":"step","count":2})"});
  EXPECT_GT(session.largest_displacement(1), 0.1);
  EXPECT_EQ(session.largest_displacement(0), 0);
  EXPECT_EQ(refusal(session, R"({"do":"tool","shape":"surface"})").where, "surface");
  EXPECT_EQ(refusal(session, R"({"do":"tool","shape":"surface","surface":"#9"})").where, "surface");
}

TEST(Command, ToolsRefuseWrongFieldsByName) {
  Session session = on_sheet({ball});
  for (const auto& [fields, field] : std::vector<std::pair<std::string, std::string>>{
           {R"("radius":0)", "radius"},
           {R"("shape":"torus","minor":-1)", "minor"},
           {R"("shape":"cylinder","height":0)", "height"},
           {R"("shape":"cone","top_radius":-1)", "top_radius"},
           {R"("shape":"bowl","thickness":0)", "thickness"},
           {R"("shape":"box","rounding":-1)", "rounding"},
           {R"("shape":"box","sizes":[1,0,1])", "sizes"},
           {R"("shape":"ellipsoid","sizes":[1,0,1])", "sizes"},
           {R"("shape":"superellipsoid","exponents":[0,1])", "exponents"},
           {R"("axis":[0,0,0])", "axis"},
           {R"("scale":[1,0,1])", "scale"},
           {R"("stiffness":-1)", "stiffness"},
           {R"("mode":"proximity","range":0)", "range"},
           {R"("friction":-1)", "friction"},
           {R"("plasticity":2)", "plasticity"},
           {R"("shape":"cube")", "shape"}}) {
    const Error e = refusal(session, R"({"do":"tool","position":[0,0,0],)" + fields + "}");
    EXPECT_EQ(e.kind, ErrorKind::input);
    EXPECT_EQ(e.where.substr(0, field.size()), field) << fields << ": " << e.message();
  }
  EXPECT_EQ(refusal(session, R"({"do":"turn","angle":1,"axis":[0,0,0]})").where, "axis");
  EXPECT_EQ(refusal(session, R"({"do":"scale","by":[1,0,1]})").where, "by");
  EXPECT_EQ(refusal(session, R"({"do":"turn","tool":"x","angle":1})").where, "tool");
}

TEST(Command, TurnAndScaleMoveTheToolAboutItsCentre) {
  Session session =
      on_sheet({R"({"do":"tool","shape":"box","sizes":[1,2,3],"position":[5,5,9]})",
                R"({"do":"turn","axis":[0,0,1],"angle":90})", R"({"do":"scale","by":[2,1,1]})"});
  const Tool& tool = session.state().tools.front();
  EXPECT_LT((tool.shape.placement().position - Point(5, 5, 9)).norm(), 1e-15);
  const auto distance = [&](double x, double y) {
    return tool.shape.nearest(Point(x, y, 9)).distance;
  };
  EXPECT_NEAR(distance(5, 5 + 3), 1, 1e-12) << "its x, doubled, points along y now";
  EXPECT_NEAR(distance(5 + 3, 5), 1, 1e-12);
}

TEST(Command, ImprintAndPlasticityKeepTheirShareWhenTheToolGoes) {
  const auto left = [](const std::string& fields) {
    Session session = on_sheet({R"({"do":"tool","radius":2,"position":[5,5,-1.2])" + fields + "}",
                                R"({"do":"step","count":4,"lambda":0.5})", R"({"do":"remove"})",
                                R"({"do":"step","count":40,"lambda":0.01})"});
    return session.largest_displacement(0);
  };
  const double elastic = left(""), half = left(R"(,"plasticity":0.5)"),
               all = left(R"(,"plasticity":1)"), imprint = left(R"(,"mode":"imprint")");
  EXPECT_LT(elastic, 1e-6);
  EXPECT_NEAR(half / all, 0.5, 0.02);
  EXPECT_GT(imprint, 0.9 * all);
  EXPECT_GT(all, 0.3);
}

TEST(Command, SpringsDrawAndVolcanoesDriveAway) {
  Session session =
      on_sheet({R"({"do":"force","name":"s","at":[0.5,0.5],"to":[5,5,3],"strength":100})",
                R"({"do":"step","count":10,"lambda":0.1})"});
  EXPECT_GT(at(*first(session).current, 0.5, 0.5).z(), 1);
  EXPECT_LT(at(*first(session).current, 0.5, 0.5).z(), 3);
  run(session, {R"({"do":"remove","tool":"s"})", R"({"do":"step","count":20,"lambda":0.01})"});
  EXPECT_LT(session.largest_displacement(0), 1e-3);
  run(session, {R"({"do":"force","kind":"volcano","at":[0.5,0.5],"to":[5,5,-1],"strength":0.1})",
                R"({"do":"step","count":5})"});
  EXPECT_GT(at(*first(session).current, 0.5, 0.5).z(), 0.01);
  EXPECT_EQ(refusal(session, R"({"do":"force","at":[2,0],"to":[0,0,0]})").where, "at[0]");
  EXPECT_EQ(refusal(session, R"({"do":"force","at":[0,0],"to":[0,0,0],"strength":-1})").where,
            "strength");
  EXPECT_EQ(refusal(session, R"({"do":"force","at":[0,0],"to":[0,0,0],"core":0})").where, "core");
}

TEST(Command, AForceStaysWithItsSurface) {
  Session session = fresh();
  run(session, {new_sheet, R"({"do":"edge"})", new_sheet, R"({"do":"edge"})",
                R"({"do":"force","at":[0.5,0.5],"to":[5,5,3]})",
                R"({"do":"select","surface":"#1"})", R"({"do":"step"})"});
  EXPECT_EQ(session.largest_displacement(0), 0);
  run(session, {R"({"do":"seams","couple":false})", R"({"do":"select","surfaces":["#1","#2"]})",
                R"({"do":"step"})"});
  EXPECT_EQ(session.largest_displacement(0), 0);
  EXPECT_GT(session.largest_displacement(1), 0.01);
}

TEST(Command, LoadsPressAndTheLimitHolds) {
  for (const std::string load :
       {R"("vector":[0,0,2])", R"("gravity":[0,0,2])", R"("pressure":2)", R"("wind":[0,0,2])"}) {
    Session session = on_sheet({R"({"do":"load",)" + load + "}", R"({"do":"step","count":3})"});
    EXPECT_GT(at(*first(session).current, 0.5, 0.5).z(), 1e-3) << load;
    run(session, {R"({"do":"load"})", R"({"do":"step","count":30,"lambda":0.01})"});
    EXPECT_LT(session.largest_displacement(0), 1e-3) << load;
  }
  Session session =
      on_sheet({R"({"do":"load","vector":[0,0,30]})", R"({"do":"limit","distance":0.25})",
                R"({"do":"step","count":5,"lambda":0.1})"});
  EXPECT_LT(session.largest_displacement(0), 0.25 * (1 + 1e-5));
  EXPECT_GT(session.largest_displacement(0), 0.2);
  EXPECT_TRUE(session.state().steps.back().limited);
  EXPECT_EQ(refusal(session, R"({"do":"limit","distance":0})").where, "distance");
  run(session, {R"({"do":"limit"})", R"({"do":"step","count":5,"lambda":0.1})"});
  EXPECT_GT(session.largest_displacement(0), 0.3);
}

}  // namespace
}  // namespace knead
