// Commands are edits: what they do not name stays, to the last bit.
#include <fmt/format.h>

#include <cmath>

#include "sheet.hpp"

namespace knead {
namespace {

using testing::at;
using testing::first;
using testing::fresh;
using testing::on_sheet;
using testing::refusal;
using testing::run;

const Tool& tool_of(const Session& session) { return session.state().tools.front(); }

const std::vector<std::string> turned_box = {
    R"({"do":"tool","name":"b","shape":"box","sizes":[2,1,0.5],"rounding":0.1,"axis":[1,1,1],)"
    R"("position":[5,5,2],"mode":"proximity","stiffness":50,"range":3,"plasticity":0.5})",
    R"({"do":"turn","tool":"b","axis":[1,1,1],"angle":40})"};

TEST(EditTool, ChangesWhatItNamesAndNothingElse) {
  struct Case {
    const char* fields;
    void (*expect)(Tool&);
  };
  const std::vector<Case> cases = {
      {R"("sizes":[3,1,1])",
       [](Tool& t) {
         t.shape = *PlacedShape::create(BoxShape{{3, 1, 1}, 0.1}, t.shape.placement());
       }},
      {R"("rounding":0.2)",
       [](Tool& t) {
         t.shape = *PlacedShape::create(BoxShape{{2, 1, 0.5}, 0.2}, t.shape.placement());
       }},
      {R"("position":[1,2,3])",
       [](Tool& t) { t.shape = *t.shape.moved(t.shape.placement().rotation, Point(1, 2, 3)); }},
      {R"("orientation":[0,0,0,2])",
       [](Tool& t) {
         t.shape = *t.shape.moved(Eigen::Quaterniond::Identity(), t.shape.placement().position);
       }},
      {R"("stiffness":70)", [](Tool& t) { t.stiffness = 70; }},
      {R"("range":1)", [](Tool& t) { t.range = 1; }},
      {R"("mode":"collision")", [](Tool& t) { t.mode = ToolMode::collision; }},
      {R"("direction":"push")", [](Tool& t) { t.direction = ToolDirection::push; }},
      {R"("rigid":true)", [](Tool& t) { t.rigid = true; }},
      {R"("friction":0.3)", [](Tool& t) { t.friction = 0.3; }},
      {R"("plasticity":1)", [](Tool& t) { t.plasticity = 1; }}};
  for (const auto& [fields, expect] : cases) {
    for (const char* named : {R"("tool":"b",)", R"("name":"b",)", ""}) {
      Session session = on_sheet(turned_box), wanted = on_sheet(turned_box);
      run(session, {fmt::format(R"({{"do":"edit_tool",{}{}}})", named, fields)});
      SessionState state = wanted.state();
      expect(state.tools.front());
      EXPECT_TRUE(testing::same_state(session.state(), state)) << fields;
    }
  }
}

TEST(EditTool, AnotherAxisKeepsTheTurnAboutIt) {
  Session session = on_sheet(turned_box);
  const Eigen::Quaterniond before = tool_of(session).shape.placement().rotation;
  run(session, {R"({"do":"edit_tool","axis":[1,1,1]})"});
  EXPECT_LE((tool_of(session).shape.placement().rotation.coeffs() - before.coeffs()).norm(), 1e-14);
  run(session, {R"({"do":"edit_tool","axis":[0,0,1]})"});
  const Eigen::Quaterniond upright = tool_of(session).shape.placement().rotation;
  EXPECT_LE((upright * Point::UnitZ() - Point::UnitZ()).norm(), 1e-14);
  run(session, {R"({"do":"edit_tool","axis":[1,1,1]})"});
  EXPECT_LE((tool_of(session).shape.placement().rotation.coeffs() - before.coeffs()).norm(), 1e-14);
  // The same axis given to `tool` makes a new one, that is not turned.
  run(session, {turned_box.front()});
  EXPECT_GT((tool_of(session).shape.placement().rotation.coeffs() - before.coeffs()).norm(), 0.1);
}

TEST(EditTool, AnotherShapeKeepsTheMeasuresThatBothHave) {
  Session session =
      on_sheet({R"({"do":"tool","shape":"torus","radius":2,"minor":0.7,"position":[5,5,3]})",
                R"({"do":"edit_tool","shape":"supertoroid","exponents":[0.5,2]})"});
  EXPECT_EQ(tool_of(session).shape.shape(), Shape(SupertoroidShape{2, {0.7, 0.7}, 0.5, 2}));
  run(session, {R"({"do":"edit_tool","shape":"cylinder"})"});
  EXPECT_EQ(tool_of(session).shape.shape(), Shape(CylinderShape{2, 2}));
  run(session, {R"({"do":"edit_tool","height":5})"});
  EXPECT_EQ(tool_of(session).shape.shape(), Shape(CylinderShape{2, 2.5}));
}

TEST(EditTool, RefusesWhatTheShapeOrTheSceneDoesNotHave) {
  Session session = on_sheet(turned_box);
  const Error error = refusal(session, R"({"do":"edit_tool","minor":1})");
  EXPECT_EQ(error.where, "minor");
  EXPECT_NE(error.what.find("box"), std::string::npos) << error.what;
  EXPECT_NE(error.remedy.find("radius, sizes, rounding"), std::string::npos) << error.remedy;
  EXPECT_EQ(refusal(session, R"({"do":"edit_tool","tool":"ball"})").where, "tool");
  EXPECT_EQ(refusal(session, R"({"do":"edit_tool","tool":"b","name":"c"})").where, "name");
  EXPECT_EQ(refusal(session, R"({"do":"edit_tool","shape":"potato"})").where, "shape");
  EXPECT_EQ(refusal(session, R"({"do":"edit_tool","sizes":[1,0,1]})").where, "sizes");
  EXPECT_EQ(refusal(session, R"({"do":"edit_tool","orientation":[0,0,0,0]})").where, "orientation");
  EXPECT_EQ(refusal(session, R"({"do":"edit_tool","orientation":[0,0,0,1],"axis":[1,0,0]})").where,
            "orientation");
}

TEST(Tool, TakesAnOrientation) {
  const double half = std::sqrt(0.5);
  Session session = on_sheet(
      {fmt::format(R"({{"do":"tool","shape":"box","sizes":[1,2,3],"orientation":[0,0,{0},{0}],)"
                   R"("position":[5,5,5]}})",
                   half)});
  EXPECT_LE((tool_of(session).shape.placement().rotation * Point::UnitX() - Point::UnitY()).norm(),
            1e-15);
}

TEST(Tool, FieldsThatTheShapeDoesNotHaveAreRefused) {
  struct Case {
    const char *shape, *field, *value, *has;
  };
  for (const auto& [shape, field, value, has] :
       {Case{"supertoroid", "sizes", "[1,1,1]", "radius, minor, exponents"},
        Case{"sphere", "minor", "1", "radius"}, Case{"plane", "radius", "1", ""},
        Case{"capsule", "rounding", "0.1", "radius, height"},
        Case{"box", "surface", "\"#1\"", "radius, rounding, sizes"}}) {
    Session session = on_sheet();
    const Error error =
        refusal(session, fmt::format(R"({{"do":"tool","shape":"{}","position":[5,5,9],"{}":{}}})",
                                     shape, field, value));
    EXPECT_EQ(error.where, field);
    EXPECT_NE(error.what.find(shape), std::string::npos) << error.what;
    EXPECT_NE(error.remedy.find(has), std::string::npos) << error.remedy;
  }
}

TEST(New, FieldsThatTheShapeDoesNotHaveAreRefused) {
  Session session = fresh();
  EXPECT_EQ(refusal(session, R"({"do":"new","shape":"sphere","radius":2,"height":3})").where,
            "height");
  EXPECT_EQ(refusal(session, R"({"do":"new","shape":"sphere","radius":2,"size":[1,1]})").where,
            "size");
}

const char* const painted =
    R"({"do":"material","alpha":[4,0,4],"beta":[0.5,0.5,0.5],"region":[[0.2,0.6],[0.2,0.6]],)"
    R"("falloff":0.2})";

TEST(Material, MassAndDampingLeaveStretchAndBendAsTheyAre) {
  Session session = on_sheet({painted});
  const MaterialFieldOf<2> before = first(session).material;
  ASSERT_FALSE(std::holds_alternative<double>(before.alpha[0]));
  run(session, {R"({"do":"material","mass":3})", R"({"do":"material","damping":0.1})"});
  EXPECT_EQ(first(session).material.alpha, before.alpha);
  EXPECT_EQ(first(session).material.beta, before.beta);
  EXPECT_EQ(first(session).material.mass, Coefficient<2>(3.0));
  EXPECT_EQ(first(session).material.damping, Coefficient<2>(0.1));
}

TEST(Material, StretchLeavesBendAndBendLeavesStretch) {
  for (const char* region : {"", R"(,"region":[[0.4,0.9],[0.1,0.5]],"falloff":0.2)"}) {
    Session session = on_sheet({painted});
    const MaterialFieldOf<2> before = first(session).material;
    run(session, {fmt::format(R"({{"do":"material","alpha":[2,0,2]{}}})", region)});
    EXPECT_EQ(first(session).material.beta, before.beta);
    EXPECT_NE(first(session).material.alpha, before.alpha);
    run(session,
        {R"({"do":"undo"})", fmt::format(R"({{"do":"material","beta":[1,1,1]{}}})", region)});
    EXPECT_EQ(first(session).material.alpha, before.alpha);
    EXPECT_NE(first(session).material.beta, before.beta);
  }
}

double value(const Coefficient<2>& coefficient, double u, double v) {
  if (const double* constant = std::get_if<double>(&coefficient)) return *constant;
  const std::vector<double> us = {u}, vs = {v};
  return std::get<SplineField<2>>(coefficient).on_grid({us, vs})->front();
}

TEST(Material, ARegionKeepsRegionsPaintedBefore) {
  Session session = on_sheet(
      {painted,
       R"({"do":"material","alpha":[2,0,2],"region":[[0.4,0.9],[0.1,0.5]],"falloff":0.2})"});
  const MaterialFieldOf<2>& material = first(session).material;
  EXPECT_NEAR(value(material.alpha[0], 0.2, 0.6), 4, 1e-2);
  EXPECT_NEAR(value(material.alpha[0], 0.05, 0.9), 1, 1e-2);
  EXPECT_NEAR(value(material.alpha[0], 0.8, 0.3), 2, 1e-2);
  EXPECT_NEAR(value(material.beta[0], 0.5, 0.3), 0.5, 1e-2);
  EXPECT_NEAR(value(material.beta[0], 0.9, 0.3), 0.01, 1e-2);
}

TEST(Material, ThatNamesNothingIsRefused) {
  Session session = on_sheet({painted});
  const Error error = refusal(session, R"({"do":"material"})");
  EXPECT_EQ(error.where, "alpha");
  EXPECT_NE(error.remedy.find("reset"), std::string::npos) << error.remedy;
  EXPECT_EQ(refusal(session, R"({"do":"material","reset":false})").where, "alpha");
}

TEST(Material, AResetIsOfAllOfItAndComesFirst) {
  const SceneSurface fresh_one = first(on_sheet());
  for (const char* const more : {"", R"(,"mass":3,"beta":[1,1,1])"}) {
    Session session =
        on_sheet({painted, R"({"do":"material","preset":"sheet metal","mass":7,"damping":2})",
                  R"({"do":"material","model":"shell","young":210,"thickness":1})",
                  R"({"do":"material","coefficient":"alpha11","formula":"1 + s"})"});
    run(session, {fmt::format(R"({{"do":"material","reset":true{}}})", more)});
    MaterialFieldOf<2> wanted = fresh_one.material;
    if (*more != 0) {
      wanted.mass = 3.0;
      wanted.beta = {1.0, 1.0, 1.0};
    }
    EXPECT_EQ(first(session).material, wanted) << more;
    EXPECT_EQ(first(session).elasticity, fresh_one.elasticity);
    EXPECT_EQ(first(session).plastic, fresh_one.plastic);
  }
}

TEST(Material, ACurveIsResetToo) {
  Session session = fresh(), wanted = fresh();
  for (Session* const s : {&session, &wanted})
    run(*s, {R"({"do":"new","shape":"curve","form":"helix"})"});
  run(session,
      {R"({"do":"material","alpha":[3],"beta":[2],"mass":4,"damping":1,"model":"fundamental"})",
       R"({"do":"material","reset":true})"});
  const auto& curve = std::get<SceneCurve>(session.state().bodies.at(0));
  const auto& other = std::get<SceneCurve>(wanted.state().bodies.at(0));
  EXPECT_EQ(curve.material, other.material);
  EXPECT_EQ(curve.elasticity.index(), 0U);
}

TEST(Release, FreesWhatItNames) {
  const std::vector<std::string> held = {
      R"({"do":"hold","rows":1})",      R"({"do":"pin","control_points":[[4,4]]})",
      R"({"do":"pin","at":[0.3,0.3]})", R"({"do":"freeze","region":[[0,0.2],[0,1]]})",
      R"({"do":"keep","v":0.5})",       R"({"do":"symmetry","mirror":"v"})"};
  const auto left = [&](const std::string& what) {
    Session session = on_sheet(held);  // whose edges are held
    run(session, {fmt::format(R"({{"do":"release"{}}})", what)});
    const SceneSurface& s = first(session);
    std::string text = fmt::format("{} {}", s.hold_rows, s.pins.size());
    for (const KeptConstraint& kept : s.constraints)
      text += fmt::format(" {}", kept.constraint.index());
    return text;
  };
  EXPECT_EQ(left(R"(,"what":["hold"])"), "0 1 0 0 0 0 1 2 3 5");
  EXPECT_EQ(left(R"(,"what":["pins"])"), "1 0 0 0 0 0 2 3 5");
  EXPECT_EQ(left(R"(,"what":["edges"])"), "1 1 1 2 3 5");
  EXPECT_EQ(left(R"(,"what":["freeze","keep"])"), "1 1 0 0 0 0 1 5");
  EXPECT_EQ(left(R"(,"what":["symmetry"])"), "1 1 0 0 0 0 1 2 3");
  EXPECT_EQ(left(""), "0 0");
  Session session = on_sheet(held);
  EXPECT_EQ(refusal(session, R"({"do":"release","what":["edges","all"]})").where, "what[1]");
}

}  // namespace
}  // namespace knead
